//! Errors of a report.

use std::path::PathBuf;

/// Reason why a report was not made. An earlier report in the folder stays unchanged, except for
/// `reruns.jsonl`, from which the next report continues.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// No logbook was given.
    #[error("expected at least one logbook, found none")]
    NoFiles,
    /// A file does not exist.
    #[error("{0}: file not found")]
    Missing(
        /// Path of the file.
        PathBuf,
    ),
    /// A file is no logbook, or cannot be read.
    #[error(transparent)]
    Logbook(#[from] tamaire_logbook::Error),
    /// The first day is after the last.
    #[error("expected a first day not after the last day, found {from} and {to}")]
    Days {
        /// First day.
        from: crate::Day,
        /// Last day.
        to: crate::Day,
    },
    /// A file or folder of the report cannot be written, or the stored results cannot be read.
    #[error("{path}: cannot be written: {reason}")]
    Unwritable {
        /// Path of the file or folder.
        path: PathBuf,
        /// Message of the operating system.
        reason: String,
    },
}

impl Error {
    pub(crate) fn unwritable(path: &std::path::Path, reason: impl std::fmt::Display) -> Self {
        Self::Unwritable {
            path: path.into(),
            reason: reason.to_string(),
        }
    }
}
