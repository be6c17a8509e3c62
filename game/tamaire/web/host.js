// What the page does for the game (game/tamaire/src/platform/web/host.rs asks for it): keeps things, hands out files, takes them in.

import { Speaker } from "./sound.js";

const STORE = "things";
/** Under this key stands what is another one after each change. */
const STAMP = "stamp";
/** Most bytes of a file that is read: the game reads no more of any kind. */
const MOST_BYTES = 1 << 26;

/** @typedef {{key: string, bytes: Uint8Array | undefined, written: number}} Changed */
/** @typedef {{name: string, bytes: Uint8Array | undefined, length: number}} GivenFile */

export class Host {
  /** Why nothing can be kept, if so. @type {string | undefined} */
  refusal;
  /** @type {IDBDatabase | undefined} */
  #database;
  /** Tells other tabs what changed. @type {BroadcastChannel | undefined} */
  #others;
  /** @type {Changed[]} */
  #changes = [];
  /** What stood under STAMP when all was read. @type {string | undefined} */
  #stamp;
  /** What is done alone now. @type {IDBTransaction | undefined} */
  #transaction;
  /** Why those were given up that were not taken. @type {WeakMap<IDBTransaction, unknown>} */
  #refused = new WeakMap();
  /** @type {string | undefined} */
  #failure;
  /** Called when the game cannot go on drawing. @type {() => void} */
  onLost = () => {};
  /** @type {GivenFile[][]} */
  #dropped = [];
  /** @type {GivenFile[][]} */
  #picked = [];
  /** @type {string | undefined} */
  #link;
  /** @type {boolean | undefined} */
  #copied;
  /** @type {Speaker | undefined} */
  #speaker;
  #wantsLetters = false;
  /** @type {Uint8Array | undefined} */
  #letters;

  /** The page, with all that it kept. It opens also where the browser keeps nothing. */
  static async open() {
    const host = new Host();
    host.#hearLinks();
    host.#takeDrops();
    try {
      await host.#read(await host.#begin("readonly"));
    } catch (error) {
      host.refusal = String(error);
    }
    return host;
  }

  /** The language that the visitor prefers. */
  get language() {
    return navigator.language ?? "";
  }

  /** The language that the game speaks. @param {string} language */
  set spoken(language) {
    if (document.documentElement.lang !== language) {
      document.documentElement.lang = language;
    }
  }

  // ---- what is kept ----

  async #openStore() {
    // What another tab changes meanwhile is heard after what is read.
    if (!this.#others && "BroadcastChannel" in globalThis) {
      this.#others = new BroadcastChannel("tamaire");
      this.#others.onmessage = () => this.#look();
    }
    const asked = indexedDB.open("tamaire", 1);
    asked.onupgradeneeded = () => asked.result.createObjectStore(STORE);
    const database = await answer(asked);
    // Another tab with a newer version wants to change how things are kept.
    database.onversionchange = () => database.close();
    // Browsers close it in the background, too.
    database.onclose = () => (this.#database = undefined);
    this.#database = database;
    // What a browser keeps for pages that are visited often it does not throw away when its disk is full.
    navigator.storage?.persist?.().catch(() => {});
  }

  /** A way to what is kept. @param {IDBTransactionMode} mode */
  async #begin(mode) {
    if (!this.#database) {
      await this.#openStore();
    }
    return /** @type {IDBDatabase} */ (this.#database).transaction(STORE, mode);
  }

