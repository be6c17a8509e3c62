// Sound output in a browser: the synth runs in an audio worklet from the first user gesture on. After any error, the game
// continues without sound and reports it as trouble. Needs `worklet.js` and `sound.wasm` in the same folder.

/** Events that browsers accept as a user gesture; they differ. A pad connects when one of its buttons is pressed. */
const GESTURES = ["pointerdown", "pointerup", "touchend", "keydown", "click", "gamepadconnected"];

const beside = (/** @type {string} */ file) => new URL(file, import.meta.url);

/** Returns the missing requirement, if any. */
function lack() {
  if (!isSecureContext) return "sound requires a page loaded over https";
  if (!globalThis.AudioContext || !globalThis.AudioWorkletNode) return "this browser has no audio worklets";
}

export class Speaker {
  /** @type {Promise<WebAssembly.Module> | undefined} */
  #module;
  /** @type {AudioContext | undefined} */
  #context;
  /** @type {AudioWorkletNode | undefined} */
  #node;
  /** @type {string | undefined} */
  #trouble = lack();

  constructor() {
    if (this.#trouble) return;
    // Not every server sends the right media type, so streaming compilation is not used.
    this.#module = fetch(beside("sound.wasm"))
      .then((response) => (response.ok ? response.arrayBuffer() : Promise.reject(new Error(`no synth (${response.status})`))))
      .then((bytes) => WebAssembly.compile(bytes));
    this.#module.catch((error) => this.#fail(`sound.wasm: ${error.message}`));
    for (const gesture of GESTURES) {
      addEventListener(gesture, () => this.#wake(), { capture: true, passive: true });
    }
    document.addEventListener("visibilitychange", () => {
      if (document.hidden) this.#context?.suspend().catch(() => {});
      else if (this.#context) this.#wake();
    });
    // The user may have interacted while the game was loading.
    if (navigator.userActivation?.hasBeenActive) this.#wake();
  }

  /**
   * Sends a `Message` of game/tamaire_sound to the synth. Messages are dropped while no sound is playing.
   * @param {Uint8Array} bytes
   */
  tell(bytes) {
    if (!this.#node || this.#context?.state !== "running") return;
    // The game reuses this memory.
    const copy = bytes.slice();
    this.#node.port.postMessage(copy, [copy.buffer]);
  }

  /**
   * Returns the reason of missing sound, if any. Waiting for a gesture is not an error.
   * @returns {string | undefined}
   */
  trouble() {
    return this.#trouble;
  }

  /** Starts or resumes playing. Some browsers stop it for a call or another program and require a new gesture. */
  #wake() {
    if (document.hidden || this.#trouble) return;
    try {
      this.#context ??= this.#begin();
      if (this.#context.state !== "running") this.#context.resume().catch(() => {});
    } catch (error) {
      this.#fail(`the sound device: ${error}`);
    }
  }

  #begin() {
    const context = new AudioContext();
    this.#join(context).catch((error) => this.#fail(`worklet.js: ${error.message}`));
    return context;
  }

  /** @param {AudioContext} context */
  async #join(context) {
    await context.audioWorklet.addModule(beside("worklet.js"));
    const processorOptions = { module: await this.#module };
    const options = { numberOfInputs: 0, outputChannelCount: [2], processorOptions };
    const node = new AudioWorkletNode(context, "tamaire", options);
    node.onprocessorerror = () => this.#fail("the synth stopped");
    node.connect(context.destination);
    this.#node = node;
  }

  /** @param {string} trouble */
  #fail(trouble) {
    this.#trouble ??= trouble;
    this.#context?.close().catch(() => {});
  }
}
