//! Clipboard of the system.

/// Access to the system's clipboard.
#[derive(Default)]
pub struct Clipboard {
    is_told: bool,
}

impl Clipboard {
    /// Copies a text to the clipboard.
    pub fn copy(&mut self, context: &egui::Context, text: String) {
        context.copy_text(text);
        self.is_told = true;
    }

    /// Returns whether the last copy succeeded, once for each copy. Desktop systems never refuse.
    pub fn took(&mut self) -> Option<bool> {
        std::mem::take(&mut self.is_told).then_some(true)
    }
}
