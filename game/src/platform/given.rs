//! Files that somebody named or dropped onto the window.

use super::storage::Kind;
use std::io;
use std::path::Path;
use tamaire_play::{Replay, ReplayError, bytes_of};

/// The replay in a file.
///
/// # Errors
/// [`ReplayError`] when it cannot be read or is none.
pub fn replay_in(path: &Path) -> Result<Replay, ReplayError> {
    let bytes = bytes_of(path, Kind::Replay.most_bytes());
    let unreadable = |error: io::Error| ReplayError::Unreadable(error.to_string());
    Replay::of_bytes(&bytes.map_err(unreadable)?)
}
