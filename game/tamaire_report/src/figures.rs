//! All figures of a report, as written to `report.json` and described in `docs/report.md`. The names are a
//! file format and must not be changed.

use crate::Day;
use crate::spread::thousandth;
use serde::Serialize;
use tamaire_logbook::Id;
use tamaire_play::Route;

/// Version of the format of `report.json`. It changes when a name is removed or changes its meaning.
pub const FORMAT: u32 = 2;

/// All figures.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Figures {
    /// [`FORMAT`].
    pub format: u32,
    /// Version of the game's rules in this program, [`tamaire_play::replay::VERSION`].
    pub rules: u32,
    /// First day selected by the options.
    pub from: Option<Day>,
    /// Last day selected by the options.
    pub to: Option<Day>,
    /// Day of the first counted visit.
    pub first_day: Option<Day>,
    /// Day of the last counted visit.
    pub last_day: Option<Day>,
    /// Totals over all stands and days.
    pub total: Totals,
    /// Totals by stand, sorted by name.
    pub stands: Vec<StandTotals>,
    /// Totals by day, without days that had no visit.
    pub days: Vec<DayTotals>,
    /// Number of visits by the language shown last.
    pub languages: Vec<Count>,
    /// Visits and rounds by the hour in which they began, from midnight, in the local time of the stand.
    pub hours: Vec<Hour>,
    /// Figures of each level that was played, the one with most rounds first.
    pub levels: Vec<LevelFigures>,
    /// Rounds by their number within the visit: first, second, third, and fourth or later.
    pub tries: Vec<Wins>,
    /// Number of visits with 0, 1, 2 … rounds. The last entry, 20, includes visits with more rounds.
    pub rounds_per_visit: Vec<u64>,
    /// Playing time up to the first win.
    pub to_first_win: Times,
    /// Routes of a visit's first and second win.
    pub switching: Switching,
    /// Rounds before which the game suggested the other route.
    pub dares: Dares,
    /// Rounds by the number of pieces at their end.
    pub pieces: Vec<Pieces>,
    /// Number of rounds by ending.
    pub ends: Vec<Count>,
    /// Fastest win of each day by each route.
    pub best: Vec<Best>,
    /// Number of events by kind.
    pub events: Vec<Count>,
    /// Data on which the figures are based.
    pub basis: Basis,
}

/// Visits, rounds and wins.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Totals {
    /// Number of visits.
    pub visits: u64,
    /// Number of visits with at least one round.
    pub visits_played: u64,
    /// Number of visits with at least one won round.
    pub visits_won: u64,
    /// `visits_won` as a share of `visits`, 0 to 1; `None` without a visit.
    pub share_won: Option<f64>,
    /// Rounds by result.
    pub rounds: Wins,
    /// Median playing time to the first win, of visits with a win [s]. For an even count, the lower of the
    /// two middle values.
    pub median_to_first_win: Option<f64>,
}

/// Totals of a stand.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StandTotals {
    /// Name of the stand.
    pub stand: String,
    /// Totals of the stand.
    #[serde(flatten)]
    pub totals: Totals,
}

/// Totals of a day.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DayTotals {
    /// Day on which the visits began.
    pub day: Day,
    /// Totals of the visits.
    #[serde(flatten)]
    pub totals: Totals,
}

/// Number of rounds by the route of the win. The other rounds were not won.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Wins {
    /// All rounds, won or not.
    pub all: u64,
    /// Rounds won by squeezing the whole body in.
    pub squeeze: u64,
    /// Rounds won by shaving bits off the body.
    pub shave: u64,
    /// Rounds won by a mix of squeezing and shaving.
    pub mix: u64,
}

/// Number of items of a kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Count {
    /// Name of the kind.
    pub name: String,
    /// Number of items.
    pub count: u64,
}

/// Visits and rounds that began in an hour of the day.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Hour {
    /// Number of visits.
    pub visits: u64,
    /// Number of rounds.
    pub rounds: u64,
}

/// Figures of a level.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelFigures {
    /// Name of the level in the logbooks.
    pub level: String,
    /// Hash of the level in hexadecimal. It differs between a level and its easier variant.
    pub level_hash: String,
    /// Rounds by result.
    pub rounds: Wins,
    /// Rounds for each won round; `None` without a win.
    pub tries_per_win: Option<f64>,
    /// Median playing time of the level's won rounds [s]. For an even count, the lower of the two middle
    /// values.
    pub median_win: Option<f64>,
    /// Map of the hand positions, if rounds were run again.
    pub hands: Option<Heat>,
}

/// Map of the hand positions: time spent in each square cell of a level's room.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Heat {
    /// Number of rounds in the map.
    pub rounds: u64,
    /// Horizontal and vertical axis of the map: x and y in 2D; x and z in 3D, which is seen from above.
    pub axes: [usize; 2],
    /// Minimum coordinates of the room along `axes` [m].
    pub low: [f32; 2],
    /// Width of a cell [m].
    pub cell: f32,
    /// Number of cells along the first axis.
    pub columns: usize,
    /// Time that hands spent in each cell, summed over all rounds [s]. Row-major along the first axis,
    /// minimum coordinates first.
    pub seconds: Vec<f64>,
}

