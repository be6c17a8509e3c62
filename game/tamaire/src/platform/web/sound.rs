//! How sound comes out in a browser: `game/web/sound.js` hands it to a synth in an audio worklet.

use super::host;
use super::host::Speaker;
use std::cell::RefCell;
use tamaire_sound::{Cue, Message, Soundscape, Volumes};

/// The loudspeaker. Until a first gesture, and where there is none, everything goes on in silence.
pub struct Sound {
    speaker: Option<Speaker>,
    /// What was played since the last frame.
    message: RefCell<Message>,
}

impl Sound {
    /// Opens the device that the browser prefers, once it may.
    pub fn open() -> Self {
        Self {
            speaker: Some(host().speaker()),
            ..Self::none()
        }
    }

    /// No sound, by choice.
    pub fn none() -> Self {
        Self {
            speaker: None,
            message: RefCell::default(),
        }
    }

    /// Tells what lasts, each frame.
    pub fn update(&self, soundscape: &Soundscape, volumes: &Volumes) {
        let mut message = self.message.borrow_mut();
        message.hear(soundscape);
        message.set_volumes(volumes);
        if let Some(speaker) = &self.speaker {
            speaker.tell(message.bytes());
        }
        message.clear();
    }

    /// Begins what sounds once, with the next frame.
    pub fn play(&self, cue: Cue) {
        self.message.borrow_mut().play(cue);
    }

    /// Whether nothing is heard by choice.
    pub fn is_off(&self) -> bool {
        self.speaker.is_none()
    }

    /// Why nothing is heard that should be, if so.
    pub fn trouble(&self) -> Option<String> {
        self.speaker.as_ref()?.trouble()
    }
}
