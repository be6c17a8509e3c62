//! Best results of the players, by level.

use crate::game::is_made_here;
use crate::sift::sift;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use tamaire_play::{Joints, Level, Outcome, Route, Wish};

/// Results in all levels, by level id. A level that was made here can change and keeps its id, so its results belong to a
/// version: the key is the id and the hash of the content. Results of older programs have the id alone.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Records(BTreeMap<String, Record>);

/// Results in a level.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Record {
    /// Shortest time by route [ticks], without assists.
    pub best: BTreeMap<Route, u64>,
    /// Shortest time by route [ticks], with assists.
    pub best_assisted: BTreeMap<Route, u64>,
    /// Shortest time by route [ticks] in rounds in which time ran back, without assists.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub best_rewound: BTreeMap<Route, u64>,
    /// Wishes of the level that were fulfilled.
    pub wishes: BTreeSet<WishName>,
}

/// Name of a wish, made from its conditions and independent of its index in the level.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(from = "Written")]
pub struct WishName(String);

/// Wish in a file: a name, or an index in the old format.
#[derive(Deserialize)]
#[serde(untagged)]
enum Written {
    Place(usize),
    Name(String),
}

impl From<Written> for WishName {
    fn from(written: Written) -> Self {
        Self(match written {
            Written::Place(index) => index.to_string(),
            Written::Name(name) => name,
        })
    }
}

impl WishName {
    /// Returns the name of a wish.
    pub fn of(wish: &Wish) -> Self {
        let route = wish.route.map(|route| match route {
            Route::Squeeze => "squeeze".to_string(),
            Route::Shave => "shave".to_string(),
            Route::Mix => "mix".to_string(),
        });
        let parts = [
            route,
            wish.seconds.map(|most| format!("within {most} s")),
            wish.kept.map(|least| format!("keep {least}")),
            wish.pieces.map(|least| format!("{least} pieces")),
            wish.max_pieces.map(|most| format!("at most {most} pieces")),
            wish.joints.map(|joints| match joints {
                Joints::Whole => "joints whole".into(),
                Joints::Broken => "joints broken".into(),
            }),
            (!wish.whole.is_empty()).then(|| format!("whole {:?}", wish.whole)),
            wish.inside.map(|least| format!("inside {least}")),
        ];
        Self(parts.into_iter().flatten().collect::<Vec<_>>().join(", "))
    }
}

impl Record {
    /// Returns whether the level was won.
    pub fn is_won(&self) -> bool {
        let all = [&self.best, &self.best_assisted, &self.best_rewound];
        all.into_iter().any(|best| !best.is_empty())
    }

    /// Returns the shortest time [ticks], and whether the level was won with the whole body; `None` before a win.
    pub fn shortest(&self) -> Option<(u64, bool)> {
        let all = [&self.best, &self.best_assisted, &self.best_rewound];
        let all = || all.into_iter().flatten();
        let is_whole = all().any(|(route, _)| *route == Route::Squeeze);
        Some((all().map(|(_, ticks)| *ticks).min()?, is_whole))
    }

    /// Merges the better results of another record of the same level into this record.
    fn take(&mut self, other: Self) {
        for (route, ticks) in other.best {
            lower(&mut self.best, route, ticks);
        }
        for (route, ticks) in other.best_assisted {
            lower(&mut self.best_assisted, route, ticks);
        }
        for (route, ticks) in other.best_rewound {
            lower(&mut self.best_rewound, route, ticks);
        }
        self.wishes.extend(other.wishes);
    }
}

/// Separator between the id of a level and the hash of its content.
const VERSION: char = '@';

/// Returns the key of the results in a level.
fn key_of(level: &Level) -> String {
    match is_made_here(&level.id) {
        true => format!("{}{VERSION}{:016x}", level.id, level.content_hash()),
        false => level.id.clone(),
    }
}

/// Lowers the best time of a route to `ticks` if `ticks` is shorter. Returns whether the time was lowered.
fn lower(best: &mut BTreeMap<Route, u64>, route: Route, ticks: u64) -> bool {
    let known = best.entry(route).or_insert(u64::MAX);
    let is_better = ticks < *known;
    *known = ticks.min(*known);
    is_better
}

impl Records {
    /// Reads records from TOML. Also returns a description of each entry that could not be used.
    pub fn read(text: &str) -> (Self, Vec<String>) {
        let sifted = sift::<Self>(text);
        (sifted.value, sifted.refused)
    }

    /// Returns the records as TOML.
    pub fn text(&self) -> String {
        toml::to_string(self).expect("all fields can be written as TOML")
    }

