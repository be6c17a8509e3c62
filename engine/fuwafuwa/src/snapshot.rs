//! Saving a world and going on from there, to the same bits.
//!
//! ```text
//! "fuwa"  version u32  dimensions u8  checksum u64  the world, in postcard's format
//! ```

use crate::dim::Dim;
use crate::hash::Hash;
use crate::world::World;
use std::fmt;

/// Number of the format. It changes when an older world would be misread or go on differently.
pub const VERSION: u32 = 17;

const MAGIC: [u8; 4] = *b"fuwa";
const HEADER: usize = 17;

/// Why a snapshot was not taken up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BadSnapshot {
    /// It is no snapshot, or ends in its header.
    NotOne,
    /// It was saved by another version of this library.
    Version {
        /// The format it has.
        found: u32,
    },
    /// It is of a world with another number of dimensions.
    Dimensions {
        /// The number it has.
        found: u8,
    },
    /// It is not as it was saved: cut off, damaged or changed.
    Damaged,
    /// It is as it was written, but not of a world.
    NoWorld {
        /// What is wrong with it.
        defect: &'static str,
    },
    /// It is as it was written, but not of a world: a body in it cannot be.
    Broken {
        /// Which body.
        body: usize,
        /// What is wrong with it.
        defect: String,
    },
}

impl fmt::Display for BadSnapshot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotOne => write!(f, "this is no snapshot of a world"),
            Self::Version { found } => write!(
                f,
                "the snapshot has format {found}, this library reads format {VERSION}"
            ),
            Self::Dimensions { found } => {
                write!(f, "the snapshot is of a world with {found} dimensions")
            }
            Self::Broken { body, defect } => {
                write!(f, "the snapshot is of no world: of body {body}, {defect}")
            }
            Self::NoWorld { defect } => write!(f, "the snapshot is of no world: {defect}"),
            Self::Damaged => write!(f, "the snapshot is damaged: its checksum does not fit"),
        }
    }
}

impl std::error::Error for BadSnapshot {}

/// The world as it is now, to be saved.
#[inline(never)]
pub fn save<D: Dim>(world: &World<D>) -> Vec<u8> {
    let state = postcard::to_stdvec(world).expect("a world has nothing that postcard cannot write");
    let mut bytes = Vec::with_capacity(HEADER + state.len());
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.push(D::N as u8);
    bytes.extend(Hash::of(&state).to_le_bytes());
    bytes.extend(state);
    bytes
}

/// The world that was saved.
///
/// # Errors
/// [`BadSnapshot`] when it is none, has another format or other dimensions, was damaged, or when the
/// voxels, connections, elements, nodes or pieces of a body in it contradict each other, or a node is nowhere.
///
/// So who wrote it does not matter: what is loaded can be stepped, and goes out of hand at the worst, as what is
/// placed badly does. It takes time and memory by how long the snapshot is, and not by what it says of lengths.
#[inline(never)]
pub fn load<D: Dim>(bytes: &[u8]) -> Result<World<D>, BadSnapshot> {
    if bytes.len() < HEADER || bytes[..4] != MAGIC {
        return Err(BadSnapshot::NotOne);
    }
    let (header, state) = bytes.split_at(HEADER);
    let number = |from: usize| header[from..].iter().take(4);
    let found = number(4)
        .rev()
        .fold(0, |all, &byte| all << 8 | u32::from(byte));
    if found != VERSION {
        return Err(BadSnapshot::Version { found });
    }
    let found = header[8];
    if usize::from(found) != D::N {
        return Err(BadSnapshot::Dimensions { found });
    }
    if header[9..] != Hash::of(state).to_le_bytes() {
        return Err(BadSnapshot::Damaged);
    }
    let mut world: World<D> = postcard::from_bytes(state).map_err(|_| BadSnapshot::Damaged)?;
    if let Some(defect) = world.defect() {
        return Err(BadSnapshot::NoWorld { defect });
    }
    for (id, body) in world.bodies().entries() {
        let checked = body.check();
        checked.map_err(|defect| BadSnapshot::Broken {
            body: id.slot().index(),
            defect: defect.to_string(),
        })?;
    }
    world.rebuild();
    Ok(world)
}
