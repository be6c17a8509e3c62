//! A visit: the time between two idle phases of a stand.

use super::config::Config;
use crate::game::EndedRound;
use fuwafuwa::DEFAULT_TICK;
use tamaire_logbook::{Id, Moment, Round, RoundEnd};
use tamaire_play::Route;

/// A visit in progress.
#[derive(Clone, Debug)]
pub struct Visit {
    /// Unique identifier.
    pub id: Id,
    /// Start time.
    pub began: Moment,
    /// Whether the visit is in the logbook.
    pub is_noted: bool,
    /// Route that the game suggested to the visitor for the current round, if any.
    pub dare: Option<Route>,
    rounds: u32,
}

impl Visit {
    /// Begins a visit now.
    pub fn begin() -> Self {
        Self {
            id: Id::random(),
            began: Moment::now(),
            is_noted: false,
            dare: None,
            rounds: 0,
        }
    }

    /// Returns the logbook entry of a round. `end` is the reason why the round ended if it was not won.
    pub fn round(&mut self, config: &Config, ended: &EndedRound, end: RoundEnd) -> Round {
        self.rounds += 1;
        let (progress, won) = (&ended.progress, ended.progress.outcome);
        let seconds = ended.replay.ticks() as f32 * DEFAULT_TICK;
        Round {
            id: Id::random(),
            visit: self.id,
            stand: config.stand.0.clone(),
            number: self.rounds,
            began: Moment::now().after(-(1000.0 * seconds) as i64),
            seconds,
            level: ended.level.id.clone(),
            level_hash: ended.level.hash(),
            players: ended.players as u8,
            end: won.map_or(end, |_| RoundEnd::Won),
            route: won.map(|won| won.route),
            kept: won.map_or(progress.kept, |won| won.kept),
            inside: won.map_or(progress.inside, |won| won.inside),
            pieces: won.map_or(progress.pieces, |won| won.pieces) as u32,
            lost: won.map_or(0, |won| won.lost) as u32,
            dare: self.dare.take(),
            // Encoding cannot fail for a round that was just played, so the empty default is never used.
            replay: ended.replay.fragment().unwrap_or_default(),
        }
    }
}
