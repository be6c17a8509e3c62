// Test of drawing a body and making a level in a browser, by touch at the size of a phone.
import assert from "node:assert/strict";
import { Visit, seconds } from "./visit.mjs";

/** @typedef {import("./game.mjs").Site} Site */
/** @typedef {import("./game.mjs").Browser} Browser */

/** A drawing is dropped into the room, becomes a level, is kept and sent, and is there after a reload. @param {Browser} browser @param {Site} site */
export async function making(browser, site) {
  const visit = await Visit.begin(browser, site.address, { size: [390, 844], isTouch: true });
  await visit.page.evaluate(() => {
    globalThis.copied = "";
    // A headless browser has no clipboard.
    navigator.clipboard.writeText = async (text) => void (globalThis.copied = text);
  });
  await visit.tap("Draw");
  await visit.sees("Paper");
  const { x, y } = await visit.place("Paper");
  await line(visit, [[x - 90, y], [x, y - 80], [x + 90, y], [x, y + 80], [x - 90, y]]);
  await visit.tap("Drop it!");
  await visit.sees("Play");
  await visit.until(({ ticks }) => ticks > 10, "the drawing moves");
  await visit.tap("Back to making");
  await visit.sees("Paper");
  await visit.tap("Drop it!");
  await visit.sees("Play");
  await visit.tap("Paused");
  await visit.tap("Build a level");
  await visit.sees("Editor");
  await visit.tap("Basket");
  await visit.place("Basket 1");
  await visit.tap("Finish");
  await visit.sees("Finish");
  await visit.tap("Keep");
  await visit.hears("Kept under Your levels");
  await visit.tap("Copy link");
  await visit.page.waitForFunction(() => globalThis.copied);
  const link = await visit.page.evaluate(() => globalThis.copied);
  assert.match(link, /^http:\/\/localhost:\d+\/#l1/);
  assert(link.length <= 2500, `${link.length} characters`);
  visit.isQuiet();

  // Somebody else opens the link and plays the level.
  const other = await Visit.begin(browser, link, { size: [390, 844], isTouch: true });
  await other.sees("Offered");
  await other.tap("Play");
  await other.sees("Play");
  other.isQuiet();
  await other.page.close();

  await visit.page.bringToFront();
  await seconds(1);
  await visit.page.reload();
  await visit.comes();
  await visit.tap("Play");
  await visit.sees("Levels");
  await visit.until(({ labels }) => labels.some(({ name }) => name === "Change: My level"), "the kept level");
  visit.isQuiet();
  await visit.page.close();
}

/** Draws with a finger through points. @param {Visit} visit @param {[number, number][]} points */
async function line(visit, points) {
  const finger = visit.page.touchscreen;
  const [first, ...rest] = points;
  await finger.touchStart(...first);
  let [before] = points;
  for (const point of rest) {
    for (let step = 1; step <= 8; step++) {
      const [x, y] = [0, 1].map((axis) => before[axis] + ((point[axis] - before[axis]) * step) / 8);
      await finger.touchMove(x, y);
    }
    before = point;
  }
  await finger.touchEnd();
}
