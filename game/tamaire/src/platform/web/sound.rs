//! Sound output in a browser: `game/tamaire/web/sound.js` passes messages to a synthesizer in an audio worklet.

use super::host;
use super::host::Speaker;
use std::cell::RefCell;
use tamaire_sound::{Cue, Message, Soundscape, Volumes};

/// Sound output. It is silent before the first gesture of the player, and if there is no device.
pub struct Sound {
    speaker: Option<Speaker>,
    /// Sounds played since the last frame.
    message: RefCell<Message>,
}

impl Sound {
    /// Opens the default output device as soon as the browser allows sound.
    pub fn open() -> Self {
        Self {
            speaker: Some(host().speaker()),
            ..Self::none()
        }
    }

    /// Turns sound off, by choice.
    pub fn none() -> Self {
        Self {
            speaker: None,
            message: RefCell::default(),
        }
    }

    /// Updates continuous sounds, once per frame.
    pub fn update(&self, soundscape: &Soundscape, volumes: &Volumes) {
        let mut message = self.message.borrow_mut();
        message.hear(soundscape);
        message.set_volumes(volumes);
        if let Some(speaker) = &self.speaker {
            speaker.tell(message.bytes());
        }
        message.clear();
    }

    /// Starts a sound effect with the next frame.
    pub fn play(&self, cue: Cue) {
        self.message.borrow_mut().play(cue);
    }

    /// Whether sound is off by choice.
    pub fn is_off(&self) -> bool {
        self.speaker.is_none()
    }

    /// Returns the reason why sound does not work, if any.
    pub fn trouble(&self) -> Option<String> {
        self.speaker.as_ref()?.trouble()
    }
}
