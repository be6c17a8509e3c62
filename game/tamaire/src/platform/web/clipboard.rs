//! The clipboard, which browsers hand out as they please.

use super::host;

/// The clipboard.
#[derive(Default)]
pub struct Clipboard;

impl Clipboard {
    /// Puts a text on it. Some browsers take it only in the frame of a press.
    pub fn copy(&mut self, _: &egui::Context, text: String) {
        host().copy(&text);
    }

    /// Whether it took what was put on it, told once.
    pub fn took(&mut self) -> Option<bool> {
        host().take_copied()
    }
}
