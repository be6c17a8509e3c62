//! Problems with their position in a file.

use fuwafuwa_scenes::import::{FilePosition, ImportError, Problem};

/// Position and problem; the caller adds the name of the file.
pub type PositionedProblem = (FilePosition, Problem);

pub fn unexpected(
    place: FilePosition,
    expected: impl Into<String>,
    found: impl ToString,
) -> PositionedProblem {
    let (expected, found) = (expected.into(), found.to_string());
    (place, Problem::Unexpected { expected, found })
}

pub fn too_large(
    place: FilePosition,
    what: &'static str,
    found: u64,
    limit: u64,
) -> PositionedProblem {
    (place, Problem::TooLarge { what, found, limit })
}

pub fn in_file<T>(file: &str, outcome: Result<T, PositionedProblem>) -> Result<T, ImportError> {
    outcome.map_err(|(place, problem)| ImportError {
        file: file.to_owned(),
        position: place,
        problem,
    })
}
