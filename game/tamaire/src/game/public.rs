//! Public mode of the game at a stand: collects the rounds that end, and shows the best ones while the stand
//! is idle.

use crate::session::Session;
use std::sync::Arc;
use tamaire_play::{Level, Progress, Replay};

/// State of public mode, in which no round can be paused, slowed down or left.
#[derive(Default)]
pub struct PublicMode {
    /// Rounds that ended since the stand last took them.
    pub ended: Vec<EndedRound>,
    /// Rounds shown while the stand is idle, in addition to the built-in ones.
    pub attractions: Vec<Arc<Replay>>,
    /// Whether a second player may join.
    pub takes_two: bool,
    /// Whether visitors cannot let time run back.
    pub is_rewind_off: bool,
    /// Whether the visitor seems to have left. Force feedback is then off.
    pub is_left: bool,
    /// Whether a visitor asked for the other language.
    pub asks_for_language: bool,
}

/// A round that ended, won or not.
pub struct EndedRound {
    /// Level of the round.
    pub level: Arc<Level>,
    /// Progress of the round.
    pub progress: Progress,
    /// Number of players.
    pub players: usize,
    /// Recording of the round.
    pub replay: Replay,
}

impl PublicMode {
    /// Returns one of [`Self::attractions`] for every odd `number`, unless its replay is no longer valid.
    /// `None` = show a built-in round.
    pub(super) fn attraction(&self, number: usize) -> Option<Session> {
        let index = number / 2 % self.attractions.len().max(1);
        let replay = self.attractions.get(index).filter(|_| number % 2 == 1)?;
        Session::of_replay(replay.clone()).ok()
    }
}
