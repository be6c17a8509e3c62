//! Recording of a procedure: the initial organ and the input of each tick. A replay reproduces everything
//! else bit for bit.
//!
//! ```text
//! "fuwacut\n"  version u32  checksum u64  length u32  contents, deflated: postcard
//! ```
//!
//! Numbers are little-endian. The checksum covers all bytes that follow it. The length is that of the
//! uncompressed contents. A recording contains the voxels of the organ. A recording made from a patient's
//! scan therefore contains part of that scan.

use crate::case::{Case, CaseError};
use crate::procedure::{Input, MOST_TICKS, Procedure};
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use fuwafuwa::inspect::Hash;
use fuwafuwa::{Error, Material, VoxelGrid};
use serde::{Deserialize, Serialize};
use std::io::{Read, Write};
use std::sync::Arc;

/// Format version. It is increased if older recordings would be misread or would replay differently.
pub const VERSION: u32 = 5;
/// Maximum size of a recording [bytes].
pub const MOST_BYTES: usize = 1 << 26;
/// Maximum size of the uncompressed contents [bytes]: the voxels of the finest organ and an hour of inputs.
const MOST_INSIDE: usize = 1 << 25;
const MAGIC: [u8; 8] = *b"fuwacut\n";
/// Size of the header: magic, version, checksum, length [bytes].
const HEADER: usize = 8 + 4 + 8 + 4;
/// Ticks between two recorded hashes of the world.
const BETWEEN: usize = 60;

/// Recorded procedure.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Organ before the first tick.
    pub case: Arc<Case>,
    /// Input of each tick.
    pub inputs: Vec<Input>,
    /// World hashes after every 60 ticks and after the last one.
    pub hashes: Vec<u64>,
}

