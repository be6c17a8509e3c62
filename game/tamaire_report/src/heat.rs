//! Maps of the hand positions by level.

use crate::figures::Heat;
use crate::rerun::{RerunResult, TICK};
use crate::room::{Grid, Stroke, strokes};
use crate::tally::LevelKey;
use std::collections::HashMap;
use tamaire_logbook::Round;
use tamaire_play::{Level, Replay};

/// Map of the hand positions for each level, summed over the rounds of the level.
#[derive(Debug, Default)]
pub struct Heats(HashMap<LevelKey, Sum>);

#[derive(Debug)]
struct Sum {
    rounds: u64,
    /// Number of ticks that a hand spent in each cell.
    ticks: Vec<u64>,
    level: Level,
}

impl Heats {
    /// Adds the hand positions of a round to the map of its level.
    pub fn add(&mut self, round: &Round, ran: &RerunResult) {
        let key = (round.level.clone(), round.level_hash);
        let sum = match self.0.get_mut(&key) {
            Some(sum) => sum,
            None => {
                let replay = Replay::of_fragment(&round.replay).ok();
                let Some(level) = replay.and_then(|replay| replay.level().ok()) else {
                    return;
                };
                let [columns, rows] = Grid::of(&level).counts;
                self.0.entry(key).or_insert(Sum {
                    rounds: 0,
                    ticks: vec![0; columns * rows],
                    level,
                })
            }
        };
        sum.rounds += 1;
        for &(cell, ticks) in &ran.cells {
            if let Some(sum) = sum.ticks.get_mut(usize::from(cell)) {
                *sum += u64::from(ticks);
            }
        }
    }

    /// Removes the map of a level, and returns it with the objects of the level's room.
    pub fn take(&mut self, name: &str, hash: &str) -> Option<(Heat, Vec<Stroke>)> {
        let hash = u64::from_str_radix(hash, 16).ok()?;
        let sum = self.0.remove(&(name.into(), hash))?;
        let grid = Grid::of(&sum.level);
        let seconds = sum.ticks.iter().map(|&ticks| ticks as f64 * TICK);
        let heat = Heat {
            rounds: sum.rounds,
            axes: grid.axes,
            low: grid.low,
            cell: grid.cell,
            columns: grid.counts[0],
            seconds: seconds.map(crate::spread::thousandth).collect(),
        };
        Some((heat, strokes(sum.level)))
    }
}
