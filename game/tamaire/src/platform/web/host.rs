//! What the page does for the game: `game/web/host.js`, which says what each of these is.

use std::cell::RefCell;
use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
extern "C" {
    /// The page. It outlives the game, which begins anew on it after the GPU was lost.
    #[derive(Clone)]
    pub type Host;

    /// The language that the visitor prefers, as in `ja-JP`.
    #[wasm_bindgen(method, getter)]
    pub fn language(this: &Host) -> String;

    /// Why nothing can be kept, if so.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn refusal(this: &Host) -> Option<String>;
    /// The next thing that is kept and not known here yet.
    #[wasm_bindgen(method, js_name = takeChange)]
    pub(crate) fn take_change(this: &Host) -> Option<Changed>;
    /// Keeps and removes things, all of them or none, while no other tab does. Resolves to why they are not kept, if so.
    #[wasm_bindgen(method)]
    pub(crate) fn alone(this: &Host, job: &js_sys::Function) -> js_sys::Promise;
    #[wasm_bindgen(method)]
    pub(crate) fn keep(this: &Host, key: &str, bytes: &[u8], written: f64);
    #[wasm_bindgen(method)]
    pub(crate) fn remove(this: &Host, key: &str);
    /// Why something that was not kept alone is not, told once.
    #[wasm_bindgen(method, js_name = takeFailure)]
    pub(crate) fn take_failure(this: &Host) -> Option<String>;

    /// Hands a file to the visitor.
    #[wasm_bindgen(method)]
    pub(crate) fn download(this: &Host, name: &str, media: &str, bytes: &[u8]);
    /// Asks for files; they come through [`Host::take_picked`].
    #[wasm_bindgen(method)]
    pub(crate) fn pick(this: &Host, endings: &str);
    /// What was picked or dropped together: files, or nothing.
    #[wasm_bindgen(method, js_name = takePicked)]
    pub(crate) fn take_picked(this: &Host) -> Option<js_sys::Array>;
    #[wasm_bindgen(method, js_name = takeDropped)]
    pub(crate) fn take_dropped(this: &Host) -> Option<js_sys::Array>;
    /// What stood behind the address, once.
    #[wasm_bindgen(method, js_name = takeLink)]
    pub(crate) fn take_link(this: &Host) -> Option<String>;
    /// The address of the page, without what stands behind it.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn address(this: &Host) -> String;
    #[wasm_bindgen(method)]
    pub(crate) fn copy(this: &Host, text: &str);
    #[wasm_bindgen(method, js_name = takeCopied)]
    pub(crate) fn take_copied(this: &Host) -> Option<bool>;

    /// The GPU is gone, or what is drawn with it fails: the page begins anew.
    #[wasm_bindgen(method)]
    pub(crate) fn lost(this: &Host);
    /// Whether the page fills the screen.
    #[wasm_bindgen(method, getter, js_name = isFull)]
    pub(crate) fn is_full(this: &Host) -> bool;
    #[wasm_bindgen(method, js_name = fillScreen)]
    pub(crate) fn fill_screen(this: &Host, wanted: bool);
    /// The language that the game speaks now, for whoever reads the page aloud.
    #[wasm_bindgen(method, setter)]
    pub(crate) fn set_spoken(this: &Host, language: &str);

    /// What sounds come out of; the same one when the game begins anew.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn speaker(this: &Host) -> Speaker;
    /// Resolves in the next frame, and also where no frames are drawn.
    #[wasm_bindgen(method)]
    pub(crate) fn breathe(this: &Host) -> js_sys::Promise;
    /// Asks for the letters of Japanese; they come through [`Host::take_letters`], unless the page cannot fetch them.
    #[wasm_bindgen(method, js_name = wantLetters)]
    pub(crate) fn want_letters(this: &Host);
    #[wasm_bindgen(method, js_name = takeLetters)]
    pub(crate) fn take_letters(this: &Host) -> Option<Vec<u8>>;

    /// `game/web/sound.js`
    pub(crate) type Speaker;
    #[wasm_bindgen(method)]
    pub(crate) fn tell(this: &Speaker, bytes: &[u8]);
    #[wasm_bindgen(method)]
    pub(crate) fn trouble(this: &Speaker) -> Option<String>;

    /// Something that was kept.
    pub(crate) type Changed;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn key(this: &Changed) -> String;
    /// Nothing where it is not a thing but says that nothing is kept but what follows.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn bytes(this: &Changed) -> Option<Vec<u8>>;
    /// When it was written [ms since 1970].
    #[wasm_bindgen(method, getter)]
    pub(crate) fn written(this: &Changed) -> f64;

    /// A file that was handed to the game.
    pub(crate) type GivenFile;
    #[wasm_bindgen(method, getter)]
    pub(crate) fn name(this: &GivenFile) -> String;
    #[wasm_bindgen(method, getter, js_name = bytes)]
    pub(crate) fn contents(this: &GivenFile) -> Option<Vec<u8>>;
    /// How long it is; one that is too long has no bytes.
    #[wasm_bindgen(method, getter)]
    pub(crate) fn length(this: &GivenFile) -> f64;
}

thread_local! {
    static HOST: RefCell<Option<Host>> = const { RefCell::new(None) };
}

/// From now on this page is asked.
pub fn set_host(host: Host) {
    HOST.replace(Some(host));
}

/// The page.
///
/// # Panics
/// Before there is one: the game begins with it.
pub(crate) fn host() -> Host {
    HOST.with_borrow(|host| host.clone().expect("the page is told first"))
}
