// node check.mjs PAGE.html… [--screens DIR] [--keep DIR] [--compare DIR] [--chromium PATH]: opens each page as a file, wide and narrow, and looks for
// faults; one line per fault, exit code 1 where there are any. docs of the checks: look.mjs, solid.mjs.
import { existsSync } from "node:fs";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { PATIENCE, dataOf, keepFile, launch, readArguments, stop, watch } from "./browser.mjs";
import { charts, overflow, structure, visit } from "./look.mjs";
import { fixTexts, hold, keep } from "./reference.mjs";
import { solid } from "./solid.mjs";

const PROGRAM = "check.mjs";
const USAGE = "usage: node check.mjs PAGE.html… [--screens DIR] [--keep DIR] [--compare DIR] [--chromium PATH]";
const WIDTHS = [1280, 390];
const TALLEST = 3000; // px of a screenshot

const { pages, options } = readArguments(PROGRAM, USAGE, ["screens", "keep", "compare", "chromium"]);
if (options.compare && !existsSync(options.compare)) stop(`${PROGRAM}: there is no folder ${options.compare} to compare with: make it with --keep`);

/** A long page gives several pictures, because browsers refuse or repeat what is taller than a texture of their renderer. */
async function screenshots(page, name) {
  const height = await page.evaluate(() => document.documentElement.scrollHeight);
  const { width } = page.viewportSize();
  for (let top = 0, part = 1; top < height; top += TALLEST, part += 1) {
    const clip = { x: 0, y: top, width, height: Math.min(TALLEST, height - top) };
    keepFile(join(options.screens, `${name}-${part}.png`), await page.screenshot({ fullPage: true, clip }));
  }
}

/** What printing does, without a printer: all opened, all drawn, no controls. */
async function printed(page, complain) {
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  await page.emulateMedia({ media: "print" });
  const faults = await page.evaluate(() => {
    const found = [];
    if (document.querySelector("main details:not([open])")) found.push("something stays shut on paper");
    const undrawn = [...document.querySelectorAll(".chart")].filter((chart) => !chart.querySelector("svg")).length;
    if (undrawn > 0) found.push(`${undrawn} charts are missing on paper`);
    const wide = [...document.querySelectorAll(".chart svg")].filter((drawing) => drawing.getBoundingClientRect().width > 700).length;
    if (wide > 0) found.push(`${wide} charts are wider than the paper`);
    for (const canvas of document.querySelectorAll(".view canvas")) {
      const [whole, shown] = [canvas.getBoundingClientRect(), canvas.parentElement.getBoundingClientRect()];
      if (whole.width > shown.width + 2 || whole.height > shown.height + 2) found.push("a picture in 3-D is cut on paper");
    }
    if ([...document.querySelectorAll(".controls, .chooser")].some((node) => node.offsetParent !== null)) found.push("controls are printed");
    return found;
  });
  faults.forEach(complain);
  const bytes = await page.pdf({ format: "A4" });
  if (bytes.length < 10000) complain(`printing gives a file of ${bytes.length} bytes`);
}

async function newPage(browser, width) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, reducedMotion: "reduce", colorScheme: "light" });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE);
  return page;
}

/** Its charts and 3-D views against those that were kept. */
async function pictured(browser, path, width, complain) {
  const page = await newPage(browser, width);
  await page.addInitScript(fixTexts);
  await page.goto(pathToFileURL(resolve(path)).href);
  await page.waitForSelector("main > section");
  await page.evaluate(visit, true);
  await page.waitForTimeout(400);
  const name = `${basename(path, ".html")}-${width}.png`;
  if (options.keep) await keep(page, join(options.keep, name));
  if (options.compare) await hold(page, join(options.compare, name), complain);
  await page.context().close();
}

async function look(browser, path, data, width, complain) {
  const page = await newPage(browser, width);
  const url = pathToFileURL(resolve(path)).href;
  watch(page, (asked) => asked === url || /^(data|blob):/.test(asked), complain);
  await page.goto(url);
  await page.waitForSelector("main > section, main > .missing");
  const shown = await page.evaluate(() => ({ title: document.title, head: document.querySelector("h1")?.textContent, sections: [...document.querySelectorAll("main > .part h2")].map((node) => node.textContent) }));
  if (shown.head !== data.title || shown.title !== data.title) complain(`the title is shown as "${shown.head}", it is "${data.title}"`);
  data.sections.forEach((section, index) => shown.sections[index] !== section.title && complain(`section ${index + 1} is headed "${shown.sections[index]}", not "${section.title}"`));
  (await page.evaluate(overflow)).forEach(complain);
  if (options.screens) {
    await page.evaluate(visit, false);
    await page.waitForTimeout(400);
    await screenshots(page, `${basename(path, ".html")}-${width}`);
  }
  await solid(page, data, width === WIDTHS[0], complain);
  await page.evaluate(visit, true);
  await page.waitForTimeout(300);
  for (const check of [structure, charts, overflow]) (await page.evaluate(check)).forEach(complain);
  if (width === WIDTHS[0]) await printed(page, complain);
  await page.context().close();
}

/** Without WebGL a sentence stands where the 3-D would be, and the rest works. */
async function withoutSolid(browser, path, complain) {
  const page = await newPage(browser, WIDTHS[0]);
  page.on("pageerror", (error) => complain(`error: ${error.message}`));
  await page.addInitScript(() => {
    const get = HTMLCanvasElement.prototype.getContext; // charts measure their texts with the flat kind, which every browser has
    HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
      return /webgl/.test(kind) ? null : get.call(this, kind, ...more);
    };
  });
  await page.goto(pathToFileURL(resolve(path)).href);
  await page.waitForSelector("main > section");
  if ((await page.locator(".missing", { hasText: "shows no 3-D" }).count()) === 0) complain("nothing says that the 3-D is missing");
  await page.evaluate(visit, false); // charts are the same with and without 3-D: what is open is enough
  await page.waitForTimeout(300);
  (await page.evaluate(structure)).forEach(complain);
  const undrawn = await page.evaluate(() => [...document.querySelectorAll(".chart")].filter((chart) => !chart.closest("details:not([open])") && !chart.querySelector("svg")).length);
  if (undrawn > 0) complain(`${undrawn} charts are not drawn`);
  await page.context().close();
}

const browser = await launch(PROGRAM, options.chromium);
let faults = 0;
for (const path of pages) {
  const complaint = (where) => (text) => {
    faults += 1;
    console.log(`${path} ${where}: ${text}`);
  };
  try {
    const data = dataOf(path);
    if (data.live) throw new Error("this page is live: check it with live.mjs");
    const solidParts = data.sections.some((section) => section.movie || section.calibration?.surface?.factors?.length > 1);
    for (const width of WIDTHS) await look(browser, path, data, width, complaint(`at ${width} px`));
    if (options.keep || options.compare) for (const width of WIDTHS) await pictured(browser, path, width, complaint(`at ${width} px`));
    if (solidParts) await withoutSolid(browser, path, complaint("without WebGL"));
  } catch (error) {
    complaint("")(error.message.split("\n")[0]);
  }
}
await browser.close();
console.log(faults === 0 ? `${pages.length} ${pages.length === 1 ? "page" : "pages"}, no faults` : `${faults} faults`);
process.exit(faults === 0 ? 0 : 1);
