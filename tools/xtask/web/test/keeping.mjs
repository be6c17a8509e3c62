// Tests of the storage: without permission, without space, with two tabs, and with a newer version.
import assert from "node:assert/strict";
import { cpSync, mkdtempSync, readFileSync, readdirSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { brotliCompressSync } from "node:zlib";
import { serve } from "../serve.mjs";
import { drop, start } from "./game.mjs";
import { Visit } from "./visit.mjs";

/** @typedef {import("./game.mjs").Site} Site */
/** @typedef {import("./game.mjs").Browser} Browser */

/** A browser without storage is reported, and the game works. @param {Browser} browser @param {Site} site */
export async function forbidden(browser, site) {
  const before = () => Object.defineProperty(globalThis, "indexedDB", { get: () => { throw new DOMException("refused", "SecurityError"); } });
  const visit = await Visit.begin(browser, site.address, { before });
  await visit.hears("the browser keeps nothing for this page");
  await start(visit, "click");
  visit.isQuiet();
  await visit.page.close();
}

/** A full storage is reported once, and nothing else. @param {Browser} browser @param {Site} site */
export async function full(browser, site) {
  const before = () => {
    IDBObjectStore.prototype.put = () => {
      throw new DOMException("the quota is used up", "QuotaExceededError");
    };
  };
  const visit = await Visit.begin(browser, site.address, { before });
  await start(visit, "click");
  await visit.press("Escape");
  await visit.click("Save replay");
  const { notices } = await visit.hears("no space left");
  assert.equal(notices.length, 1, notices.join("\n"));
  await visit.click("Levels");
  await visit.click("Back");
  await visit.click("Replays");
  await visit.until(({ screen, labels }) => screen === "Replays" && labels.length && !labels.some(({ name }) => name === "Watch"), "an empty list");
  visit.isQuiet();
  await visit.page.close();
}

/** Tabs see each other's changes. @param {Browser} browser @param {Site} site */
export async function tabs(browser, site) {
  const one = await Visit.begin(browser, site.address);
  const other = await Visit.begin(browser, site.address);
  await one.page.bringToFront();
  await start(one, "click");
  await one.press("Escape");
  await one.click("Save replay");
  await one.hears("Saved");
  assert.deepEqual(await kept(one), ["replay/classic-1"], "saved before the notice appears");
  await other.page.bringToFront();
  await other.click("Replays");
  await other.place("Watch");
  await other.click("Delete");
  await other.click("Really?");
  await one.page.bringToFront();
  await one.click("Levels");
  await one.click("Back");
  await one.click("Replays");
  await one.until((report) => report.screen === "Replays" && !report.labels.some(({ name }) => name === "Watch"), "an empty list");
  one.isQuiet();
  other.isQuiet();
  await one.page.close();
  await other.page.close();
}

/** Concurrent changes of the same entry in two tabs are not lost. @param {Browser} browser @param {Site} site */
export async function race(browser, site) {
  const TIMES = 100;
  const script = `${site.address}${versionOf(site.folder)}/host.js`;
  const [one, other] = [await browser.newPage(), await browser.newPage()];
  // Any page of the same origin without the game.
  await Promise.all([one, other].map((page) => page.goto(`${site.address}licences.txt`)));
  const count = async (/** @type {string} */ script, /** @type {number} */ times) => {
    const { Host } = await import(script);
    const host = await Host.open();
    let known = new Map();
    const failures = [];
    const add = () => {
      for (let change; (change = host.takeChange()); ) {
        change.bytes ? known.set(change.key, change.bytes) : known.clear();
      }
      const bytes = new Uint8Array([(known.get("note/count")?.[0] ?? 0) + 1]);
      known.set("note/count", bytes);
      host.keep("note/count", bytes, 0);
    };
    for (let time = 0; time < times; time++) {
      // Two at once, then the next two.
      const done = [host.alone(add), host.alone(add)];
      failures.push(...(await Promise.all(done)).filter((failure) => failure !== undefined));
    }
    return failures;
  };
  const failures = await Promise.all([one, other].map((page) => page.evaluate(count, script, TIMES / 4)));
  assert.deepEqual(failures.flat(), []);
  const third = await browser.newPage();
  await third.goto(`${site.address}licences.txt`);
  const counted = await third.evaluate(async (script) => {
    const { Host } = await import(script);
    const host = await Host.open();
    for (let change; (change = host.takeChange()); ) {
      if (change.key === "note/count") return change.bytes[0];
    }
  }, script);
  assert.equal(counted, TIMES);
  await Promise.all([one, other, third].map((page) => page.close()));
}

/** A newer version takes over at the second reload and finds all saved data. @param {Browser} browser @param {Site} site */
export async function newer(browser, site) {
  const folder = mkdtempSync(join(tmpdir(), "tamaire-newer-"));
  const served = join(folder, "site");
  for (const end of ["", ".br"]) {
    cpSync(site.folder + end, served + end, { recursive: true });
  }
  const server = await serve(served);
  try {
    const visit = await Visit.begin(browser, server.address);
    const [old, version] = [versionOf(served), "0123456789ab"];
    await drop(visit, "cat.png");
    await visit.until(({ level }) => level === "cat.png", "the cat is played");
    await visit.press("Escape");
    await visit.click("Save replay");
    await visit.hears("Saved");
    await visit.click("Levels");
    await visit.click("Classic");
    await visit.win(async (x, y) => visit.page.mouse.move(x, y));
    await visit.sees("Result");
    await visit.click("Levels");
    await visit.click("Back");
    await visit.page.waitForFunction(async () => (await navigator.serviceWorker.ready).active?.state === "activated");

    rename(served, old, version);
    await visit.click("日本語");
    await visit.until(({ language }) => language === "Japanese", "another language");
    // Settings are saved once they stop changing, or when the page closes.
    await visit.page.reload();
    await visit.comes();
    assert.equal(await played(visit), old, "the old version starts without waiting for the newer one");
    await visit.page.waitForFunction(async () => (await navigator.serviceWorker.ready).waiting, { timeout: 90_000 });
    await visit.page.reload();
    await visit.page.waitForFunction(
      (version) => document.querySelector("script")?.src.includes(version),
      { timeout: 90_000 },
      version,
    );
    await visit.comes();
    const { language, won } = await visit.until(({ labels }) => labels.some(({ name }) => name === "リプレイ"), "a title in Japanese");
    assert.deepEqual([language, won], ["Japanese", ["classic"]], "settings and records");
    await visit.click("リプレイ");
    await visit.place("見る");
    await visit.click("もどる");
    await visit.click("あそぶ");
    await visit.place("cat");
    // The old version is deleted once no tab uses it.
    await visit.page.waitForFunction(async () => (await caches.keys()).length === 1);
    assert.deepEqual(await visit.page.evaluate(() => caches.keys()), [`tamaire-${version}`]);
    // eframe draws Japanese with a canvas until the font is loaded.
    visit.isQuiet(/willReadFrequently/);
    await visit.page.close();
  } finally {
    await server.close();
    rmSync(folder, { recursive: true });
  }
}

/** Returns the name of the folder named by a content hash. @param {string} folder */
export const versionOf = (folder) => /** @type {string} */ (readdirSync(folder).find((name) => /^[0-9a-f]{12}$/.test(name)));

/** Returns the running version. @param {Visit} visit */
const played = (visit) => visit.page.evaluate(() => document.querySelector("script")?.src.split("/").at(-2));

/** Renames the version of a packed folder. @param {string} folder @param {string} old @param {string} version */
function rename(folder, old, version) {
  for (const end of ["", ".br"]) {
    renameSync(join(folder + end, old), join(folder + end, version));
  }
  for (const name of ["index.html", "sw.js"]) {
    const text = readFileSync(join(folder, name), "utf8").replaceAll(old, version);
    writeFileSync(join(folder, name), text);
    writeFileSync(join(`${folder}.br`, name), brotliCompressSync(text));
  }
}

/** Returns the keys in the storage. @param {Visit} visit @returns {Promise<string[]>} */
function kept(visit) {
  return visit.page.evaluate(
    () =>
      new Promise((resolve, reject) => {
        const asked = indexedDB.open("tamaire", 1);
        asked.onerror = () => reject(asked.error);
        asked.onsuccess = () => {
          const keys = asked.result.transaction("things").objectStore("things").getAllKeys();
          keys.onsuccess = () => resolve(keys.result.filter((key) => key !== "stamp"));
        };
      }),
  );
}
