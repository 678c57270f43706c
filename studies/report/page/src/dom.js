// Markup without markup: every text goes in as a text node, so that no text from the data can become an element.

const SVG = "http://www.w3.org/2000/svg";

function append(parent, child) {
  if (child === null || child === undefined || child === false) return;
  if (Array.isArray(child)) child.forEach((one) => append(parent, one));
  else parent.append(child instanceof Node ? child : document.createTextNode(String(child)));
}

function build(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") node.addEventListener(name, value);
    else node.setAttribute(name, value === true ? "" : String(value));
  }
  append(node, children);
  return node;
}

/** element("p", {class: "note", click: handler}, "text", node, [more]) */
export const element = (name, attributes, ...children) => build(document.createElement(name), attributes, children);
export const svg = (name, attributes, ...children) => build(document.createElementNS(SVG, name), attributes, children);

let counter = 0;
/** An id that no other element of this page has. */
export const freshId = (stem) => `${stem}-${++counter}`;

/** Columns: {label, value(row) → text or node, number: right-aligned, wide: for sentences, header: names the row}. Rows of one groupOf(row) stand under its name. */
export function table({ caption, columns, rows, classOf, groupOf }) {
  const kind = (column) => (column.number ? "number" : column.wide ? "wide" : null);
  const cell = (row) => (column, index) => {
    const name = column.header || (index === 0 && !columns.some((one) => one.header)) ? "th" : "td";
    return element(name, { class: kind(column), scope: name === "th" ? "row" : null }, column.value(row));
  };
  const head = columns.map((column) => element("th", { scope: "col", class: kind(column) }, column.label));
  const groupRow = (name) => element("tr", { class: "group" }, element("th", { scope: "rowgroup", colspan: columns.length }, element("span", null, name)));
  const body = rows.flatMap((row, index) => {
    const begins = groupOf && (index === 0 || groupOf(rows[index - 1]) !== groupOf(row));
    return [begins ? groupRow(groupOf(row)) : null, element("tr", { class: classOf ? classOf(row) : null }, columns.map(cell(row)))];
  });
  return element("div", { class: "table-box", tabindex: 0, role: "region", "aria-label": caption },
    element("table", null, element("caption", null, element("span", null, caption)), element("thead", null, element("tr", null, head)),
      element("tbody", null, body)));
}

/** Pairs of a name and what it is, for single facts. */
export const facts = (pairs) => element("dl", { class: "facts" },
  pairs.filter(Boolean).map(([name, value, note]) =>
    element("div", null, element("dt", null, name), element("dd", null, value, note ? element("small", null, note) : null))));

const opened = new Map(); // by key: what the reader has opened, for when a live page is built anew

/** Shut until it is opened; `fill` may be a function that makes the content at the first opening. */
export function disclosure(key, summary, fill, openAtFirst = false) {
  const details = element("details", { "data-key": key }, element("summary", null, summary));
  let filled = typeof fill !== "function";
  if (filled) append(details, fill);
  const complete = () => {
    if (!filled) append(details, fill());
    filled = true;
  };
  if (opened.get(key) ?? openAtFirst) {
    complete();
    details.open = true;
  }
  details.addEventListener("toggle", () => {
    opened.set(key, details.open);
    if (details.open) complete();
  });
  details.complete = complete; // printing shows what is inside
  return details;
}

export const list = (items, attributes) => element("ul", attributes, items.map((item) => element("li", null, item)));
export const paragraph = (...children) => element("p", null, ...children);
export const note = (...children) => element("p", { class: "note" }, ...children);

/** A figure with its caption below. */
export const figure = (caption, ...children) =>
  element("figure", null, ...children, element("figcaption", null, caption));

/** A part of a section, with a heading that the contents list finds. */
export const block = (id, title, ...children) => {
  const filled = children.flat().some((child) => child !== null && child !== undefined && child !== false);
  return filled ? element("section", { class: "block", id, "data-title": title }, element("h3", null, title), ...children) : null;
};
