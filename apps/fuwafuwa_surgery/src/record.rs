//! A procedure on file: the organ as it was laid on the table, and what the hand wanted, tick by tick. All the rest comes out
//! of that again, to the same bits.
//!
//! ```text
//! "fuwacut\n"  version u32  checksum u64  length u32  the rest, deflated: postcard
//! ```
//!
//! Numbers are little-endian, and the checksum is that of all behind it. A recording holds the voxels of the organ: who
//! hands on one that was made of a patient's scan hands on part of that scan.

use crate::case::{Case, CaseError};
use crate::procedure::{Input, MOST_TICKS, Procedure};
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use fuwafuwa::hash::Hash;
use fuwafuwa::{Material, Refused, VoxelGrid};
use serde::{Deserialize, Serialize};
use std::io::{Read, Write};
use std::sync::Arc;

/// Number of the format. It changes when an older recording would be misread or go another way.
pub const VERSION: u32 = 2;
/// Most bytes of a recording.
pub const MOST_BYTES: usize = 1 << 26;
/// Most bytes of what is in it: the voxels of the finest organ and an hour of inputs.
const MOST_INSIDE: usize = 1 << 25;
const MAGIC: [u8; 8] = *b"fuwacut\n";
/// Magic, version, checksum, length.
const HEADER: usize = 8 + 4 + 8 + 4;
/// Ticks between two hashes.
const BETWEEN: usize = 60;

/// A procedure as it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What was operated on.
    pub case: Arc<Case>,
    /// What the hand wanted, tick by tick.
    pub inputs: Vec<Input>,
    /// The world's hash after every sixtieth tick and after the last.
    pub hashes: Vec<u64>,
}

/// Why a recording is not played.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// It is none.
    #[error("this is no recording of a procedure: it does not begin as one does")]
    NotOne,
    /// It was made by another version.
    #[error("this recording has format {found}, and this program plays format {VERSION}")]
    Version {
        /// The format it has.
        found: u32,
    },
    /// It is longer than any.
    #[error("{what}: expected {limit} at most, found {found}")]
    TooLarge {
        /// What of it.
        what: &'static str,
        /// How much there is.
        found: usize,
        /// How much there may be.
        limit: usize,
    },
    /// It is not as it was written.
    #[error("this recording is damaged: {0}")]
    Damaged(&'static str),
    /// What was operated on cannot be.
    #[error("the organ in this recording cannot be: {0}")]
    Case(#[from] CaseError),
    /// The world does not take what was wanted.
    #[error("{0}")]
    Refused(Refused),
    /// It does not lead to what it says.
    #[error(
        "this recording does not come out as it was made: it goes another way within second {second}"
    )]
    Differs {
        /// Where.
        second: usize,
    },
}

/// What is written.
#[derive(Serialize, Deserialize)]
struct Written {
    name: String,
    size: [u16; 3],
    /// [m]
    voxel: f32,
    materials: Vec<u8>,
    tissues: Vec<Material>,
    corner: [f64; 3],
    inputs: Vec<Input>,
    hashes: Vec<u64>,
}

impl Recording {
    /// What was done so far.
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

    /// Its bytes.
    pub fn bytes(&self) -> Vec<u8> {
        let inside = self.inside();
        let mut deflated = ZlibEncoder::new(Vec::new(), Compression::default());
        let deflated = deflated.write_all(&inside).and_then(|()| deflated.finish());
        let deflated = deflated.expect("memory takes all that is written to it");
        let mut behind = (inside.len() as u32).to_le_bytes().to_vec();
        behind.extend(deflated);
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(Hash::of(&behind).to_le_bytes());
        bytes.extend(behind);
        bytes
    }

    /// What of them is deflated.
    pub fn inside(&self) -> Vec<u8> {
        let grid = &self.case.grid;
        let written = Written {
            name: self.case.name.clone(),
            size: grid.size().map(|extent| extent as u16),
            voxel: grid.voxel_size(),
            materials: grid.voxels().map(|at| grid.material(at)).collect(),
            tissues: self.case.tissues.clone(),
            corner: self.case.corner,
            inputs: self.inputs.clone(),
            hashes: self.hashes.clone(),
        };
        postcard::to_stdvec(&written).expect("a recording has nothing that postcard cannot write")
    }

