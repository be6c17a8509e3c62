// Which crates are inside programs that are built for a system: what only builds or tests is not.
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";

/** Debian 12 has Node 18, which knows no `import.meta.dirname`. */
export const root = fileURLToPath(new URL("../../..", import.meta.url));

/**
 * The packages inside, as `cargo metadata` describes them, by name and version; and for each the ids of those that it uses.
 * @param {string} target @param {string[]} programs
 */
export function inside(target, programs) {
  const words = ["metadata", "--format-version", "1", "--filter-platform", target];
  const text = execFileSync(process.env.CARGO ?? "cargo", words, { cwd: root, maxBuffer: 1 << 28 });
  const { packages, resolve } = JSON.parse(text.toString());
  const packageOf = new Map(packages.map((one) => [one.id, one]));
  const nodeOf = new Map(resolve.nodes.map((node) => [node.id, node]));
  /** @type {Map<string, string[]>} */
  const uses = new Map();
  const open = packages.filter(({ name }) => programs.includes(name)).map(({ id }) => id);
  if (open.length !== programs.length) {
    throw new Error(`of ${programs.join(", ")} the workspace has ${open.length}`);
  }
  while (open.length) {
    const id = open.pop();
    if (uses.has(id)) continue;
    const compiledIn = nodeOf.get(id).deps.filter(({ dep_kinds }) => dep_kinds.some(({ kind }) => kind === null));
    uses.set(id, compiledIn.map(({ pkg }) => pkg));
    open.push(...uses.get(id));
  }
  const all = [...uses.keys()].map((id) => packageOf.get(id));
  const key = ({ name, version }) => `${name} ${version}`;
  all.sort((a, b) => (key(a) < key(b) ? -1 : 1));
  return { all, uses };
}
