// node contents.mjs PAGE.html [--chromium PATH]: prints what the contents say of each section, one line each.
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { PATIENCE, launch, readArguments } from "./browser.mjs";

const PROGRAM = "contents.mjs";
const { pages, options } = readArguments(PROGRAM, "usage: node contents.mjs PAGE.html [--chromium PATH]", ["chromium"]);
const browser = await launch(PROGRAM, options.chromium);
const page = await browser.newPage();
page.setDefaultTimeout(PATIENCE);
await page.goto(pathToFileURL(resolve(pages[0])).href);
await page.waitForSelector("#contents li");
for (const text of await page.locator("#contents > ol > li > p").allTextContents()) console.log(text.replace(/\u00a0/g, " "));
await browser.close();