/// Reason why a recording cannot be read or replayed.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The file is not a recording.
    #[error("not a recording of a procedure: the header is missing")]
    NotARecording,
    /// The recording has another format version.
    #[error("unsupported recording: expected format {VERSION}, found format {found}")]
    Version {
        /// Format version of the recording.
        found: u32,
    },
    /// A size in the recording exceeds its limit.
    #[error("{what}: expected at most {limit}, found {found}")]
    TooLarge {
        /// Name of the quantity that is too large.
        what: &'static str,
        /// Given value.
        found: usize,
        /// Maximum value.
        limit: usize,
    },
    /// The recording is damaged.
    #[error("damaged recording: {0}")]
    Damaged(&'static str),
    /// The organ is invalid.
    #[error("invalid organ in the recording: {0}")]
    Case(#[from] CaseError),
    /// The world rejected an input of the recording during the replay.
    #[error("{0}")]
    Refused(Error),
    /// The replay differs from the recording.
    #[error("the replay differs from the recording in second {second}")]
    Differs {
        /// Second in which the first difference was found, starting at 0. The world hashes are compared once
        /// a second.
        second: usize,
    },
}

/// Contents of a recording as they are serialized.
#[derive(Serialize, Deserialize)]
struct Written {
    name: String,
    size: [u16; 3],
    /// Voxel size [m].
    voxel: f32,
    materials: Vec<u8>,
    tissues: Vec<Material>,
    names: Vec<String>,
    corner: [f64; 3],
    inputs: Vec<Input>,
    hashes: Vec<u64>,
}

impl Recording {
    /// Returns the recording of a procedure up to now.
    pub fn of(procedure: &Procedure) -> Self {
        let mut hashes = procedure.hashes().to_vec();
        if hashes.len() < marks(procedure.ticks()) {
            hashes.push(procedure.world().hash());
        }
        Self {
            case: procedure.case().clone(),
            inputs: procedure.inputs().to_vec(),
            hashes,
        }
    }

    /// Returns the recording as bytes of a file.
    pub fn bytes(&self) -> Vec<u8> {
        let inside = self.inside();
        let mut deflated = ZlibEncoder::new(Vec::new(), Compression::default());
        let deflated = deflated.write_all(&inside).and_then(|()| deflated.finish());
        let deflated = deflated.expect("writing to a Vec cannot fail");
        let mut behind = (inside.len() as u32).to_le_bytes().to_vec();
        behind.extend(deflated);
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(Hash::of(&behind).to_le_bytes());
        bytes.extend(behind);
        bytes
    }

    /// Returns the uncompressed contents of the file, for tests.
    pub fn inside(&self) -> Vec<u8> {
        let grid = &self.case.grid;
        let written = Written {
            name: self.case.name.clone(),
            size: grid.size().map(|extent| extent as u16),
            voxel: grid.voxel_size(),
            materials: grid.voxels().map(|at| grid.material(at)).collect(),
            tissues: self.case.tissues.clone(),
            names: self.case.names.clone(),
            corner: self.case.corner,
            inputs: self.inputs.clone(),
            hashes: self.hashes.clone(),
        };
        postcard::to_stdvec(&written).expect("postcard can serialize every recording")
    }

    /// Reads a recording from the bytes of an untrusted file.
    ///
    /// # Errors
    /// [`RecordError`] names the problem.
    pub fn read(bytes: &[u8]) -> Result<Self, RecordError> {
        limit("bytes", bytes.len(), MOST_BYTES)?;
        if bytes.len() < HEADER || bytes[..8] != MAGIC {
            return Err(RecordError::NotARecording);
        }
        let number = |from: usize| {
            let digits = bytes[from..].iter().take(4).rev();
            digits.fold(0, |all, &byte| all << 8 | u32::from(byte))
        };
        let found = number(8);
        if found != VERSION {
            return Err(RecordError::Version { found });
        }
        if bytes[12..20] != Hash::of(&bytes[20..]).to_le_bytes() {
            return Err(RecordError::Damaged("checksum mismatch"));
        }
        let length = number(20) as usize;
        limit("bytes inside", length, MOST_INSIDE)?;
        let mut inside = Vec::new();
        // One more byte than the expected length is read, to detect contents that are too long.
        let inflated = ZlibDecoder::new(&bytes[HEADER..])
            .take(length as u64 + 1)
            .read_to_end(&mut inside);
        if inflated.is_err() || inside.len() != length {
            return Err(RecordError::Damaged(
                "the contents do not inflate to the length in the header",
            ));
        }
        Self::read_inside(&inside)
    }

    /// Reads a recording from uncompressed contents, for tests that cannot provide a valid checksum.
    ///
    /// # Errors
    /// The same errors as [`Recording::read`].
    pub fn read_inside(inside: &[u8]) -> Result<Self, RecordError> {
        limit("bytes inside", inside.len(), MOST_INSIDE)?;
        let (written, rest) = postcard::take_from_bytes::<Written>(inside)
            .map_err(|_| RecordError::Damaged("the contents cannot be decoded"))?;
        if !rest.is_empty() {
            return Err(RecordError::Damaged("unexpected bytes after the contents"));
        }
        written.checked()
    }

    /// Returns the number of ticks.
    pub fn ticks(&self) -> usize {
        self.inputs.len()
    }
}

impl Written {
    fn checked(self) -> Result<Recording, RecordError> {
        limit("ticks", self.inputs.len(), MOST_TICKS)?;
        if self.hashes.len() != marks(self.inputs.len()) {
            return Err(RecordError::Damaged(
                "the number of hashes does not match the number of ticks",
            ));
        }
        let size = self.size.map(usize::from);
        let grid = VoxelGrid::from_materials(size, self.voxel, self.materials);
        let case = Case {
            name: self.name,
            grid: grid.map_err(CaseError::Engine)?,
            tissues: self.tissues,
            names: self.names,
            corner: self.corner,
        };
        case.check()?;
        Ok(Recording {
            case: Arc::new(case),
            inputs: self.inputs,
            hashes: self.hashes,
        })
    }
}

/// Returns the number of hashes of a recording with `ticks` ticks.
fn marks(ticks: usize) -> usize {
    ticks.div_ceil(BETWEEN)
}

fn limit(what: &'static str, found: usize, limit: usize) -> Result<(), RecordError> {
    let error = RecordError::TooLarge { what, found, limit };
    (found <= limit).then_some(()).ok_or(error)
}

/// Replay of a recording.
pub struct Playback {
    recording: Arc<Recording>,
    procedure: Procedure,
}

impl Playback {
    /// Starts a replay.
    ///
    /// # Errors
    /// [`RecordError`] if the organ cannot be laid on a table.
    pub fn new(recording: Arc<Recording>) -> Result<Self, RecordError> {
        let procedure = Procedure::new(recording.case.clone())?;
        Ok(Self {
            recording,
            procedure,
        })
    }

    /// Returns the procedure in its current state.
    pub fn procedure(&self) -> &Procedure {
        &self.procedure
    }

    /// Returns the procedure as replayed so far. The user can continue it by hand.
    pub fn into_procedure(self) -> Procedure {
        self.procedure
    }

    /// Returns the recording.
    pub fn recording(&self) -> &Arc<Recording> {
        &self.recording
    }

    /// Returns whether all ticks were replayed.
    pub fn is_over(&self) -> bool {
        self.procedure.ticks() >= self.recording.ticks()
    }

    /// Replays a tick. Does nothing after the end.
    ///
    /// # Errors
    /// [`RecordError::Differs`] if the replay differs from the recording.
    pub fn step(&mut self) -> Result<(), RecordError> {
        let Some(&input) = self.recording.inputs.get(self.procedure.ticks()) else {
            return Ok(());
        };
        self.procedure.step(input).map_err(RecordError::Refused)?;
        let ticks = self.procedure.ticks();
        if !ticks.is_multiple_of(BETWEEN) && !self.is_over() {
            return Ok(());
        }
        let mark = marks(ticks) - 1;
        let is_same = self.recording.hashes.get(mark) == Some(&self.procedure.world().hash());
        let second = mark;
        is_same.then_some(()).ok_or(RecordError::Differs { second })
    }
}
