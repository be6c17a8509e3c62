//! Interface to the page, implemented and documented in `game/tamaire/web/host.js`.

use std::cell::RefCell;
use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
extern "C" {
    /// The page, which outlives the game: after a lost GPU a new game starts on it.
    #[derive(Clone)]
    pub type Host;

    /// Preferred language of the player, such as `ja-JP`.
    #[wasm_bindgen(method, getter)]
    pub fn language(this: &Host) -> String;

    /// Reason why nothing can be stored, if any.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn refusal(this: &Host) -> Option<String>;
    /// Next stored entry that the game has not read yet.
    #[wasm_bindgen(method, js_name = takeChange)]
    pub(crate) fn take_change(this: &Host) -> Option<Changed>;
    /// Runs `job` and stores its changes atomically, while no other tab stores anything. The promise resolves
    /// to the reason of a failure, or to `undefined`.
    #[wasm_bindgen(method)]
    pub(crate) fn alone(this: &Host, job: &js_sys::Function) -> js_sys::Promise;
    #[wasm_bindgen(method)]
    pub(crate) fn keep(this: &Host, key: &str, bytes: &[u8], written: f64);
    #[wasm_bindgen(method)]
    pub(crate) fn remove(this: &Host, key: &str);
    /// Returns the reason why a change outside of [`Host::alone`] failed. Returns each reason once.
    #[wasm_bindgen(method, js_name = takeFailure)]
    pub(crate) fn take_failure(this: &Host) -> Option<String>;

    /// Offers a file as a download.
    #[wasm_bindgen(method)]
    pub(crate) fn download(this: &Host, name: &str, media: &str, bytes: &[u8]);
    /// Opens a file dialog; the files arrive through [`Host::take_picked`].
    #[wasm_bindgen(method)]
    pub(crate) fn pick(this: &Host, endings: &str);
    /// Files that were chosen or dropped together, if any.
    #[wasm_bindgen(method, js_name = takePicked)]
    pub(crate) fn take_picked(this: &Host) -> Option<js_sys::Array>;
    #[wasm_bindgen(method, js_name = takeDropped)]
    pub(crate) fn take_dropped(this: &Host) -> Option<js_sys::Array>;
    /// Fragment of the page's address, if it has not been taken yet.
    #[wasm_bindgen(method, js_name = takeLink)]
    pub(crate) fn take_link(this: &Host) -> Option<String>;
    /// Address of the page without its fragment.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn address(this: &Host) -> String;
    #[wasm_bindgen(method)]
    pub(crate) fn copy(this: &Host, text: &str);
    #[wasm_bindgen(method, js_name = takeCopied)]
    pub(crate) fn take_copied(this: &Host) -> Option<bool>;

    /// Reports that the GPU is lost or drawing fails. The page then starts a new game.
    #[wasm_bindgen(method)]
    pub(crate) fn lost(this: &Host);
    /// Whether the page is full screen.
    #[wasm_bindgen(method, getter, js_name = isFull)]
    pub(crate) fn is_full(this: &Host) -> bool;
    #[wasm_bindgen(method, js_name = fillScreen)]
    pub(crate) fn fill_screen(this: &Host, wanted: bool);
    /// Sets the current language of the game, for screen readers.
    #[wasm_bindgen(method, setter)]
    pub(crate) fn set_spoken(this: &Host, language: &str);

    /// Sound output. It outlives the game, so that sound continues after a restart.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn speaker(this: &Host) -> Speaker;
    /// Returns a promise that resolves in the next frame, or at once if the page is hidden and gets no
    /// frames.
    #[wasm_bindgen(method)]
    pub(crate) fn breathe(this: &Host) -> js_sys::Promise;
    /// Requests the Japanese font. The font arrives through [`Host::take_letters`], unless it cannot be
    /// fetched.
    #[wasm_bindgen(method, js_name = wantLetters)]
    pub(crate) fn want_letters(this: &Host);
    #[wasm_bindgen(method, js_name = takeLetters)]
    pub(crate) fn take_letters(this: &Host) -> Option<Vec<u8>>;

    /// Sound output of the page, implemented in `game/tamaire/web/sound.js`.
    pub(crate) type Speaker;
    #[wasm_bindgen(method)]
    pub(crate) fn tell(this: &Speaker, bytes: &[u8]);
    #[wasm_bindgen(method)]
    pub(crate) fn trouble(this: &Speaker) -> Option<String>;

    /// Stored entry that was read or changed, see [`Host::take_change`].
    pub(crate) type Changed;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn key(this: &Changed) -> String;
    /// Bytes of the entry. `None` marks a reset: all entries before it are obsolete.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn bytes(this: &Changed) -> Option<Vec<u8>>;
    /// Time of the last write [ms since 1970].
    #[wasm_bindgen(method, getter)]
    pub(crate) fn written(this: &Changed) -> f64;

    /// A file passed to the game.
    pub(crate) type GivenFile;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn name(this: &GivenFile) -> String;
    #[wasm_bindgen(method, getter, js_name = bytes)]
    pub(crate) fn contents(this: &GivenFile) -> Option<Vec<u8>>;
    /// Length [bytes]. A file that is too long has no contents.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn length(this: &GivenFile) -> f64;
}

thread_local! {
    static HOST: RefCell<Option<Host>> = const { RefCell::new(None) };
}

/// Sets the page on which the game runs.
pub fn set_host(host: Host) {
    HOST.replace(Some(host));
}

/// Returns the page.
///
/// # Panics
/// Before [`set_host`] was called, which happens at the start of the game.
pub(crate) fn host() -> Host {
    HOST.with_borrow(|host| host.clone().expect("set_host is called first"))
}
