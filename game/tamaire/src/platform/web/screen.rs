//! What only the page can do to what is seen.

use super::host;
use crate::look::add_letters;
use crate::words::Language;

/// Makes the page as large as was chosen.
pub fn fill_screen(_: &egui::Context, wanted: bool) {
    host().fill_screen(wanted);
}

/// Has the page begin anew, with another canvas.
pub fn begin_anew() {
    host().lost();
}

/// Whether the page fills the screen: browsers have keys and gestures of their own for that.
pub fn is_full_by_itself() -> Option<bool> {
    Some(host().is_full())
}

/// The address of the page, which opens links.
pub fn address_of_page() -> String {
    host().address()
}

/// Sees to it that a language can be written, and read aloud.
pub fn speak(context: &egui::Context, language: Language, has_own_levels: bool) {
    let host = host();
    let is_japanese = language == Language::Japanese;
    host.set_spoken(if is_japanese { "ja" } else { "en" });
    // Names that somebody gave may be written in anything.
    if is_japanese || has_own_levels {
        host.want_letters();
    }
    if let Some(letters) = host.take_letters() {
        add_letters(context, letters);
    }
}
