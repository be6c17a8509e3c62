// Writes the licences of all contents of programs: each text once, with the crates that it belongs to.
// usage: node licences.mjs OUT TARGET PROGRAM...
//        node licences.mjs OUT TARGET --workspace FOLDER PROGRAM...   programs without the game, in another workspace
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { inside, root } from "./inside.mjs";

const [out, target, ...words] = process.argv.slice(2);
const isGame = words[0] !== "--workspace";
const [workspace, ...programs] = isGame ? [root, ...words] : words.slice(1);
/** Licence texts of bundled C code, in subfolders. */
const DEEPER = new Map([["sdl3-src", ["SDL/LICENSE.txt", "SDL/src/hidapi/LICENSE-bsd.txt"]]]);

/** @type {Map<string, string[]>} */
const owners = new Map();
const note = (/** @type {string} */ text, /** @type {string} */ owner) =>
  owners.set(text.trim(), [...(owners.get(text.trim()) ?? []), owner]);
for (const file of ["LICENSE-MIT", "LICENSE-APACHE"]) {
  note(readFileSync(join(root, file), "utf8"), isGame ? "tamaire, fuwafuwa" : "fuwafuwa");
}
if (isGame) {
  note(readFileSync(join(root, "apps/app_shell/fonts/OFL.txt"), "utf8"), "M PLUS Rounded 1c, the font of the game");
}
const { all } = inside(target, programs, workspace);
const without = [];
for (const { name, version, license, manifest_path, source } of all) {
  if (!source) continue;
  const folder = dirname(manifest_path);
  const files = readdirSync(folder).filter((file) => /^(licen[cs]e|copying|notice|unlicense)/i.test(file));
  const texts = [...files.sort(), ...(DEEPER.get(name) ?? [])].flatMap((file) => {
    try {
      return [readFileSync(join(folder, file), "utf8")];
    } catch {
      return []; // a folder
    }
  });
  texts.forEach((text) => note(text, `${name} ${version}`));
  if (!texts.length) without.push(`${name} ${version}: ${license}`);
}
// The game's own list comes first.
const known = isGame ? [readFileSync(join(root, "THIRD-PARTY.md"), "utf8")] : [];
const line = "=".repeat(78);
const parts = [...owners].map(([text, who]) => `${line}\n${[...new Set(who)].sort().join(", ")}\n\n${text}\n`);
if (without.length) {
  parts.push(`${line}\nThese packages contain no licence text:\n\n${without.sort().join("\n")}\n`);
}
writeFileSync(out, [...known, ...parts].join("\n"));
console.log(`licences: ${all.length} crates, ${owners.size} texts, ${without.length} crates without a text`);
