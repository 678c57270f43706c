// What both programs share: the browser, the data in a page, complaints.
import { existsSync, mkdirSync, readFileSync, renameSync, writeFileSync } from "node:fs";
import { dirname, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const PLACES = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

export const PATIENCE = 120000; // ms for what takes a moment on a free machine

export function stop(message) {
  console.error(message);
  process.exit(2);
}

/** Writes a file aside and renames it; makes its folder. */
export function keepFile(path, bytes) {
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(`${path}.tmp`, bytes);
  renameSync(`${path}.tmp`, path);
}

/** {pages, options}: --name VALUE for the names that take one. */
export function readArguments(program, usage, names) {
  const [pages, options] = [[], {}];
  const given = process.argv.slice(2);
  for (let index = 0; index < given.length; index++) {
    if (!given[index].startsWith("--")) {
      pages.push(given[index]);
      continue;
    }
    const name = given[index].slice(2);
    if (!names.includes(name)) stop(`${program}: there is no option --${name}; ${usage}`);
    if (index + 1 >= given.length) stop(`${program}: --${name} needs a value; ${usage}`);
    options[name] = given[++index];
  }
  if (pages.length === 0) stop(`${program}: no page was given; ${usage}`);
  for (const page of pages) if (!existsSync(page)) stop(`${program}: there is no file ${page}: make it with millscope report`);
  return { pages, options };
}

/** {browser, page}: the one page that is named on the command line, with its contents there. */
export async function openPage(program, usage) {
  const { pages, options } = readArguments(program, usage, ["chromium"]);
  const browser = await launch(program, options.chromium);
  const page = await browser.newPage();
  page.setDefaultTimeout(PATIENCE);
  await page.goto(pathToFileURL(resolve(pages[0])).href);
  await page.waitForSelector("#contents li");
  return { browser, page };
}

/** Headless, drawing 3-D in software, as build machines have no graphics card. */
export function launch(program, given) {
  const path = given ?? PLACES.find(existsSync);
  if (!path || !existsSync(path)) stop(`${program}: no browser at ${path ?? PLACES.join(", ")}: apt-get install chromium, or say where with --chromium`);
  return chromium.launch({ executablePath: path, args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars", "--force-color-profile=srgb"] });
}

/** The document that millscope has put into a page. */
export function dataOf(path) {
  const found = /<script type="application\/json" id="millscope-data">([\s\S]*?)<\/script>/.exec(readFileSync(path, "utf8"));
  if (!found) throw new Error(`${path}: there is no element millscope-data; it is not a page of millscope report`);
  return JSON.parse(found[1]);
}

/** Notes what a page must not do: errors, requests, dialogs. */
export function watch(page, allowed, complain) {
  page.on("console", (message) => message.type() === "error" && complain(`console: ${message.text()}`));
  page.on("pageerror", (error) => complain(`error: ${error.message}`));
  page.on("request", (request) => !allowed(request.url()) && complain(`asks for ${request.url().slice(0, 100)}`));
  page.on("dialog", (dialog) => {
    complain(`opens a dialog: ${dialog.message()}; a text of the data was run`);
    dialog.dismiss();
  });
}
