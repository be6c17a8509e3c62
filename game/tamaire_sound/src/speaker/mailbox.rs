//! Mailbox shared by the game and the sound device.

use crate::cue::Cue;
use crate::soundscape::{Soundscape, Volumes};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Maximum number of waiting cues; a tick of heavy tearing has about a hundred.
const MOST_CUES: usize = 256;

/// Maximum number of waiting cues at which thuds, tears and crumbs are still accepted. The places above are
/// for menus and jingles, which are few and must not be lost.
pub const MOST_CUES_OF_THE_WORLD: usize = 240;

/// Reason why there is no sound. The game continues silently.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SoundError {
    /// No device was found.
    #[error("no sound device was found")]
    NoDevice,
    /// Another program uses the device exclusively.
    #[error("the sound device is in use by another program")]
    Busy,
    /// The device did not respond in time.
    #[error("the sound device does not answer")]
    NoAnswer,
    /// Another error, with the message of the system.
    #[error("the sound device cannot be used: {0}")]
    Refused(String),
}

/// Data from the game for the device, and the state of the device.
pub struct Mailbox {
    pub soundscape: Soundscape,
    pub volumes: Volumes,
    /// Number of the last update. The device detects an update by a changed number.
    pub number: u64,
    pub cues: Vec<Cue>,
    pub trouble: Option<SoundError>,
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

    /// Adds a cue. Drops the cue if the mailbox is full. Also drops the cue if there is no device, because it
    /// would be heard too late.
    pub fn put(&mut self, cue: Cue) {
        let most = match cue.is_of_world() {
            true => MOST_CUES_OF_THE_WORLD,
            false => MOST_CUES,
        };
        if self.trouble.is_none() && self.cues.len() < most {
            self.cues.push(cue);
        }
    }
}

/// Locks the mailbox. Ignores poisoning, because a panic cannot leave the mailbox inconsistent.
pub fn lock(mailbox: &Mutex<Mailbox>) -> MutexGuard<'_, Mailbox> {
    mailbox.lock().unwrap_or_else(PoisonError::into_inner)
}
