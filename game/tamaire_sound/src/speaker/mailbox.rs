//! What the game leaves for the device, and what it hears of it.

use crate::cue::Cue;
use crate::soundscape::{Soundscape, Volumes};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// As many cues may wait for the device; a tick of heavy tearing has some hundred.
const MOST_CUES: usize = 256;

/// As many of them may be of the world. The rest are kept for menus and jingles, which are few and
/// must not be lost.
pub const MOST_CUES_OF_THE_WORLD: usize = 240;

/// Why nothing is heard. The game goes on without.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoSound {
    /// There is none.
    #[error("no sound device was found")]
    NoDevice,
    /// Another program has it for itself.
    #[error("the sound device is in use by another program")]
    Busy,
    /// It neither works nor fails.
    #[error("the sound device does not answer")]
    NoAnswer,
    /// Something else, in the words of the system.
    #[error("the sound device cannot be used: {0}")]
    Refused(String),
}

/// What the game leaves for the device.
pub struct Mailbox {
    pub soundscape: Soundscape,
    pub volumes: Volumes,
    /// Counts what was told, so that the device sees what is new.
    pub number: u64,
    pub cues: Vec<Cue>,
    pub trouble: Option<NoSound>,
}

impl Mailbox {
    pub fn new() -> Self {
        Self {
            soundscape: Soundscape::default(),
            volumes: Volumes::default(),
            number: 0,
            cues: Vec::with_capacity(MOST_CUES),
            trouble: None,
        }
    }

    /// Drops a cue for which there is no room, or no device: it would come too late.
    pub fn put(&mut self, cue: Cue) {
        let most = match cue {
            Cue::Thud { .. } | Cue::Tear { .. } | Cue::Crumb { .. } => MOST_CUES_OF_THE_WORLD,
            Cue::Won(_) | Cue::Menu(_) => MOST_CUES,
        };
        if self.trouble.is_none() && self.cues.len() < most {
            self.cues.push(cue);
        }
    }
}

/// Nothing in the mailbox can be half done, so a thread that panicked does no harm.
pub fn lock(mailbox: &Mutex<Mailbox>) -> MutexGuard<'_, Mailbox> {
    mailbox.lock().unwrap_or_else(PoisonError::into_inner)
}
