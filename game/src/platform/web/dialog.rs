//! The browser's dialog in which a file is picked.

use super::host;
use crate::platform::given::{Given, Picked, read_together};

/// Whether there is one here.
pub const IS_THERE: bool = true;

/// The dialog. The page remembers whether it is open.
#[derive(Default)]
pub struct Dialog;

impl Dialog {
    /// Asks for a file; browsers name the kinds by their endings alone.
    pub fn ask(&mut self, _: &str) {
        host().pick(".toml,.tamaire,.png,.vox");
    }

    /// What was picked since this was asked last.
    pub fn take(&mut self) -> Option<Picked> {
        let files = host().take_picked()?;
        let given: Option<Given> = read_together(&files).pop();
        Some(given.map_or(Picked::Nothing, Picked::File))
    }
}
