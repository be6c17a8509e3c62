//! The bytes of a file, no more than are taken.

use super::error::{Complaint, ImportError, Place, Problem, in_file, unexpected};
use crate::file::bytes_of;
use std::io::{self, ErrorKind};
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
    let complaint = |error: io::Error| match error.kind() {
        ErrorKind::InvalidInput => {
            unexpected(Place::File, "a file", "a folder, a pipe or a device")
        }
        ErrorKind::FileTooLarge => too_large(MAX_FILE_BYTES + 1),
        _ => (Place::File, Problem::Unreadable(error)),
    };
    bytes_of(path, MAX_FILE_BYTES).map_err(complaint)
}

pub fn check_length(bytes: &[u8]) -> Result<(), Complaint> {
    let found = bytes.len() as u64;
    let good = found <= MAX_FILE_BYTES;
    good.then_some(()).ok_or_else(|| too_large(found))
}

fn too_large(found: u64) -> Complaint {
    let problem = Problem::TooLarge {
        what: "bytes or more",
        found,
        limit: MAX_FILE_BYTES,
    };
    (Place::File, problem)
}
