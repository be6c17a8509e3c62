// Wrapper of the module of tools/determinism_checks for a page.

/** @param {string} address */
export async function open(address) {
  const { instance } = await WebAssembly.instantiateStreaming(fetch(address));
  const wasm = /** @type {Record<string, any>} */ (instance.exports);
  // The buffer is replaced when the memory grows.
  const bytes = (at, length) => new Uint8Array(wasm.memory.buffer, at, length);
  const text = (at, length) => new TextDecoder().decode(bytes(at, length));
  const output = () => text(wasm.checks_output(), wasm.checks_output_length());

  /** Returns the output of a call with this input; throws the reason of a failure. */
  function answer(call, /** @type {string} */ input) {
    const encoded = new TextEncoder().encode(input);
    const at = wasm.checks_input(encoded.length);
    if (at === 0) {
      throw new Error(`the module cannot take an input of ${encoded.length} bytes`);
    }
    bytes(at, encoded.length).set(encoded);
    if (call() === 0) {
      throw new Error(output());
    }
    return output();
  }

  return {
    /** Returns the names of the golden scenes. */
    scenes() {
      const scenes = Array.from({ length: wasm.golden_count() }, (_, scene) => scene);
      return scenes.map((scene) => text(wasm.golden_name(scene), wasm.golden_name_length(scene)));
    },
    /** Runs a golden scene; returns its hash, the expected hash, and the duration [ms]. */
    golden(/** @type {number} */ scene) {
      const start = performance.now();
      const found = wasm.golden_run(scene);
      const milliseconds = performance.now() - start;
      const [hash, golden] = [found, wasm.golden_hash(scene)].map((hash) => BigInt.asUintN(64, hash).toString(16));
      return { hash, golden, milliseconds };
    },
    /** Returns the games in a series of rounds. */
    series(/** @type {number} */ number) {
      wasm.checks_series(number);
      return output().split("\n");
    },
    /** Plays a round; returns its replay. */
    record: (/** @type {string} */ game) => answer(wasm.checks_record, game),
    /** Verifies a replay; throws if the result differs. */
    verify: (/** @type {string} */ replay) => answer(wasm.checks_verify, replay),
    /** Plays a round of at most `most` ticks; returns the duration of each tick of the simulation [ms]. */
    time(/** @type {string} */ game, /** @type {number} */ most) {
      answer(wasm.checks_begin, game);
      const times = [];
      for (let goesOn = 1; goesOn && times.length < most; ) {
        wasm.checks_ask();
        const start = performance.now();
        goesOn = wasm.checks_step();
        times.push(performance.now() - start);
      }
      return times;
    },
  };
}
