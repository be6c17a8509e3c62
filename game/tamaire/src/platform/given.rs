//! Files and links from the command line, from drag and drop, or from the file dialog.

use fuwafuwa_scenes::scene::{Fetch, extension_of};
use tamaire_play::level::LevelError;
use tamaire_play::{Level, Pack, Replay, ReplayError};

/// Level, replay or link to open, or the error of reading it.
pub enum OpenRequest {
    /// A level.
    Level(Result<Box<Level>, LevelError>),
    /// A picture or model, which becomes a body: its name and its bytes.
    Body(String, Vec<u8>),
    /// A replay and its location, as text for the player.
    Replay(String, Result<Box<Replay>, ReplayError>),
    /// A pack of levels: its name and its levels.
    Pack(String, Result<Box<Pack>, LevelError>),
    /// Link to a round or a level.
    Link(String),
}

/// Result of a file dialog.
pub enum DialogResult {
    /// A file was chosen.
    File(OpenRequest),
    /// The dialog was cancelled.
    Nothing,
    /// The system has no file dialog.
    NoDialog,
}

impl OpenRequest {
    /// Returns the level around a picture or model.
    ///
    /// # Errors
    /// [`LevelError`] states the problem.
    pub fn level_around(name: &str, bytes: &[u8]) -> Result<Level, LevelError> {
        // Pictures and models name no other files.
        Level::read(name, bytes, &|_| Err(std::io::ErrorKind::NotFound.into()))
    }

    /// Reads a replay, level, picture, model or pack from the bytes of a file. The content decides the type. `fetch`
    /// loads the files that a level refers to.
    pub fn read(name: &str, bytes: &[u8], fetch: Fetch) -> Self {
        match is_replay(name, bytes) {
            true => Self::Replay(name.into(), Replay::of_bytes(bytes).map(Box::new)),
            false if Level::is_body_in(bytes) => Self::Body(name.into(), bytes.to_vec()),
            false if Pack::is_in(bytes) => {
                Self::Pack(name.into(), Pack::read(name, bytes).map(Box::new))
            }
            false => Self::Level(Level::read(name, bytes, fetch).map(Box::new)),
        }
    }
}

/// Returns whether a file is a replay. The name decides only for content that is neither a level nor a replay, so
/// that the error names what the player meant.
fn is_replay(name: &str, bytes: &[u8]) -> bool {
    Replay::is_in(bytes) || !Level::is_in(bytes) && extension_of(name) == "tamaire"
}

#[cfg(not(target_family = "wasm"))]
pub use on_disk::{dropped, level_at, replay_in};

#[cfg(not(target_family = "wasm"))]
mod on_disk {
    use super::{OpenRequest, is_replay};
    use crate::platform::storage::Kind;
    use fuwafuwa_scenes::disk::{read_bytes, reader_in};
    use fuwafuwa_scenes::import::MAX_FILE_BYTES;
    use std::fs;
    use std::io::{self, ErrorKind};
    use std::path::{Path, PathBuf};
    use tamaire_play::level::LevelError;
    use tamaire_play::link::is_link;
    use tamaire_play::{Level, Pack, Replay, ReplayError, pack};

    impl OpenRequest {
        /// Opens a file with a replay, level, picture, model or pack, a folder with such files, a built-in level by its
        /// name, or a link.
        pub fn at(path: &Path) -> Self {
            let location = path.to_string_lossy();
            if is_link(&location) && !path.exists() {
                return Self::Link(location.into());
            }
            if path.is_dir() && Level::open(&location).is_err() {
                return Self::Pack(location.into(), pack_in(path).map(Box::new));
            }
            let bytes = read_bytes(path, MAX_FILE_BYTES);
            // Without content, the name decides.
            let content = bytes.as_deref().unwrap_or_default();
            match is_replay(&location, content) {
                true => Self::Replay(location.into(), replay_of(bytes).map(Box::new)),
                false if Level::is_body_in(content) => {
                    let name = path.file_name().unwrap_or_default().to_string_lossy();
                    Self::Body(id_of(&name), content.to_vec())
                }
                false if Pack::is_in(content) => {
                    let pack = Pack::read(&location, content).map(Box::new);
                    Self::Pack(location.into(), pack)
                }
                false => Self::Level(level_of(path, bytes).map(Box::new)),
            }
        }
    }

    /// Opens a built-in level by its name, or a level in a file.
    ///
    /// # Errors
    /// [`LevelError`] states the problem.
    pub fn level_at(path: &Path) -> Result<Level, LevelError> {
        level_of(path, read_bytes(path, MAX_FILE_BYTES))
    }

