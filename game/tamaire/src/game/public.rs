//! What is different where the game stands in public: rounds are collected, and what visitors reached is shown to others.

use crate::session::Session;
use std::sync::Arc;
use tamaire_play::{Level, Progress, Replay};

/// What is different in public. No round can be paused there, slowed down or left behind.
#[derive(Default)]
pub struct Public {
    /// Rounds of people that ended since somebody took them.
    pub ended: Vec<Ended>,
    /// Rounds that are shown while nobody plays, beside those that come along.
    pub attractions: Vec<Arc<Replay>>,
    /// Whether a second player may come in.
    pub takes_two: bool,
    /// Whether whoever played seems to have gone: then nothing is felt.
    pub is_left: bool,
    /// Whether a visitor asked for the other language.
    pub asks_for_language: bool,
}

/// A round that ended, won or not.
pub struct Ended {
    /// The level.
    pub level: Arc<Level>,
    /// How far it came.
    pub progress: Progress,
    /// How many played.
    pub players: usize,
    /// The round.
    pub replay: Replay,
}

impl Public {
    /// Every other time one of those that are shown beside those that come along, if it still goes as it went.
    pub(super) fn attraction(&self, number: usize) -> Option<Session> {
        let index = number / 2 % self.attractions.len().max(1);
        let replay = self.attractions.get(index).filter(|_| number % 2 == 1)?;
        Session::of_replay(replay.clone()).ok()
    }
}
