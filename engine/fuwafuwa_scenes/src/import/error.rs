//! Why a file gives no shape.

use fuwafuwa::BuildError;
use std::{fmt, io};

/// Why a file gives no shape.
#[derive(Debug, thiserror::Error)]
#[error("{file}{place}: {problem}")]
pub struct ImportError {
    /// The name that the caller gave its bytes.
    pub file: String,
    /// Where in the file.
    pub place: Place,
    /// What is wrong there.
    pub problem: Problem,
}

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// So many bytes from its beginning. A picture is decoded some bytes ahead of what is wrong.
    Byte(usize),
    /// The chunk of this name, whose header begins so many bytes from the beginning.
    Chunk([u8; 4], usize),
    /// The field of this name in a header, so many bytes from the beginning.
    Field(&'static str, usize),
}

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// The system does not let us read it.
    #[error("it cannot be read: {0}")]
    Unreadable(io::Error),
    /// Something else stands there than what is needed.
    #[error("expected {expected}, found {found}")]
    Unexpected {
        /// What is needed.
        expected: String,
        /// What stands there.
        found: String,
    },
    /// A number is above its limit.
    #[error("{found} {what} are too many, the limit is {limit}")]
    TooLarge {
        /// What is counted.
        what: &'static str,
        /// The number found.
        found: u64,
        /// The largest that is taken.
        limit: u64,
    },
    /// Nothing in it is solid.
    #[error("the shape is empty: there is no {0}")]
    Empty(&'static str),
    /// The engine takes no such grid.
    #[error("{0}")]
    Grid(BuildError),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Byte(at) => write!(f, ", byte {at}"),
            Self::Chunk(name, at) => write!(f, ", chunk {} at byte {at}", name.escape_ascii()),
            Self::Field(name, at) => write!(f, ", {name} at byte {at}"),
        }
    }
}

/// A problem and its place, before the name of the file is put to it.
pub type Complaint = (Place, Problem);

pub fn unexpected(
    place: Place,
    expected: impl Into<String>,
    found: impl Into<String>,
) -> Complaint {
    let (expected, found) = (expected.into(), found.into());
    (place, Problem::Unexpected { expected, found })
}

pub fn in_file<T>(file: &str, outcome: Result<T, Complaint>) -> Result<T, ImportError> {
    outcome.map_err(|(place, problem)| ImportError {
        file: file.to_owned(),
        place,
        problem,
    })
}

/// The complaint about a grid that cannot be; `sought` is what would have been solid.
pub fn no_grid(error: BuildError, sought: &'static str) -> Complaint {
    let problem = match error {
        BuildError::Empty => Problem::Empty(sought),
        error => Problem::Grid(error),
    };
    (Place::File, problem)
}
