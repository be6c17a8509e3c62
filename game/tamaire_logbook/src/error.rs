//! Why a logbook does not do what it is asked.

use std::path::PathBuf;

/// Why a logbook was not opened, read or written.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// It was written by a later version: nothing in it was changed.
    #[error(
        "{path}: this logbook is of version {found}, and this program knows {known} at most: it needs a newer tamaire"
    )]
    Newer {
        /// Which file.
        path: PathBuf,
        /// Its version.
        found: i64,
        /// The newest that is known here.
        known: i64,
    },
    /// Another program has it open and does not let go. It may be tried again.
    #[error("{0}: another program is writing in this logbook")]
    Locked(
        /// Which file.
        PathBuf,
    ),
    /// There is no room for more. It may be tried again.
    #[error("{0}: the disk is full")]
    Full(
        /// Which file.
        PathBuf,
    ),
    /// It may not be written, or the disk fails. It may be tried again.
    #[error("{path}: it cannot be opened, read or written: {reason}")]
    Unusable {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// It is no logbook, or is broken.
    #[error("{path}: this is no logbook, or a damaged one: {reason}")]
    Damaged {
        /// Which file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// It did not take this entry, but goes on with others.
    #[error("{path}: it did not take this: {reason}")]
    Refused {
        /// Which file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}
