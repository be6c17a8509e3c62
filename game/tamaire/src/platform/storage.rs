//! Where the game keeps things: bytes by kind and name. On a desktop that is a folder; a browser has a place of its own
//! for them. Nothing else in the game knows of files.

use std::io;
use std::time::SystemTime;

/// What kind of thing is kept.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// What the game itself notes down: settings, records.
    Note,
    /// A level that does not come along, with all that it is made from.
    Level,
    /// A round as it was played.
    Replay,
    /// The fastest one of a level.
    Best,
    /// A picture of the end of one.
    Photo,
    /// Its last seconds, as an animation.
    Clip,
}

impl Kind {
    /// Most bytes of one: what is longer is not ours, and not read.
    pub fn most_bytes(self) -> u64 {
        match self {
            Self::Note => 1 << 20,
            Self::Level => tamaire_play::level::MAX_KEPT_BYTES,
            Self::Replay | Self::Best => tamaire_play::replay::MAX_BYTES as u64,
            Self::Photo | Self::Clip => 1 << 26,
        }
    }
}

/// Something that is kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// By which it is read again.
    pub name: String,
    /// When it was written.
    pub written: SystemTime,
}

/// Works out what is to be kept from what is kept so far; none leaves it as it is.
pub type Change<'a> = dyn FnMut(Option<&[u8]>) -> Option<Vec<u8>> + 'a;

/// A place where bytes are kept by kind and name. It is used from the thread that writes too.
pub trait Storage: Send + Sync {
    /// All of a kind, in any order.
    ///
    /// # Errors
    /// What the system says.
    fn list(&self, kind: Kind) -> io::Result<Vec<Entry>>;

    /// What is kept under a name, if anything.
    ///
    /// # Errors
    /// What the system says; also when it is longer than [`Kind::most_bytes`].
    fn read(&self, kind: Kind, name: &str) -> io::Result<Option<Vec<u8>>>;

    /// Changes what is kept under a name, whole or not at all, while nobody else does: not even another program.
    ///
    /// # Errors
    /// What the system says; then it is as it was.
    fn change(&self, kind: Kind, name: &str, change: &mut Change) -> io::Result<()>;

    /// Keeps it no longer.
    ///
    /// # Errors
    /// What the system says.
    fn remove(&self, kind: Kind, name: &str) -> io::Result<()>;

    /// Where that is, for people to read.
    fn location(&self, kind: Kind, name: &str) -> String;

    /// Whether what is kept can be handed to the player as a file: where it is no file already.
    fn hands_out(&self) -> bool {
        false
    }

    /// Hands it to the player as a file, where that can be done.
    ///
    /// # Errors
    /// As [`Storage::read`].
    fn hand_out(&self, _: Kind, _: &str) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }

    /// Why something is not kept that was changed before, where that is known only later; told once.
    fn take_failure(&self) -> Option<io::Error> {
        None
    }
}

/// Keeps nothing.
pub struct Nowhere {
    /// Why, unless it is by choice.
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

    fn change(&self, _: Kind, _: &str, change: &mut Change) -> io::Result<()> {
        change(None);
        self.answer(())
    }

    fn remove(&self, _: Kind, _: &str) -> io::Result<()> {
        self.answer(())
    }

    fn location(&self, _: Kind, name: &str) -> String {
        name.into()
    }
}
