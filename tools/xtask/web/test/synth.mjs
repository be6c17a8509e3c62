// Compares the module of game/tamaire_sound under Node with the native synth. Fails if they differ by more than
// rounding errors, if a call allocates memory, or if invalid messages stop it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { natively } from "./checks.mjs";

const RATE = 48_000;
const FRAMES = 128;
// Tolerance: sines and exponentials are rounded differently by each platform's library.
const MOST_APART = 1e-3;

/** @param {string} file path of the .wasm */
export async function checkSynth(file) {
  const module = await WebAssembly.compile(readFileSync(file));
  assert.deepEqual(WebAssembly.Module.imports(module), []);
  checkSamples(module, natively("buffer", "tamaire_sound --features worklet", "reference"));
  checkHostile(module);
}

/** Creates an initialised instance. @param {WebAssembly.Module} module @param {number} rate */
function begin(module, rate) {
  const { memory, sound_begin, sound_message, sound_message_room, sound_take, sound_render } =
    new WebAssembly.Instance(module).exports;
  sound_begin(rate);
  const letters = new Uint8Array(memory.buffer, sound_message(), sound_message_room());
  return {
    memory,
    room: letters.length,
    tell(bytes) {
      letters.set(bytes);
      sound_take(bytes.length);
    },
    render: (frames) => new Float32Array(memory.buffer, sound_render(frames), 2 * Math.min(frames, FRAMES)),
  };
}

/** @param {WebAssembly.Module} module @param {Buffer} reference */
function checkSamples(module, reference) {
  const sound = begin(module, RATE);
  const size = sound.memory.buffer.byteLength;
  const [times, squares] = [[], []];
  let [at, apart, different, peak] = [0, 0, 0, 0];
  while (at < reference.length) {
    const length = reference.readUInt32LE(at);
    const message = reference.subarray(at + 4, at + 4 + length);
    at += 4 + length;
    const start = performance.now();
    if (length > 0) sound.tell(message);
    const samples = sound.render(FRAMES);
    times.push(1000 * (performance.now() - start));
    for (const sample of samples) {
      const native = reference.readFloatLE(at);
      at += 4;
      assert.ok(Math.abs(sample) <= 1, `sample beyond full scale: ${sample}`);
      apart = Math.max(apart, Math.abs(sample - native));
      different += sample !== native;
      peak = Math.max(peak, Math.abs(sample));
      squares.push(sample * sample);
    }
  }
  const count = squares.length;
  const rms = Math.sqrt(squares.reduce((sum, square) => sum + square, 0) / count);
  assert.ok(rms > 0.05, `too quiet: RMS ${rms}`);
  assert.ok(apart < MOST_APART, `samples differ by ${apart}, expected less than ${MOST_APART}`);
  assert.equal(sound.memory.buffer.byteLength, size, "memory after playing");
  // Without the first second, in which Node is still compiling.
  const settled = times.slice(RATE / FRAMES).sort((a, b) => a - b);
  const quantile = (share) => settled[Math.floor(share * (settled.length - 1))].toFixed(0);
  console.log(`worklet: ${(count / 2 / RATE).toFixed(1)} s, peak ${peak.toFixed(3)}, RMS ${rms.toFixed(3)}`);
  console.log(`worklet: compared with the native synth: maximum difference ${apart.toExponential(1)}, ${((100 * different) / count).toFixed(1)} % of samples differ`);
  console.log(`worklet: ${FRAMES} frames (${((1e6 * FRAMES) / RATE).toFixed(0)} µs) take ${quantile(0.5)} µs (median), ${quantile(0.99)} µs (99th percentile), ${quantile(1)} µs (maximum)`);
}

/** @param {WebAssembly.Module} module */
function checkHostile(module) {
  const sound = begin(module, 8000);
  let state = 1;
  const random = (below) => (state = (state * 48271) % 2147483647) % below;
  for (let round = 0; round < 2000; round++) {
    // Small bytes are valid more often.
    const most = round % 2 ? 256 : 6;
    sound.tell(Uint8Array.from({ length: random(sound.room + 1) }, () => random(most)));
    assert.ok(sound.render(FRAMES).every((sample) => Math.abs(sample) <= 1));
  }
  assert.equal(sound.render(2 ** 32 - 1).length, 2 * FRAMES);
  console.log("worklet: handles arbitrary messages");
}