    /// Returns the results in a level that cannot change, given by its id.
    pub fn of(&self, level: &str) -> Option<&Record> {
        self.0.get(level)
    }

    /// Returns the results in a level as it is now.
    pub fn of_level(&self, level: &Level) -> Option<&Record> {
        let version = self.0.get(&key_of(level));
        // Without results of any version, those of an older program count.
        let older = || match self.has_version(&level.id) {
            true => None,
            false => self.0.get(&level.id),
        };
        version.or_else(older)
    }

    /// Whether there are results of a version of a level, given by its id.
    fn has_version(&self, id: &str) -> bool {
        let first = format!("{id}{VERSION}");
        let mut later = self.0.range(first.clone()..);
        later.next().is_some_and(|(key, _)| key.starts_with(&first))
    }

    /// Notes that `level` replaces `before`, or is new. Results of an older program are assigned to `before`.
    pub fn change(&mut self, before: Option<&Level>, level: &Level) {
        if !self.0.contains_key(&level.id) {
            return;
        }
        if let Some(before) = before {
            self.assign_older(before);
        }
        self.0.entry(key_of(level)).or_default();
    }

    /// Assigns results of an older program to a version of a level, if they belong to none yet.
    fn assign_older(&mut self, level: &Level) {
        if !self.has_version(&level.id)
            && let Some(older) = self.0.get(&level.id).cloned()
        {
            self.0.insert(key_of(level), older);
        }
    }

    /// Records a win and returns whether it is the fastest win in its level by its route. `rewinds` is the number of
    /// times that time ran back in the round. A win with assists is only compared with other assisted wins, and it
    /// fulfils no wishes. A win with rewinds is only compared with other such wins.
    pub fn note(&mut self, level: &Level, outcome: &Outcome, rewinds: u32) -> bool {
        self.assign_older(level);
        let record = self.0.entry(key_of(level)).or_default();
        if !level.game().assists.is_empty() {
            return lower(&mut record.best_assisted, outcome.route, outcome.ticks);
        }
        let wishes = level.game().wish.iter();
        let fulfilled = wishes.filter(|wish| outcome.fulfils(wish));
        record.wishes.extend(fulfilled.map(WishName::of));
        let best = match rewinds {
            0 => &mut record.best,
            _ => &mut record.best_rewound,
        };
        lower(best, outcome.route, outcome.ticks)
    }

    /// Merges the better results of `others` into these records.
    pub fn take(&mut self, others: Self) {
        for (level, record) in others.0 {
            self.0.entry(level).or_default().take(record);
        }
    }

