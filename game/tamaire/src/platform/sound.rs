//! Sound output.

use tamaire_sound::{Cue, SoundError, Soundscape, Speaker, Volumes};

/// Sound output, or the reason for its absence. The game then runs silently.
pub struct Sound {
    speaker: Option<Result<Speaker, SoundError>>,
}

impl Sound {
    /// Opens the default output device of the system.
    pub fn open() -> Self {
        let speaker = Some(Speaker::open());
        Self { speaker }
    }

    /// Turns sound off, by choice.
    pub fn none() -> Self {
        Self { speaker: None }
    }

    /// Updates continuous sounds, once per frame.
    pub fn update(&self, soundscape: &Soundscape, volumes: &Volumes) {
        if let Some(Ok(speaker)) = &self.speaker {
            speaker.update(soundscape, volumes);
        }
    }

    /// Starts a sound effect.
    pub fn play(&self, cue: Cue) {
        if let Some(Ok(speaker)) = &self.speaker {
            speaker.play(cue);
        }
    }

    /// Whether sound is off by choice.
    pub fn is_off(&self) -> bool {
        self.speaker.is_none()
    }

    /// Returns the reason why sound does not work, if any.
    pub fn trouble(&self) -> Option<String> {
        let trouble = match self.speaker.as_ref()? {
            Ok(speaker) => speaker.trouble(),
            Err(none) => Some(none.clone()),
        };
        trouble.map(|trouble| trouble.to_string())
    }
}
