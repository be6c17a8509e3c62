//! What players reached, by level.

use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use tamaire_play::{Level, Outcome, Route};

/// What was reached in all levels, by their ids.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Records(BTreeMap<String, Record>);

/// What was reached in a level.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Record {
    /// Fewest ticks by each route.
    pub best: BTreeMap<Route, u64>,
    /// Which of the level's wishes came true, by their place.
    pub wishes: BTreeSet<usize>,
}

impl Records {
    /// What was reached in a level.
    pub fn of(&self, level: &str) -> Option<&Record> {
        self.0.get(level)
    }

    /// Takes note of a win; says whether it was faster than any before by that route.
    pub fn note(&mut self, level: &Level, outcome: &Outcome) -> bool {
        let record = self.0.entry(level.id.clone()).or_default();
        let wishes = level.game().wish.iter().enumerate();
        let fulfilled = wishes.filter(|(_, wish)| outcome.fulfils(wish));
        record.wishes.extend(fulfilled.map(|(place, _)| place));
        let best = record.best.entry(outcome.route).or_insert(u64::MAX);
        let is_better = outcome.ticks < *best;
        *best = outcome.ticks.min(*best);
        is_better
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_of_each_route_and_every_wish_is_kept() {
        let level = Level::open("classic").unwrap();
        let mut outcome = Outcome {
            ticks: 900,
            route: Route::Squeeze,
            kept: 1.0,
            inside: 0.9,
            pieces: 1,
            lost: 0,
        };
        let mut records = Records::default();
        assert!(records.note(&level, &outcome));
        outcome.ticks = 1000;
        assert!(!records.note(&level, &outcome));
        outcome.route = Route::Shave;
        assert!(records.note(&level, &outcome));
        let text = toml::to_string(&records).unwrap();
        let read: Records = toml::from_str(&text).unwrap();
        let record = read.of("classic").unwrap();
        assert_eq!(record.best[&Route::Squeeze], 900);
        assert!(record.wishes.len() >= 2, "{text}");
    }
}
