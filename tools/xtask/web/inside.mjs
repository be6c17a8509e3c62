// Crates contained in programs for a target, without build and test dependencies.
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";

/** Root of the repository. Node 18 of Debian 12 lacks `import.meta.dirname`. */
export const root = fileURLToPath(new URL("../../..", import.meta.url));

/**
 * Returns the packages as described by `cargo metadata`, sorted by name and version, and for each id the ids of its dependencies.
 * @param {string} target @param {string[]} programs @param {string} workspace
 */
export function inside(target, programs, workspace = root) {
  const words = ["metadata", "--format-version", "1", "--filter-platform", target];
  const text = execFileSync(process.env.CARGO ?? "cargo", words, { cwd: workspace, maxBuffer: 1 << 28 });
  const { packages, resolve } = JSON.parse(text.toString());
  const packageOf = new Map(packages.map((one) => [one.id, one]));
  const nodeOf = new Map(resolve.nodes.map((node) => [node.id, node]));
  /** @type {Map<string, string[]>} */
  const uses = new Map();
  const open = packages.filter(({ name }) => programs.includes(name)).map(({ id }) => id);
  if (open.length !== programs.length) {
    throw new Error(`expected ${programs.length} packages (${programs.join(", ")}) in the workspace, found ${open.length}`);
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
