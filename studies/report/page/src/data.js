// The data that millscope has put into the page, and its compressed numbers.

const MARK = "millscope-data";

/** The document, or an Error whose message says what is wrong with the page. */
export function readDocument() {
  const holder = document.getElementById(MARK);
  const text = holder ? holder.textContent : "";
  if (text.trim() === "" || text.startsWith("@")) throw new Error("This page was made without data: make it with millscope report.");
  let found;
  try {
    found = JSON.parse(text);
  } catch (error) {
    throw new Error(`The data of this page cannot be read (${error.message}): the file was cut or changed; make or send it again.`);
  }
  holder.textContent = ""; // it may be large, and is not needed twice
  return checked(found);
}

export function checked(found) {
  if (!found || !Array.isArray(found.sections)) throw new Error("The data of this page have no sections: make the page again.");
  if (found.schema_version !== 1)
    throw new Error(`The data of this page have version ${found.schema_version}, and it reads version 1: make it with one millscope.`);
  return found;
}

const TYPES = { f32: Float32Array, u32: Uint32Array, u16: Uint16Array, u8: Uint8Array };

/** {"deflate": base64 of zlib} → typed array of `expected` numbers. */
export async function inflate(packed, type, expected, what) {
  const text = atob(packed.deflate);
  const bytes = new Uint8Array(text.length);
  for (let index = 0; index < text.length; index++) bytes[index] = text.charCodeAt(index);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const content = await new Response(stream).arrayBuffer();
  const array = new TYPES[type](content, 0, Math.floor(content.byteLength / TYPES[type].BYTES_PER_ELEMENT));
  if (expected !== undefined && array.length !== expected)
    throw new Error(`${what}: ${array.length} numbers where ${expected} belong; make the page again.`);
  return array;
}