  /** Learns what is kept, where that changed since. @param {IDBTransaction} transaction */
  async #read(transaction) {
    const store = transaction.objectStore(STORE);
    const stamp = await answer(store.get(STAMP));
    if (stamp === undefined || stamp !== this.#stamp) {
      const [keys, things] = await Promise.all([answer(store.getAllKeys()), answer(store.getAll())]);
      this.#stamp = stamp;
      const all = keys.map((key, place) => ({ key: String(key), ...things[place] }));
      this.#changes = [{ key: "", bytes: undefined, written: 0 }, ...all.filter(({ key }) => key !== STAMP)];
    }
  }

  /** Learns it between two changes. */
  async #look() {
    try {
      await this.#read(await this.#begin("readonly"));
    } catch (error) {
      this.#failure = String(error);
    }
  }

  /** For a game that begins anew: it knows nothing yet. */
  async again() {
    this.#wantsLetters = false;
    this.#stamp = undefined;
    await this.#look();
  }

  /** The next thing that is kept; one without a key says that nothing is but what follows. */
  takeChange() {
    return this.#changes.shift();
  }

  /**
   * Keeps and removes things, all of them or none, while no other tab does, and when all that they did is known. Resolves
   * once it is truly kept, or says why it is not.
   * @param {() => void} job what does so, at once
   * @returns {Promise<string | undefined>}
   */
  async alone(job) {
    if (this.refusal) {
      job();
      return;
    }
    try {
      const transaction = await this.#begin("readwrite");
      const ended = this.#end(transaction);
      await this.#read(transaction);
      this.#transaction = transaction;
      try {
        job();
      } finally {
        this.#transaction = undefined;
      }
      await ended;
    } catch (error) {
      // What the game takes for kept is not.
      this.#stamp = undefined;
      await this.#look();
      return String(error);
    }
  }

  /** What came of it; other tabs hear of it. @param {IDBTransaction} transaction @returns {Promise<void>} */
  #end(transaction) {
    const ended = new Promise((resolve, reject) => {
      transaction.oncomplete = () => resolve(this.#others?.postMessage("changed"));
      transaction.onabort = () => reject(this.#refused.get(transaction) ?? transaction.error);
    });
    // Who waits for it may still be reading.
    ended.catch(() => {});
    return ended;
  }

  /** @param {string} key @param {Uint8Array} bytes @param {number} written */
  keep(key, bytes, written) {
    // They lie in the game's memory, which moves on.
    const thing = { bytes: bytes.slice(), written };
    this.#write((store) => store.put(thing, key));
  }

  /** @param {string} key */
  remove(key) {
    this.#write((store) => store.delete(key));
  }

  /** @param {(store: IDBObjectStore) => void} change */
  async #write(change) {
    if (this.#transaction) {
      return this.#change(this.#transaction, change);
    }
    // The page may be about to go: this asks nothing first.
    try {
      const transaction = this.#database?.transaction(STORE, "readwrite") ?? (await this.#begin("readwrite"));
      const ended = this.#end(transaction);
      this.#change(transaction, change);
      if (!this.#refused.has(transaction)) {
        // Firefox gives up what is not told to end when the page goes.
        transaction.commit?.();
      }
      await ended;
    } catch (error) {
      this.#failure = String(error);
    }
    await this.#look();
  }

  /** @param {IDBTransaction} transaction @param {(store: IDBObjectStore) => void} change */
  #change(transaction, change) {
    try {
      const store = transaction.objectStore(STORE);
      change(store);
      store.put(`${Date.now()} ${Math.random()}`, STAMP);
    } catch (error) {
      this.#refused.set(transaction, error);
      transaction.abort();
    }
  }

  /** Why something is not kept that was not done alone, once. */
  takeFailure() {
    const failure = this.#failure;
    this.#failure = undefined;
    return failure;
  }

  // ---- files ----

  /** @param {string} name @param {string} media @param {Uint8Array} bytes */
  download(name, media, bytes) {
    const address = URL.createObjectURL(new Blob([bytes.slice()], { type: media }));
    const link = document.createElement("a");
    link.href = address;
    link.download = name;
    link.click();
    // The browser begins to read it after this.
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
  }

  /** @param {string} endings */
  pick(endings) {
    const input = document.createElement("input");
    input.type = "file";
    input.accept = endings;
    input.multiple = true;
    input.addEventListener("change", async () => this.#picked.push(await read(input.files)));
    input.click();
  }

  takePicked() {
    return this.#picked.shift();
  }

  #takeDrops() {
    // What is dropped beside the canvas must not take the place of the page.
    addEventListener("dragover", (event) => event.preventDefault());
    addEventListener(
      "drop",
      async (event) => {
        event.preventDefault();
        this.#dropped.push(await read(event.dataTransfer?.files));
      },
      { capture: true },
    );
  }

  takeDropped() {
    return this.#dropped.shift();
  }

  // ---- the address ----

  #hearLinks() {
    const take = () => {
      const link = location.hash.slice(1);
      if (link) {
        this.#link = link;
      }
    };
    take();
    addEventListener("hashchange", take);
  }

  takeLink() {
    const link = this.#link;
    if (link) {
      this.#link = undefined;
      // It is opened once, not again with each reload.
      history.replaceState(null, "", location.pathname + location.search);
    }
    return link;
  }

  get address() {
    return location.origin + location.pathname;
  }

  /** Puts a text on the clipboard. @param {string} text */
  async copy(text) {
    try {
      await navigator.clipboard.writeText(text);
      this.#copied = true;
    } catch {
      this.#copied = false;
    }
  }

  /** Whether the browser took what was copied, once that is known. */
  takeCopied() {
    const copied = this.#copied;
    this.#copied = undefined;
    return copied;
  }

  // ---- sound ----

  get speaker() {
    this.#speaker ??= new Speaker();
    return this.#speaker;
  }

  // ---- the screen ----

  /** The game cannot go on drawing. */
  lost() {
    // Not in the middle of a frame.
    setTimeout(() => this.onLost(), 0);
  }

  get isFull() {
    return Boolean(document.fullscreenElement);
  }

  /** Waits for the next frame; a page that is hidden has none. */
  breathe() {
    return new Promise((resolve) => (document.hidden ? setTimeout(resolve, 0) : requestAnimationFrame(resolve)));
  }

  /** Fetches the letters of Japanese, once. */
  async wantLetters() {
    if (this.#wantsLetters) {
      return;
    }
    this.#wantsLetters = true;
    try {
      const response = await fetch(new URL("japanese.ttf", import.meta.url));
      if (!response.ok) {
        throw new Error(String(response.status));
      }
      this.#letters = new Uint8Array(await response.arrayBuffer());
    } catch {
      // Offline, before all was kept: it is tried again.
      setTimeout(() => (this.#wantsLetters = false), 5_000);
    }
  }

  takeLetters() {
    const letters = this.#letters;
    this.#letters = undefined;
    return letters;
  }

  /** @param {boolean} wanted */
  fillScreen(wanted) {
    const done = wanted
      ? document.documentElement.requestFullscreen?.()
      : document.fullscreenElement && document.exitFullscreen();
    // Browsers refuse it without a press, and some telephones always.
    Promise.resolve(done).catch(() => {});
  }
}

/** @template T @param {IDBRequest<T>} request @returns {Promise<T>} */
function answer(request) {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}

/** @param {FileList | null | undefined} files @returns {Promise<GivenFile[]>} */
function read(files) {
  const one = async (/** @type {File} */ file) => {
    const given = { name: file.name, bytes: undefined, length: file.size };
    if (file.size > MOST_BYTES) {
      return given;
    }
    try {
      return { ...given, bytes: new Uint8Array(await file.arrayBuffer()) };
    } catch {
      return given;
    }
  };
  return Promise.all([...(files ?? [])].map(one));
}
