// The licences of all that is inside the page, each text once, and whose it is.
// usage: node licences.mjs OUT
import { execFileSync } from "node:child_process";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";

const root = join(import.meta.dirname, "../..");
const [out] = process.argv.slice(2);
const PROGRAMS = ["tamaire", "tamaire_worklet"];

const words = ["metadata", "--format-version", "1", "--filter-platform", "wasm32-unknown-unknown"];
const text = execFileSync(process.env.CARGO ?? "cargo", words, { cwd: root, maxBuffer: 1 << 28 });
const { packages, resolve } = JSON.parse(text.toString());
const packageOf = new Map(packages.map((one) => [one.id, one]));
const nodeOf = new Map(resolve.nodes.map((node) => [node.id, node]));

/** All that is compiled in: what only builds or tests is not. */
const inside = new Set();
const open = packages.filter(({ name }) => PROGRAMS.includes(name)).map(({ id }) => id);
while (open.length) {
  const id = open.pop();
  if (inside.has(id)) continue;
  inside.add(id);
  for (const { pkg, dep_kinds } of nodeOf.get(id).deps) {
    if (dep_kinds.some(({ kind }) => kind === null)) open.push(pkg);
  }
}

/** @type {Map<string, string[]>} */
const owners = new Map();
const note = (/** @type {string} */ text, /** @type {string} */ owner) =>
  owners.set(text.trim(), [...(owners.get(text.trim()) ?? []), owner]);
for (const file of ["LICENSE-MIT", "LICENSE-APACHE"]) {
  note(readFileSync(join(root, file), "utf8"), "tamaire, fuwafuwa");
}
note(readFileSync(join(root, "game/fonts/OFL.txt"), "utf8"), "M PLUS Rounded 1c, the letters of the game");
const without = [];
for (const id of inside) {
  const { name, version, license, manifest_path, source } = packageOf.get(id);
  if (!source) continue;
  const folder = dirname(manifest_path);
  const files = readdirSync(folder).filter((file) => /^(licen[cs]e|copying|notice|unlicense)/i.test(file));
  const texts = files.flatMap((file) => {
    try {
      return [readFileSync(join(folder, file), "utf8")];
    } catch {
      return []; // a folder
    }
  });
  texts.forEach((text) => note(text, `${name} ${version}`));
  if (!texts.length) without.push(`${name} ${version}: ${license}`);
}
const parts = [...owners].map(([text, who]) => `${"=".repeat(78)}\n${[...new Set(who)].sort().join(", ")}\n\n${text}\n`);
if (without.length) {
  parts.push(`${"=".repeat(78)}\nThese come without a text of their own:\n\n${without.sort().join("\n")}\n`);
}
writeFileSync(out, parts.join("\n"));
console.log(`licences: ${inside.size} crates, ${owners.size} texts, ${without.length} named without one`);
