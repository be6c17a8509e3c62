//! Input devices: sticks and gamepads, real or simulated.

use force_feedback::{Nothing, Recording, Sink};
use std::collections::BTreeMap;
use sticks::{DeviceId, Error, Snapshot, Sticks};

/// Source of stick and pad input.
pub struct Pads(Source);

enum Source {
    Sticks(Sticks),
    Nothing(Error),
    Told(Snapshot, BTreeMap<DeviceId, Recording>),
}

impl Pads {
    /// Opens all connected devices.
    pub fn open() -> Self {
        Self(Sticks::open().map_or_else(Source::Nothing, Source::Sticks))
    }

    /// Uses sticks and gamepads that are already open.
    pub fn through(sticks: Sticks) -> Self {
        Self(Source::Sticks(sticks))
    }

    /// Uses no devices. This is not an error: [`Self::open_error`] returns `None`.
    pub fn none() -> Self {
        Self::of(Snapshot::default())
    }

    /// Simulates devices with this input, for tests.
    pub fn of(snapshot: Snapshot) -> Self {
        Self(Source::Told(snapshot, BTreeMap::new()))
    }

    /// Makes simulated devices record the feedback that they receive in `notes`. Does nothing for real
    /// devices.
    pub fn noting(self, notes: BTreeMap<DeviceId, Recording>) -> Self {
        Self(match self.0 {
            Source::Told(snapshot, _) => Source::Told(snapshot, notes),
            real => real,
        })
    }

    /// Returns the current input.
    pub fn snapshot(&self) -> Snapshot {
        match &self.0 {
            Source::Sticks(sticks) => Snapshot::clone(&sticks.snapshot()),
            Source::Nothing(_) => Snapshot::default(),
            Source::Told(snapshot, _) => snapshot.clone(),
        }
    }

    /// Opens a device for feedback and returns the sink of its commands. The sink ignores all commands
    /// without the feature `haptic`, or if a simulated device has no recording.
    pub fn haptic(&self, device: DeviceId) -> Box<dyn Sink> {
        match &self.0 {
            #[cfg(feature = "haptic")]
            Source::Sticks(sticks) => Box::new(sticks.haptic(device)),
            Source::Told(_, notes) if notes.contains_key(&device) => {
                Box::new(notes[&device].clone())
            }
            _ => Box::new(Nothing),
        }
    }

    /// Returns the reason why no devices can be read, if any.
    pub fn open_error(&self) -> Option<String> {
        match &self.0 {
            Source::Nothing(none) => Some(none.to_string()),
            _ => None,
        }
    }
}
