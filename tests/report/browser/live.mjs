// node live.mjs PAGE.html [--chromium PATH]: serves a live page with data that grow, and looks whether it follows without losing the
// reader's place, and says when the server is gone. One line per fault, exit code 1 where there are any.
import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { PATIENCE, dataOf, launch, readArguments, watch } from "./browser.mjs";

const PROGRAM = "live.mjs";
const { pages, options } = readArguments(PROGRAM, "usage: node live.mjs PAGE.html [--chromium PATH]", ["chromium"]);
const path = pages[0];
let faults = 0;
const complain = (text) => {
  faults += 1;
  console.log(`${path}: ${text}`);
};

const data = dataOf(path);
const index = data.sections.findIndex((section) => section.kind === "run" && section.series?.time_s?.length > 10);
if (!data.live || index < 0) {
  console.error(`${PROGRAM}: ${path} is not a live page with a run: make it with "live": true`);
  process.exit(2);
}
let current = structuredClone(data);
let asked = 0;
const server = createServer((request, answer) => {
  if (request.url.startsWith("/data.json")) {
    asked += 1;
    if (!request.url.endsWith("?key=secret")) complain(`it asks for ${request.url}, without the page's query`);
    answer.setHeader("content-type", "application/json");
    answer.end(JSON.stringify(current));
  } else if (request.url.startsWith("/?")) {
    answer.setHeader("content-type", "text/html; charset=utf-8");
    answer.end(readFileSync(path));
  } else {
    answer.statusCode = 404;
    answer.end();
  }
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
const base = `http://127.0.0.1:${server.address().port}/`;

const browser = await launch(PROGRAM, options.chromium);
const context = await browser.newContext({ viewport: { width: 1000, height: 700 }, reducedMotion: "reduce" });
const page = await context.newPage();
page.setDefaultTimeout(PATIENCE);
let gone = false;
watch(page, (url) => url.startsWith(base) || /^(data|blob):/.test(url), (text) => gone || complain(text)); // a refused answer is an error of the console
await page.goto(`${base}?key=secret`);
await page.waitForSelector(".chart");

/** Whether it becomes true in the page; waitForFunction would need what the page's security policy forbids. */
async function comes(condition) {
  for (const end = Date.now() + PATIENCE; Date.now() < end; await page.waitForTimeout(200)) if (await page.evaluate(condition)) return true;
  return false;
}

const place = () => page.evaluate(() => window.scrollY);
/** The curves of the one chart that must grow: other charts show what the run has at its end. */
const curve = () => page.evaluate(() => [...document.querySelectorAll('.chart[aria-label^="Power against time"] svg path')].map((node) => node.getAttribute("d") ?? "").join());
await page.locator("main details").first().evaluate((node) => (node.open = true));
await page.evaluate(() => document.querySelector(".chart").scrollIntoView({ block: "start", behavior: "instant" }));
await page.waitForSelector(".chart svg");
await page.waitForTimeout(500);
const [before, line] = [await place(), await curve()];
if (line === "") complain("it shows no curves of the power");
const slider = page.locator("[data-role=time]").first();
const hasMovie = (await slider.count()) > 0;
if (hasMovie) await slider.evaluate((node) => {
  node.value = 1;
  node.dispatchEvent(new Event("input"));
});

const { series, progress } = current.sections[index];
const step = series.time_s[series.time_s.length - 1] - series.time_s[series.time_s.length - 2];
for (let extra = 1; extra <= 20; extra++)
  for (const name of Object.keys(series)) series[name].push(name === "time_s" ? series[name][series[name].length - 1] + step : series[name][series[name].length - extra]);
if (progress) progress.time_s = progress.end_s / 2;
current.title = "Later";
if (!(await comes(() => document.querySelector("h1").textContent === "Later"))) complain("it does not show what the server sends later");
await page.waitForTimeout(800);
if ((await curve()) === line) complain("its curves do not grow with the data");
if (Math.abs((await place()) - before) > 2) complain(`the reader's place moved from ${before} to ${await place()} px`);
if (!(await page.locator("main details").first().evaluate((node) => node.open))) complain("what the reader had opened is shut");
if (hasMovie && (await slider.inputValue()) !== "1") complain("the reader's picture of the mill is lost");
if (asked === 0) complain("it asks for no data");

gone = true;
server.close();
server.closeAllConnections();
if (!(await comes(() => /no longer answers/.test(document.getElementById("server").textContent)))) complain("it does not say that the server is gone");
await browser.close();
console.log(faults === 0 ? "a live page, no faults" : `${faults} faults`);
process.exit(faults === 0 ? 0 : 1);
