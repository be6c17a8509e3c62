//! Shapes from files: a silhouette from PNG ([`png()`]), a model from MagicaVoxel ([`vox()`]).
//!
//! A file may come from anywhere. Whatever its bytes are, the answer is a grid or an [`ImportError`]
//! that says which file, where in it, and what was expected; every size is compared with its limit
//! and with the length of the file before memory is taken for it.

mod png;
mod vox;

pub use self::png::{MAX_PIXELS, Picture, png, png_bytes};
pub use self::vox::{MAX_VOXELS_ACROSS, Model, vox, vox_bytes};

use fuwafuwa::BuildError;
use std::collections::BTreeMap;
use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Most bytes of a file: twice what the largest model takes when it is full.
pub const MAX_FILE_BYTES: u64 = 1 << 27;

/// Why a file gives no shape.
#[derive(Debug, thiserror::Error)]
#[error("{file}{place}: {problem}")]
pub struct ImportError {
    /// The file's path, or the name that the caller gave its bytes.
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

/// Which material a colour in a file stands for; 0 leaves its voxels empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Colours {
    /// Materials by palette index, 1 to 255; for models only.
    pub indices: BTreeMap<u8, u8>,
    /// Materials by red, green and blue. A voxel is of the material whose colour is nearest to its
    /// own (least sum of squared differences, the first of several), so that shades of a colour and
    /// smoothed edges need no entries.
    pub named: BTreeMap<[u8; 3], u8>,
}

impl Colours {
    fn nearest(&self, colour: [u8; 3]) -> Option<u8> {
        let apart = |other: &[u8; 3]| -> u32 {
            let squares = (0..3).map(|k| u32::from(colour[k].abs_diff(other[k])).pow(2));
            squares.sum()
        };
        let nearest = self.named.iter().min_by_key(|(other, _)| apart(other));
        nearest.map(|(_, &material)| material)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Byte(at) => write!(f, ", byte {at}"),
            Self::Chunk(name, at) => write!(f, ", chunk {} at byte {at}", name.escape_ascii()),
        }
    }
}

/// A problem and its place, before the name of the file is put to it.
type Complaint = (Place, Problem);

fn unexpected(place: Place, expected: impl Into<String>, found: impl Into<String>) -> Complaint {
    let (expected, found) = (expected.into(), found.into());
    (place, Problem::Unexpected { expected, found })
}

fn in_file<T>(file: &str, outcome: Result<T, Complaint>) -> Result<T, ImportError> {
    outcome.map_err(|(place, problem)| ImportError {
        file: file.to_owned(),
        place,
        problem,
    })
}

/// The complaint about a grid that cannot be; `sought` is what would have been solid.
fn no_grid(error: BuildError, sought: &'static str) -> Complaint {
    let problem = match error {
        BuildError::Empty => Problem::Empty(sought),
        error => Problem::Grid(error),
    };
    (Place::File, problem)
}

fn name_of(path: &Path) -> String {
    path.display().to_string()
}

/// The bytes of a file, refused when there are more than [`MAX_FILE_BYTES`], and when it is a pipe or a
/// device: who reads one may wait for ever.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, ImportError> {
    in_file(&name_of(path), try_read(path))
}

fn try_read(path: &Path) -> Result<Vec<u8>, Complaint> {
    let unreadable = |error| (Place::File, Problem::Unreadable(error));
    if !path.metadata().map_err(unreadable)?.is_file() {
        return Err(unexpected(
            Place::File,
            "a file",
            "a folder, a pipe or a device",
        ));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    let outcome = file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes);
    outcome.map_err(unreadable)?;
    check_length(&bytes)?;
    Ok(bytes)
}

fn check_length(bytes: &[u8]) -> Result<(), Complaint> {
    let found = bytes.len() as u64;
    let too_large = Problem::TooLarge {
        what: "bytes or more",
        found,
        limit: MAX_FILE_BYTES,
    };
    let good = found <= MAX_FILE_BYTES;
    good.then_some(()).ok_or((Place::File, too_large))
}
