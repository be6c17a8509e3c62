// Measures the speed of the simulation in Chromium: golden scenes compared with native runs, and ticks of rounds played by a bot.
// Only prints, without limits, because machines differ.
// usage: node speed.mjs MODULE.wasm
import { fileURLToPath } from "node:url";
import { natively, open } from "./checks.mjs";
import { launch } from "./visit.mjs";

const RUNS = 5;
/** Games of a bot, at most a minute each, and the CPU slowdown: 4 corresponds to a phone or an old laptop. */
const GAMES = /** @type {const} */ ([["classic shave", 1], ["classic shave", 4], ["classic-3d shave", 1]]);
const SEEDS = [1, 2, 3];
const MOST_TICKS = 60 * 60;
/** Number of runs. Rounds are deterministic, so the minimum duration of a tick is its cost without disturbances. */
const GOES = 3;

/**
 * @param {import("puppeteer-core").Browser} browser Chromium
 * @param {string} module path of the .wasm of tools/determinism_checks
 */
export async function measureSpeed(browser, module) {
  const checks = await open(browser, module);
  await measureGolden(checks);
  console.log(`ticks [ms] of rounds with the seeds ${SEEDS.join(", ")}: minimum of ${GOES} runs | first run, still compiling`);
  console.log(`${"".padEnd(28)}  ticks  median     p99   worst  | median     p99   worst`);
  for (const [game, slower] of GAMES) {
    await measureTicks(checks, game, slower);
  }
  await checks.close();
}

/** Alternates between browser and native runs, so that other load affects both. */
async function measureGolden(/** @type {Awaited<ReturnType<typeof open>>} */ checks) {
  const scenes = await checks.call("scenes");
  /** @type {number[][][]} */
  const [there, here] = [scenes.map(() => []), scenes.map(() => [])];
  const inBrowser = async () => {
    const times = [];
    for (const scene of scenes.keys()) {
      times.push((await checks.call("golden", scene)).milliseconds);
    }
    return times;
  };
  const native = () => natively("utf8", "determinism_checks", "times", "1").trim().split("\n").map(Number);
  // Warm-up: the browser is still compiling, and cargo builds.
  await inBrowser();
  native();
  for (let run = 0; run < RUNS; run++) {
    native().forEach((time, scene) => here[scene].push(time));
    (await inBrowser()).forEach((time, scene) => there[scene].push(time));
  }
  console.log(`golden scenes [ms], medians of ${RUNS}`);
  console.log("natively  Chromium  ratio");
  for (const [scene, name] of scenes.entries()) {
    const [a, b] = [here, there].map((times) => part(times[scene], 0.5));
    console.log(`${a.toFixed(1).padStart(8)}${b.toFixed(1).padStart(10)}${(b / a).toFixed(2).padStart(7)}  ${name}`);
  }
}

async function measureTicks(checks, /** @type {string} */ game, /** @type {number} */ slower) {
  await checks.page.emulateCPUThrottling(slower);
  /** @type {number[]} */
  const [least, first] = [[], []];
  for (const seed of SEEDS) {
    const goes = [];
    for (let go = 0; go < GOES; go++) {
      goes.push(await checks.call("time", `${game} ${seed}`, MOST_TICKS));
    }
    first.push(...goes[0]);
    least.push(...goes[0].map((_, tick) => Math.min(...goes.map((times) => times[tick]))));
  }
  await checks.page.emulateCPUThrottling(null);
  const name = slower === 1 ? game : `${game}, ${slower} × slower`;
  const [costs, met] = [least, first].map((times) => [0.5, 0.99, 1].map((share) => part(times, share).toFixed(2).padStart(8)).join(""));
  console.log(`${name.padEnd(28)} ${String(least.length).padStart(6)}${costs}  |${met}`);
}

/** Returns the quantile of the values. */
function part(/** @type {number[]} */ values, /** @type {number} */ share) {
  const sorted = values.toSorted((a, b) => a - b);
  return sorted[Math.floor((sorted.length - 1) * share)];
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const browser = await launch("chromium");
  try {
    await measureSpeed(browser, process.argv[2]);
  } finally {
    await browser.close();
  }
}
