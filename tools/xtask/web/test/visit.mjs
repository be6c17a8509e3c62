// Page of the game in a browser, as operated by tests.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import puppeteer from "puppeteer-core";

/** Timeout for a busy machine [ms], not a tested limit. */
const PATIENCE = 90_000;

const CHROMIUM = [
  "--no-sandbox",
  // Software rendering, because there may be no GPU.
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--ignore-gpu-blocklist",
  "--autoplay-policy=document-user-activation-required",
];

export const BROWSERS = {
  chromium: { executablePath: "chromium", args: CHROMIUM },
  firefox: { browser: "firefox", executablePath: "firefox-esr" },
};

/** @param {"chromium" | "firefox"} kind @param {string} [language] */
export function launch(kind, language = "en-US") {
  const { executablePath, ...options } = BROWSERS[kind];
  return puppeteer.launch({
    ...options,
    args: [...(options.args ?? []), ...(kind === "chromium" ? [`--lang=${language}`, `--accept-lang=${language}`] : [])],
    // Without this, Firefox refuses to render in software.
    extraPrefsFirefox: { "intl.accept_languages": language, "webgl.force-enabled": true },
    env: { ...process.env, LANGUAGE: language },
    executablePath: find(executablePath),
    // A minute played by a bot, slowed down four times.
    protocolTimeout: 600_000,
    timeout: PATIENCE,
  });
}

/** Returns the path of a program. @param {string} program */
function find(program) {
  const folders = (process.env.PATH ?? "").split(":");
  const found = folders.map((folder) => `${folder}/${program}`).find((file) => existsSync(file));
  assert(found, `${program} not found on the path`);
  return found;
}

export const seconds = (/** @type {number} */ count) => new Promise((resolve) => setTimeout(resolve, 1000 * count));

export class Visit {
  /** Errors and warnings on the console. @type {string[]} */
  complaints = [];

  /** @param {import("puppeteer-core").Page} page */
  constructor(page) {
    this.page = page;
    page.on("console", (message) => {
      if (["error", "warn", "warning"].includes(message.type())) {
        this.complaints.push(message.text());
      }
    });
    page.on("pageerror", (error) => this.complaints.push(String(error)));
  }

  /**
   * @param {import("puppeteer-core").Browser | import("puppeteer-core").BrowserContext} browser
   * @param {string} address
   * @param {{size?: [number, number], isTouch?: boolean, before?: () => void}} [options] The default size is small, because
   *   software draws each pixel.
   */
  static async begin(browser, address, { size: [width, height] = [800, 500], isTouch = false, before } = {}) {
    const visit = new Visit(await browser.newPage());
    await visit.page.setViewport({ width, height, isMobile: isTouch, hasTouch: isTouch });
    if (before) {
      await visit.page.evaluateOnNewDocument(before);
    }
    await visit.page.goto(address, { timeout: PATIENCE });
    await visit.comes();
    return visit;
  }

  /** Waits until the game has started. */
  async comes() {
    await this.until((report) => report?.labels.length > 0, "the game has started");
  }

  /** Returns the state of the game. @returns {Promise<any>} */
  report() {
    return this.page.evaluate(() => {
      const report = globalThis.tamaire?.report();
      if (!report) return undefined;
      const labels = report.labels.map((label) => {
        const [x, y, ...name] = label.split(" ");
        return { x: Number(x), y: Number(y), name: name.join(" ") };
      });
      const { screen, level, language, ticks, is_won, won, notices, memory } = report;
      const places = [report.hand, report.origin, report.right].map((place) => [...place]);
      report.free();
      return { screen, level, language, ticks, is_won, won, notices, memory, labels, places };
    });
  }

  /** @param {(report: any) => boolean} is @param {string} what */
  async until(is, what) {
    const start = performance.now();
    let report;
    do {
      report = await this.report().catch(() => undefined);
      if (report && is(report)) return report;
      await seconds(0.1);
    } while (performance.now() - start < PATIENCE);
    assert.fail(`timeout, expected: ${what}\nlast state: ${JSON.stringify(report)}\nconsole: ${this.complaints.join("\n")}`);
  }

  /** @param {string} screen */
  sees(screen) {
    return this.until((report) => report?.screen === screen, `the screen ${screen}`);
  }

  /** @param {string} text */
  hears(text) {
    return this.until((report) => report?.notices.some((notice) => notice.includes(text)), `a notice with “${text}”`);
  }

  /** Returns the position of a button once it stops moving. @param {string} name */
  async place(name) {
    const find = (/** @type {any} */ report) => report?.labels.find((label) => label.name === name);
    let before;
    // New elements move at first.
    const report = await this.until((report) => {
      const now = find(report);
      const stays = now && before && now.x === before.x && now.y === before.y;
      before = now;
      return stays;
    }, `a button named “${name}”`);
    return find(report);
  }

  /** @param {string} name */
  async click(name) {
    const { x, y } = await this.place(name);
    await this.page.mouse.move(x, y);
    await this.page.mouse.click(x, y, { delay: 120 });
  }

  /** @param {string} name */
  async tap(name) {
    const { x, y } = await this.place(name);
    await this.page.touchscreen.touchStart(x, y);
    await seconds(0.15);
    await this.page.touchscreen.touchEnd();
  }

  /** @param {import("puppeteer-core").KeyInput} key */
  async press(key) {
    await this.page.keyboard.press(key, { delay: 120 });
  }

  /** Returns the position on the page of a world point [m]. @param {number} x @param {number} y */
  async at(x, y) {
    const { places: [, origin, right] } = await this.until(
      (report) => report?.places.flat().every(Number.isFinite),
      "a visible world",
    );
    const metre = right[0] - origin[0];
    return [origin[0] + metre * x, origin[1] - metre * y];
  }

  /** Wins the level Classic by pushing the body into the basket. @param {(x: number, y: number) => Promise<void>} point */
  async win(point) {
    const { ticks: start } = await this.report();
    for (let push = 0; push < 4000; push++) {
      const report = await this.report();
      if (report.is_won || report.screen === "Result") return;
      // Uses the game's time, which runs slower on a slow machine. The pointer comes from the left, so that it
      // picks up the hand before it reaches the body.
      const x = Math.min(-1.4 + (0.6 * (report.ticks - start)) / 60, 0.85);
      await point(...(await this.at(x, 0)));
      await seconds(0.02);
    }
    assert.fail("the round was not won");
  }

  /** Checks that the console reported nothing except `but`. @param {RegExp} [but] */
  isQuiet(but = /$^/) {
    const complaints = this.complaints.filter((text) => !but.test(text));
    assert.deepEqual(complaints, [], "errors and warnings on the console");
  }
}
