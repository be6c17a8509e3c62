// Runs the golden scenes of tools/determinism_checks, built for wasm32, and fails where one ends in other bits than it must.
// Beside each stands how long it took, and how long natively.
// usage: node golden.mjs FILE.wasm MILLISECONDS...   the native times, in the order of the scenes
import { readFile } from "node:fs/promises";

const [file, ...native] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(await readFile(file));
const { memory, golden_count, golden_name, golden_name_length, golden_run, golden_hash } = instance.exports;
const hex = (hash) => "0x" + BigInt.asUintN(64, hash).toString(16).padStart(16, "0");

for (let scene = 0; scene < golden_count(); scene++) {
  const name = new TextDecoder().decode(new Uint8Array(memory.buffer, golden_name(scene), golden_name_length(scene)));
  // Before the run, so that a trap can be told by its scene.
  process.stdout.write(`wasm32: ${name}: `);
  const [found, golden] = [hex(golden_run(scene)), hex(golden_hash(scene))];
  // The least of some more: Node goes on compiling while the first of them run.
  const times = Array.from({ length: 5 }, () => {
    const start = performance.now();
    golden_run(scene);
    return performance.now() - start;
  });
  const took = Math.min(...times);
  const time = `${took.toFixed()} ms, natively ${native[scene]}: ${(took / native[scene]).toFixed(1)} ×`;
  console.log(found === golden ? `${found}, as it must; ${time}` : `DIFFERENT, ${found} instead of ${golden}`);
  if (found !== golden) process.exitCode = 1;
}
