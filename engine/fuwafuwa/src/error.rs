//! The error type of the engine.

use std::borrow::Cow;
use std::fmt;

/// Error of an operation on a grid, a body, a world or a snapshot. An operation that returns an error changed nothing.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The handle is stale: the object was removed, or was never in this world. A handle from another world is not always
    /// detected, because the same slot and generation may be in use in both.
    InvalidHandle {
        /// Kind of the object, such as "soft body" or "joint".
        kind: &'static str,
        /// Slot of the handle.
        slot: u32,
    },
    /// A parameter is out of range.
    InvalidParameter {
        /// Name of the field or argument. If it belongs to one of several objects, the object is named first, as in
        /// "material 2: density".
        field: Cow<'static, str>,
        /// Expected value or range.
        expected: Cow<'static, str>,
        /// Given value.
        given: String,
    },
    /// No voxel of the grid is solid.
    EmptyGrid,
    /// The grid uses a material that was not given.
    MissingMaterial {
        /// Number of the material in the grid, from 1.
        number: u8,
        /// Number of materials given.
        given: usize,
    },
    /// The bytes are not a snapshot, or end within its header.
    NotASnapshot,
    /// The snapshot has another format version.
    SnapshotVersion {
        /// Version that this engine reads.
        expected: u32,
        /// Version in the header.
        found: u32,
    },
    /// The snapshot is of a world with another number of dimensions.
    SnapshotDimensions {
        /// Number of dimensions of the requested world.
        expected: u8,
        /// Number of dimensions in the header.
        found: u8,
    },
    /// The snapshot is truncated, damaged or modified: its checksum does not match.
    DamagedSnapshot,
    /// The checksum of the snapshot matches, but its world is invalid.
    InvalidSnapshot {
        /// Violated condition.
        reason: String,
    },
}

impl Error {
    /// Returns the error of a parameter that is out of range.
    pub(crate) fn parameter(
        field: &'static str,
        expected: impl Into<Cow<'static, str>>,
        given: impl fmt::Debug,
    ) -> Self {
        Self::InvalidParameter {
            field: field.into(),
            expected: expected.into(),
            given: format!("{given:?}"),
        }
    }

    /// Puts `owner`, such as "material 2", before the name of the parameter in an error.
    pub(crate) fn of(self, owner: impl fmt::Display) -> Self {
        match self {
            Self::InvalidParameter {
                field,
                expected,
                given,
            } => Self::InvalidParameter {
                field: format!("{owner}: {field}").into(),
                expected,
                given,
            },
            other => other,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InvalidHandle { kind, slot } => write!(
                f,
                "stale {kind} handle: slot {slot} was removed or reused, or belongs to another world"
            ),
            Self::InvalidParameter {
                field,
                expected,
                given,
            } => write!(f, "{field} must be {expected}, given {given}"),
            Self::EmptyGrid => write!(f, "the grid is empty: at least one voxel must be solid"),
            Self::MissingMaterial { number, given } => write!(
                f,
                "the grid uses material {number}, but the number of materials given is {given}"
            ),
            Self::NotASnapshot => {
                write!(f, "not a snapshot: the header is missing or truncated")
            }
            Self::SnapshotVersion { expected, found } => write!(
                f,
                "unsupported snapshot format {found}, expected format {expected}"
            ),
            Self::SnapshotDimensions { expected, found } => write!(
                f,
                "the snapshot is of a world with {found} dimensions, expected {expected}"
            ),
            Self::DamagedSnapshot => {
                write!(f, "the snapshot is damaged: its checksum does not match")
            }
            Self::InvalidSnapshot { reason } => write!(f, "the snapshot is invalid: {reason}"),
        }
    }
}

impl std::error::Error for Error {}

/// Returns an error unless a parameter is valid.
#[inline]
pub(crate) fn require(
    is_valid: bool,
    field: &'static str,
    expected: &'static str,
    given: impl fmt::Debug,
) -> Result<(), Error> {
    match is_valid {
        true => Ok(()),
        false => Err(Error::parameter(field, expected, given)),
    }
}
