// Web server for the packed folder that behaves like a static host: brotli, and a year of caching for immutable files.
// usage: node serve.mjs FOLDER [PORT]   the compressed files are in FOLDER.br
import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

const MEDIA = {
  ".html": "text/html; charset=utf-8",
  ".css": "text/css; charset=utf-8",
  ".js": "text/javascript; charset=utf-8",
  ".wasm": "application/wasm",
  ".webmanifest": "application/manifest+json",
  ".svg": "image/svg+xml",
  ".png": "image/png",
  ".ttf": "font/ttf",
  ".txt": "text/plain; charset=utf-8",
};

/**
 * @param {string} folder
 * @param {number} port 0 for any free port
 * @returns {Promise<{address: string, folder: string, sent: {path: string, bytes: number}[], close(): Promise<void>}>}
 */
export function serve(folder, port = 0) {
  /** @type {{path: string, bytes: number}[]} */
  const sent = [];
  const server = createServer((request, response) => {
    const takesBrotli = /\bbr\b/.test(String(request.headers["accept-encoding"]));
    let bytes, path;
    try {
      const { pathname } = new URL(request.url ?? "/", "http://here");
      path = normalize(decodeURIComponent(pathname)).replace(/\/$/, "/index.html");
      const isBrotli = takesBrotli && extname(path) !== ".png";
      bytes = readFileSync(join(isBrotli ? `${folder}.br` : folder, path));
    } catch {
      response.writeHead(404).end();
      return;
    }
    const isForEver = /^\/[0-9a-f]{12}\//.test(path);
    const headers = {
      "Content-Type": MEDIA[extname(path)] ?? "application/octet-stream",
      "Cache-Control": isForEver ? "public, max-age=31536000, immutable" : "no-cache",
    };
    if (takesBrotli && extname(path) !== ".png") {
      headers["Content-Encoding"] = "br";
    }
    sent.push({ path, bytes: bytes.length });
    response.writeHead(200, { ...headers, "Content-Length": bytes.length }).end(bytes);
  });
  return new Promise((resolve, reject) => {
    server.on("error", reject);
    server.listen(port, "localhost", () => {
      const { port } = /** @type {import("node:net").AddressInfo} */ (server.address());
      const close = () => {
        server.closeAllConnections();
        return new Promise((done) => server.close(() => done(undefined)));
      };
      resolve({ address: `http://localhost:${port}/`, folder, sent, close });
    });
  });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const { address } = await serve(process.argv[2], Number(process.argv[3] ?? 8000));
  console.log(`tamaire is served at ${address}; stop with Ctrl+C`);
}
