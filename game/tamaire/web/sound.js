// The loudspeaker of the game in a browser: its synth plays in an audio worklet, from the first gesture on. Whatever goes
// wrong is told as trouble, and the game goes on in silence. `worklet.js` and `sound.wasm` lie beside this.

/** What browsers take for a gesture, one this and one that. A pad is connected when a button on it is pressed. */
const GESTURES = ["pointerdown", "pointerup", "touchend", "keydown", "click", "gamepadconnected"];

const beside = (/** @type {string} */ file) => new URL(file, import.meta.url);

/** What a browser or a page lacks to play. */
function lack() {
  if (!isSecureContext) return "sound needs a page that came by https";
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
    // Not every server knows what type it has.
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
    // There may have been a gesture while the game was loading.
    if (navigator.userActivation?.hasBeenActive) this.#wake();
  }

  /**
   * Tells the synth a `Message` of game/tamaire_sound. Nothing is kept for later: who begins to hear hears what is.
   * @param {Uint8Array} bytes
   */
  tell(bytes) {
    if (!this.#node || this.#context?.state !== "running") return;
    // The game goes on writing where these are.
    const copy = bytes.slice();
    this.#node.port.postMessage(copy, [copy.buffer]);
  }

  /**
   * Why nothing is heard, if so. To wait for a gesture is no trouble.
   * @returns {string | undefined}
   */
  trouble() {
    return this.#trouble;
  }

  /** Plays, where the browser lets it: some stop it for a call or another program, and want a gesture again. */
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
