//! Storage of the game: bytes by kind and name. A desktop stores them in a folder, a browser in the browser's
//! storage. The rest of the game does not access files.

use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Location of an entry: the path of its file, or its name.
pub type Location = PathBuf;

/// Kind of a stored entry.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Settings or records.
    Note,
    /// A level that is not built in, with all its parts.
    Level,
    /// Recording of a round.
    Replay,
    /// Recording of the fastest win in a level.
    Best,
    /// Pack of levels.
    Pack,
    /// Picture of the end of a round.
    Photo,
    /// Animation of the last seconds of a round.
    Clip,
}

impl Kind {
    /// Maximum size of an entry [bytes]. A longer entry cannot come from the game and is not read.
    pub fn most_bytes(self) -> u64 {
        match self {
            Self::Note => 1 << 20,
            Self::Level => tamaire_play::level::MAX_KEPT_BYTES,
            Self::Replay | Self::Best => tamaire_play::replay::MAX_BYTES as u64,
            Self::Photo | Self::Clip => 1 << 26,
            Self::Pack => fuwafuwa_scenes::import::MAX_FILE_BYTES,
        }
    }
}

/// A stored entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Name of the entry.
    pub name: String,
    /// Time of the last write.
    pub written: SystemTime,
}

/// Computes the new bytes of an entry from the stored ones. `None` leaves the entry unchanged.
pub type UpdateEntry<'a> = dyn FnMut(Option<&[u8]>) -> Option<Vec<u8>> + 'a;

/// Storage of bytes by kind and name. Also used from the writer's thread.
pub trait Storage: Send + Sync {
    /// Returns all entries of a kind, in any order.
    ///
    /// # Errors
    /// The error of the system.
    fn list(&self, kind: Kind) -> io::Result<Vec<Entry>>;

    /// Reads an entry. `None` if it does not exist.
    ///
    /// # Errors
    /// The error of the system, also for an entry longer than [`Kind::most_bytes`].
    fn read(&self, kind: Kind, name: &str) -> io::Result<Option<Vec<u8>>>;

    /// Changes an entry atomically, while no other thread or program changes it.
    ///
    /// # Errors
    /// The error of the system. The entry is then unchanged.
    fn change(&self, kind: Kind, name: &str, change: &mut UpdateEntry) -> io::Result<()>;

    /// Deletes an entry.
    ///
    /// # Errors
    /// The error of the system.
    fn remove(&self, kind: Kind, name: &str) -> io::Result<()>;

    /// Returns the location of an entry.
    fn location(&self, kind: Kind, name: &str) -> Location;

    /// Whether entries can be given to the player as files. False if entries are files already.
    fn can_export(&self) -> bool {
        false
    }

    /// Gives an entry to the player as a file, if supported.
    ///
    /// # Errors
    /// The error of reading the entry, or `Unsupported` if the entries are files already.
    fn export(&self, _: Kind, _: &str) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }

    /// Whether entries are files in folders, which [`Storage::open_folder_of`] can open.
    fn has_folders(&self) -> bool {
        false
    }

    /// Opens the folder of a saved entry in the system's file manager. `location` is the value of
    /// [`Storage::location`].
    ///
    /// # Errors
    /// The error of the system, or `Unsupported` without folders.
    fn open_folder_of(&self, _: &Path) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }

    /// Returns the error of an earlier change that failed after [`Storage::change`] had returned. Returns
    /// each error once.
    fn take_failure(&self) -> Option<io::Error> {
        None
    }
}

/// Storage that stores nothing.
pub struct Nowhere {
    /// Reason why nothing is stored. `None` = by choice.
    pub reason: Option<&'static str>,
}

impl Nowhere {
    fn answer<T>(&self, nothing: T) -> io::Result<T> {
        match self.reason {
            Some(reason) => Err(io::Error::new(io::ErrorKind::NotFound, reason)),
            None => Ok(nothing),
        }
    }
}

impl Storage for Nowhere {
    fn list(&self, _: Kind) -> io::Result<Vec<Entry>> {
        Ok(Vec::new())
    }

    fn read(&self, _: Kind, _: &str) -> io::Result<Option<Vec<u8>>> {
        self.answer(None)
    }

    fn change(&self, _: Kind, _: &str, change: &mut UpdateEntry) -> io::Result<()> {
        change(None);
        self.answer(())
    }

    fn remove(&self, _: Kind, _: &str) -> io::Result<()> {
        self.answer(())
    }

    fn location(&self, _: Kind, name: &str) -> PathBuf {
        name.into()
    }
}
