//! From files to an organ on the table, on a thread of its own while the window lives.

use crate::case::{Case, CaseError};
use crate::phantom;
use crate::procedure::Procedure;
use crate::record::{MOST_BYTES, Playback, RecordError, Recording};
use fuwafuwa_scan::{MAX_FILE_BYTES, Options, Organ, OrganError, Scan, Segmentation, Source};
use fuwafuwa_scenes::disk::bytes_of;
use fuwafuwa_scenes::import::ImportError;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::thread;

/// What a recording is called on disk.
pub const ENDING: &str = "fuwacut";

/// Shares of the progress: scans are read, the organ is made, it is laid on the table.
const READ: f32 = 0.35;
const MADE: f32 = 0.9;

/// What is to be opened.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// The made-up organ, with so many voxels along its longest side.
    Phantom(usize),
    /// The organ in some scans.
    Scans {
        /// Their files.
        files: Vec<PathBuf>,
        /// Which material is where.
        segmentation: Segmentation,
        /// How it is made.
        options: Options,
    },
    /// A procedure that was recorded.
    Recording(PathBuf),
}

/// What came of it.
pub enum Loaded {
    /// A procedure that begins.
    Procedure(Box<Procedure>),
    /// One that is played again.
    Playback(Box<Playback>),
}

/// Something to be said beside what was loaded.
pub type Warning = &'static str;

/// Why it cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file cannot be read.
    #[error("{0}: {1}")]
    File(String, String),
    /// It is no scan.
    #[error("{0}")]
    Scan(#[from] ImportError),
    /// There is no organ in it.
    #[error("{0}")]
    Organ(#[from] OrganError),
    /// The organ cannot be laid on the table.
    #[error("{0}")]
    Case(#[from] CaseError),
    /// It is no recording that can be played.
    #[error("{0}: {1}")]
    Record(String, RecordError),
    /// The system has no thread to give.
    #[error("no thread to read it on: {0}")]
    Thread(String),
    /// Reading broke down.
    #[error("reading it broke down")]
    BrokeDown,
}

/// Opens what is wanted. `progress` hears numbers from 0 to 1.
///
/// # Errors
/// [`LoadError`] names the file and what is wrong.
pub fn load(
    wanted: &Wanted,
    progress: &mut dyn FnMut(f32),
) -> Result<(Loaded, Option<Warning>), LoadError> {
    let begin = |case: Case| -> Result<Loaded, LoadError> {
        Ok(Loaded::Procedure(Box::new(Procedure::new(Arc::new(case))?)))
    };
    match wanted {
        Wanted::Phantom(resolution) => Ok((begin(phantom::case(*resolution)?)?, None)),
        Wanted::Recording(file) => {
            let name = file.display().to_string();
            let bytes = read(file, MOST_BYTES as u64)?;
            let recording = Recording::read(&bytes);
            let playback = recording.and_then(|recording| Playback::new(Arc::new(recording)));
            let playback = playback.map_err(|error| LoadError::Record(name, error))?;
            Ok((Loaded::Playback(Box::new(playback)), None))
        }
        Wanted::Scans {
            files,
            segmentation,
            options,
        } => {
            let mut scans = Vec::new();
            let each = READ / files.len().max(1) as f32;
            for (number, file) in files.iter().enumerate() {
                let name = file.display().to_string();
                let bytes = read(file, MAX_FILE_BYTES)?;
                scans.push(Scan::decode(&name, &bytes, |done| {
                    progress(each * (number as f32 + done));
                })?);
            }
            let all: Vec<&Scan> = scans.iter().collect();
            let organ = Organ::of(&all, segmentation, options, |done| {
                progress(READ + (MADE - READ) * done);
            })?;
            let is_unplaced = |scan: &Scan| scan.placement().source() == Source::Spacing;
            let warning = "A scan does not say what of it is left and what is right.";
            let warning = scans.iter().any(is_unplaced).then_some(warning);
            let procedure = begin(Case::of(&name_of(files), &organ))?;
            progress(1.0);
            Ok((procedure, warning))
        }
    }
}

fn read(file: &std::path::Path, most: u64) -> Result<Vec<u8>, LoadError> {
    bytes_of(file, most)
        .map_err(|error| LoadError::File(file.display().to_string(), error.to_string()))
}

/// What an organ is called: its first file without folders and endings.
fn name_of(files: &[PathBuf]) -> String {
    let name = files.first().and_then(|file| file.file_name());
    let name = name.map(|name| name.to_string_lossy().into_owned());
    let name = name.unwrap_or_default();
    let name = name.trim_end_matches(".gz").trim_end_matches(".nii");
    name.to_owned()
}

/// Something that is being opened.
pub struct Loading {
    /// How far it is, as the bits of a number from 0 to 1.
    done: Arc<AtomicU32>,
    told: Receiver<Result<(Loaded, Option<Warning>), LoadError>>,
}

impl Loading {
    /// Begins to open what is wanted.
    ///
    /// # Errors
    /// [`LoadError::Thread`] when there is none.
    pub fn begin(wanted: Wanted) -> Result<Self, LoadError> {
        let done = Arc::new(AtomicU32::new(0.0f32.to_bits()));
        let (tell, told) = mpsc::channel();
        let share = done.clone();
        let work = move || {
            let mut progress = |part: f32| share.store(part.to_bits(), Ordering::Relaxed);
            // Who asked may have gone.
            let _ = tell.send(load(&wanted, &mut progress));
        };
        let thread = thread::Builder::new().name("loading".into()).spawn(work);
        thread.map_err(|error| LoadError::Thread(error.to_string()))?;
        Ok(Self { done, told })
    }

    /// How far it is, 0 to 1.
    pub fn progress(&self) -> f32 {
        f32::from_bits(self.done.load(Ordering::Relaxed))
    }

    /// What came of it, once it is there.
    pub fn take(&self) -> Option<Result<(Loaded, Option<Warning>), LoadError>> {
        match self.told.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(LoadError::BrokeDown)),
        }
    }
}
