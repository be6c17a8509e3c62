//! What the page says, in each language.

mod en;
mod ja;

pub use en::ENGLISH;
pub use ja::JAPANESE;

use crate::figures::{Basis, Dares, Figures, Reason, Switching};
use crate::reading::{Strategies, Unexplained};
use tamaire_play::Route;

/// What the page says.
pub struct Words {
    /// The code of the language.
    pub code: &'static str,
    /// The name of the page.
    pub title: &'static str,
    /// From when to when; nothing where there was no visit.
    pub days: fn(&Figures) -> String,
    /// Where nothing was found.
    pub nothing: &'static str,
    /// Visits, rounds, the share that wins, the median time to the first win.
    pub numbers: [&'static str; 4],
    /// So many of so many, below a number.
    pub of: fn(u64, u64) -> String,
    /// In place of a number that there is not.
    pub none: &'static str,
    /// A time [s].
    pub time: fn(f64) -> String,
    /// Squeezed, shaved, some of both, not won.
    pub parts: [&'static str; 4],
    /// The name of a route.
    pub route: fn(Route) -> &'static str,
    /// What rounds are called as the first, second, third, and later of a visit.
    pub tries: [&'static str; 4],
    /// So many rounds.
    pub rounds: fn(u64) -> String,
    /// The reading of 2004.
    pub reading: Reading,
    /// When people came: its title, its axes, its series and its caption.
    pub hours: Plot<fn(&Figures) -> String>,
    /// Visits and rounds, as they stand in a legend.
    pub hour_series: [&'static str; 2],
    /// How rounds ended, by level.
    pub by_level: Plot<&'static str>,
    /// How rounds ended, by try.
    pub by_try: Plot<&'static str>,
    /// How long until the first win.
    pub first_win: Plot<fn(&Figures) -> String>,
    /// What stands at the median.
    pub median: fn(f64) -> String,
    /// How many rounds visits had.
    pub per_visit: Plot<fn(&Figures) -> String>,
    /// First win and next win.
    pub switching: Plot<fn(&Switching) -> String>,
    /// What comes before the name of a route and the number of visits.
    pub after: fn(Route, u64) -> String,
    /// The part that did not win again.
    pub no_more: &'static str,
    /// What came of dares.
    pub dares: Plot<fn(&Dares) -> String>,
    /// Won as dared, won otherwise, not won.
    pub dare_parts: [&'static str; 3],
    /// How many pieces there were.
    pub pieces: Plot<fn(&Figures) -> String>,
    /// Where hands were; the axes are across and up in the plane. The caption tells how many rounds, for how long a hand was in
    /// the darkest cell in each [s], and how wide a cell is [cm].
    pub hands: Plot<fn(u64, f64, f64) -> String>,
    /// The vertical axis of a map that is seen from above, and what is said of it then.
    pub from_above: [&'static str; 2],
    /// Why there is no map.
    pub no_hands: &'static str,
    /// The best.
    pub best: Plot<&'static str>,
    /// The columns of its table: day, route, level, time, stand.
    pub best_columns: [&'static str; 5],
    /// What is said where no clip was made of a best round.
    pub no_clip: &'static str,
    /// Tables: stands, days, languages, events.
    pub tables: [&'static str; 4],
    /// The columns of tables: visits, rounds, share that won, median.
    pub columns: [&'static str; 4],
    /// What a table leaves out.
    pub more: fn(usize) -> String,
    /// A language by its code.
    pub language: fn(&str) -> Option<&'static str>,
    /// An event by its kind.
    pub event: fn(&str) -> Option<&'static str>,
    /// What the figures rest on: title and sentences.
    pub basis: (&'static str, fn(&Basis) -> Vec<String>),
    /// What comes before the list of rounds that do not count.
    pub refused: fn(usize) -> String,
    /// Why a round does not count.
    pub reason: fn(Reason) -> &'static str,
    /// What the last line says.
    pub foot: &'static str,
}

/// A plot: its title, its axes with their units, and its caption.
pub struct Plot<C> {
    /// Its title.
    pub title: &'static str,
    /// The horizontal axis and the vertical one.
    pub axes: [&'static str; 2],
    /// What is seen.
    pub caption: C,
}

/// The reading of 2004.
pub struct Reading {
    /// Its title.
    pub title: &'static str,
    /// What was seen in 2004.
    pub then: &'static str,
    /// Which strategies appeared.
    pub strategies: fn(Strategies, &Figures) -> String,
    /// Whether people won without an explanation.
    pub unexplained: fn(Unexplained, &Figures) -> String,
    /// Whether who had won tried another way; whether there are enough to tell.
    pub switching: fn(bool, &Figures) -> String,
    /// What the logbooks do not know.
    pub unknown: &'static str,
}

/// A share in percent; 0 where there is nothing.
fn percent(some: u64, all: u64) -> String {
    format!("{:.0}", 100.0 * some as f64 / all.max(1) as f64)
}

/// The share that wins in percent, and between which numbers it is 19 times of 20.
fn sure(some: u64, all: u64) -> [String; 3] {
    let [low, high] = crate::spread::interval(some, all);
    let percents = [some as f64 / all.max(1) as f64, low, high];
    percents.map(|share| format!("{:.0}", 100.0 * share))
}

/// The hour in which most visits began.
fn busiest(figures: &Figures) -> Option<(usize, u64)> {
    let hours = figures.hours.iter().enumerate();
    let most = hours.rev().max_by_key(|(_, hour)| hour.visits);
    most.map(|(hour, of_it)| (hour, of_it.visits))
        .filter(|(_, visits)| *visits > 0)
}

/// Rounds that ended in two pieces, and in more than 128.
fn halves_and_dust(figures: &Figures) -> [u64; 2] {
    let of = |from: u32| {
        let bin = figures.pieces.iter().find(|bin| bin.from == from);
        bin.map_or(0, |bin| bin.rounds.all)
    };
    [of(2), of(129)]
}

/// Visits with one round alone, and with several.
fn once_and_often(figures: &Figures) -> [u64; 2] {
    let often = figures.rounds_per_visit.iter().skip(2).sum();
    [figures.rounds_per_visit.get(1).copied().unwrap_or(0), often]
}
