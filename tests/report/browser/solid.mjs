// The 3-D parts: something is drawn, and slider, play, cut, view and keys do what they say.
import { colours, decode, difference, painted } from "./picture.mjs";

const CHANGED = 0.002; // mean difference of the channels: a few beads that have moved give more
const PATIENCE = 10000; // ms until a play must have moved
const pause = (page, ms) => page.waitForTimeout(ms);

async function shot(page, canvas) {
  await pause(page, 250);
  return decode(await canvas.screenshot());
}

async function setRange(slider, value) {
  await slider.evaluate((node, to) => {
    node.value = to;
    node.dispatchEvent(new Event("input", { bubbles: true }));
  }, value);
}

/** whole: everything that can be done with it; else only that it is drawn and moves. */
async function mill(page, holder, whole, complain) {
  await holder.scrollIntoViewIfNeeded();
  await page.waitForFunction((node) => node.dataset.ready === "1", await holder.elementHandle(), { timeout: 120000 });
  const canvas = holder.locator("canvas");
  const [slider, cut] = [holder.locator("[data-role=time]"), holder.locator("[data-role=cut]")];
  const last = Number(await slider.getAttribute("max"));
  const first = await shot(page, canvas);
  if (painted(first) < 0.02 || colours(first) < 12) complain(`the 3-D picture is blank: ${(100 * painted(first)).toFixed(1)} % painted, ${colours(first)} colours`);
  const changes = async (what, act, back) => {
    const before = await shot(page, canvas);
    await act();
    const moved = difference(before, await shot(page, canvas));
    if (moved < CHANGED) complain(`${what} changes nothing in the 3-D picture (difference ${moved.toFixed(5)})`);
    if (back) await back();
  };
  if (last > 0) {
    await changes("the time slider", () => setRange(slider, Math.floor(last / 2)));
    await setRange(slider, 0);
  }
  if (!whole) return changes("the button 3-D", () => holder.getByRole("button", { name: "3-D" }).click());
  if (last > 0) {
    await holder.getByRole("button", { name: "Play" }).click();
    for (let waited = 0; Number(await slider.inputValue()) === 0 && waited < PATIENCE; waited += 100) await pause(page, 100);
    if (Number(await slider.inputValue()) === 0) complain("play does not move the time slider");
    await canvas.focus();
    await page.keyboard.press("Space");
    await pause(page, 150);
    const stopped = Number(await slider.inputValue());
    await pause(page, 800);
    if (Number(await slider.inputValue()) !== stopped) complain("the space key does not stop the play");
    await page.keyboard.press("Home");
    await page.keyboard.press("PageDown");
    if (Number(await slider.inputValue()) !== 1) complain("the page-down key does not step to the next picture");
    await setRange(slider, 0);
  }
  await changes("the cut", () => setRange(cut, 250), () => setRange(cut, 1000));
  await changes("the button 3-D", () => holder.getByRole("button", { name: "3-D" }).click());
  await changes("the arrow key", async () => {
    await canvas.focus();
    await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("ArrowLeft");
  });
  await changes("the button End view", () => holder.getByRole("button", { name: "End view" }).click());
}

async function surface(page, view, complain) {
  await view.scrollIntoViewIfNeeded();
  const canvas = view.locator("canvas");
  const before = await shot(page, canvas);
  if (painted(before) < 0.02 || colours(before) < 12) complain("the surface in 3-D is blank");
  await canvas.focus();
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("ArrowLeft");
  if (difference(before, await shot(page, canvas)) < CHANGED) complain("the arrow key does not turn the surface");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
}

export async function solid(page, data, whole, complain) {
  const movies = data.sections.filter((section) => section.kind === "run" && section.movie).length;
  const mills = page.locator(".mill");
  if ((await mills.count()) !== movies) complain(`${await mills.count()} turning mills are shown where the data have ${movies}`);
  for (let index = 0; index < (await mills.count()); index++) await mill(page, mills.nth(index), whole, complain);
  const surfaces = page.locator(".view:not(.mill .view)");
  const expected = data.sections.filter((section) => section.kind === "calibration" && section.calibration?.surface?.factors?.length > 1).length;
  if ((await surfaces.count()) !== expected) complain(`${await surfaces.count()} surfaces are shown in 3-D where the data have ${expected}`);
  for (let index = 0; index < (await surfaces.count()); index++) await surface(page, surfaces.nth(index), complain);
}
