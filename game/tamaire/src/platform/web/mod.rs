//! What a browser has in place of folders, a system's dialog and its clock. The page hands in a [`Host`]; nothing here
//! makes elements of its own.

pub mod breath;
pub mod clipboard;
pub mod date;
pub mod dialog;
mod host;
mod kept;
pub mod screen;
pub mod sound;
pub mod writer;

pub(crate) use host::{GivenFile, host};
pub use host::{Host, set_host};
pub(super) use kept::Kept;