/// Distribution of the playing times to the first win.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Times {
    /// Number of visits with a win.
    pub visits: u64,
    /// Quantiles 0.1, 0.25, 0.5, 0.75 and 0.9 of the playing times [s].
    pub quantiles: Option<[f64; 5]>,
    /// Number of visits by time.
    pub bins: Vec<Bin>,
}

/// Number of visits whose time lies within two limits.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct Bin {
    /// Lower limit, inclusive [s].
    pub from: f64,
    /// Upper limit, exclusive [s]; `None` for the last bin.
    pub to: Option<f64>,
    /// Number of visits.
    pub visits: u64,
}

/// Routes of the first and the second win of visits.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Switching {
    /// One table for each route of the first win: squeeze, shave, mix. The table counts visits by the route of
    /// their second win; its field `all` includes visits that did not win again.
    pub after: [Wins; 3],
    /// Number of visits whose second win took another route than the first.
    pub switched: u64,
    /// Number of visits whose second win took another route than the first, without a suggestion from the
    /// game between these wins.
    pub switched_undared: u64,
}

/// Rounds and visits in which the game suggested the other route.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Dares {
    /// Number of rounds before which the game made the suggestion.
    pub rounds: u64,
    /// Number of rounds with a suggestion that were won by the suggested route.
    pub won_as_dared: u64,
    /// Number of rounds with a suggestion that were won by another route.
    pub won_otherwise: u64,
    /// Number of visits in which the game made the suggestion.
    pub visits: u64,
    /// Number of visits that won a round by the route suggested before that round.
    pub visits_as_dared: u64,
}

/// Rounds by the number of pieces at their end.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Pieces {
    /// Minimum number of pieces.
    pub from: u32,
    /// Maximum number of pieces; `None` for the last entry.
    pub to: Option<u32>,
    /// Rounds by result.
    pub rounds: Wins,
}

/// Fastest win of a day by one route.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Best {
    /// Day of the visit.
    pub day: Day,
    /// Route of the win.
    pub route: Route,
    /// Playing time [s].
    pub seconds: f64,
    /// Id of the round.
    pub round: Id,
    /// Name of the level.
    pub level: String,
    /// Hash of the level, as [`LevelFigures::level_hash`].
    pub level_hash: String,
    /// Name of the stand.
    pub stand: String,
}

/// Data on which the figures are based.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Basis {
    /// Number of logbooks read.
    pub files: u64,
    /// Number of rows whose id had been read already. Rows with the same id count once.
    pub repeated_rows: u64,
    /// Number of visits without an end: interrupted, or still going on.
    pub visits_without_end: u64,
    /// Number of visits during which the clock went backwards.
    pub visits_with_clock_back: u64,
    /// Whether rounds were run again.
    pub is_rerun: bool,
    /// Number of rounds that gave the recorded result when run again.
    pub rerun: u64,
    /// Number of rounds counted unchecked: without a replay, or with rules or a level that this program does
    /// not have.
    pub not_rerun: u64,
    /// Rounds that were not counted.
    pub refused: Vec<Refused>,
}

/// A round that was not counted.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Refused {
    /// Id of the round.
    pub round: Id,
    /// Name of the stand.
    pub stand: String,
    /// Reason why the round was not counted.
    pub reason: Reason,
    /// Details of the reason.
    pub detail: String,
}

/// Reason why a round was not counted.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// The values of the round's row contradict each other.
    Contradictory,
    /// The round's replay cannot be decoded.
    Unreadable,
    /// The round's replay diverges from the recorded hashes when run again.
    Astray,
    /// The result of the round's replay differs from the result in the round's row.
    Differs,
}

impl Wins {
    /// Counts a round.
    pub fn add(&mut self, route: Option<Route>) {
        self.all += 1;
        match route {
            Some(Route::Squeeze) => self.squeeze += 1,
            Some(Route::Shave) => self.shave += 1,
            Some(Route::Mix) => self.mix += 1,
            None => {}
        }
    }

    /// Returns the number of won rounds.
    pub fn won(&self) -> u64 {
        self.squeeze + self.shave + self.mix
    }

    /// Returns the number of rounds for each won round, to a thousandth; `None` without a win.
    pub fn tries_per_win(&self) -> Option<f64> {
        let won = self.won();
        (won > 0).then(|| thousandth(self.all as f64 / won as f64))
    }

    /// Returns the numbers of rounds won by squeezing, by shaving and by a mix of both, and of rounds not
    /// won.
    pub fn parts(&self) -> [u64; 4] {
        let lost = self.all.saturating_sub(self.won());
        [self.squeeze, self.shave, self.mix, lost]
    }
}

impl Serialize for Day {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
