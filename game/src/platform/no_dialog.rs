//! Where no file can be picked.

use super::given::Picked;

/// Whether there is a dialog here.
pub const IS_THERE: bool = false;

/// The dialog that there is not.
#[derive(Default)]
pub struct Dialog;

impl Dialog {
    /// Asks for a file: in vain.
    pub fn ask(&mut self, _: &str) {}

    /// Nothing was picked.
    pub fn take(&mut self) -> Option<Picked> {
        None
    }
}
