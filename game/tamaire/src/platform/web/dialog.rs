//! File dialog of the browser.

use super::host;
use crate::platform::given::{DialogResult, OpenRequest, read_together};

/// Whether file dialogs are supported.
pub const IS_THERE: bool = true;

/// File dialog of the page. Holds the chosen files that were not taken yet.
#[derive(Default)]
pub struct Dialog(Vec<OpenRequest>);

impl Dialog {
    /// Opens the dialog. The description is unused, since browsers show only file extensions.
    pub fn ask(&mut self, _: &str) {
        host().pick(".toml,.tamaire,.zip,.vox,image/png,image/jpeg,image/webp,image/gif,image/bmp");
    }

    /// Returns the next chosen file, if any.
    pub fn take(&mut self) -> Option<DialogResult> {
        if let Some(files) = host().take_picked() {
            self.0.extend(read_together(&files));
        }
        self.0.pop().map(DialogResult::File)
    }
}
