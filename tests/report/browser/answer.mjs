// node answer.mjs PAGE.html [--chromium PATH]: prints what stands on the page from above, one line each: in an answer its headings, first
// sentence, next step, pictures and tables; of all else the contents, the kinds of the sections, and what is said first of a
// calibration's parameters.
import { openPage } from "./browser.mjs";

const { browser, page } = await openPage("answer.mjs", "usage: node answer.mjs PAGE.html [--chromium PATH]");
const lines = await page.evaluate(() => [...document.querySelectorAll(".answer h2, .answer h3, .answer p, .answer .chart, .answer table, #contents, main > .part, .part [id$=-parameters] > h3 + p")]
  .sort((one, other) => (one.compareDocumentPosition(other) & Node.DOCUMENT_POSITION_FOLLOWING ? -1 : 1)).map((node) => {
    if (node.id === "contents") return "contents";
    if (node.matches(".part")) return `section ${node.dataset.kind}`;
    if (node.matches(".chart")) return `chart ${node.getAttribute("aria-label")}`;
    if (node.matches("table")) return `table ${[...node.rows].map((row) => [...row.cells].map((cell) => cell.innerText.replace(/\s+/g, " ").trim()).join("|")).join(" / ")}`;
    return node.textContent;
  }));
for (const text of lines) console.log(text.replace(/\u00a0/g, " "));
await browser.close();
