//! Loads an organ from files and lays it on the table. The window does so in a background thread.

use crate::case::{Case, CaseError};
use crate::phantom;
use crate::procedure::Procedure;
use crate::record::{MOST_BYTES, Playback, RecordError, Recording};
use fuwafuwa_scan::{MAX_FILE_BYTES, Options, Organ, OrganError, Scan, Segmentation, warnings};
use fuwafuwa_scenes::disk::read_bytes;
use fuwafuwa_scenes::import::ImportError;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::thread;

/// File extension of recordings.
pub const ENDING: &str = "fuwacut";

/// Progress when the scans have been read; 1 is the end of loading.
const READ: f32 = 0.35;
/// Progress when the organ has been made; 1 is the end of loading.
const MADE: f32 = 0.9;

/// Source of an organ or a procedure to load.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadRequest {
    /// Synthetic organ with a number of voxels along its longest side.
    Phantom(usize),
    /// Organ from scans.
    Scans {
        /// Scan files.
        files: Vec<PathBuf>,
        /// Assignment of materials.
        segmentation: Segmentation,
        /// Options for making the organ.
        options: Options,
    },
    /// Recorded procedure.
    Recording(PathBuf),
}

/// Result of loading a [`LoadRequest`].
pub enum Loaded {
    /// New procedure.
    Procedure(Box<Procedure>),
    /// Replay of a recording.
    Playback(Box<Playback>),
}

/// Warnings about a loaded organ, as sentences for the user.
pub type Warnings = Vec<String>;

/// Reason why loading failed.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file cannot be read: name and reason.
    #[error("{0}: {1}")]
    File(String, String),
    /// The file is not a valid scan.
    #[error("{0}")]
    Scan(#[from] ImportError),
    /// The scans contain no usable organ.
    #[error("{0}")]
    Organ(#[from] OrganError),
    /// The organ cannot be laid on the table.
    #[error("{0}")]
    Case(#[from] CaseError),
    /// The file is not a valid recording: name and reason.
    #[error("{0}: {1}")]
    Record(String, RecordError),
    /// The loading thread cannot be started.
    #[error("cannot start the loading thread: {0}")]
    Thread(String),
    /// The loading thread panicked.
    #[error("the loading thread panicked")]
    BrokeDown,
}

/// Loads an organ or a procedure. Calls `progress` with values from 0 to 1.
///
/// # Errors
/// [`LoadError`] names the file and the problem.
pub fn load(
    wanted: &LoadRequest,
    progress: &mut dyn FnMut(f32),
) -> Result<(Loaded, Warnings), LoadError> {
    let begin = |case: Case| -> Result<Loaded, LoadError> {
        Ok(Loaded::Procedure(Box::new(Procedure::new(Arc::new(case))?)))
    };
    match wanted {
        LoadRequest::Phantom(resolution) => Ok((begin(phantom::case(*resolution)?)?, Vec::new())),
        LoadRequest::Recording(file) => {
            let name = file.display().to_string();
            let bytes = read(file, MOST_BYTES as u64)?;
            let recording = Recording::read(&bytes);
            let playback = recording.and_then(|recording| Playback::new(Arc::new(recording)));
            let playback = playback.map_err(|error| LoadError::Record(name, error))?;
            Ok((Loaded::Playback(Box::new(playback)), Vec::new()))
        }
        LoadRequest::Scans {
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
            let names: Vec<_> = files
                .iter()
                .map(|file| file.display().to_string())
                .collect();
            let named: Vec<_> = names.iter().map(String::as_str).zip(&scans).collect();
            let warnings = warnings(&named, segmentation);
            let procedure = begin(Case::of(&name_of(files), &organ))?;
            progress(1.0);
            Ok((procedure, warnings))
        }
    }
}

fn read(file: &std::path::Path, most: u64) -> Result<Vec<u8>, LoadError> {
    read_bytes(file, most)
        .map_err(|error| LoadError::File(file.display().to_string(), error.to_string()))
}

/// Returns the name of an organ: the name of its first file without folders and extensions.
fn name_of(files: &[PathBuf]) -> String {
    let name = files.first().and_then(|file| file.file_name());
    let name = name.map(|name| name.to_string_lossy().into_owned());
    let name = name.unwrap_or_default();
    let name = name.trim_end_matches(".gz").trim_end_matches(".nii");
    name.to_owned()
}

/// Loading in a background thread.
pub struct Loading {
    /// Progress from 0 to 1, as the bits of an `f32`.
    done: Arc<AtomicU32>,
    told: Receiver<Result<(Loaded, Warnings), LoadError>>,
}

impl Loading {
    /// Starts loading.
    ///
    /// # Errors
    /// [`LoadError::Thread`] if the thread cannot be started.
    pub fn begin(wanted: LoadRequest) -> Result<Self, LoadError> {
        let done = Arc::new(AtomicU32::new(0.0f32.to_bits()));
        let (tell, told) = mpsc::channel();
        let share = done.clone();
        let work = move || {
            let mut progress = |part: f32| share.store(part.to_bits(), Ordering::Relaxed);
            // Ignores the error if the window no longer waits for the result.
            let _ = tell.send(load(&wanted, &mut progress));
        };
        let thread = thread::Builder::new().name("loading".into()).spawn(work);
        thread.map_err(|error| LoadError::Thread(error.to_string()))?;
        Ok(Self { done, told })
    }

    /// Returns the progress of loading, 0 to 1.
    pub fn progress(&self) -> f32 {
        f32::from_bits(self.done.load(Ordering::Relaxed))
    }

    /// Returns the result once loading has finished.
    pub fn take(&self) -> Option<Result<(Loaded, Warnings), LoadError>> {
        match self.told.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(LoadError::BrokeDown)),
        }
    }
}
