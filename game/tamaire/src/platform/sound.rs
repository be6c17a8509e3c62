//! How sound comes out.

use tamaire_sound::{Cue, NoSound, Soundscape, Speaker, Volumes};

/// The loudspeaker, or the reason why there is none: then everything goes on in silence.
pub struct Sound {
    speaker: Option<Result<Speaker, NoSound>>,
}

impl Sound {
    /// Opens the device that the system prefers.
    pub fn open() -> Self {
        let speaker = Some(Speaker::open());
        Self { speaker }
    }

    /// No sound, by choice.
    pub fn none() -> Self {
        Self { speaker: None }
    }

    /// Tells what lasts, each frame.
    pub fn update(&self, soundscape: &Soundscape, volumes: &Volumes) {
        if let Some(Ok(speaker)) = &self.speaker {
            speaker.update(soundscape, volumes);
        }
    }

    /// Begins what sounds once.
    pub fn play(&self, cue: Cue) {
        if let Some(Ok(speaker)) = &self.speaker {
            speaker.play(cue);
        }
    }

    /// Whether nothing is heard by choice.
    pub fn is_off(&self) -> bool {
        self.speaker.is_none()
    }

    /// Why nothing is heard that should be, if so.
    pub fn trouble(&self) -> Option<String> {
        let trouble = match self.speaker.as_ref()? {
            Ok(speaker) => speaker.trouble(),
            Err(none) => Some(none.clone()),
        };
        trouble.map(|trouble| trouble.to_string())
    }
}
