//! The browser's dialog in which a file is picked.

use super::host;
use crate::platform::given::{Given, Picked, read_together};

/// Whether there is one here.
pub const IS_THERE: bool = true;

/// The dialog. The page remembers whether it is open.
#[derive(Default)]
pub struct Dialog(Vec<Given>);

impl Dialog {
    /// Asks for a file; browsers name the kinds by their endings alone.
    pub fn ask(&mut self, _: &str) {
        host().pick(".toml,.tamaire,.png,.vox");
    }

    /// What was picked since this was asked last.
    pub fn take(&mut self) -> Option<Picked> {
        if let Some(files) = host().take_picked() {
            self.0.extend(read_together(&files));
        }
        self.0.pop().map(Picked::File)
    }
}
