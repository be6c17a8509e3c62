//! Sticks and pads.

use sticks::{NoSticks, Snapshot, Sticks};

/// The sticks and pads that can be read here.
pub struct Pads {
    sticks: Result<Sticks, NoSticks>,
}

impl Pads {
    /// Starts to listen to them.
    pub fn open() -> Self {
        Self {
            sticks: Sticks::open(),
        }
    }

    /// What they say now.
    pub fn snapshot(&self) -> Snapshot {
        match &self.sticks {
            Ok(sticks) => Snapshot::clone(&sticks.snapshot()),
            Err(_) => Snapshot::default(),
        }
    }

    /// Why none can be read, if so.
    pub fn complaint(&self) -> Option<String> {
        self.sticks.as_ref().err().map(ToString::to_string)
    }
}