    /// Opens a built-in level by its name, or the level at `path` from the content of its file.
    fn level_of(path: &Path, bytes: io::Result<Vec<u8>>) -> Result<Level, LevelError> {
        let location = path.to_string_lossy();
        let missing = match Level::open(&location) {
            Err(LevelError::Unknown { id, known }) => LevelError::Missing { id, known },
            opened => return opened,
        };
        let bytes = match bytes {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return Err(missing),
            Err(error) => {
                return Err(LevelError::Unreadable(location.into(), error.to_string()));
            }
        };
        // The id does not contain the folder, so records stay valid when the folder is moved.
        let id = id_of(&path.file_name().unwrap_or_default().to_string_lossy());
        Level::read(
            &id,
            &bytes,
            &reader_in(path.parent().unwrap_or(Path::new(""))),
        )
    }

    /// Reads the files directly in a folder as a pack.
    fn pack_in(folder: &Path) -> Result<Pack, LevelError> {
        let location = folder.to_string_lossy();
        let unreadable =
            |error: io::Error| LevelError::Unreadable(location.clone().into(), error.to_string());
        let files = fs::read_dir(folder).map_err(unreadable)?.flatten();
        let mut files: Vec<PathBuf> = files
            .map(|file| file.path())
            .filter(|file| file.is_file())
            .collect();
        files.sort();
        let files = files.into_iter().map(|file| {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            let name = name.into_owned();
            let read = move |most: u64| {
                let length = file.metadata().map_or(0, |data| data.len());
                match length > most {
                    true => Err(pack::too_long(length)),
                    false => read_bytes(&file, most).map_err(|error| error.to_string()),
                }
            };
            (name, read)
        });
        Pack::gather(&location, files, &reader_in(folder))
    }

    /// Returns the id of a level in a file: a name that the storage accepts. A name without an extension gets
    /// `.toml`, so that it differs from the names of built-in levels.
    fn id_of(name: &str) -> String {
        let name = name.trim_start_matches('.');
        let name: String = name.chars().filter(|letter| !letter.is_control()).collect();
        match name.contains('.') {
            true => name,
            false => name + ".toml",
        }
    }

    /// Reads a replay from a file.
    ///
    /// # Errors
    /// [`ReplayError`] if it cannot be read or is not a replay.
    pub fn replay_in(path: &Path) -> Result<Replay, ReplayError> {
        replay_of(read_bytes(path, Kind::Replay.most_bytes()))
    }

    /// Reads a replay from the content of its file.
    fn replay_of(bytes: io::Result<Vec<u8>>) -> Result<Replay, ReplayError> {
        let unreadable = |error: io::Error| ReplayError::Unreadable(error.to_string());
        Replay::of_bytes(&bytes.map_err(unreadable)?)
    }

    /// Returns the files dropped onto the window.
    pub fn dropped(ctx: &egui::Context) -> Vec<OpenRequest> {
        let files = ctx.input(|input| input.raw.dropped_files.clone());
        files
            .iter()
            .map(|file| OpenRequest::at(file.path()))
            .collect()
    }
}

#[cfg(target_family = "wasm")]
pub use on_page::{dropped, read_together};

#[cfg(target_family = "wasm")]
mod on_page {
    use super::OpenRequest;
    use crate::platform::here::{GivenFile, host};
    use js_sys::Array;
    use std::collections::BTreeMap;
    use std::io;
    use tamaire_play::Level;
    use tamaire_play::level::LevelError;
    use wasm_bindgen::JsCast;

    /// Returns the files dropped onto the page, and the link in its address.
    pub fn dropped(_: &egui::Context) -> Vec<OpenRequest> {
        let host = host();
        let files = host.take_dropped();
        let mut given = files.map_or(Vec::new(), |files| read_together(&files));
        given.extend(host.take_link().map(OpenRequest::Link));
        given
    }

    /// Reads files that were dropped or chosen together. A level may refer to other files among them. If
    /// there is a level, pictures and models count as its parts and do not become levels of their own.
    pub fn read_together(files: &Array) -> Vec<OpenRequest> {
        let files = files.iter().map(JsCast::unchecked_into::<GivenFile>);
        let files = files.map(|file| (file.name(), (file.contents(), file.length())));
        let files: BTreeMap<String, _> = files.collect();
        let fetch = |name: &str| {
            let found = files.get(name).and_then(|(bytes, _)| bytes.clone());
            found.ok_or_else(|| io::ErrorKind::NotFound.into())
        };
        let contents = || files.values().filter_map(|(bytes, _)| bytes.as_deref());
        let has_levels = contents().any(Level::is_text_in);
        let own = files.iter().filter(|(_, (bytes, _))| {
            let is_part = bytes.as_deref().is_some_and(Level::is_body_in);
            !(has_levels && is_part)
        });
        own.map(|(name, (bytes, length))| match bytes {
            Some(bytes) => OpenRequest::read(name, bytes, &fetch),
            None => {
                let reason = format!("cannot read the file, or it is too long ({length} bytes)");
                OpenRequest::Level(Err(LevelError::Unreadable(name.to_string(), reason)))
            }
        })
        .collect()
    }
}
