//! The bytes of a file, no more than are taken.

use super::error::{Complaint, ImportError, Place, Problem, in_file, unexpected};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Most bytes of a file: twice what the largest model takes when it is full.
pub const MAX_FILE_BYTES: u64 = 1 << 27;

pub fn name_of(path: &Path) -> String {
    path.display().to_string()
}

/// The bytes of a file, refused when there are more than [`MAX_FILE_BYTES`], and when it is a pipe or a
/// device: who reads one may wait for ever.
pub fn read(path: &Path) -> Result<Vec<u8>, ImportError> {
    in_file(&name_of(path), try_read(path))
}

fn try_read(path: &Path) -> Result<Vec<u8>, Complaint> {
    let unreadable = |error| (Place::File, Problem::Unreadable(error));
    if !path.metadata().map_err(unreadable)?.is_file() {
        return Err(unexpected(
            Place::File,
            "a file",
            "a folder, a pipe or a device",
        ));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    let outcome = file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes);
    outcome.map_err(unreadable)?;
    check_length(&bytes)?;
    Ok(bytes)
}

pub fn check_length(bytes: &[u8]) -> Result<(), Complaint> {
    let found = bytes.len() as u64;
    let too_large = Problem::TooLarge {
        what: "bytes or more",
        found,
        limit: MAX_FILE_BYTES,
    };
    let good = found <= MAX_FILE_BYTES;
    good.then_some(()).ok_or((Place::File, too_large))
}
