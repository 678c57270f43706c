// node doubts.mjs PAGE.html [--chromium PATH]: prints the doubts that stand between a section's first sentence and its figures, one line each.
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { PATIENCE, launch, readArguments } from "./browser.mjs";

const PROGRAM = "doubts.mjs";
const { pages, options } = readArguments(PROGRAM, "usage: node doubts.mjs PAGE.html [--chromium PATH]", ["chromium"]);
const browser = await launch(PROGRAM, options.chromium);
const page = await browser.newPage();
page.setDefaultTimeout(PATIENCE);
await page.goto(pathToFileURL(resolve(pages[0])).href);
await page.waitForSelector("#contents li");
for (const text of await page.locator(".sentence + .doubts li").allTextContents()) console.log(text.replace(/\u00a0/g, " "));
await browser.close();
