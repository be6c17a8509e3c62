//! What is asked for.

use crate::Day;
use tamaire_play::Replay;

/// Makes an animated GIF of a round, a small one.
pub type Clip<'a> = &'a dyn Fn(&Replay) -> Result<Vec<u8>, String>;

/// What a report is to have.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// In which language the page is.
    pub language: Language,
    /// `visits.csv`, `rounds.csv` and `events.csv` beside the page.
    pub csv: bool,
    /// `report.json` beside the page: all figures.
    pub json: bool,
    /// The first day that counts. A visit is of the day on which it began, in the local time of its stand, with all that
    /// was played in it.
    pub from: Option<Day>,
    /// The last day that counts.
    pub to: Option<Day>,
    /// Whether all rounds are run again: what does not come out as it was written is not counted, and where hands moved is
    /// drawn. Rounds that were run again are kept in `reruns.jsonl` beside the page, so that a next time goes on there.
    pub rerun: bool,
}

/// The language of a page.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum Language {
    /// English.
    #[default]
    English,
    /// 日本語
    Japanese,
}

impl Language {
    /// All, with the names by which they are chosen.
    pub const NAMED: [(&'static str, Self); 2] = [("en", Self::English), ("ja", Self::Japanese)];
}

/// How far a report has come.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What is done.
    pub stage: Stage,
    /// So many of them are done.
    pub done: u64,
    /// So many there are, where that is known before.
    pub all: Option<u64>,
}

/// What is done for a report, in this order.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Visits are read.
    Visits,
    /// Rounds are run again.
    Rerun,
    /// Rounds are counted.
    Rounds,
    /// Clips are drawn.
    Clips,
}

impl Progress {
    pub(crate) fn of(stage: Stage, done: u64) -> Self {
        let all = None;
        Self { stage, done, all }
    }
}
