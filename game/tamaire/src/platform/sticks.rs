//! Sticks and pads.

use force_feedback::{Nothing, Recording, Sink};
use std::collections::BTreeMap;
use sticks::{DeviceId, NoSticks, Snapshot, Sticks};

/// The sticks and pads that can be read here.
pub struct Pads(Source);

enum Source {
    Sticks(Sticks),
    Nothing(NoSticks),
    Told(Snapshot, BTreeMap<DeviceId, Recording>),
}

impl Pads {
    /// Starts to listen to them.
    pub fn open() -> Self {
        Self(Sticks::open().map_or_else(Source::Nothing, Source::Sticks))
    }

    /// Listens to these.
    pub fn through(sticks: Sticks) -> Self {
        Self(Source::Sticks(sticks))
    }

    /// None, by choice.
    pub fn none() -> Self {
        Self::of(Snapshot::default())
    }

    /// Made up ones that say this.
    pub fn of(snapshot: Snapshot) -> Self {
        Self(Source::Told(snapshot, BTreeMap::new()))
    }

    /// The same with notes of what some of the made up ones are made to do.
    pub fn noting(self, notes: BTreeMap<DeviceId, Recording>) -> Self {
        Self(match self.0 {
            Source::Told(snapshot, _) => Source::Told(snapshot, notes),
            real => real,
        })
    }

    /// What they say now.
    pub fn snapshot(&self) -> Snapshot {
        match &self.0 {
            Source::Sticks(sticks) => Snapshot::clone(&sticks.snapshot()),
            Source::Nothing(_) => Snapshot::default(),
            Source::Told(snapshot, _) => snapshot.clone(),
        }
    }

    /// Takes hold of one to be felt; nothing where that was left out of the build.
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

    /// Why none can be read, if so.
    pub fn complaint(&self) -> Option<String> {
        match &self.0 {
            Source::Nothing(none) => Some(none.to_string()),
            _ => None,
        }
    }
}
