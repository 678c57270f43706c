// Checks that run inside the page; each returns a list of faults. Playwright sends them there as they stand, so none uses another's names.

/** Headings, contents, and texts that show a value gone missing. */
export function structure() {
  const faults = [];
  const text = (node) => (node?.textContent ?? "").trim();
  const sections = [...document.querySelectorAll("main > section.part")];
  if (sections.length === 0) faults.push("there is no section");
  if (document.querySelectorAll("h1").length !== 1) faults.push("there is not one h1");
  for (const broken of document.querySelectorAll(".broken")) faults.push(`a section is broken: ${text(broken)}`);
  for (const section of sections) {
    if (text(section.querySelector("h2")) === "") faults.push(`section ${section.id} has no heading`);
    if (!section.querySelector(".block")) faults.push(`section ${section.id} is empty`);
    for (const block of section.querySelectorAll(".block")) {
      if (text(block.querySelector("h3")) === "") faults.push(`block ${block.id} has no heading`);
      if (block.children.length < 2) faults.push(`block ${block.id} has nothing below its heading`);
    }
  }
  const ids = [...document.querySelectorAll("[id]")].map((node) => node.id);
  for (const id of new Set(ids.filter((one, index) => ids.indexOf(one) !== index))) faults.push(`two elements have the id ${id}`);
  for (const link of document.querySelectorAll('#contents a[href^="#"]'))
    if (!document.getElementById(decodeURIComponent(link.hash.slice(1)))) faults.push(`the contents lead to ${link.hash}, which is not there`);
  if (document.querySelectorAll("#contents a").length < sections.length) faults.push("a section is missing from the contents");
  for (const node of document.querySelectorAll("td.number, dd, .sentence, svg text, option, output"))
    if (/\b(undefined|NaN)\b|\[object/.test(text(node))) faults.push(`a number reads "${text(node).slice(0, 60)}"`);
  for (const node of document.querySelectorAll("main td, main th, main figcaption, main p, main li"))
    if (/\[object|^undefined$/.test(text(node))) faults.push(`a text reads "${text(node).slice(0, 60)}"`);
  for (const table of document.querySelectorAll("main table")) {
    if (text(table.caption) === "") faults.push("a table has no caption");
    if (table.querySelector("th:not([scope])")) faults.push(`table "${text(table.caption)}": a heading has no scope`);
    if (table.querySelectorAll("tbody tr").length === 0) faults.push(`table "${text(table.caption)}" has no rows`);
  }
  for (const control of document.querySelectorAll("input, select, canvas"))
    if (!control.getAttribute("aria-label") && !control.labels?.length) faults.push(`a ${control.localName} has no name`);
  for (const image of document.querySelectorAll("img")) if (!image.alt || !image.src.startsWith("data:")) faults.push("a picture has no text beside it, or lies outside the page");
  if (document.querySelector("main script, main iframe, main object, main [onerror], main [onload]")) faults.push("a text of the data has become an element");
  return faults;
}

/** Charts have marks, named axes, and no text that is cut. */
export function charts() {
  const faults = [];
  const squeeze = (text) => text.replace(/\s/g, "");
  const AXES = ["#1c2329", "#55606a", "#d9dee3", "#ffffff", "#eceff2", "none", "transparent"];
  const colour = (node, name) => {
    const value = (node.getAttribute(name) ?? node.style[name] ?? "").toLowerCase();
    const channels = /^rgba?\((\d+), ?(\d+), ?(\d+)/.exec(value);
    return channels ? `#${channels.slice(1, 4).map((one) => Number(one).toString(16).padStart(2, "0")).join("")}` : value;
  };
  for (const chart of document.querySelectorAll(".chart")) {
    const name = (chart.getAttribute("aria-label") ?? "").slice(0, 50);
    if (name === "") faults.push("a chart has no text beside it");
    const drawing = chart.querySelector("svg");
    if (!drawing) {
      faults.push(`chart "${name}" is not drawn`);
      continue;
    }
    const box = drawing.getBoundingClientRect();
    const isKey = (found) => Math.abs(found.width - 18) < 2 && Math.abs(found.height - 9) < 2; // the legend's signs
    const marks = [...drawing.querySelectorAll("path, rect, circle, polygon, polyline, line")].filter((node) => {
      const [fill, stroke] = [colour(node, "fill"), colour(node, "stroke")];
      const painted = (fill !== "" && !AXES.slice(3).includes(fill)) || (stroke !== "" && !AXES.includes(stroke));
      const found = node.getBoundingClientRect();
      return painted && !node.closest("defs, clipPath") && found.width + found.height > 1 && !isKey(found);
    });
    if (marks.length === 0) faults.push(`chart "${name}" has no marks`);
    const texts = [...drawing.querySelectorAll("text")];
    const written = squeeze(texts.map((node) => node.textContent).join(""));
    const axes = JSON.parse(chart.dataset.axes ?? "[]");
    if (axes.length === 0) faults.push(`chart "${name}" names no axis`);
    for (const axis of axes) if (squeeze(axis) === "" || !written.includes(squeeze(axis))) faults.push(`chart "${name}": the axis "${axis}" is not named`);
    for (const node of texts) {
      const found = node.getBoundingClientRect();
      if (found.left < box.left - 2 || found.right > box.right + 2 || found.top < box.top - 2 || found.bottom > box.bottom + 2)
        faults.push(`chart "${name}": the text "${node.textContent}" is cut`);
    }
  }
  return faults;
}

/** Nothing stands out of the window; wide tables and long lines scroll in boxes of their own. */
export function overflow() {
  const width = document.documentElement.clientWidth;
  const faults = [];
  if (document.documentElement.scrollWidth > width) faults.push(`the page scrolls sideways: ${document.documentElement.scrollWidth} px in ${width}`);
  for (const node of document.querySelectorAll("body *")) {
    const found = node.getBoundingClientRect();
    if (found.width === 0 || (found.right <= width + 1 && found.left >= -1)) continue;
    if (node.closest(".table-box table, pre, .skip, svg")) continue;
    faults.push(`${node.localName}${node.className ? `.${String(node.className).split(" ")[0]}` : ""} reaches from ${Math.round(found.left)} to ${Math.round(found.right)} px`);
  }
  return faults.slice(0, 5);
}

/** Comes by every chart, as a reader does, until it is drawn; with `open` all that is shut is opened before. */
export async function visit(open) {
  const PATIENCE = 30000; // ms for one chart, on a machine that is busy with something else
  document.documentElement.style.scrollBehavior = "auto";
  if (open) for (const details of document.querySelectorAll("main details")) details.open = true;
  await new Promise((resolve) => setTimeout(resolve, 200));
  for (const chart of document.querySelectorAll(".chart")) {
    if (chart.closest("details:not([open])")) continue;
    chart.scrollIntoView({ block: "center" });
    for (const end = performance.now() + PATIENCE; !chart.querySelector("svg") && performance.now() < end; ) await new Promise((resolve) => setTimeout(resolve, 30));
  }
  window.scrollTo(0, 0);
}
