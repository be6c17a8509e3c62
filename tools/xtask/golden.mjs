// Runs the golden scenes of tools/determinism_checks on wasm32; fails if the result of one differs from the native bits.
// Prints the duration of each scene beside the native one.
// usage: node golden.mjs FILE.wasm MILLISECONDS...   native durations in the order of the scenes
import { readFile } from "node:fs/promises";

const [file, ...native] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(await readFile(file));
const { memory, golden_count, golden_name, golden_name_length, golden_run, golden_hash } = instance.exports;
const hex = (hash) => "0x" + BigInt.asUintN(64, hash).toString(16).padStart(16, "0");

for (let scene = 0; scene < golden_count(); scene++) {
  const name = new TextDecoder().decode(new Uint8Array(memory.buffer, golden_name(scene), golden_name_length(scene)));
  // Printed before the run, so that a trap can be attributed to its scene.
  process.stdout.write(`wasm32: ${name}: `);
  const [found, golden] = [hex(golden_run(scene)), hex(golden_hash(scene))];
  // Minimum of further runs, because Node is still compiling during the first ones.
  const times = Array.from({ length: 5 }, () => {
    const start = performance.now();
    golden_run(scene);
    return performance.now() - start;
  });
  const took = Math.min(...times);
  const time = `${took.toFixed()} ms, natively ${native[scene]}: ${(took / native[scene]).toFixed(1)} ×`;
  console.log(found === golden ? `${found}, as expected; ${time}` : `DIFFERENT: expected ${golden}, found ${found}`);
  if (found !== golden) process.exitCode = 1;
}
