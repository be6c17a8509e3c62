//! List of saved rounds with their details. The details of one round are read per frame, because reading
//! takes long.

use crate::platform::{Entry, Files};
use std::sync::Arc;
use tamaire_play::{Level, Outcome, Replay, ReplayError};

/// Saved rounds, the newest first.
#[derive(Default)]
pub struct SavedRounds(Vec<SavedRound>);

/// A saved round.
pub struct SavedRound {
    /// Entry in the storage.
    pub entry: Entry,
    /// Details of the round: outer `None` before it was read, inner `None` if it cannot be played.
    pub found: Option<Option<RoundDetails>>,
}

/// Details of a saved round.
#[derive(Clone)]
pub struct RoundDetails {
    /// Level of the round.
    pub level: Arc<Level>,
    /// Outcome, if the round was won.
    pub outcome: Option<Outcome>,
    /// Length [s].
    pub seconds: f32,
}

impl SavedRounds {
    /// Returns all saved rounds.
    pub fn iter(&self) -> impl Iterator<Item = &SavedRound> {
        self.0.iter()
    }

    /// Whether there are no saved rounds.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Reads the list of saved rounds again and keeps known details.
    pub(super) fn refresh(&mut self, files: &Files) {
        let before = std::mem::take(&mut self.0);
        let known = |entry: &Entry| before.iter().find(|kept| kept.entry == *entry);
        let kept = files.replays().into_iter().map(|entry| SavedRound {
            found: known(&entry).and_then(|kept| kept.found.clone()),
            entry,
        });
        self.0 = kept.collect();
    }

    /// Reads the details of one round whose details are unknown. Reuses an equal level from this list or from
    /// `levels`.
    pub(super) fn load_next_details(&mut self, files: &Files, levels: &[Arc<Level>]) {
        let Some(index) = self.0.iter().position(|kept| kept.found.is_none()) else {
            return;
        };
        let read = files.replay(&self.0[index].entry.name);
        let found = read.and_then(|replay| self.found(&replay, levels));
        self.0[index].found = Some(found.ok());
    }

    fn found(&self, replay: &Replay, levels: &[Arc<Level>]) -> Result<RoundDetails, ReplayError> {
        // Building a level takes long, so a known one is reused.
        let known = levels
            .iter()
            .cloned()
            .chain(self.levels())
            .find(|known| replay.is_of(known));
        let level = match known {
            Some(level) => level,
            None => Arc::new(replay.level()?),
        };
        Ok(RoundDetails {
            level,
            outcome: replay.outcome,
            seconds: replay.seconds(),
        })
    }

    /// Returns the levels of the rounds with known details.
    pub fn levels(&self) -> impl Iterator<Item = Arc<Level>> {
        let found = self
            .0
            .iter()
            .filter_map(|kept| kept.found.as_ref()?.as_ref());
        found.map(|found| found.level.clone())
    }
}
