// Every chart and 3-D view of a page as a small picture, so small that a browser's next version makes next to no difference to it and an
// empty chart, another colour or many marks that are missing do; a single one of twenty may not. Texts are left out and take up a room that
// does not depend on the machine's fonts. The small pictures of a page lie side by side in one PNG that is kept with the tests.
import { existsSync, readFileSync } from "node:fs";
import { PNG } from "pngjs";
import { keepFile } from "./browser.mjs";
import { decode } from "./picture.mjs";

const [WIDE, HIGH, ACROSS] = [60, 40, 8]; // cells of a small picture; pictures in a row of the sheet
const INK = 40; // difference from white, of 255, in an empty picture
const TOLERANCE = 0.15; // share of what is drawn; up to 0.06 between two looks at one page, whatever the fonts; 0.15 to 0.6 for another colour

/** Runs in the page before its own programs: charts are laid out as if every letter were as wide as every other. */
export function fixTexts() {
  CanvasRenderingContext2D.prototype.measureText = function (text) {
    const size = Number(/([\d.]+)px/.exec(this.font)?.[1] ?? 12);
    return { width: 0.55 * size * text.length, actualBoundingBoxAscent: 0.75 * size, actualBoundingBoxDescent: 0.25 * size };
  };
}

/** Mean colour of each cell. */
function small(picture) {
  const cells = new Float64Array(WIDE * HIGH * 3);
  for (let row = 0; row < HIGH; row++)
    for (let column = 0; column < WIDE; column++) {
      const [top, bottom] = [row, row + 1].map((at) => Math.round((at * picture.height) / HIGH));
      const [left, right] = [column, column + 1].map((at) => Math.round((at * picture.width) / WIDE));
      for (let channel = 0; channel < 3; channel++) {
        let sum = 0;
        for (let y = top; y < bottom; y++) for (let x = left; x < right; x++) sum += picture.data[4 * (y * picture.width + x) + channel];
        cells[3 * (row * WIDE + column) + channel] = sum / Math.max(1, (bottom - top) * (right - left));
      }
    }
  return cells;
}

/** The least difference of a cell from the other picture's cells around it: what has moved by a cell has not changed. */
function apart(one, other, row, column) {
  let least = Infinity;
  for (let y = Math.max(0, row - 1); y <= Math.min(HIGH - 1, row + 1); y++)
    for (let x = Math.max(0, column - 1); x <= Math.min(WIDE - 1, column + 1); x++) {
      let sum = 0;
      for (let channel = 0; channel < 3; channel++) sum += Math.abs(one[3 * (row * WIDE + column) + channel] - other[3 * (y * WIDE + x) + channel]);
      least = Math.min(least, sum);
    }
  return least;
}

/** How much of what is drawn in either picture is missing in the other, 0 … 1 and more. */
function change(one, other) {
  let [changed, drawn] = [0, 0];
  for (let row = 0; row < HIGH; row++)
    for (let column = 0; column < WIDE; column++) {
      changed += Math.max(apart(one, other, row, column), apart(other, one, row, column));
      for (let channel = 0; channel < 3; channel++) drawn += 255 - Math.min(one[3 * (row * WIDE + column) + channel], other[3 * (row * WIDE + column) + channel]);
    }
  return changed / Math.max(drawn, INK);
}

/** A chart's drawing on an empty page, without its texts: there it has no place between pixels, which thin lines would show. */
async function alone(page, chart) {
  const drawing = await chart.evaluate((node) => node.querySelector("svg").outerHTML);
  await page.setContent(`<style>body { margin: 0 } svg { display: block } text { visibility: hidden }</style>${drawing}`);
  return page.locator("svg").first().screenshot();
}

/** [{name, cells}] of all charts and 3-D views in the order of the page. */
async function gather(page) {
  const found = [];
  const empty = await page.context().newPage();
  for (const element of await page.locator(".chart:has(svg), .view canvas").all()) {
    const flat = await element.evaluate((node) => node.matches(".chart"));
    await (flat ? empty : page).bringToFront(); // a page behind another draws nothing
    found.push({ name: (await element.getAttribute("aria-label")) ?? "", cells: small(decode(flat ? await alone(empty, element) : await element.screenshot({ animations: "disabled" }))) });
  }
  return found;
}

/** Where on a sheet number `at` of a small picture lies. */
const place = (sheet, index, at) => {
  const [row, column] = [Math.floor(at / (3 * WIDE)), Math.floor(at / 3) % WIDE];
  return 4 * ((Math.floor(index / ACROSS) * HIGH + row) * sheet.width + (index % ACROSS) * WIDE + column) + (at % 3);
};

function sheetOf(pictures) {
  const sheet = new PNG({ width: ACROSS * WIDE, height: Math.ceil(pictures.length / ACROSS) * HIGH });
  sheet.data.fill(255);
  pictures.forEach(({ cells }, index) => cells.forEach((value, at) => (sheet.data[place(sheet, index, at)] = Math.round(value))));
  return sheet;
}

/** The picture with this number on a sheet. */
const cellsOf = (sheet, index) => Float64Array.from({ length: WIDE * HIGH * 3 }, (_, at) => sheet.data[place(sheet, index, at)]);

/** Writes the sheet of a page. */
export async function keep(page, file) {
  keepFile(file, PNG.sync.write(sheetOf(await gather(page))));
}

/** Holds a page against its sheet. */
export async function hold(page, file, complain) {
  if (!existsSync(file)) return complain(`there is no ${file} to compare with: make it with --keep`);
  const [pictures, sheet] = [await gather(page), decode(readFileSync(file))];
  if (sheet.width !== ACROSS * WIDE || sheet.height !== Math.ceil(pictures.length / ACROSS) * HIGH)
    return complain(`it has ${pictures.length} charts, which ${file} has not: look at the page, then keep it with --keep`);
  for (let index = pictures.length; index < ACROSS * (sheet.height / HIGH); index++)
    if (cellsOf(sheet, index).some((value) => value !== 255)) return complain(`${file} has more charts than the page's ${pictures.length}`);
  pictures.forEach(({ name, cells }, index) => {
    const found = change(cells, cellsOf(sheet, index));
    if (found > TOLERANCE) complain(`"${name.slice(0, 60)}" differs from its picture in ${file} by ${Math.round(100 * found)} % of what is drawn, more than ${100 * TOLERANCE} %`);
  });
}
