//! Files that somebody named or dropped onto the window.

use super::storage::Kind;
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;
use tamaire_play::{Replay, ReplayError};

/// The replay in a file.
///
/// # Errors
/// [`ReplayError`] when it cannot be read or is none.
pub fn replay_in(path: &Path) -> Result<Replay, ReplayError> {
    let bytes = read_file(path, Kind::Replay.most_bytes());
    let unreadable = |error: io::Error| ReplayError::Unreadable(error.to_string());
    Replay::of_bytes(&bytes.map_err(unreadable)?)
}

/// The bytes of a file, refused when there are more than `most`, and when it is a pipe or a device: who reads one may wait
/// for ever.
pub(super) fn read_file(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let refused = |kind, reason: String| Err(io::Error::new(kind, reason));
    if !path.metadata()?.is_file() {
        let reason = "expected a file, found a folder, a pipe or a device";
        return refused(ErrorKind::InvalidInput, reason.into());
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return refused(
            ErrorKind::FileTooLarge,
            format!("longer than {most} bytes, the most that are read"),
        );
    }
    Ok(bytes)
}
