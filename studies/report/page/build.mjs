// node build.mjs OUTDIR: writes OUTDIR/page.html, the report page with everything in it but the data.
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, readFileSync, renameSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const LARGEST = 1_300_000; // bytes: the page goes by mail, with its data on top

// What esbuild puts into the page, and the files with its terms.
const BUNDLED = [
  ["Apache ECharts", "echarts", ["NOTICE", "LICENSE", "licenses/LICENSE-d3"]],
  ["ZRender", "zrender", ["LICENSE"]],
  ["tslib", "tslib", ["LICENSE.txt"]],
  ["three.js", "three", ["LICENSE"]],
];

function fail(message) {
  console.error(`build.mjs: ${message}`);
  process.exit(1);
}

const escapeHtml = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");

function licences(inputs) {
  const folders = new Set();
  for (const path of Object.keys(inputs)) {
    const found = /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path);
    if (found) folders.add(found[1]);
  }
  const unknown = [...folders].filter((folder) => !BUNDLED.some((entry) => entry[1] === folder));
  if (unknown.length > 0) fail(`${unknown.join(", ")} would be bundled without a licence: add it to BUNDLED`);
  return BUNDLED.filter((entry) => folders.has(entry[1])).map(([name, folder, files]) => {
    const at = join(here, "node_modules", folder);
    const version = JSON.parse(readFileSync(join(at, "package.json"), "utf8")).version;
    const text = files.map((file) => readFileSync(join(at, file), "utf8").trim()).join("\n\n");
    return `<h3>${name} ${version}</h3>\n<pre>${escapeHtml(text)}</pre>`;
  }).join("\n");
}

/** Tables of palette.hpp, the header of the pictures, for src/colours.js. */
function writePalette() {
  const header = readFileSync(join(here, "palette.hpp"), "utf8");
  const tables = [...header.matchAll(/> k(\w+)\{([^}]*)\};/g)].map(([, name, body]) => [name.toUpperCase(), body.match(/0x[0-9a-f]{6}/g).map((hex) => `#${hex.slice(2)}`)]);
  if (tables.map(([name]) => name).join() !== "SEQUENTIAL,DIVERGING,DISTINCT") fail("palette.hpp has not the tables Sequential, Diverging and Distinct");
  writeFileSync(join(here, "src/palette.js"), tables.map(([name, colours]) => `export const ${name} = ${JSON.stringify(colours)};\n`).join(""));
}

async function main() {
  const out = process.argv[2];
  if (!out || process.argv.length > 3) fail("usage: node build.mjs OUTDIR");
  if (!existsSync(join(here, "node_modules"))) fail(`there is no node_modules in ${here}: run npm ci there first`);
  writePalette();
  const { build } = await import("esbuild");
  const common = { bundle: true, minify: true, write: false, target: "es2020", charset: "utf8", legalComments: "none", logLevel: "error" };
  const code = await build({ ...common, entryPoints: [join(here, "src/main.js")], format: "iife", metafile: true,
    define: { "process.env.NODE_ENV": '"production"' } });
  const sheet = await build({ ...common, entryPoints: [join(here, "style.css")] });

  // Inside <script> an end tag ends the script wherever it stands, and <!-- begins a comment.
  const script = code.outputFiles[0].text.replace(/<\/(script)/gi, "<\\/$1").replace(/\r/g, "");
  if (/<!--/.test(script)) fail("the script contains <!--, which HTML would take for a comment: write that text otherwise");
  const style = sheet.outputFiles[0].text.replace(/\r/g, "");
  if (/<\/style/i.test(style)) fail("style.css contains </style, which would end it: write that text otherwise");

  // Only this very script may run, whatever the data contain. connect-src 'self' is for `millscope watch`; a file has no 'self' to ask.
  const hash = createHash("sha256").update(script, "utf8").digest("base64");
  const policy = [`default-src 'none'`, `script-src 'sha256-${hash}'`, `style-src 'unsafe-inline'`, `img-src data:`, `connect-src 'self'`,
    `base-uri 'none'`, `form-action 'none'`].join("; ");

  const parts = { POLICY: policy, STYLE: style, SCRIPT: script, LICENCES: licences(code.metafile.inputs) };
  const page = readFileSync(join(here, "index.html"), "utf8").replace(/%([A-Z]+)%/g, (all, name) => parts[name] ?? all);
  for (const mark of ["@DATA@", "@TITLE@"])
    if (page.split(mark).length !== 2) fail(`the page has ${page.split(mark).length - 1} times ${mark}, not once: it is the place where data go in`);
  const bytes = Buffer.byteLength(page);
  if (bytes > LARGEST) fail(`the page has ${bytes} bytes, more than ${LARGEST}: import less`);

  mkdirSync(out, { recursive: true });
  writeFileSync(join(out, "page.html.tmp"), page);
  renameSync(join(out, "page.html.tmp"), join(out, "page.html"));
  console.log(`wrote ${join(out, "page.html")} (${bytes} bytes)`);
}

main().catch((error) => fail(error.message));
