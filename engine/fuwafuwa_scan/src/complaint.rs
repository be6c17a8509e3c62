//! Problems with their position in a file.

use fuwafuwa_scenes::import::{ImportError, Place, Problem};

/// Position and problem; the caller adds the name of the file.
pub type Complaint = (Place, Problem);

pub fn unexpected(place: Place, expected: impl Into<String>, found: impl ToString) -> Complaint {
    let (expected, found) = (expected.into(), found.to_string());
    (place, Problem::Unexpected { expected, found })
}

pub fn too_large(place: Place, what: &'static str, found: u64, limit: u64) -> Complaint {
    (place, Problem::TooLarge { what, found, limit })
}

pub fn in_file<T>(file: &str, outcome: Result<T, Complaint>) -> Result<T, ImportError> {
    outcome.map_err(|(place, problem)| ImportError {
        file: file.to_owned(),
        place,
        problem,
    })
}
