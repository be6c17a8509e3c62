//! Why there is no report.

use std::path::PathBuf;

/// Why a report was not made. Then nothing of it is left, but for rounds that were run again: a next time goes on there.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// No logbook was named.
    #[error("expected one logbook or more, found none")]
    NoFiles,
    /// A file is not there.
    #[error("{0}: there is no such file")]
    Missing(
        /// Which file.
        PathBuf,
    ),
    /// A file is no logbook, or cannot be read.
    #[error(transparent)]
    Logbook(#[from] tamaire_logbook::Error),
    /// The days are the wrong way round.
    #[error("expected a first day that is not after the last, found {from} and {to}")]
    Days {
        /// The first.
        from: crate::Day,
        /// The last.
        to: crate::Day,
    },
    /// The report cannot be written.
    #[error("{path}: it cannot be written: {reason}")]
    Unwritable {
        /// Which file or folder.
        path: PathBuf,
        /// What the system says.
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
