// node contents.mjs PAGE.html [--chromium PATH]: prints what the contents say of each section, one line each.
import { openPage } from "./browser.mjs";

const { browser, page } = await openPage("contents.mjs", "usage: node contents.mjs PAGE.html [--chromium PATH]");
for (const text of await page.locator("#contents > ol > li > p").allTextContents()) console.log(text.replace(/\u00a0/g, " "));
await browser.close();
