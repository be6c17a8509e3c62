//! Options and progress of a report.

use crate::Day;
use tamaire_play::Replay;

/// Function that makes a small animated GIF of a round. If it fails, the page shows the error instead of the
/// clip.
pub type Clip<'a> = &'a dyn Fn(&Replay) -> Result<Vec<u8>, String>;

/// Options of a report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Language of the page.
    pub language: Language,
    /// Whether `visits.csv`, `rounds.csv` and `events.csv` are written beside the page.
    pub csv: bool,
    /// Whether `report.json`, which has all figures, is written beside the page.
    pub json: bool,
    /// First day to count. A visit counts with all of its rounds for the day on which it began, in the local
    /// time of its stand. `None` sets no limit.
    pub from: Option<Day>,
    /// Last day to count. `None` sets no limit.
    pub to: Option<Day>,
    /// Whether all rounds are run again. Rounds with another result than recorded are not counted, and the
    /// page shows the hand positions. The results are stored in `reruns.jsonl` beside the page, so that a
    /// later report runs only rounds without a stored result.
    pub rerun: bool,
}

/// Language of a page.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum Language {
    /// English.
    #[default]
    English,
    /// Japanese (日本語).
    Japanese,
}

impl Language {
    /// All languages with their codes on the command line.
    pub const NAMED: [(&'static str, Self); 2] = [("en", Self::English), ("ja", Self::Japanese)];
}

/// Progress of a report.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Current stage.
    pub stage: Stage,
    /// Number of finished items.
    pub done: u64,
    /// Total number of items, if known in advance.
    pub all: Option<u64>,
}

/// Stage of a report, in order.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Reading visits.
    Visits,
    /// Running rounds again.
    Rerun,
    /// Counting rounds.
    Rounds,
    /// Making clips.
    Clips,
}

impl Progress {
    pub(crate) fn of(stage: Stage, done: u64) -> Self {
        let all = None;
        Self { stage, done, all }
    }
}
