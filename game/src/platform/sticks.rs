//! Sticks and pads.

use sticks::{NoSticks, Snapshot, Sticks};

/// The sticks and pads that can be read here.
pub struct Pads(Source);

enum Source {
    Sticks(Sticks),
    Nothing(NoSticks),
    Told(Snapshot),
}

impl Pads {
    /// Starts to listen to them.
    pub fn open() -> Self {
        Self(Sticks::open().map_or_else(Source::Nothing, Source::Sticks))
    }

    /// None, by choice.
    pub fn none() -> Self {
        Self::of(Snapshot::default())
    }

    /// Made up ones that say this.
    pub fn of(snapshot: Snapshot) -> Self {
        Self(Source::Told(snapshot))
    }

    /// What they say now.
    pub fn snapshot(&self) -> Snapshot {
        match &self.0 {
            Source::Sticks(sticks) => Snapshot::clone(&sticks.snapshot()),
            Source::Nothing(_) => Snapshot::default(),
            Source::Told(snapshot) => snapshot.clone(),
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
