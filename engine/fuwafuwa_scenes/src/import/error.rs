//! Errors of imported files.

use fuwafuwa::Error;
use std::{fmt, io};

/// Reason why a file could not be imported.
#[derive(Debug, thiserror::Error)]
#[error("{file}{position}: {problem}")]
pub struct ImportError {
    /// Name of the file, as given by the caller.
    pub file: String,
    /// Position in the file.
    pub position: FilePosition,
    /// Problem that was found at `position`.
    pub problem: Problem,
}

/// A position in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilePosition {
    /// The file as a whole.
    File,
    /// Byte offset. The decoder of pictures reads ahead, so the problem may lie some bytes earlier.
    Byte(usize),
    /// Name of a chunk and byte offset of its header.
    Chunk([u8; 4], usize),
    /// Name of a header field and its byte offset.
    Field(&'static str, usize),
}

/// Problem with a file.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// The system refuses to read the file.
    #[error("the file cannot be read: {0}")]
    Unreadable(io::Error),
    /// The content is not as expected.
    #[error("expected {expected}, found {found}")]
    Unexpected {
        /// Expected content.
        expected: String,
        /// Content that was found.
        found: String,
    },
    /// A number exceeds its limit.
    #[error("{found} {what} are too many, the limit is {limit}{advice}")]
    TooLarge {
        /// Unit of the number, in the plural.
        what: &'static str,
        /// Number that was found.
        found: u64,
        /// Largest accepted number.
        limit: u64,
        /// What the user can do, after a semicolon; may be empty.
        advice: String,
    },
    /// The shape has no solid voxel. The text names what would be solid.
    #[error("the shape is empty: there is no {0}")]
    Empty(&'static str),
    /// The shape has solid pixels, but no solid voxel.
    #[error("the shape is empty: solid pixels cover less than half of every voxel")]
    TooThin,
    /// The engine rejects the grid.
    #[error("{0}")]
    Grid(Box<Error>),
}

impl fmt::Display for FilePosition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Byte(at) => write!(f, ", byte {at}"),
            Self::Chunk(name, at) => write!(f, ", chunk {} at byte {at}", name.escape_ascii()),
            Self::Field(name, at) => write!(f, ", {name} at byte {at}"),
        }
    }
}

/// Position and problem; the caller adds the name of the file.
pub type PositionedProblem = (FilePosition, Problem);

/// Returns the problem of content that is not as expected.
pub fn unexpected(
    place: FilePosition,
    expected: impl Into<String>,
    found: impl ToString,
) -> PositionedProblem {
    let (expected, found) = (expected.into(), found.to_string());
    (place, Problem::Unexpected { expected, found })
}

/// Returns the problem of a number above its limit. `what` is the unit of the number, in the plural.
pub fn too_large(
    place: FilePosition,
    what: &'static str,
    found: u64,
    limit: u64,
) -> PositionedProblem {
    too_large_with(place, what, found, limit, String::new())
}

/// Returns the problem of a number above its limit, with advice after a semicolon.
pub fn too_large_with(
    place: FilePosition,
    what: &'static str,
    found: u64,
    limit: u64,
    advice: String,
) -> PositionedProblem {
    let problem = Problem::TooLarge {
        what,
        found,
        limit,
        advice,
    };
    (place, problem)
}

/// Adds the name of the file to a problem.
///
/// # Errors
/// The problem of `outcome`.
pub fn in_file<T>(file: &str, outcome: Result<T, PositionedProblem>) -> Result<T, ImportError> {
    outcome.map_err(|(place, problem)| ImportError {
        file: file.to_owned(),
        position: place,
        problem,
    })
}

/// Converts an error of the engine's voxel grid; `sought` names what would have been solid.
pub fn no_grid(error: Error, sought: &'static str) -> PositionedProblem {
    let problem = match error {
        Error::EmptyGrid => Problem::Empty(sought),
        error => Problem::Grid(Box::new(error)),
    };
    (FilePosition::File, problem)
}
