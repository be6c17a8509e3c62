// Runs the golden scenes of crates/fuwafuwa_golden, built for wasm32: node golden.mjs FILE.wasm
import { readFile } from "node:fs/promises";

const { instance } = await WebAssembly.instantiate(await readFile(process.argv[2]));
const { golden_count, golden_holds } = instance.exports;
let different = 0;
for (let scene = 0; scene < golden_count(); scene++) {
  const holds = golden_holds(scene) === 1;
  console.log(`golden scene ${scene + 1} of ${golden_count()}: ${holds ? "the same" : "DIFFERENT"} on wasm32`);
  different += holds ? 0 : 1;
}
process.exit(different);
