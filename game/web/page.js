// The page around the game: what is missing is told, what is loaded is counted, and what breaks down comes back.

import { Host } from "./host.js";
// Written by the build: where the game lies, and how long it is before compression.
import { PARTS } from "./parts.js";

const WORDS = {
  en: {
    loading: "Loading",
    noWasm: "This browser is too old for the game: it lacks WebAssembly with SIMD. Chrome or Edge 91, Firefox 89, Safari 16.4 or newer have it.",
    noWebgl: "The game draws with WebGL 2, and this browser does not offer it. Turn on hardware acceleration in the browser's settings, or try another browser.",
    offline: "The game could not be loaded. Are you offline?",
    broken: "Something in the game broke down. What was won and kept is safe.",
    lost: "The graphics were lost. One moment …",
    gone: "The graphics do not come back.",
    again: "Try again",
  },
  ja: {
    loading: "よみこみ中",
    noWasm: "このブラウザは古いため遊べません（WebAssembly SIMD が必要です）。Chrome・Edge 91、Firefox 89、Safari 16.4 以降で開いてください。",
    noWebgl: "このゲームは WebGL 2 で絵をかきますが、このブラウザでは使えません。設定でハードウェアアクセラレーションをオンにするか、ほかのブラウザで開いてください。",
    offline: "よみこめませんでした。インターネットにつながっていますか？",
    broken: "ゲームが止まってしまいました。記録はのこっています。",
    lost: "画面がとぎれました。すこしまってください …",
    gone: "画面がもどりません。",
    again: "もう一度",
  },
};

const language = navigator.language?.startsWith("ja") ? "ja" : "en";
const said = WORDS[language];
const part = (/** @type {string} */ id) => /** @type {HTMLElement} */ (document.getElementById(id));
const [front, bar, done, told, again] = ["front", "bar", "done", "told", "again"].map(part);

/** For how long a lost GPU is waited for [ms]. */
const PATIENCE = 30_000;

/** @type {{flush(): void, end(): void} | undefined} */
let running;

document.documentElement.lang = language;
again.textContent = said.again;
again.addEventListener("click", () => location.reload());

/** Tells the visitor something instead of the game. @param {string} text @param {{canTry?: boolean}} [options] */
function tell(text, { canTry = false } = {}) {
  front.hidden = false;
  bar.hidden = true;
  again.hidden = !canTry;
  told.textContent = text;
}

/** The smallest module with a wide lane. */
function hasLanes() {
  const module = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11];
  return typeof WebAssembly === "object" && WebAssembly.validate(new Uint8Array(module));
}

function hasWebgl() {
  return Boolean(document.createElement("canvas").getContext("webgl2"));
}

/** The game as it comes in, counted. */
async function load() {
  const response = await fetch(new URL(PARTS.wasm, import.meta.url));
  if (!response.ok || !response.body) {
    throw new Error(`${response.status}`);
  }
  let bytes = 0;
  const counted = response.body.pipeThrough(
    new TransformStream({
      transform(chunk, controller) {
        bytes += chunk.byteLength;
        show(bytes / PARTS.bytes);
        controller.enqueue(chunk);
      },
    }),
  );
  return new Response(counted, { headers: { "Content-Type": "application/wasm" } });
}

/** @param {number} share */
function show(share) {
  const percent = Math.min(100, Math.round(100 * share));
  done.style.width = `${percent}%`;
  bar.setAttribute("aria-valuenow", String(percent));
  told.textContent = `${said.loading} ${((share * PARTS.bytes) / 1e6).toFixed(1)} / ${(PARTS.bytes / 1e6).toFixed(1)} MB`;
}

/** Begins on a canvas of its own. @param {Host} host @param {any} game */
async function begin(host, game) {
  const canvas = document.createElement("canvas");
  document.body.append(canvas);
  // Browsers show their menu on a long press.
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "webglcontextlost",
    (event) => {
      event.preventDefault();
      tell(said.lost);
      running?.end();
      running = undefined;
      canvas.remove();
      beginAgain(host, game, performance.now());
    },
    { once: true },
  );
  try {
    running = await game.Running.start(canvas, host);
  } catch (error) {
    canvas.remove();
    throw error;
  }
  front.hidden = true;
  canvas.focus({ preventScroll: true });
}

/** Begins on a new canvas, once the browser has something to draw with. @param {Host} host @param {any} game @param {number} since */
async function beginAgain(host, game, since) {
  await new Promise((resolve) => setTimeout(resolve, 500));
  try {
    await host.again();
    await begin(host, game);
  } catch {
    if (performance.now() - since < PATIENCE) {
      beginAgain(host, game, since);
    } else {
      tell(said.gone, { canTry: true });
    }
  }
}

/** A newer version that waits takes over while nothing is played. Whether the page is loaded anew. */
async function isRenewed() {
  const registration = await navigator.serviceWorker?.getRegistration().catch(() => undefined);
  if (!registration?.waiting) {
    return false;
  }
  navigator.serviceWorker.addEventListener("controllerchange", () => location.reload());
  registration.waiting.postMessage("take over");
  return true;
}

/** How things stand, for whoever looks on. */
Object.defineProperty(globalThis, "tamaire", { value: { report: () => running?.report?.() } });

async function main() {
  if (!hasLanes()) {
    return tell(said.noWasm);
  }
  if (!hasWebgl()) {
    return tell(said.noWebgl, { canTry: true });
  }
  if (await isRenewed()) {
    return;
  }
  show(0);
  let game, host;
  try {
    const module = load();
    // What fails is told below, not where nobody listens.
    module.catch(() => {});
    [game, host] = await Promise.all([import(PARTS.game), Host.open()]);
    await game.default({ module_or_path: module });
  } catch (error) {
    console.error(error);
    return tell(said.offline, { canTry: true });
  }
  // A panic ends all: what was kept is kept.
  addEventListener("error", ({ error }) => {
    if (error instanceof WebAssembly.RuntimeError) {
      tell(said.broken, { canTry: true });
    }
  });
  try {
    await begin(host, game);
  } catch (error) {
    console.error(error);
    return tell(said.noWebgl, { canTry: true });
  }
  const flush = () => document.visibilityState === "hidden" && running?.flush();
  document.addEventListener("visibilitychange", flush);
  addEventListener("pagehide", () => running?.flush());
  // The first seconds belong to the game.
  setTimeout(() => {
    navigator.serviceWorker?.register(new URL(PARTS.worker, import.meta.url)).catch((error) => console.warn(String(error)));
  }, 3000);
}

main();
