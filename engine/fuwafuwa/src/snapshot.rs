//! Saving and loading of worlds; a loaded world continues bit for bit like the original.
//!
//! ```text
//! "fuwa"  version u32  dimensions u8  checksum u64  the world, in postcard's format
//! ```

use crate::error::Error;
use crate::foundation::dim::Dim;
use crate::foundation::hash::Hash;
use crate::world::{StoredWorld, World};

/// Version of the format. It changes when an older snapshot would be misread or would continue differently.
pub const VERSION: u32 = 25;

const MAGIC: [u8; 4] = *b"fuwa";
const HEADER: usize = 17;

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
/// [`Error`] if the bytes are not a snapshot, have another format version or number of dimensions, or are
/// damaged. A snapshot is also rejected if a position is not finite, or if the voxels, connections, elements,
/// nodes or pieces of a body contradict each other.
///
/// Input from untrusted sources is therefore safe: a loaded world can be stepped, and at worst its simulation
/// diverges. Time and memory are bounded by the number of bytes, not by lengths that the bytes claim.
#[inline(never)]
pub fn load<D: Dim>(bytes: &[u8]) -> Result<World<D>, Error> {
    if bytes.len() < HEADER || bytes[..4] != MAGIC {
        return Err(Error::NotASnapshot);
    }
    let (header, state) = bytes.split_at(HEADER);
    let number = |from: usize| header[from..].iter().take(4);
    let found = number(4)
        .rev()
        .fold(0, |all, &byte| all << 8 | u32::from(byte));
    if found != VERSION {
        return Err(Error::SnapshotVersion {
            expected: VERSION,
            found,
        });
    }
    let found = header[8];
    if usize::from(found) != D::N {
        return Err(Error::SnapshotDimensions {
            expected: D::N as u8,
            found,
        });
    }
    if header[9..] != Hash::of(state).to_le_bytes() {
        return Err(Error::DamagedSnapshot);
    }
    let stored: StoredWorld<D> = postcard::from_bytes(state).map_err(|_| Error::DamagedSnapshot)?;
    World::try_from(stored)
}
