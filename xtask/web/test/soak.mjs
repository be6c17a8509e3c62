// Somebody who does anything, for long: does the page take more and more memory, or complain?
// usage: node soak.mjs SITE [MINUTES]
import assert from "node:assert/strict";
import { serve } from "../serve.mjs";
import { Visit, launch, seconds } from "./visit.mjs";

const [folder, minutes = "30"] = process.argv.slice(2);
const KEYS = /** @type {import("puppeteer-core").KeyInput[]} */ (["Escape", "e", "r", "f", "j", "q", "z", "Enter", "ArrowDown", "Tab"]);
/** After so much of the time everything was there once. */
const SETTLED = 0.3;

let seed = 1;
/** Below one, the same each time. */
function random() {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 2 ** 32;
}

const site = await serve(folder);
const browser = await launch("chromium");
const visit = await Visit.begin(browser, site.address, { size: [900, 640] });
const session = await visit.page.createCDPSession();
await session.send("Performance.enable");

async function measured() {
  await session.send("HeapProfiler.collectGarbage");
  const { metrics } = await session.send("Performance.getMetrics");
  const of = (/** @type {string} */ name) => metrics.find((metric) => metric.name === name)?.value ?? 0;
  return { wasm: (await visit.report())?.memory ?? 0, heap: of("JSHeapUsedSize"), nodes: of("Nodes"), listeners: of("JSEventListeners") };
}

const begin = performance.now();
const passed = () => (performance.now() - begin) / 60_000;
let [settled, minute, level] = [undefined, 0, 0];
while (passed() < Number(minutes)) {
  const report = await visit.report();
  if (!report) {
    visit.isQuiet();
    assert.fail("the game ended");
  }
  if (report.screen !== "Play" || random() < 0.01) {
    // On to another level, by way of the title.
    for (const _ of [1, 2, 3, 4]) {
      if ((await visit.report())?.screen !== "Title") await visit.press("Escape");
    }
    for (const name of ["Levels", "Back", "Play"]) {
      const found = (await visit.report())?.labels.find((label) => label.name === name);
      if (found) await visit.page.mouse.click(found.x, found.y);
      await seconds(0.5);
    }
    const { screen, labels } = (await visit.report()) ?? {};
    const tiles = labels?.filter(({ name }) => !["Back", "Open…"].includes(name)) ?? [];
    if (screen === "Levels" && tiles.length) {
      const { x, y } = tiles[level++ % tiles.length];
      await visit.page.mouse.click(x, y);
    }
  } else if (random() < 0.05) {
    await visit.press(KEYS[Math.floor(random() * KEYS.length)]);
  } else {
    await visit.page.mouse.move(900 * random(), 640 * random(), { steps: 8 });
  }
  if (passed() > minute) {
    const now = await measured();
    const line = Object.entries(now).map(([name, value]) => `${name} ${value > 1e5 ? `${(value / 1e6).toFixed(1)} MB` : value}`);
    console.log(`${String(minute).padStart(3)} min: ${line.join(", ")}, ${report.screen} ${report.level}`);
    minute++;
    if (!settled && passed() > SETTLED * Number(minutes)) settled = now;
  }
}
const last = await measured();
for (const [name, value] of Object.entries(settled ?? last)) {
  console.log(`${name} grew by ${(100 * (last[name] / value - 1)).toFixed(1)} %`);
}
visit.isQuiet();
console.log("and the console is empty");
const grown = Object.entries(settled ?? last).filter(([name, value]) => last[name] > 1.05 * value);
assert.deepEqual(grown.map(([name]) => name), [], "grew by more than a twentieth");
await browser.close();
await site.close();
