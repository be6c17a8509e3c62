//! Screen functions in a browser. The page provides them.

use super::host;
use crate::words::Language;
use app_shell::style::add_japanese_font;

/// Switches full screen on or off.
pub fn fill_screen(_: &egui::Context, wanted: bool) {
    host().fill_screen(wanted);
}

/// Makes the page start a new game on a new canvas.
pub fn restart() {
    host().lost();
}

/// Whether the page is full screen. Players can change this with keys and gestures of the browser.
pub fn full_screen_of_page() -> Option<bool> {
    Some(host().is_full())
}

/// Returns the address of the page without its fragment. A link to a round or level is this address with a
/// fragment.
pub fn address_of_page() -> String {
    host().address()
}

/// Makes the page load the font of a language, and announces the language to screen readers.
pub fn set_language(context: &egui::Context, language: Language, has_own_levels: bool) {
    let host = host();
    let is_japanese = language == Language::Japanese;
    host.set_spoken(if is_japanese { "ja" } else { "en" });
    // Names given by players may be in any script, so they need the Japanese font, too.
    if is_japanese || has_own_levels {
        host.want_letters();
    }
    if let Some(letters) = host.take_letters() {
        add_japanese_font(context, letters);
    }
}
