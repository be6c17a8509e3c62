// Tests of sound in a browser: silent before a user gesture, then without clipping, silent in a hidden tab; and the game
// continues without audio support.

import assert from "node:assert/strict";

/** Runs in the page before it starts: taps everything that is connected to the audio output. */
function listen() {
  globalThis.heard = [];
  const connect = AudioNode.prototype.connect;
  AudioNode.prototype.connect = function (to, ...more) {
    if (to instanceof AudioDestinationNode) {
      const splitter = new ChannelSplitterNode(this.context, { numberOfOutputs: 2 });
      const sides = [0, 1].map((side) => {
        const analyser = new AnalyserNode(this.context, { fftSize: 32768 });
        connect.call(splitter, analyser, side);
        return analyser;
      });
      connect.call(this, splitter);
      globalThis.heard.push({ context: this.context, sides });
    }
    return connect.call(this, to, ...more);
  };
}

/** Runs in the page: analyses some half a second of sound. */
function hear() {
  const { heard = [] } = globalThis;
  const [{ context, sides } = { sides: [] }] = heard;
  const samples = sides.map((side) => {
    const samples = new Float32Array(side.fftSize);
    side.getFloatTimeDomainData(samples);
    return samples;
  });
  const all = samples.flatMap((side) => [...side]);
  return {
    count: heard.length,
    state: context?.state ?? "none",
    rate: context?.sampleRate,
    time: context?.currentTime,
    clock: performance.now() / 1000,
    // Chromium only: total duration of underruns [s].
    missing: context?.playbackStats?.underrunDuration,
    peak: all.reduce((most, sample) => Math.max(most, Math.abs(sample)), 0),
    rms: Math.sqrt(all.reduce((sum, sample) => sum + sample * sample, 0) / Math.max(all.length, 1)),
    // A click is a large step between two samples.
    step: Math.max(0, ...samples.map((side) => side.reduce((most, sample, at) => Math.max(most, Math.abs(sample - side[Math.max(at, 1) - 1])), 0))),
  };
}

/**
 * Runs in the page before it starts: logs the sound one second after the game has started. Evaluating a script from the
 * test would count as a user gesture.
 */
function confess() {
  const look = setInterval(() => {
    if (!globalThis.tamaire?.report()) return;
    clearInterval(look);
    setTimeout(() => console.debug(`heard: ${JSON.stringify(hear())}`), 1000);
  }, 100);
}

const rest = (seconds) => new Promise((done) => setTimeout(done, 1000 * seconds));

/** Polls until the audio context has this state. */
async function until(page, state, seconds = 10) {
  for (let left = seconds; left > 0; left -= 0.1) {
    if ((await page.evaluate(hear)).state === state) return;
    await rest(0.1);
  }
  assert.fail(`still ${(await page.evaluate(hear)).state}, not ${state}, after ${seconds} s`);
}

/** Opens a page; collects its errors and warnings. */
async function open(browser, url, first) {
  const page = await browser.newPage();
  const complaints = [];
  page.on("console", (message) => /error|warn/.test(message.type()) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(error.message));
  await page.evaluateOnNewDocument(`(${first})(); ${hear}; (${confess})();`);
  const [before] = await Promise.all([confession(page), page.goto(url, { waitUntil: "load" })]);
  return { page, complaints, before };
}

/** Returns the sound analysis that a page has logged. @param {import("puppeteer-core").Page} page */
function confession(page, seconds = 90) {
  return new Promise((done, fail) => {
    const late = setTimeout(() => fail(new Error(`the game did not start within ${seconds} s`)), 1000 * seconds);
    page.on("console", (message) => {
      const [, heard] = /^heard: (.*)$/.exec(message.text()) ?? [];
      if (!heard) return;
      clearTimeout(late);
      done(JSON.parse(heard));
    });
  });
}

/**
 * Tests a page that plays sound by itself once permitted, such as the title's music. The browser must require a gesture:
 * `--autoplay-policy=document-user-activation-required` in Chromium.
 * @param {import("puppeteer-core").Browser} browser
 * @param {string} url
 */
export async function checkSound(browser, url, seconds = 5) {
  const { page, complaints, before } = await open(browser, url, listen);
  assert.notEqual(before.state, "running", "sound plays before a user gesture");
  assert.equal(before.peak, 0);

  await page.mouse.click(100, 100);
  await until(page, "running").catch((error) => assert.fail(`${error.message}: ${complaints.join("; ")}`));
  await rest(1);
  const first = await page.evaluate(hear);
  let [peak, square, step, last] = [0, 0, 0, first];
  for (let times = 0; times < 2 * seconds; times++) {
    await rest(0.5);
    last = await page.evaluate(hear);
    peak = Math.max(peak, last.peak);
    step = Math.max(step, last.step);
    square += last.rms ** 2 / (2 * seconds);
  }
  const rms = Math.sqrt(square);
  assert.equal(last.count, 1, "number of nodes connected to the audio output");
  assert.ok(rms > 0.003, `silent after a click: RMS ${rms}`);
  assert.ok(peak <= 1, `clipped: ${peak}`);
  const pace = (last.time - first.time) / (last.clock - first.clock);
  assert.ok(Math.abs(pace - 1) < 0.2, `expected real-time speed of sound, found a factor of ${pace}`);

  const other = await browser.newPage();
  await other.bringToFront();
  await until(page, "suspended");
  await other.close();
  await page.bringToFront();
  await until(page, "running");
  await rest(1);
  assert.ok((await page.evaluate(hear)).rms > 0, "silent after the tab was hidden and shown");
  assert.deepEqual(complaints, []);
  await page.close();
  const missing = last.missing === undefined ? "" : `${(1000 * last.missing).toFixed(0)} ms missing in ${seconds} s, `;
  console.log(
    `sound: silent before a click, then ${last.rate} Hz, peak ${peak.toFixed(3)}, RMS ${rms.toFixed(3)}, largest step ` +
      `${step.toFixed(3)}, pace ${pace.toFixed(3)}, ${missing}suspended while hidden`,
  );
}

/**
 * Tests a page in a browser without audio worklets.
 * @param {import("puppeteer-core").Browser} browser
 * @param {string} url
 */
export async function checkSilence(browser, url) {
  const { page, complaints } = await open(browser, url, () => delete globalThis.AudioWorkletNode);
  await page.mouse.click(100, 100);
  const ticks = await page.evaluate(() => globalThis.tamaire.report().ticks);
  await page.waitForFunction((ticks) => globalThis.tamaire.report().ticks !== ticks, { timeout: 30_000 }, ticks);
  assert.deepEqual(complaints, []);
  await page.close();
  console.log("sound: without audio worklets, the game runs silently");
}
