// Soak test of the page: random input on every level, twice. Fails if memory of the page or of the GPU grows, or if the
// console reports errors.
// usage: node soak.mjs SITE [MINUTES]
import assert from "node:assert/strict";
import { serve } from "../serve.mjs";
import { countGpu } from "./gpu.mjs";
import { Visit, launch, seconds } from "./visit.mjs";

const [folder, minutes = "30"] = process.argv.slice(2);
const [WIDTH, HEIGHT] = [900, 640];
/** Keys that are pressed at random. */
const KEYS = /** @type {import("puppeteer-core").KeyInput[]} */ (["Escape", "e", "r", "f", "j", "q", "z", "x", "c", "[", "Enter", "ArrowDown", "Tab"]);
const ROUNDS = 2;

let seed = 1;
/** Returns a reproducible pseudo-random number in [0, 1). */
function random() {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 2 ** 32;
}

const site = await serve(folder);
const browser = await launch("chromium");
const visit = await Visit.begin(browser, site.address, { size: [WIDTH, HEIGHT], before: countGpu });
const session = await visit.page.createCDPSession();
await session.send("Performance.enable");

async function measured() {
  await session.send("HeapProfiler.collectGarbage");
  const { metrics } = await session.send("Performance.getMetrics");
  const of = (/** @type {string} */ name) => metrics.find((metric) => metric.name === name)?.value ?? 0;
  const gpu = await visit.page.evaluate(() => globalThis.gpu());
  return {
    wasm: (await report()).memory,
    heap: of("JSHeapUsedSize"),
    gpu: gpu.bytes,
    "gpu objects": gpu.objects,
    nodes: of("Nodes"),
    listeners: of("JSEventListeners"),
  };
}

/** Returns the state of the game; fails if it has ended. */
async function report() {
  const report = await visit.report();
  if (!report) {
    visit.isQuiet();
    assert.fail("the game ended");
  }
  return report;
}

/** Opens the list of levels; returns their names. */
async function openLevels() {
  while ((await report()).screen !== "Levels") {
    const { screen, labels } = await report();
    // On the title screen or below it.
    const wanted = screen === "Title" ? "Play" : "Levels";
    const found = labels.find(({ name }) => name === wanted);
    await (found ? visit.page.mouse.click(found.x, found.y, { delay: 120 }) : visit.press("Escape"));
    await seconds(0.5);
  }
  const { labels } = await visit.until(({ labels }) => labels.some(({ name }) => name === "Classic"), "a list of levels");
  const others = ["Back", "Open…", "Levels", "The mouse rests"];
  return labels.map(({ name }) => name).slice(labels.findIndex(({ name }) => name === "Classic")).filter((name) => !others.includes(name));
}

/** Starts a level from the list, after scrolling to it. */
async function begin(/** @type {string} */ level) {
  await openLevels();
  await visit.page.mouse.move(WIDTH / 2, HEIGHT / 2);
  for (let goes = 0; goes < 40; goes++) {
    const { y } = await visit.place(level);
    if (y > 120 && y < HEIGHT - 60) {
      await visit.click(level);
      await seconds(1);
      if ((await report()).screen !== "Levels") return;
    } else {
      await visit.page.mouse.wheel({ deltaY: y < HEIGHT / 2 ? -150 : 150 });
      await seconds(0.3);
    }
  }
  assert.fail(`“${level}” could not be scrolled into view`);
}

/** Performs a random action; returns the tick of the round. */
async function act(/** @type {string} */ level) {
  const { screen, ticks } = await report();
  if (screen === "Title" || screen === "Levels") {
    await begin(level);
  } else if (screen !== "Play") {
    await visit.press(random() < 0.5 ? "Escape" : "r");
  } else if (random() < 0.05) {
    await visit.press(KEYS[Math.floor(random() * KEYS.length)]);
  } else if (random() < 0.05) {
    await visit.page.mouse.wheel({ deltaY: 200 * (random() - 0.5) });
  } else {
    await visit.page.mouse.move(WIDTH * random(), HEIGHT * random(), { steps: 8 });
  }
  return ticks;
}

const levels = await openLevels();
console.log(`${levels.length} levels: ${levels.join(", ")}`);
const turn = (60 * Number(minutes)) / (ROUNDS * levels.length);
/** Maximum of each figure in each pass over the levels. @type {Record<string, number>[]} */
const most = [];
const since = performance.now();
const text = ([name, value]) => `${name} ${value > 1e5 ? `${(value / 1e6).toFixed(1)} MB` : value}`;
for (let round = 0; round < ROUNDS; round++) {
  most.push({});
  for (const [place, level] of levels.entries()) {
    await begin(level);
    const end = since + 1000 * turn * (round * levels.length + place + 1);
    let [played, before] = [0, 0];
    while (performance.now() < end) {
      const ticks = await act(level);
      played += Math.max(ticks - before, 0);
      before = ticks;
    }
    const now = await measured();
    for (const [name, value] of Object.entries(now)) {
      most[round][name] = Math.max(most[round][name] ?? 0, value);
    }
    const minute = ((performance.now() - since) / 60_000).toFixed(1).padStart(5);
    console.log(`${minute} min: ${Object.entries(now).map(text).join(", ")}; ${played} ticks of ${(await report()).level}`);
  }
}
for (const [name, value] of Object.entries(most[0])) {
  console.log(`maximum of ${name}: ${text(["first", value])}, ${text(["then", most[1][name]])}: ${(100 * (most[1][name] / value - 1)).toFixed(1)} %`);
}
visit.isQuiet();
console.log("no errors on the console");
const grown = Object.keys(most[0]).filter((name) => most[1][name] > 1.05 * most[0][name]);
assert.deepEqual(grown, [], "figures that grew by more than 5 %");
await browser.close();
await site.close();
