// Whether a page of the game is heard in a browser: not before a gesture, then without clipping, not in a hidden tab; and
// whether it goes on where there is no sound.

import assert from "node:assert/strict";

/** In the page, before it begins: listens to whatever goes to a loudspeaker. */
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

/** In the page: what was heard over the last half second or so. */
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
    // Of Chromium: what was missing when the device asked for it [s].
    missing: context?.playbackStats?.underrunDuration,
    peak: all.reduce((most, sample) => Math.max(most, Math.abs(sample)), 0),
    rms: Math.sqrt(all.reduce((sum, sample) => sum + sample * sample, 0) / Math.max(all.length, 1)),
    // A click is a wide step from one sample to the next.
    step: Math.max(0, ...samples.map((side) => side.reduce((most, sample, at) => Math.max(most, Math.abs(sample - side[Math.max(at, 1) - 1])), 0))),
  };
}

/**
 * In the page, before it begins: says by itself what is heard a second after the game began. A test that asks a page
 * something is, to the browser, somebody who uses it.
 */
function confess() {
  const look = setInterval(() => {
    if (!globalThis.tamaire?.report()) return;
    clearInterval(look);
    setTimeout(() => console.debug(`heard: ${JSON.stringify(hear())}`), 1000);
  }, 100);
}

const rest = (seconds) => new Promise((done) => setTimeout(done, 1000 * seconds));

/** Looks again and again until the state is this. */
async function until(page, state, seconds = 10) {
  for (let left = seconds; left > 0; left -= 0.1) {
    if ((await page.evaluate(hear)).state === state) return;
    await rest(0.1);
  }
  assert.fail(`still ${(await page.evaluate(hear)).state}, not ${state}, after ${seconds} s`);
}

/** A new page, and what it complains of. */
async function open(browser, url, first) {
  const page = await browser.newPage();
  const complaints = [];
  page.on("console", (message) => /error|warn/.test(message.type()) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(error.message));
  await page.evaluateOnNewDocument(`(${first})(); ${hear}; (${confess})();`);
  const [before] = await Promise.all([confession(page), page.goto(url, { waitUntil: "load" })]);
  return { page, complaints, before };
}

/** What a page says that was heard. @param {import("puppeteer-core").Page} page */
function confession(page, seconds = 90) {
  return new Promise((done, fail) => {
    const late = setTimeout(() => fail(new Error(`the game did not begin within ${seconds} s`)), 1000 * seconds);
    page.on("console", (message) => {
      const [, heard] = /^heard: (.*)$/.exec(message.text()) ?? [];
      if (!heard) return;
      clearTimeout(late);
      done(JSON.parse(heard));
    });
  });
}

/**
 * Plays a page that sounds by itself once it may, as the title does with its music. The browser must ask for a gesture:
 * `--autoplay-policy=document-user-activation-required` of Chromium.
 * @param {import("puppeteer-core").Browser} browser
 * @param {string} url
 */
export async function checkSound(browser, url, seconds = 5) {
  const { page, complaints, before } = await open(browser, url, listen);
  assert.notEqual(before.state, "running", "it plays before a gesture");
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
  assert.equal(last.count, 1, "one way to the loudspeaker");
  assert.ok(rms > 0.003, `silent after a click: RMS ${rms}`);
  assert.ok(peak <= 1, `clipped: ${peak}`);
  const pace = (last.time - first.time) / (last.clock - first.clock);
  assert.ok(Math.abs(pace - 1) < 0.2, `the sound runs at ${pace} of its pace`);

  const other = await browser.newPage();
  await other.bringToFront();
  await until(page, "suspended");
  await other.close();
  await page.bringToFront();
  await until(page, "running");
  await rest(1);
  assert.ok((await page.evaluate(hear)).rms > 0, "silent after it was hidden");
  assert.deepEqual(complaints, []);
  await page.close();
  const missing = last.missing === undefined ? "" : `${(1000 * last.missing).toFixed(0)} ms missing in ${seconds} s, `;
  console.log(
    `sound: silent before a click, then ${last.rate} Hz, peak ${peak.toFixed(3)}, RMS ${rms.toFixed(3)}, widest step ` +
      `${step.toFixed(3)}, pace ${pace.toFixed(3)}, ${missing}suspended while hidden`,
  );
}

/**
 * Plays a page in a browser that lacks what sound needs.
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
  console.log("sound: without audio worklets the page goes on in silence");
}
