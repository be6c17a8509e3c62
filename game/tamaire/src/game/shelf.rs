//! The rounds that were kept, and what is known of each: read one by one, since each takes a moment.

use crate::platform::{Entry, Files};
use std::sync::Arc;
use tamaire_play::{Level, Outcome, Replay, ReplayError};

/// The rounds that were kept, the newest first.
#[derive(Default)]
pub struct Shelf(Vec<Kept>);

/// A round that was kept.
pub struct Kept {
    /// By which it is read.
    pub entry: Entry,
    /// What was found in it, once it was looked into; nothing where it cannot be played.
    pub found: Option<Option<Found>>,
}

/// What was found in a round that was kept.
#[derive(Clone)]
pub struct Found {
    /// Where it was played.
    pub level: Arc<Level>,
    /// How it was won, if it was.
    pub outcome: Option<Outcome>,
    /// How long it is [s].
    pub seconds: f32,
}

impl Shelf {
    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = &Kept> {
        self.0.iter()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Looks again which there are.
    pub(super) fn look(&mut self, files: &Files) {
        let before = std::mem::take(&mut self.0);
        let known = |entry: &Entry| before.iter().find(|kept| kept.entry == *entry);
        let kept = files.replays().into_iter().map(|entry| Kept {
            found: known(&entry).and_then(|kept| kept.found.clone()),
            entry,
        });
        self.0 = kept.collect();
    }

    /// Looks into one that is not known yet. A level that is known, here or among `levels`, is the same one.
    pub(super) fn look_into_one(&mut self, files: &Files, levels: &[Arc<Level>]) {
        let Some(index) = self.0.iter().position(|kept| kept.found.is_none()) else {
            return;
        };
        let read = files.replay(&self.0[index].entry.name);
        let found = read.and_then(|replay| self.found(&replay, levels));
        self.0[index].found = Some(found.ok());
    }

    fn found(&self, replay: &Replay, levels: &[Arc<Level>]) -> Result<Found, ReplayError> {
        // To build a level takes long: the same one is not built again.
        let known = levels
            .iter()
            .cloned()
            .chain(self.levels())
            .find(|known| replay.is_of(known));
        let level = match known {
            Some(level) => level,
            None => Arc::new(replay.level()?),
        };
        Ok(Found {
            level,
            outcome: replay.outcome,
            seconds: replay.ticks() as f32 * fuwafuwa::world::TICK,
        })
    }

    /// The levels of those that were looked into.
    pub fn levels(&self) -> impl Iterator<Item = Arc<Level>> {
        let found = self
            .0
            .iter()
            .filter_map(|kept| kept.found.as_ref()?.as_ref());
        found.map(|found| found.level.clone())
    }
}
