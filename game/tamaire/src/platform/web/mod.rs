//! Browser versions of storage, file dialog, clock, sound and screen. The page passes in a [`Host`]; no
//! module here creates page elements.

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
pub(super) use kept::BrowserStorage;
