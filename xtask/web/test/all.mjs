// Plays the packed game in real browsers. What only prints figures, `speed`, is done when it is named.
// usage: node all.mjs SITE MODULE [TEST …]   MODULE: the .wasm of crates/browser_checks
import { serve } from "../serve.mjs";
import { checkBits } from "./bits.mjs";
import * as game from "./game.mjs";
import { checkSilence, checkSound } from "./sound.mjs";
import { measureSpeed } from "./speed.mjs";
import { launch } from "./visit.mjs";

const [folder, module, ...wanted] = process.argv.slice(2);
const site = await serve(folder);

/** Each with a browser of its own, which knows nothing yet. @type {[string, "chromium" | "firefox", (browser: any) => Promise<void>][]} */
const TESTS = [
  ...["first", "play", "touch", "offline", "forbidden", "full", "links", "drops", "lost", "pictures", "pad", "tabs"].map((name) => [
    name,
    "chromium",
    (browser) => game[name](browser, site),
  ]),
  ["sound", "chromium", (browser) => checkSound(browser, site.address)],
  ["silence", "chromium", (browser) => checkSilence(browser, site.address)],
  ["play", "firefox", (browser) => game.play(browser, site)],
  ["bits", "chromium", (browser) => checkBits({ Chromium: browser }, module)],
  ["bits", "firefox", (browser) => checkBits({ Firefox: browser }, module)],
  ["speed", "chromium", (browser) => measureSpeed(browser, module)],
];
const NAMED_ONLY = ["speed"];

/** Whether it passes. A browser on a machine that is busy may be late once; a fault is there again. */
async function passes(name, kind, test) {
  const start = performance.now();
  const browser = await launch(kind);
  try {
    await test(browser);
    console.log(`ok    ${kind}: ${name} (${((performance.now() - start) / 1000).toFixed(0)} s)`);
    return true;
  } catch (error) {
    console.log(`FAILED ${kind}: ${name}\n${error.stack ?? error}`);
    return false;
  } finally {
    await browser.close();
  }
}

let failed = 0;
for (const [name, kind, test] of TESTS) {
  const isWanted = wanted.includes(name) || wanted.includes(`${name}-${kind}`);
  if (wanted.length ? !isWanted : NAMED_ONLY.includes(name)) continue;
  if (!(await passes(name, kind, test)) && !(await passes(`${name}, once more`, kind, test))) {
    failed++;
  }
}
await site.close();
process.exitCode = failed ? 1 : 0;
