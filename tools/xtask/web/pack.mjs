// Packs the folder for a web server: puts immutable files into a folder named by a hash of the contents,
// and prints the sizes of the compressed files.
// usage: node pack.mjs STAGE PAGE LICENCES OUT [ADDRESS]
//   STAGE: output of wasm-bindgen, and sound.wasm; PAGE: game/tamaire/web; LICENCES: text file; OUT: the folder, which is replaced;
//   ADDRESS: address of the page
import { createHash } from "node:crypto";
import { cpSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { addressed } from "./address.mjs";
import { brotli } from "./compress.mjs";

const [stage, page, licences, out, address] = process.argv.slice(2);
const here = fileURLToPath(new URL(".", import.meta.url));

/** Files of the page with fixed names, because they are referred to from outside. */
const NAMED = ["index.html", "sw.js", "manifest.webmanifest", "icon.svg", "icon-192.png", "icon-512.png"];
/** Font that the page fetches on demand. */
const JAPANESE = join(here, "../../../apps/app_shell/fonts/MPLUSRounded1c-Bold-japanese.ttf");
/** Image for link previews. */
const PREVIEW = join(here, "../../../docs/game-squeezed.png");

/** @type {Map<string, Buffer>} */
const files = new Map();
for (const name of readdirSync(page, { withFileTypes: true })) {
  if (name.isFile() && !NAMED.includes(name.name)) {
    files.set(name.name, readFileSync(join(page, name.name)));
  }
}
files.set("tamaire.js", readFileSync(join(stage, "tamaire.js")));
files.set("tamaire.wasm", readFileSync(join(stage, "tamaire_bg.wasm")));
files.set("sound.wasm", readFileSync(join(stage, "sound.wasm")));
files.set("japanese.ttf", readFileSync(JAPANESE));
const parts = {
  game: "./tamaire.js",
  wasm: "./tamaire.wasm",
  bytes: files.get("tamaire.wasm").length,
  worker: "../sw.js",
};
files.set("parts.js", Buffer.from(`export const PARTS = ${JSON.stringify(parts)};\n`));

const hash = createHash("sha256");
for (const [name, bytes] of [...files, ...NAMED.map((name) => [name, readFileSync(join(page, name))])]) {
  hash.update(name).update(bytes);
}
hash.update(readFileSync(licences)).update(readFileSync(PREVIEW)).update(address ?? "");
const version = hash.digest("hex").slice(0, 12);

for (const folder of [out, `${out}.br`]) {
  rmSync(folder, { recursive: true, force: true });
}
mkdirSync(join(out, version), { recursive: true });
for (const [name, bytes] of files) {
  writeFileSync(join(out, version, name), bytes);
}
for (const name of NAMED) {
  cpSync(join(page, name), join(out, name));
}
cpSync(licences, join(out, "licences.txt"));
cpSync(PREVIEW, join(out, "preview.png"));
const change = (/** @type {string} */ name, /** @type {(text: string) => string} */ how) =>
  writeFileSync(join(out, name), how(readFileSync(join(out, name), "utf8")));
change("index.html", (text) => addressed(text, address).replaceAll(/"(page\.(?:css|js))"/g, `"${version}/$1"`));
const kept = ["./", ...NAMED.filter((name) => name !== "sw.js" && name !== "index.html")];
kept.push("licences.txt", ...[...files.keys()].map((name) => `${version}/${name}`));
change("sw.js", (text) => text.replace("@VERSION@", version).replace('"@FILES@"', kept.map((name) => JSON.stringify(name)).join(", ")));

console.log(`${out}: version ${version}`);
const all = [...NAMED, "licences.txt", "preview.png", ...[...files.keys()].map((name) => `${version}/${name}`)];
const rows = all.map((name) => {
  const bytes = readFileSync(join(out, name));
  const small = brotli(bytes);
  // For serve.mjs, because compressing on demand would be too slow.
  const beside = join(`${out}.br`, name);
  mkdirSync(dirname(beside), { recursive: true });
  writeFileSync(beside, small);
  return [name, bytes.length, small.length];
});
rows.sort((a, b) => b[2] - a[2]);
console.log("     bytes    brotli");
for (const [name, bytes, small] of rows) {
  console.log(`${String(bytes).padStart(10)}${String(small).padStart(10)}  ${name}`);
}
