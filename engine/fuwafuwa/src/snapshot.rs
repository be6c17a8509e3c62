//! Saving and loading of worlds; a loaded world continues bit for bit like the original.
//!
//! ```text
//! "fuwa"  version u32  dimensions u8  checksum u64  the world, in postcard's format
//! ```

use crate::foundation::dim::Dim;
use crate::foundation::hash::Hash;
use crate::world::World;
use std::fmt;

/// Version of the format. It changes when an older snapshot would be misread or would continue differently.
pub const VERSION: u32 = 18;

const MAGIC: [u8; 4] = *b"fuwa";
const HEADER: usize = 17;

/// Reason why a snapshot could not be loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SnapshotError {
    /// The bytes are not a snapshot, or end within the header.
    NotASnapshot,
    /// The snapshot has another format version.
    Version {
        /// Version in the header.
        found: u32,
    },
    /// The snapshot is of a world with another number of dimensions.
    Dimensions {
        /// Number of dimensions in the header.
        found: u8,
    },
    /// The snapshot is truncated, damaged or modified: its checksum does not match.
    Damaged,
    /// The checksum matches, but the world is invalid.
    InvalidWorld {
        /// Violated invariant.
        defect: &'static str,
    },
    /// The checksum matches, but a body of the world is invalid.
    InvalidBody {
        /// Slot of the body.
        body: usize,
        /// Violated invariant.
        defect: String,
    },
}

impl fmt::Display for SnapshotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotASnapshot => write!(f, "this is no snapshot of a world"),
            Self::Version { found } => write!(
                f,
                "unsupported snapshot format {found}: expected format {VERSION}"
            ),
            Self::Dimensions { found } => {
                write!(f, "the snapshot is of a world with {found} dimensions")
            }
            Self::InvalidBody { body, defect } => {
                write!(f, "the snapshot is invalid: body {body}: {defect}")
            }
            Self::InvalidWorld { defect } => write!(f, "the snapshot is invalid: {defect}"),
            Self::Damaged => write!(f, "the snapshot is damaged: its checksum does not match"),
        }
    }
}

impl std::error::Error for SnapshotError {}

/// Serialises the present state of a world.
#[inline(never)]
pub fn save<D: Dim>(world: &World<D>) -> Vec<u8> {
    let state = postcard::to_stdvec(world).expect("postcard can serialise every world");
    let mut bytes = Vec::with_capacity(HEADER + state.len());
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.push(D::N as u8);
    bytes.extend(Hash::of(&state).to_le_bytes());
    bytes.extend(state);
    bytes
}

/// Loads a world from the bytes of [`save`].
///
/// # Errors
/// [`SnapshotError`] if the bytes are not a snapshot, have another version or number of dimensions, or are
/// damaged. Also if the voxels, connections, elements, nodes or pieces of a body contradict each other, or if
/// a position is not finite.
///
/// Input from untrusted sources is therefore safe: a loaded world can be stepped, and at worst it diverges,
/// like a badly posed scene. Time and memory are bounded by the number of bytes, not by lengths that the
/// bytes claim.
#[inline(never)]
pub fn load<D: Dim>(bytes: &[u8]) -> Result<World<D>, SnapshotError> {
    if bytes.len() < HEADER || bytes[..4] != MAGIC {
        return Err(SnapshotError::NotASnapshot);
    }
    let (header, state) = bytes.split_at(HEADER);
    let number = |from: usize| header[from..].iter().take(4);
    let found = number(4)
        .rev()
        .fold(0, |all, &byte| all << 8 | u32::from(byte));
    if found != VERSION {
        return Err(SnapshotError::Version { found });
    }
    let found = header[8];
    if usize::from(found) != D::N {
        return Err(SnapshotError::Dimensions { found });
    }
    if header[9..] != Hash::of(state).to_le_bytes() {
        return Err(SnapshotError::Damaged);
    }
    let mut world: World<D> = postcard::from_bytes(state).map_err(|_| SnapshotError::Damaged)?;
    if let Some(defect) = world.defect() {
        return Err(SnapshotError::InvalidWorld { defect });
    }
    for (id, body) in world.soft_bodies().entries() {
        let checked = body.check();
        checked.map_err(|defect| SnapshotError::InvalidBody {
            body: id.slot().index(),
            defect: defect.to_string(),
        })?;
    }
    world.rebuild();
    Ok(world)
}
