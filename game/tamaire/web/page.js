// The page around the game: what is missing is told, what is loaded is counted, and what breaks down comes back.

import { Host } from "./host.js";
// Written by the build: where the game lies, and how long it is before compression.
import { PARTS } from "./parts.js";

const WORDS = {
  en: {
    loading: "Loading",
    noWasm: "This browser is too old for the game: it lacks WebAssembly with SIMD. Chrome or Edge 97, Firefox 102, Safari 16.4 or newer have it.",
    noWebgl: "The game draws with WebGL 2, and this browser does not offer it. Turn on hardware acceleration in the browser's settings, or try another browser.",
    offline: "The game could not be loaded. Are you offline?",
    broken: "Something in the game broke down. What was won and kept is safe.",
    lost: "The graphics were lost. One moment …",
    gone: "The graphics do not come back.",
    again: "Try again",
  },
  ja: {
    loading: "よみこみ中",
    noWasm: "このブラウザは古いため遊べません（WebAssembly SIMD が必要です）。Chrome・Edge 97、Firefox 102、Safari 16.4 以降で開いてください。",
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

/** @type {{flush(): void, end(): void, report(): any} | undefined} */
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
  const hasStreams = typeof TransformStream === "function";
  return hasStreams && typeof WebAssembly === "object" && WebAssembly.validate(new Uint8Array(module));
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
  // What is kept comes at once, and browsers keep what they compiled only of an answer as it came.
  if (navigator.serviceWorker?.controller) {
    return response;
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

const rest = (/** @type {number} */ milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

/** Begins on a canvas of its own. @param {Host} host @param {any} game */
async function begin(host, game) {
  const canvas = document.createElement("canvas");
  document.body.append(canvas);
  // Browsers show their menu on a long press.
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  let isLost = false;
  const lose = () => {
    isLost = true;
    // Who is just beginning sees it there.
    if (running) {
      running.end();
      running = undefined;
      canvas.remove();
      beginAgain(host, game);
    }
  };
  canvas.addEventListener("webglcontextlost", lose, { once: true });
  // Something failed on it that the game cannot go on from.
  host.onLost = lose;
  let begun;
  try {
    begun = await game.Running.start(canvas, host);
    if (isLost) {
      begun.end();
      throw new Error("the graphics were lost at once");
    }
  } catch (error) {
    canvas.remove();
    throw error;
  }
  running = begun;
  front.hidden = true;
  canvas.focus({ preventScroll: true });
}

/** Begins on a new canvas, once the browser has something to draw with. @param {Host} host @param {any} game */
async function beginAgain(host, game) {
  tell(said.lost);
  for (const since = performance.now(); performance.now() - since < PATIENCE; ) {
    await rest(500);
    try {
      await host.again();
      return await begin(host, game);
    } catch (error) {
      console.info(String(error));
    }
  }
  tell(said.gone, { canTry: true });
}

/** A newer version that waits takes over while nothing is played. Whether the page is loaded anew. */
async function isRenewed() {
  const workers = navigator.serviceWorker;
  const registration = await workers?.getRegistration().catch(() => undefined);
  if (!workers?.controller || !registration?.waiting) {
    return false;
  }
  const changed = new Promise((resolve) => workers.addEventListener("controllerchange", () => resolve(true)));
  registration.waiting.postMessage("take over");
  // One that does not come is for the next time.
  const isChanged = await Promise.race([changed, rest(2000).then(() => false)]);
  if (isChanged) {
    location.reload();
  }
  return isChanged;
}

/** How things stand, for whoever looks on; whoever takes a report frees it. */
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
    return tell(navigator.onLine ? said.broken : said.offline, { canTry: true });
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
