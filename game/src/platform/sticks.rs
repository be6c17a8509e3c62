//! Sticks and pads.

use sticks::{NoSticks, Snapshot, Sticks};

/// The sticks and pads that can be read here.
pub struct Pads {
    sticks: Option<Result<Sticks, NoSticks>>,
}

impl Pads {
    /// Starts to listen to them.
    pub fn open() -> Self {
        Self {
            sticks: Some(Sticks::open()),
        }
    }

    /// None, by choice.
    pub fn none() -> Self {
        Self { sticks: None }
    }

    /// What they say now.
    pub fn snapshot(&self) -> Snapshot {
        match &self.sticks {
            Some(Ok(sticks)) => Snapshot::clone(&sticks.snapshot()),
            _ => Snapshot::default(),
        }
    }

    /// Why none can be read, if so.
    pub fn complaint(&self) -> Option<String> {
        let sticks = self.sticks.as_ref()?;
        sticks.as_ref().err().map(ToString::to_string)
    }
}
