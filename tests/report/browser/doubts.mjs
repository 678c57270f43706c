// node doubts.mjs PAGE.html [--chromium PATH]: prints the doubts that stand between a section's first sentence and its figures, one line each.
import { openPage } from "./browser.mjs";

const { browser, page } = await openPage("doubts.mjs", "usage: node doubts.mjs PAGE.html [--chromium PATH]");
for (const text of await page.locator(".sentence + .doubts li").allTextContents()) console.log(text.replace(/\u00a0/g, " "));
await browser.close();
