//! Errors of a logbook.

use std::path::PathBuf;

/// Reason why opening, reading or writing a logbook failed.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A later version of the program wrote the file. The file was not changed.
    #[error(
        "{path}: logbook of version {found}: this program supports up to version {known}; install a newer tamaire"
    )]
    Newer {
        /// Path of the logbook.
        path: PathBuf,
        /// Version of the file.
        found: i64,
        /// Newest version that this program supports.
        known: i64,
    },
    /// Another program holds a lock on the file. The caller may try again.
    #[error("{0}: another program is writing to this logbook")]
    Locked(
        /// Path of the logbook.
        PathBuf,
    ),
    /// The disk is full, or the file has reached its size limit. The caller may try again.
    #[error("{0}: the disk is full")]
    Full(
        /// Path of the logbook.
        PathBuf,
    ),
    /// The file cannot be accessed, for example because of its permissions or a failing disk. The caller may
    /// try again.
    #[error("{path}: the logbook cannot be opened, read or written: {reason}")]
    Unusable {
        /// Path of the logbook.
        path: PathBuf,
        /// Message of the operating system or of SQLite.
        reason: String,
    },
    /// The file is no logbook, or it is damaged.
    #[error("{path}: not a logbook, or a damaged one: {reason}")]
    Damaged {
        /// Path of the logbook.
        path: PathBuf,
        /// Description of the damage.
        reason: String,
    },
    /// SQLite rejected this entry, for example by a constraint. Other entries can still be written.
    #[error("{path}: the logbook rejected an entry: {reason}")]
    Refused {
        /// Path of the logbook.
        path: PathBuf,
        /// Reason for the rejection.
        reason: String,
    },
}
