//! Where no sound comes out yet: the browser.

use tamaire_sound::{Cue, Soundscape, Volumes};

/// No loudspeaker.
pub struct Sound;

impl Sound {
    /// As on a desktop.
    pub fn open() -> Self {
        Self
    }

    /// No sound, by choice.
    pub fn none() -> Self {
        Self
    }

    /// Nothing hears it.
    pub fn update(&self, _: &Soundscape, _: &Volumes) {}

    /// Nothing hears it.
    pub fn play(&self, _: Cue) {}

    /// Why nothing is heard.
    pub fn trouble(&self) -> Option<String> {
        Some("no sound in the browser yet".into())
    }
}
