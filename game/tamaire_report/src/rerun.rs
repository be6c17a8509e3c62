//! Running a recorded round again.

use crate::figures::Reason;
use crate::room::Grid;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;
use tamaire_logbook::Round;
use tamaire_play::level::LevelError;
use tamaire_play::link::LinkError;
use tamaire_play::{Outcome, Playback, Replay, ReplayError};

/// Duration of a tick [s].
pub const TICK: f64 = 1.0 / 60.0;
/// Tolerance when playing times are compared [s]. The time in a row was stored in single precision.
const SAME_TIME: f64 = 0.05;

/// Result of running a replay again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rerun {
    /// The replay reproduced its recorded hashes. Holds the final state.
    Ran(RerunResult),
    /// The replay diverged from its recorded hashes. Holds the reason.
    Astray(String),
    /// The replay cannot be decoded. Holds the reason.
    Unreadable(String),
    /// The replay has rules or a level that this program does not have. Holds the reason.
    Foreign(String),
}

/// Final state of a replay.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RerunResult {
    level: String,
    level_hash: u64,
    ticks: u64,
    outcome: Option<Outcome>,
    kept: f32,
    inside: f32,
    pieces: usize,
    /// Whether the replay has the maximum length, so that the round may have gone on after the end of the
    /// replay.
    is_cut: bool,
    /// Number of ticks that a hand spent in each cell of the level's [`Grid`].
    pub cells: Vec<(u16, u32)>,
}

impl Rerun {
    /// Runs the replay of a row, given as the text [`Round::replay`].
    pub fn of(fragment: &str) -> Self {
        let run = || match Replay::of_fragment(fragment) {
            Ok(replay) => run(replay),
            Err(error) => Self::of_error(&error),
        };
        // A hostile replay may get past all checks and cause a panic, which must not stop the report.
        let result = std::panic::catch_unwind(run);
        result.unwrap_or_else(|_| Self::Unreadable("the replay makes the simulation panic".into()))
    }

    /// Returns the reason for not counting `row`, whose replay gave this result; `None` if the row counts.
    pub fn objection(&self, row: &Round) -> Option<(Reason, String)> {
        match self {
            Self::Ran(ran) => ran.difference(row).map(|what| (Reason::Differs, what)),
            Self::Astray(why) => Some((Reason::Astray, why.clone())),
            Self::Unreadable(why) => Some((Reason::Unreadable, why.clone())),
            Self::Foreign(_) => None,
        }
    }

    fn of_error(error: &LinkError) -> Self {
        let text = error.to_string();
        match error {
            LinkError::Newer
            | LinkError::LevelDiffers(_)
            | LinkError::Round(ReplayError::Version { .. }) => Self::Foreign(text),
            LinkError::Level(LevelError::Unknown { .. }) => Self::Foreign(text),
            _ => Self::Unreadable(text),
        }
    }
}

fn run(replay: Replay) -> Rerun {
    let (level, level_hash) = (replay.level.clone(), replay.level_hash.clone());
    let level_hash = u64::from_str_radix(&level_hash, 16).unwrap_or_default();
    let ticks = replay.ticks();
    let mut playback = match Playback::new(Arc::new(replay)) {
        Ok(playback) => playback,
        Err(error) => return Rerun::Unreadable(error.to_string()),
    };
    let grid = Grid::of(playback.round().level());
    let mut cells = BTreeMap::new();
    while !playback.is_over() {
        if let Err(error) = playback.step() {
            return Rerun::Astray(error.to_string());
        }
        for hand in playback.round().hands() {
            *cells.entry(grid.cell_at(hand.position) as u16).or_default() += 1;
        }
    }
    let progress = playback.round().progress();
    Rerun::Ran(RerunResult {
        level,
        level_hash,
        ticks: ticks as u64,
        outcome: progress.outcome,
        kept: progress.kept,
        inside: progress.inside,
        pieces: progress.pieces,
        is_cut: ticks >= tamaire_play::round::MAX_TICKS,
        cells: cells.into_iter().collect(),
    })
}

impl RerunResult {
    /// Returns the first difference between a row and the replay.
    fn difference(&self, row: &Round) -> Option<String> {
        let told = |what: &str, row: String, run: String| {
            (row != run).then(|| format!("{what}: {row} in the row, {run} in the replay"))
        };
        let number = |k: f32| format!("{k:.4}");
        let won = self.outcome.as_ref();
        let route = |route: Option<_>| format!("{route:?}").to_lowercase();
        let hash = |hash: u64| format!("{hash:016x}");
        let level = row.level.rsplit(['/', '\\']).next().unwrap_or_default();
        let level = level.strip_suffix(".toml").unwrap_or(level);
        let mut differences = vec![
            told("level_hash", hash(row.level_hash), hash(self.level_hash)),
            told(
                "level",
                level.chars().take(200).collect(),
                self.level.clone(),
            ),
            told("route", route(row.route), route(won.map(|won| won.route))),
        ];
        if !self.is_cut {
            let seconds = self.ticks as f64 * TICK;
            let is_off = (f64::from(row.seconds) - seconds).abs() > SAME_TIME;
            let both = || (format!("{:.2}", row.seconds), format!("{seconds:.2}"));
            differences.push(
                is_off
                    .then(both)
                    .and_then(|(row, run)| told("seconds", row, run)),
            );
            let pieces = won.map_or(self.pieces, |won| won.pieces).to_string();
            let inside = won.map_or(self.inside, |won| won.inside);
            let kept = won.map_or(self.kept, |won| won.kept);
            differences.extend([
                told("pieces", row.pieces.to_string(), pieces),
                told("inside", number(row.inside), number(inside)),
                told("kept", number(row.kept), number(kept)),
                won.and_then(|won| told("lost", row.lost.to_string(), won.lost.to_string())),
            ]);
        }
        differences.into_iter().flatten().next()
    }
}
