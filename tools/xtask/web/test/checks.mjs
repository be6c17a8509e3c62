// Opens a blank page with the module of tools/determinism_checks.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { join, resolve } from "node:path";

const ROOT = join(import.meta.dirname, "../../../..");
const CARGO = process.env.CARGO ?? "cargo";

/** Headers for cross-origin isolation, which gives clocks a resolution of 5 µs instead of 100 µs. */
const ALONE = { "Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Embedder-Policy": "require-corp" };

/**
 * @param {import("puppeteer-core").Browser} browser
 * @param {string} module path of the .wasm
 */
export async function open(browser, module) {
  const wrapper = join(import.meta.dirname, "module.js");
  /** @type {Record<string, [string, string | Buffer]>} */
  const files = {
    "/": ["text/html", "<!doctype html><title>checks</title>"],
    "/module.js": ["text/javascript", readFileSync(wrapper)],
    "/module.wasm": ["application/wasm", readFileSync(module)],
  };
  const server = createServer((request, response) => {
    const file = files[request.url ?? ""];
    response.writeHead(file ? 200 : 404, { ...ALONE, "Content-Type": file?.[0] ?? "text/plain" }).end(file?.[1]);
  });
  await new Promise((done) => server.listen(0, "localhost", () => done(undefined)));
  const { port } = /** @type {import("node:net").AddressInfo} */ (server.address());
  const page = await browser.newPage();
  await page.goto(`http://localhost:${port}/`);
  const checks = await page.evaluateHandle(async () => {
    // @ts-ignore: a module of the page
    const { open } = await import("/module.js");
    return open("/module.wasm");
  });
  return {
    page,
    /** Calls a function of `module.js`. @param {string} name @param {...(string | number)} words */
    call: (name, ...words) => checks.evaluate((checks, name, words) => checks[name](...words), name, words),
    async close() {
      await page.close();
      server.closeAllConnections();
      server.close();
    },
  };
}

/** Runs an example natively in release mode; returns its output. @param {"utf8" | "buffer"} encoding @param {string} crate @param {string} name @param {...string} words */
export function natively(encoding, crate, name, ...words) {
  const cargo = ["run", "--quiet", "--release", "--package", ...crate.split(" "), "--example", name, "--", ...words];
  const stdio = /** @type {["ignore", "pipe", "inherit"]} */ (["ignore", "pipe", "inherit"]);
  return execFileSync(CARGO, cargo, { cwd: ROOT, stdio, encoding, maxBuffer: 1 << 26 });
}

/** Runs an example in the build of the tests; returns its output. @param {string} name @param {...string} words */
export function inDebug(name, ...words) {
  const build = ["build", "--quiet", "--workspace", "--all-features", "--example", name];
  execFileSync(CARGO, build, { cwd: ROOT, stdio: ["ignore", "ignore", "inherit"] });
  const program = join(process.env.CARGO_TARGET_DIR ?? "target", "debug/examples", name);
  return execFileSync(resolve(ROOT, program), words, { cwd: ROOT, stdio: ["ignore", "pipe", "inherit"], encoding: "utf8" });
}