    /// That in the bytes of a file, whoever wrote it.
    ///
    /// # Errors
    /// [`RecordError`] says what is wrong with it.
    pub fn read(bytes: &[u8]) -> Result<Self, RecordError> {
        limit("bytes", bytes.len(), MOST_BYTES)?;
        if bytes.len() < HEADER || bytes[..8] != MAGIC {
            return Err(RecordError::NotOne);
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
            return Err(RecordError::Damaged("its checksum does not fit"));
        }
        let length = number(20) as usize;
        limit("bytes inside", length, MOST_INSIDE)?;
        let mut inside = Vec::new();
        // One byte more than there should be tells that there are too many.
        let inflated = ZlibDecoder::new(&bytes[HEADER..])
            .take(length as u64 + 1)
            .read_to_end(&mut inside);
        if inflated.is_err() || inside.len() != length {
            return Err(RecordError::Damaged("it does not inflate as it says"));
        }
        Self::read_inside(&inside)
    }

    /// That in what was deflated: for tests, which would never find a checksum.
    ///
    /// # Errors
    /// As [`Recording::read`].
    pub fn read_inside(inside: &[u8]) -> Result<Self, RecordError> {
        limit("bytes inside", inside.len(), MOST_INSIDE)?;
        let (written, rest) = postcard::take_from_bytes::<Written>(inside)
            .map_err(|_| RecordError::Damaged("what is in it is none"))?;
        if !rest.is_empty() {
            return Err(RecordError::Damaged(
                "there is more in it than there should be",
            ));
        }
        written.checked()
    }

    /// Ticks in it.
    pub fn ticks(&self) -> usize {
        self.inputs.len()
    }
}

impl Written {
    fn checked(self) -> Result<Recording, RecordError> {
        limit("ticks", self.inputs.len(), MOST_TICKS)?;
        if self.hashes.len() != marks(self.inputs.len()) {
            return Err(RecordError::Damaged(
                "it has another number of hashes than seconds",
            ));
        }
        let size = self.size.map(usize::from);
        let grid = VoxelGrid::from_materials(size, self.voxel, self.materials);
        let case = Case {
            name: self.name,
            grid: grid.map_err(CaseError::Grid)?,
            tissues: self.tissues,
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

/// How many hashes there are of so many ticks.
fn marks(ticks: usize) -> usize {
    ticks.div_ceil(BETWEEN)
}

fn limit(what: &'static str, found: usize, limit: usize) -> Result<(), RecordError> {
    let error = RecordError::TooLarge { what, found, limit };
    (found <= limit).then_some(()).ok_or(error)
}

/// A recording that is being played.
pub struct Playback {
    recording: Arc<Recording>,
    procedure: Procedure,
}

impl Playback {
    /// One from its start.
    ///
    /// # Errors
    /// [`RecordError`] when its organ cannot be laid on a table.
    pub fn new(recording: Arc<Recording>) -> Result<Self, RecordError> {
        let procedure = Procedure::new(recording.case.clone())?;
        Ok(Self {
            recording,
            procedure,
        })
    }

    /// The procedure as it is now.
    pub fn procedure(&self) -> &Procedure {
        &self.procedure
    }

    /// The same, to go on from there.
    pub fn into_procedure(self) -> Procedure {
        self.procedure
    }

    /// What is played.
    pub fn recording(&self) -> &Arc<Recording> {
        &self.recording
    }

    /// Whether all of it was played.
    pub fn is_over(&self) -> bool {
        self.procedure.ticks() >= self.recording.ticks()
    }

    /// Plays a tick; past the end nothing happens.
    ///
    /// # Errors
    /// [`RecordError::Differs`] when it turns out that it does not come out as it was made.
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
