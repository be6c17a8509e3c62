//! Texts of the page in each language.

mod en;
mod ja;

pub use en::ENGLISH;
pub use ja::JAPANESE;

use crate::comparison_2004::{Strategies, Unexplained};
use crate::figures::{Basis, Dares, Figures, Reason, Switching};
use tamaire_play::Route;

/// Texts of the page.
pub struct Words {
    /// Code of the language.
    pub code: &'static str,
    /// Title of the page.
    pub title: &'static str,
    /// Range of days; empty without a visit.
    pub days: fn(&Figures) -> String,
    /// Text of a page without a visit.
    pub nothing: &'static str,
    /// Labels of the four numbers at the top of the page: visits, rounds, share that won, median time to the
    /// first win.
    pub numbers: [&'static str; 4],
    /// Text below a share, from a number and its total: `12 of 30`.
    pub of: fn(u64, u64) -> String,
    /// Replacement for a missing number.
    pub none: &'static str,
    /// Formats a time [s].
    pub time: fn(f64) -> String,
    /// Names of the results of a round: squeezed, shaved, a mix of both, not won.
    pub parts: [&'static str; 4],
    /// Name of a route.
    pub route: fn(Route) -> &'static str,
    /// Names of the first, second, third, and later rounds of a visit.
    pub tries: [&'static str; 4],
    /// Formats a number of rounds.
    pub rounds: fn(u64) -> String,
    /// Number of rounds of a level, and of rounds for each won round.
    pub level_rounds: fn(u64, Option<f64>) -> String,
    /// Comparison with the observations of 2004.
    pub reading: Reading,
    /// Plot of visits and rounds by hour.
    pub hours: Plot<fn(&Figures) -> String>,
    /// Legend of the plot by hour: visits, rounds.
    pub hour_series: [&'static str; 2],
    /// Plot of results by level.
    pub by_level: Plot<&'static str>,
    /// Plot of results by number of the round within its visit.
    pub by_try: Plot<&'static str>,
    /// Plot of the time to the first win.
    pub first_win: Plot<fn(&Figures) -> String>,
    /// Label of the median in the plot of the time to the first win. The argument is the median [s].
    pub median: fn(f64) -> String,
    /// Plot of rounds per visit.
    pub per_visit: Plot<fn(&Figures) -> String>,
    /// Plot of the routes of the first and the second win.
    pub switching: Plot<fn(&Switching) -> String>,
    /// Label of a bar in the plot of routes: route of the first win and number of visits.
    pub after: fn(Route, u64) -> String,
    /// Legend entry for visits without a second win.
    pub no_more: &'static str,
    /// Plot of rounds with a suggestion from the game.
    pub dares: Plot<fn(&Dares) -> String>,
    /// Legend of the plot of suggestions: won as suggested, won another way, not won.
    pub dare_parts: [&'static str; 3],
    /// Plot of the number of pieces.
    pub pieces: Plot<fn(&Figures) -> String>,
    /// Map of the hand positions, with the axes of a level in 2D. The arguments of the caption are the number
    /// of rounds, the time per round in the darkest cell [s] and the width of a cell [cm].
    pub hands: Plot<fn(u64, f64, f64) -> String>,
    /// Vertical axis of a map seen from above, and the sentence added to its caption.
    pub from_above: [&'static str; 2],
    /// Explanation for missing maps.
    pub no_hands: &'static str,
    /// Table of the best rounds.
    pub best: Plot<&'static str>,
    /// Columns of the table of best rounds: day, route, level, time, stand.
    pub best_columns: [&'static str; 5],
    /// Text before the id of a round that has no clip. The reason follows the id.
    pub no_clip: &'static str,
    /// Titles of the tables: stands, days, languages, events.
    pub tables: [&'static str; 4],
    /// Columns of the tables of stands and days: visits, rounds, share that won, median.
    pub columns: [&'static str; 4],
    /// Note on the number of rows left out of a table.
    pub more: fn(usize) -> String,
    /// Name of a language by its code; `None` if the code is unknown.
    pub language: fn(&str) -> Option<&'static str>,
    /// Name of an event by its kind; `None` if the kind is unknown.
    pub event: fn(&str) -> Option<&'static str>,
    /// Section on the data: title and sentences.
    pub basis: (&'static str, fn(&Basis) -> Vec<String>),
    /// Text before the list of rounds that were not counted, from their number.
    pub refused: fn(usize) -> String,
    /// Text for a reason why a round was not counted.
    pub reason: fn(Reason) -> &'static str,
    /// Footer.
    pub foot: &'static str,
}

/// Texts of a plot.
pub struct Plot<C> {
    /// Title.
    pub title: &'static str,
    /// Horizontal and vertical axis with their units.
    pub axes: [&'static str; 2],
    /// Caption.
    pub caption: C,
}

/// Texts of the comparison with the observations of 2004.
pub struct Reading {
    /// Title.
    pub title: &'static str,
    /// Observations of 2004.
    pub then: &'static str,
    /// Sentence on the strategies that appeared.
    pub strategies: fn(Strategies, &Figures) -> String,
    /// Sentence on whether visitors won without an explanation.
    pub unexplained: fn(Unexplained, &Figures) -> String,
    /// Sentence on whether winners tried another route; the first argument tells whether the data suffice.
    pub switching: fn(bool, &Figures) -> String,
    /// Text on what the logbooks cannot tell.
    pub unknown: &'static str,
}

/// Formats a share in percent; 0 if `all` is 0.
fn percent(some: u64, all: u64) -> String {
    format!("{:.0}", 100.0 * some as f64 / all.max(1) as f64)
}

/// Formats a share and its 95 % confidence interval in percent: share, lower limit, upper limit.
fn sure(some: u64, all: u64) -> [String; 3] {
    let [low, high] = crate::spread::interval(some, all);
    let percents = [some as f64 / all.max(1) as f64, low, high];
    percents.map(|share| format!("{:.0}", 100.0 * share))
}

/// Maximum number of hours that a caption names.
const MOST_HOURS: usize = 3;

/// Returns the hours in which most visits began, and the number of visits in each of them. Several hours are
/// returned only if they have the same number. `None` without a visit, and for more than [`MOST_HOURS`] hours.
fn busiest(figures: &Figures) -> Option<(Vec<usize>, u64)> {
    let most = figures.hours.iter().map(|hour| hour.visits).max();
    let most = most.filter(|most| *most > 0)?;
    let hours = figures.hours.iter().enumerate();
    let hours = hours.filter(|(_, of_it)| of_it.visits == most);
    let hours: Vec<usize> = hours.map(|(hour, _)| hour).collect();
    (hours.len() <= MOST_HOURS).then_some((hours, most))
}

/// Returns the number of rounds that ended in two pieces, and the number that ended in more than 128.
fn halves_and_dust(figures: &Figures) -> [u64; 2] {
    let of = |from: u32| {
        let bin = figures.pieces.iter().find(|bin| bin.from == from);
        bin.map_or(0, |bin| bin.rounds.all)
    };
    [of(2), of(129)]
}

/// Returns the number of visits with exactly one round, and the number with several.
fn once_and_often(figures: &Figures) -> [u64; 2] {
    let often = figures.rounds_per_visit.iter().skip(2).sum();
    [figures.rounds_per_visit.get(1).copied().unwrap_or(0), often]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Hour;

    #[test]
    fn up_to_three_hours_with_equally_many_visits_are_named() {
        let caption = |visits: [u64; 4]| {
            let mut figures = Figures::default();
            let hour = |visits| Hour {
                visits,
                ..Hour::default()
            };
            figures.hours = visits.map(hour).into();
            [&ENGLISH, &JAPANESE].map(|words| (words.hours.caption)(&figures))
        };
        let [english, japanese] = caption([1, 3, 2, 0]);
        assert!(
            english.ends_with(" The busiest hour had 3 visits, beginning between 1:00 and 2:00.")
        );
        assert!(japanese.ends_with("来場が最も多かったのは1時台で、3組でした。"));
        let [english, japanese] = caption([2, 1, 2, 0]);
        assert!(
            english.ends_with(" The busiest hours began at 0:00 and 2:00, with 2 visits each."),
            "{english}"
        );
        assert!(japanese.ends_with("来場が最も多かったのは0時台と2時台で、それぞれ2組でした。"));
        let [english, japanese] = caption([1, 0, 1, 1]);
        let expected = " The busiest hours began at 0:00, 2:00 and 3:00, with 1 visit each.";
        assert!(english.ends_with(expected), "{english}");
        assert!(
            japanese.ends_with("来場が最も多かったのは0時台、2時台、3時台で、それぞれ1組でした。")
        );
        for visits in [[0; 4], [5; 4]] {
            let [english, japanese] = caption(visits);
            assert!(english.ends_with("in which they began."), "{english}");
            assert!(japanese.ends_with("ラウンドの数です。"));
        }
    }
}
