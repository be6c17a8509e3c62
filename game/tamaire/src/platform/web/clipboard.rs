//! Clipboard of the browser, which may refuse to copy.

use super::host;

/// Access to the browser's clipboard.
#[derive(Default)]
pub struct Clipboard;

impl Clipboard {
    /// Copies a text to the clipboard. Some browsers allow this only in the frame in which the player pressed
    /// a button.
    pub fn copy(&mut self, _: &egui::Context, text: String) {
        host().copy(&text);
    }

    /// Returns whether the last copy succeeded; `None` if that is not known yet or was already returned.
    pub fn took(&mut self) -> Option<bool> {
        host().take_copied()
    }
}
