// Synth of the game on the browser's audio thread. Its messages are bytes of game/tamaire_sound, decoded by the module.
// It allocates memory at the start only.

/** Frames in a render quantum of the Web Audio API. */
const FRAMES = 128;

/**
 * @typedef {object} Exports Exports of game/tamaire_sound.
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
