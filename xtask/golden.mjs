// Runs the golden scenes of crates/fuwafuwa_golden, built for wasm32, and fails where one ends in other bits than it must.
// usage: node golden.mjs FILE.wasm
import { readFile } from "node:fs/promises";

const { instance } = await WebAssembly.instantiate(await readFile(process.argv[2]));
const { memory, golden_count, golden_name, golden_name_length, golden_run, golden_hash } = instance.exports;
const hex = (hash) => "0x" + BigInt.asUintN(64, hash).toString(16).padStart(16, "0");

for (let scene = 0; scene < golden_count(); scene++) {
  const name = new TextDecoder().decode(new Uint8Array(memory.buffer, golden_name(scene), golden_name_length(scene)));
  // Before the run, so that a trap can be told by its scene.
  process.stdout.write(`wasm32: ${name}: `);
  const [found, golden] = [hex(golden_run(scene)), hex(golden_hash(scene))];
  console.log(found === golden ? `${found}, as it must` : `DIFFERENT, ${found} instead of ${golden}`);
  if (found !== golden) process.exitCode = 1;
}
