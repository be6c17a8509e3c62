// The synth of the game, on the thread of the browser that plays sound. What it is told are bytes of
// game/tamaire_sound, which the module alone understands. Memory is taken at the beginning only.

/** As many frames as a browser asks for at a time. */
const FRAMES = 128;

/**
 * @typedef {object} Exports Of `tamaire_sound` built with the feature `worklet`.
 * @property {WebAssembly.Memory} memory
 * @property {(rate: number) => void} sound_begin
 * @property {() => number} sound_message
 * @property {() => number} sound_message_room
 * @property {(length: number) => void} sound_take
 * @property {(frames: number) => number} sound_render
 */

class Synth extends AudioWorkletProcessor {
  /** @param {{processorOptions: {module: WebAssembly.Module}}} options */
  constructor({ processorOptions }) {
    super();
    const { exports } = new WebAssembly.Instance(processorOptions.module);
    const synth = /** @type {Exports} */ (/** @type {unknown} */ (exports));
    synth.sound_begin(sampleRate);
    const { buffer } = synth.memory;
    const message = new Uint8Array(buffer, synth.sound_message(), synth.sound_message_room());
    this.port.onmessage = ({ data }) => {
      message.set(data.subarray(0, message.length));
      synth.sound_take(data.length);
    };
    this.render = synth.sound_render;
    this.samples = new Float32Array(buffer, synth.sound_render(0), 2 * FRAMES);
  }

  /**
   * @param {Float32Array[][]} _
   * @param {Float32Array[][]} outputs
   */
  process(_, [[left, right]]) {
    this.render(FRAMES);
    for (let frame = 0; frame < FRAMES; frame++) {
      left[frame] = this.samples[2 * frame];
      right[frame] = this.samples[2 * frame + 1];
    }
    return true;
  }
}

registerProcessor("tamaire", Synth);
