//! The error type of the engine.

use std::borrow::Cow;
use std::fmt;

/// Error of an operation on a voxel grid, a body, a world or a snapshot. An operation that fails leaves all
/// state unchanged.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The handle is stale: the object was removed, or was never in this world. A handle from another world
    /// is not always detected, because this world may hold a different object with the same arena index and
    /// generation.
    InvalidHandle {
        /// Kind of the object, such as "soft body" or "joint".
        kind: &'static str,
        /// Index in the handle: position of the object in the arena that stores all objects of its kind.
        slot: u32,
    },
    /// A parameter is out of range.
    InvalidParameter {
        /// Name of the field or argument. If several objects in the call have a field of this name, the
        /// object precedes it, as in "material 2: density".
        field: Cow<'static, str>,
        /// Description of the allowed values, for example "0 to 1".
        expected: Cow<'static, str>,
        /// Rejected value, formatted as text.
        given: String,
    },
    /// No voxel of the grid is solid.
    EmptyGrid,
    /// A voxel has a material number beyond the end of the given list of materials.
    MissingMaterial {
        /// Material number of the voxel, counted from 1.
        number: u8,
        /// Length of the given list of materials.
        given: usize,
    },
    /// The bytes are not a snapshot, or they end before its header is complete.
    NotASnapshot,
    /// The format version of the snapshot is not the version that this engine reads.
    SnapshotVersion {
        /// Version that this engine reads.
        expected: u32,
        /// Format version in the header of the snapshot.
        found: u32,
    },
    /// The snapshot contains a 2D world, but a 3D world was requested, or the reverse.
    SnapshotDimensions {
        /// Number of dimensions of the requested world.
        expected: u8,
        /// Number of dimensions in the header of the snapshot.
        found: u8,
    },
    /// The snapshot is truncated, damaged or modified: its checksum does not match.
    DamagedSnapshot,
    /// The snapshot is undamaged, but its contents are inconsistent or out of range.
    InvalidSnapshot {
        /// Description of the fault, for example "a joint in it is invalid".
        reason: String,
    },
}

impl Error {
    /// Builds [`Error::InvalidParameter`] from the name of the field, the allowed values and the rejected
    /// value.
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

    /// Puts `owner`, for example "material 2", before the field name of an [`Error::InvalidParameter`]. Other
    /// errors stay unchanged.
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

/// Returns [`Error::InvalidParameter`] unless `is_valid` is true.
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
