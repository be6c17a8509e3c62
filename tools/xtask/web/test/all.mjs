// Tests the packed game in real browsers. By default all tests run in Chromium and the main ones in Firefox.
// usage: node all.mjs SITE MODULE [TEST …]   MODULE: the .wasm of tools/determinism_checks; TEST: for example play or play-firefox
import { join } from "node:path";
import { serve } from "../serve.mjs";
import { checkBits } from "./bits.mjs";
import * as game from "./game.mjs";
import * as keeping from "./keeping.mjs";
import * as making from "./making.mjs";
import { checkSilence, checkSound } from "./sound.mjs";
import { measureSpeed } from "./speed.mjs";
import { checkSynth } from "./synth.mjs";
import { launch } from "./visit.mjs";

const [folder, module, ...wanted] = process.argv.slice(2);
const site = await serve(folder);

/** Tests for both browsers, by name. @type {Record<string, (browser: any, site: any) => Promise<void>>} */
const PLAYED = { ...game, ...keeping, ...making };
const NAMES = ["preview", "first", "play", "touch", "offline", "links", "clipboard", "drops", "lost", "pictures", "pad", "making"]
  .concat(["forbidden", "full", "tabs", "race", "newer"]);

/** All tests. Each one gets a fresh browser. @type {[string, "chromium" | "firefox" | "node", (browser?: any) => Promise<void>][]} */
const TESTS = ["chromium", "firefox"].flatMap((kind) => [
  ...NAMES.map((name) => [name, kind, (browser) => PLAYED[name](browser, site)]),
  ["sound", kind, (browser) => checkSound(browser, site.address)],
  ["silence", kind, (browser) => checkSilence(browser, site.address)],
  ["bits", kind, (browser) => checkBits({ [kind]: browser }, module)],
  ["speed", kind, (browser) => measureSpeed(browser, module)],
]);
TESTS.push(["synth", "node", () => checkSynth(join(folder, keeping.versionOf(folder), "sound.wasm"))]);
/** Tests that run by default; `newer` takes minutes. */
const USUAL = { chromium: [...NAMES.filter((name) => name !== "newer"), "sound", "silence", "bits"], firefox: ["play", "offline", "race", "bits"], node: ["synth"] };

/** Runs a test; returns whether it passes. Failed tests are repeated once, because a busy machine may cause a timeout. */
async function passes(name, kind, test) {
  const start = performance.now();
  const browser = kind === "node" ? undefined : await launch(kind);
  try {
    await test(browser);
    console.log(`ok    ${kind}: ${name} (${((performance.now() - start) / 1000).toFixed(0)} s)`);
    return true;
  } catch (error) {
    console.log(`FAILED ${kind}: ${name}\n${error.stack ?? error}`);
    return false;
  } finally {
    await browser?.close();
  }
}

let failed = 0;
for (const [name, kind, test] of TESTS) {
  const isWanted = wanted.includes(name) || wanted.includes(`${name}-${kind}`);
  if (wanted.length ? !isWanted : !USUAL[kind].includes(name)) continue;
  if (!(await passes(name, kind, test)) && !(await passes(`${name}, second try`, kind, test))) {
    failed++;
  }
}
await site.close();
process.exitCode = failed ? 1 : 0;