    /// Converts records of older versions: wishes of `levels` from indices to names, and keys of level files
    /// from paths to file names.
    pub fn by_name<'a>(self, levels: impl Iterator<Item = &'a Level>) -> Self {
        let mut named = Self::default();
        for (id, record) in self.0 {
            let name = id.rsplit(['/', '\\']).next();
            // Only a level file has an extension in its name. A key without an extension is the id of a
            // built-in level and stays unchanged.
            let name = name.filter(|name| name.contains('.')).unwrap_or(&id);
            named.0.entry(name.into()).or_default().take(record);
        }
        named.wishes_by_name(levels)
    }

    fn wishes_by_name<'a>(mut self, levels: impl Iterator<Item = &'a Level>) -> Self {
        for level in levels {
            let Some(record) = self.0.get_mut(&level.id) else {
                continue;
            };
            for (index, wish) in level.game().wish.iter().enumerate() {
                if record.wishes.remove(&WishName(index.to_string())) {
                    record.wishes.insert(WishName::of(wish));
                }
            }
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome() -> Outcome {
        Outcome {
            ticks: 900,
            route: Route::Squeeze,
            kept: 1.0,
            inside: 0.9,
            pieces: 1,
            lost: 0,
            broken: 0,
            torn: 0,
        }
    }

    #[test]
    fn records_keep_best_time_of_each_route_and_wishes() {
        let level = Level::open("classic").unwrap();
        let mut outcome = outcome();
        let mut records = Records::default();
        assert!(records.note(&level, &outcome, 0));
        outcome.ticks = 1000;
        assert!(!records.note(&level, &outcome, 0));
        outcome.route = Route::Shave;
        assert!(records.note(&level, &outcome, 0));
        let (read, refused) = Records::read(&records.text());
        assert_eq!((&read, refused.len()), (&records, 0));
        let record = read.of("classic").unwrap();
        assert_eq!(record.best[&Route::Squeeze], 900);
        assert!(record.wishes.len() >= 2, "{}", records.text());
    }

    #[test]
    fn wish_name_is_made_from_conditions() {
        let level = Level::open("classic").unwrap();
        let wishes = &level.game().wish;
        let names: BTreeSet<WishName> = wishes.iter().map(WishName::of).collect();
        assert_eq!(
            names.len(),
            wishes.len(),
            "each wish has its own name: {names:?}"
        );
        let wish = Wish {
            seconds: Some(20.0),
            kept: Some(0.9),
            route: Some(Route::Squeeze),
            ..Wish::default()
        };
        assert_eq!(WishName::of(&wish).0, "squeeze, within 20 s, keep 0.9");
        let (old, refused) = Records::read("[classic]\nwishes = [0, 2, 77]\n");
        assert!(refused.is_empty(), "{refused:?}");
        let names = old.by_name([&level].into_iter());
        let names = names.of("classic").unwrap().wishes.clone();
        let wanted = [
            WishName::of(&wishes[0]),
            WishName::of(&wishes[2]),
            WishName("77".into()),
        ];
        assert_eq!(names, wanted.into());
    }

    #[test]
    fn records_take_keeps_better_results() {
        let read = |text| Records::read(text).0;
        let mut mine = read("[a]\nwishes = [\"x\"]\nbest = { squeeze = 10, shave = 50 }\n");
        mine.take(read(
            "[a]\nwishes = [\"y\"]\nbest = { squeeze = 20, shave = 40 }\n[b]\nbest = { mix = 1 }\n",
        ));
        let both = "[b]\nbest = { mix = 1 }\n[a]\nwishes = [\"y\", \"x\"]\nbest = { squeeze = 10, shave = 40 }\n";
        assert_eq!(mine, read(both));
    }

    #[test]
    fn records_by_name_drops_folders_of_level_files() {
        let text = "[\"/home/me/own.toml\"]\nbest = { mix = 9 }\n['C:\\me\\own.toml']\nbest = { mix = 8 }\n['/me/classic']\n";
        let records = Records::read(text).0.by_name(std::iter::empty());
        assert_eq!(records.of("own.toml").unwrap().best[&Route::Mix], 8);
        assert_eq!((records.0.len(), records.of("classic")), (2, None));
    }

    #[test]
    fn records_read_drops_only_invalid_entries() {
        let text =
            "[a]\nbest = { squeeze = 10, fly = 3, mix = -1 }\n[b]\nbest = 7\nwishes = [\"x\"]\n";
        let (records, refused) = Records::read(text);
        assert_eq!(refused.len(), 3, "{refused:?}");
        assert_eq!(records.of("a").unwrap().best[&Route::Squeeze], 10);
        assert_eq!(records.of("b").unwrap().wishes.len(), 1);
    }

    #[test]
    fn results_of_an_older_program_stay_with_the_version_before() {
        let version = |gravity: f32| {
            let mut scene = Level::open("classic").unwrap().scene().clone();
            scene.gravity[1] = gravity;
            scene.game.as_mut().unwrap().name.en = format!("{gravity}");
            Level::from_scene("my-level-1", scene).unwrap()
        };
        let [first, second] = [-2.0, -3.0].map(version);
        let (mut records, _) = Records::read("[my-level-1]\nbest = { squeeze = 900 }\n");
        assert_eq!(
            records.of_level(&second).unwrap().best[&Route::Squeeze],
            900
        );
        let mut won_again = records.clone();
        let slower = Outcome {
            ticks: 1200,
            ..outcome()
        };
        assert!(!won_again.note(&first, &slower, 0));
        assert_eq!(
            won_again.of_level(&first).unwrap().shortest(),
            Some((900, true))
        );
        records.change(Some(&first), &second);
        assert_eq!(
            records.of_level(&first).unwrap().shortest(),
            Some((900, true))
        );
        assert!(!records.of_level(&second).unwrap().is_won());
        assert!(records.note(&second, &outcome(), 0));
        records.change(Some(&second), &first);
        // A merge with what was written before changes nothing.
        let (mut merged, refused) = Records::read("[my-level-1]\nbest = { squeeze = 900 }\n");
        merged.take(records.clone());
        assert!(refused.is_empty());
        assert_eq!(merged, records);
        assert_eq!(Records::read(&records.text()).0, records);
        // A name is no part of the content.
        let mut renamed = first.scene().clone();
        renamed.game.as_mut().unwrap().name.en = "other".into();
        let renamed = Level::from_scene("my-level-1", renamed).unwrap();
        assert_eq!(records.of_level(&renamed), records.of_level(&first));
    }
}
