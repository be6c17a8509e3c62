//! Where texts are put for other programs.

/// The clipboard.
#[derive(Default)]
pub struct Clipboard {
    is_told: bool,
}

impl Clipboard {
    /// Puts a text on it.
    pub fn copy(&mut self, context: &egui::Context, text: String) {
        context.copy_text(text);
        self.is_told = true;
    }

    /// Whether it took what was put on it, told once. Systems do not refuse it.
    pub fn took(&mut self) -> Option<bool> {
        std::mem::take(&mut self.is_told).then_some(true)
    }
}
