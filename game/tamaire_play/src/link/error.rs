//! Errors of links.

use crate::ReplayError;
use crate::level::LevelError;
use serde::Deserialize;

/// Maximum length of a link's fragment without the `#` [characters]. Browsers and chat programs accept links
/// of this length.
pub const MAX_LENGTH: usize = 16_000;

/// Reason why a link cannot be made or read.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// The text is no link to a round or a level.
    #[error("this is not a link to a round or a level of tamaire")]
    Other,
    /// The format of the link, or the rules of its round, are of a later version.
    #[error("this link was made by a newer tamaire")]
    Newer,
    /// The end of the link is missing.
    #[error("the end of this link is missing")]
    CutShort,
    /// The link was changed: its checksum does not match.
    #[error("this link is damaged or incomplete")]
    Damaged,
    /// The link is too long.
    #[error("this link is too long: expected at most {MAX_LENGTH} characters, found {found}")]
    TooLong {
        /// Length of the link [characters].
        found: usize,
    },
    /// The link names a built-in level that differs in this program.
    #[error("the level {0:?} has changed since this link was made")]
    LevelDiffers(
        /// Name of the level.
        String,
    ),
    /// The round is invalid.
    #[error(transparent)]
    Round(#[from] ReplayError),
    /// The level is invalid.
    #[error(transparent)]
    Level(#[from] LevelError),
}

/// Decodes a value at the start of the bytes. Returns the value and the remaining bytes.
pub(super) fn taken<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<(T, &'a [u8]), LinkError> {
    postcard::take_from_bytes(bytes).map_err(|_| LinkError::Damaged)
}

/// Decodes a value from all of the bytes.
pub(super) fn all<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<T, LinkError> {
    let (value, rest) = taken(bytes)?;
    rest.is_empty().then_some(value).ok_or(LinkError::Damaged)
}
