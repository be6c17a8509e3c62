//! Limit on the length of a file.

use super::error::{FilePosition, PositionedProblem, too_large};

/// Maximum length of a file [bytes]: twice that of the largest model with every voxel solid.
pub const MAX_FILE_BYTES: u64 = 1 << 27;

pub fn check_length(bytes: &[u8]) -> Result<(), PositionedProblem> {
    let found = bytes.len() as u64;
    let problem = too_large(FilePosition::File, "bytes", found, MAX_FILE_BYTES);
    (found <= MAX_FILE_BYTES).then_some(()).ok_or(problem)
}
