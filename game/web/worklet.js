// The synth of the game, on the thread of the browser that plays sound. What it is told are bytes of
// crates/tamaire_sound, which the module alone understands. Memory is taken at the beginning only.

/** As many frames as a browser asks for at a time. */
const FRAMES = 128;

class Synth extends AudioWorkletProcessor {
  /** @param {{processorOptions: {module: WebAssembly.Module}}} options */
  constructor({ processorOptions }) {
    super();
    const { memory, sound_begin, sound_message, sound_message_room, sound_take, sound_render } =
      new WebAssembly.Instance(processorOptions.module).exports;
    sound_begin(sampleRate);
    const room = new Uint8Array(memory.buffer, sound_message(), sound_message_room());
    this.port.onmessage = ({ data }) => {
      room.set(data.subarray(0, room.length));
      sound_take(data.length);
    };
    this.render = sound_render;
    this.samples = new Float32Array(memory.buffer, sound_render(0), 2 * FRAMES);
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
