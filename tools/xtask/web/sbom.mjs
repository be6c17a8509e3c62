// Writes the bill of materials of programs in CycloneDX 1.5: contained crates with origin and SHA-256.
// usage: node sbom.mjs OUT TARGET PROGRAM...
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { inside, root } from "./inside.mjs";

const [out, target, ...programs] = process.argv.slice(2);
const { all, uses } = inside(target, programs);

/** Checksums from the lock file, by name and version. */
const checksums = new Map();
const lock = readFileSync(join(root, "Cargo.lock"), "utf8");
for (const [, name, version, rest] of lock.matchAll(/\[\[package\]\]\nname = "(.*)"\nversion = "(.*)"\n((?:.+\n)*)/g)) {
  const checksum = /^checksum = "([0-9a-f]{64})"$/m.exec(rest)?.[1];
  if (checksum) checksums.set(`${name} ${version}`, checksum);
}

const versionOf = (/** @type {string} */ name) => all.find((one) => one.name === name).version;
const refOf = new Map(all.map(({ id, name, version }) => [id, `pkg:cargo/${name}@${version}`]));
const components = all.map(({ id, name, version, license, description, source }) => {
  const checksum = checksums.get(`${name} ${version}`);
  if (source && !checksum) throw new Error(`${name} ${version} has no checksum in Cargo.lock`);
  return {
    type: programs.includes(name) ? "application" : "library",
    "bom-ref": refOf.get(id),
    name,
    version,
    description: description?.trim().replace(/\s+/g, " ") ?? undefined,
    scope: "required",
    hashes: checksum ? [{ alg: "SHA-256", content: checksum }] : undefined,
    // Some crates use the old notation with a slash for "or".
    licenses: license ? [{ expression: license.replaceAll(/\s*\/\s*/g, " OR ") }] : undefined,
    purl: refOf.get(id),
  };
});
const dependencies = [...uses].map(([id, used]) => ({
  ref: refOf.get(id),
  dependsOn: [...new Set(used.map((one) => refOf.get(one)))].sort(),
}));
dependencies.sort((a, b) => (a.ref < b.ref ? -1 : 1));
const body = JSON.stringify({ components, dependencies });
// Derived from the contents, so that equal contents have the same serial number.
const digest = createHash("sha256").update(target).update(body).digest("hex");
const serial = `${digest.slice(0, 8)}-${digest.slice(8, 12)}-5${digest.slice(13, 16)}-8${digest.slice(17, 20)}-${digest.slice(20, 32)}`;
const bill = {
  bomFormat: "CycloneDX",
  specVersion: "1.5",
  serialNumber: `urn:uuid:${serial}`,
  version: 1,
  metadata: {
    component: { type: "application", "bom-ref": "programs", name: programs[0], version: versionOf(programs[0]) },
    properties: [{ name: "target", value: target }],
  },
  components,
  dependencies: [{ ref: "programs", dependsOn: programs.map((name) => `pkg:cargo/${name}@${versionOf(name)}`) }, ...dependencies],
};
writeFileSync(out, `${JSON.stringify(bill, null, 1)}\n`);
console.log(`bill of materials: ${components.length} crates for ${target}`);
