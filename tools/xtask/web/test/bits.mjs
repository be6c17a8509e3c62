// Compares bits in a browser with native ones: golden scenes, replays recorded natively, and replays recorded in the browser.
// usage: node bits.mjs MODULE.wasm   in Chromium, then in Firefox
import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { inDebug, open } from "./checks.mjs";
import { launch } from "./visit.mjs";

/**
 * Fails if a bit differs.
 * @param {Record<string, import("puppeteer-core").Browser>} browsers by name
 * @param {string} module path of the .wasm of tools/determinism_checks
 */
export async function checkBits(browsers, module) {
  const folder = mkdtempSync(join(tmpdir(), "tamaire-bits-"));
  try {
    const recorded = join(folder, "natively");
    inDebug("replays", "record", recorded);
    for (const [index, [name, browser]] of Object.entries(browsers).entries()) {
      const checks = await open(browser, module);
      await checkGolden(name, checks);
      await checkReplays(name, checks, recorded);
      const written = join(folder, name);
      mkdirSync(written);
      // Each browser plays a third of a series of its own, different from the native one.
      const series = await checks.call("series", 1 + index);
      for (const game of series.filter((_, round) => round % 3 === index)) {
        writeFileSync(join(written, `${game}.tamaire`), await checks.call("record", game));
      }
      await checks.close();
      process.stdout.write(`${name}, then ${inDebug("replays", "verify", written)}`);
    }
  } finally {
    rmSync(folder, { recursive: true });
  }
}

async function checkGolden(/** @type {string} */ browser, /** @type {Awaited<ReturnType<typeof open>>} */ checks) {
  const scenes = await checks.call("scenes");
  assert(scenes.length > 0);
  for (const [scene, name] of scenes.entries()) {
    const { hash, golden } = await checks.call("golden", scene);
    assert.equal(hash, golden, `${browser}: the result of the golden scene “${name}” differs`);
  }
  console.log(`${browser}: ${scenes.length} golden scenes have the expected results`);
}

async function checkReplays(browser, checks, /** @type {string} */ folder) {
  const files = readdirSync(folder);
  assert(files.length > 0);
  for (const file of files) {
    const told = checks.call("verify", readFileSync(join(folder, file), "utf8"));
    await told.catch((/** @type {Error} */ error) => assert.fail(`${browser}: ${file}, recorded natively: ${error.message}`));
  }
  console.log(`${browser}: ${files.length} replays recorded natively are verified`);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const browsers = { Chromium: await launch("chromium"), Firefox: await launch("firefox") };
  try {
    await checkBits(browsers, process.argv[2]);
  } finally {
    await Promise.all(Object.values(browsers).map((browser) => browser.close()));
  }
}
