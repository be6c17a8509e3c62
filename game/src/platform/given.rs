//! What somebody named on the command line or dropped onto the window.

use super::storage::Kind;
use std::io;
use std::path::Path;
use tamaire_play::level::LevelError;
use tamaire_play::{Level, Replay, ReplayError, bytes_of};

/// Something to play or to watch, or why it is none. From here on nobody knows where it came from.
pub enum Given {
    /// A level, or a picture or a model as one.
    Level(Result<Box<Level>, LevelError>),
    /// A replay, and where it lies, for people to read.
    Replay(String, Result<Box<Replay>, ReplayError>),
}

impl Given {
    /// A replay, a level, a picture or a model in a file, or a level that comes along, by its name.
    pub fn at(path: &Path) -> Self {
        let place = path.to_string_lossy();
        let ending = path.extension().unwrap_or_default();
        if ending.eq_ignore_ascii_case("tamaire") {
            return Self::Replay(place.into(), replay_in(path).map(Box::new));
        }
        let named = |mut level: Level| {
            // Its records stay when its folder is moved. One without an ending is not taken for one that comes along.
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if name.contains('.') {
                level.id = name.into();
            }
            Box::new(level)
        };
        Self::Level(Level::open(&place).map(named))
    }
}

/// The replay in a file.
///
/// # Errors
/// [`ReplayError`] when it cannot be read or is none.
pub fn replay_in(path: &Path) -> Result<Replay, ReplayError> {
    let bytes = bytes_of(path, Kind::Replay.most_bytes());
    let unreadable = |error: io::Error| ReplayError::Unreadable(error.to_string());
    Replay::of_bytes(&bytes.map_err(unreadable)?)
}
