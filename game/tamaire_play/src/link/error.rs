//! What can be wrong with a link.

use crate::ReplayError;
use crate::level::LevelError;
use serde::Deserialize;

/// Most characters of a fragment, the `#` aside: browsers and chat programs bear as many.
pub const MAX_LENGTH: usize = 16_000;

/// Why there is no such link.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// It is the address of something else.
    #[error("this is no link to a round or a level of tamaire")]
    Other,
    /// Its format is a later one, or its round was played by later rules.
    #[error("this link was made by a newer tamaire")]
    Newer,
    /// Not all of it arrived.
    #[error("the end of this link is missing")]
    CutShort,
    /// It is not what was sent.
    #[error("this link was changed on its way, or is not all of it")]
    Damaged,
    /// There is too much in it.
    #[error("a link has {MAX_LENGTH} characters at most, and this one has {found}")]
    TooLong {
        /// How many characters it has, or would have.
        found: usize,
    },
    /// It was played in a level that is another one here.
    #[error("the level {0:?} is not what it was when this link was made")]
    LevelDiffers(
        /// The level.
        String,
    ),
    /// The round is broken.
    #[error(transparent)]
    Round(#[from] ReplayError),
    /// The level is broken.
    #[error(transparent)]
    Level(#[from] LevelError),
}

/// The first value in the bytes, and the rest.
pub(super) fn taken<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<(T, &'a [u8]), LinkError> {
    postcard::take_from_bytes(bytes).map_err(|_| LinkError::Damaged)
}

/// The value that the bytes are.
pub(super) fn all<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<T, LinkError> {
    let (value, rest) = taken(bytes)?;
    rest.is_empty().then_some(value).ok_or(LinkError::Damaged)
}
