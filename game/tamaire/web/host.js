// Services of the page for the game (see game/tamaire/src/platform/web/host.rs): storage, downloads, and opening of files.

import { Speaker } from "./sound.js";

const STORE = "things";
/** Key of a value that changes with every change of the storage. */
const STAMP = "stamp";
/** Maximum size of a file that is read [bytes], the game's limit for all kinds of files. */
const MOST_BYTES = 1 << 26;

/** @typedef {{key: string, bytes: Uint8Array | undefined, written: number}} Changed */
/** @typedef {{name: string, bytes: Uint8Array | undefined, length: number}} GivenFile */

export class Host {
  /** Reason why nothing can be saved, if any. @type {string | undefined} */
  refusal;
  /** @type {IDBDatabase | undefined} */
  #database;
  /** Notifies other tabs of changes. @type {BroadcastChannel | undefined} */
  #others;
  /** @type {Changed[]} */
  #changes = [];
  /** Value of STAMP when the storage was last read. @type {string | undefined} */
  #stamp;
  /** Current exclusive transaction. @type {IDBTransaction | undefined} */
  #transaction;
  /** Reasons of aborted transactions. @type {WeakMap<IDBTransaction, unknown>} */
  #refused = new WeakMap();
  /** @type {string | undefined} */
  #failure;
  /** Called when the game cannot continue drawing. @type {() => void} */
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

  /** Opens the page's services and reads the storage. Also works if the browser refuses to store anything. */
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

  /** Language that the player prefers. */
  get language() {
    return navigator.language ?? "";
  }

  /** Sets the language of the game. @param {string} language */
  set spoken(language) {
    if (document.documentElement.lang !== language) {
      document.documentElement.lang = language;
    }
  }

  // ---- storage ----

  async #openStore() {
    // Listens first, so that changes of other tabs during the first read are noticed.
    if (!this.#others && "BroadcastChannel" in globalThis) {
      this.#others = new BroadcastChannel("tamaire");
      this.#others.onmessage = () => this.#look();
    }
    const asked = indexedDB.open("tamaire", 1);
    asked.onupgradeneeded = () => asked.result.createObjectStore(STORE);
    const database = await answer(asked);
    // Another tab with a newer version wants to change the format of the storage.
    database.onversionchange = () => database.close();
    // Browsers may close the database of a page in the background.
    database.onclose = () => (this.#database = undefined);
    this.#database = database;
    // Asks the browser not to delete the data when its disk is full. It grants that to pages that are visited often.
    navigator.storage?.persist?.().catch(() => {});
  }

  /** Begins a transaction. @param {IDBTransactionMode} mode */
  async #begin(mode) {
    if (!this.#database) {
      await this.#openStore();
    }
    return /** @type {IDBDatabase} */ (this.#database).transaction(STORE, mode);
  }

  /** Reads the storage if it has changed since the last read. @param {IDBTransaction} transaction */
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

  /** Reads the storage in a transaction of its own. */
  async #look() {
    try {
      await this.#read(await this.#begin("readonly"));
    } catch (error) {
      this.#failure = String(error);
    }
  }

  /** Reads everything again for a restarted game. */
  async again() {
    this.#wantsLetters = false;
    this.#stamp = undefined;
    await this.#look();
  }

  /** Returns the next change of the storage. A change with an empty key means that only the following entries exist. */
  takeChange() {
    return this.#changes.shift();
  }

  /**
   * Saves and removes entries in one exclusive transaction, after reading all changes of other tabs. Resolves once the
   * transaction is complete; if it failed, to the reason.
   * @param {() => void} job calls `keep` and `remove` synchronously
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
      // The game assumes entries that were not saved, so it must read everything again.
      this.#stamp = undefined;
      await this.#look();
      return String(error);
    }
  }

  /** Resolves at the end of a transaction and notifies other tabs. @param {IDBTransaction} transaction @returns {Promise<void>} */
  #end(transaction) {
    const ended = new Promise((resolve, reject) => {
      transaction.oncomplete = () => resolve(this.#others?.postMessage("changed"));
      transaction.onabort = () => reject(this.#refused.get(transaction) ?? transaction.error);
    });
    // The caller may still be reading when it fails.
    ended.catch(() => {});
    return ended;
  }

  /** @param {string} key @param {Uint8Array} bytes @param {number} written */
  keep(key, bytes, written) {
    // The bytes are in the game's memory, which will change.
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
    // The page may be closing, so nothing is awaited before the write.
    try {
      const transaction = this.#database?.transaction(STORE, "readwrite") ?? (await this.#begin("readwrite"));
      const ended = this.#end(transaction);
      this.#change(transaction, change);
      if (!this.#refused.has(transaction)) {
        // Firefox aborts uncommitted transactions when the page closes.
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

  /** Returns and clears the reason of a failed write outside of `alone`. */
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
    // The browser starts reading after this call.
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
    // A file dropped beside the canvas must not replace the page.
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
      // A reload does not open the link again.
      history.replaceState(null, "", location.pathname + location.search);
    }
    return link;
  }

  get address() {
    return location.origin + location.pathname;
  }

  /** Copies a text to the clipboard. @param {string} text */
  async copy(text) {
    try {
      await navigator.clipboard.writeText(text);
      this.#copied = true;
    } catch {
      this.#copied = false;
    }
  }

  /** Returns once whether the last copy succeeded; undefined while unknown. */
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

  /** Called when the game cannot continue drawing. */
  lost() {
    // After the current frame.
    setTimeout(() => this.onLost(), 0);
  }

  get isFull() {
    return Boolean(document.fullscreenElement);
  }

  /** Waits for the next frame. A hidden page has no frames and only yields. */
  breathe() {
    return new Promise((resolve) => (document.hidden ? setTimeout(resolve, 0) : requestAnimationFrame(resolve)));
  }

  /** Downloads the Japanese font once. */
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
      // Offline before the font was cached: tries again later.
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
    // Browsers refuse it without a user gesture, and some phones always.
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
