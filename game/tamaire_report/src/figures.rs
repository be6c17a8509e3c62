//! All that a report knows: the figures of `report.json`, described in `docs/report.md`. Their names stay as they are.

use crate::Day;
use serde::Serialize;
use tamaire_logbook::Id;
use tamaire_play::Route;

/// Number of the format of `report.json`. It changes when a name goes or means something else.
pub const FORMAT: u32 = 1;

/// All figures.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Figures {
    /// [`FORMAT`].
    pub format: u32,
    /// The number of the rules by which this program plays: [`tamaire_play::replay::VERSION`].
    pub rules: u32,
    /// The first day that was asked for.
    pub from: Option<Day>,
    /// The last day that was asked for.
    pub to: Option<Day>,
    /// The day of the first visit that counts.
    pub first_day: Option<Day>,
    /// The day of the last visit that counts.
    pub last_day: Option<Day>,
    /// Everything together.
    pub total: Totals,
    /// The same for each stand, by name.
    pub stands: Vec<StandTotals>,
    /// The same for each day on which there was a visit.
    pub days: Vec<DayTotals>,
    /// Visits by the language that was shown last.
    pub languages: Vec<Count>,
    /// What began in each hour of the day, from midnight on, in the local time of its stand.
    pub hours: Vec<Hour>,
    /// Each level that was played, the one with most rounds first.
    pub levels: Vec<LevelFigures>,
    /// Rounds by which of their visit they were: first, second, third, fourth or later.
    pub tries: Vec<Wins>,
    /// Visits by how many rounds they had: 0, 1, 2 … and in the last place, 20, as many or more.
    pub rounds_per_visit: Vec<u64>,
    /// How long it took to win for the first time.
    pub to_first_win: Times,
    /// By which route a visit won for the first and for the second time.
    pub switching: Switching,
    /// Rounds before which the other route was suggested.
    pub dares: Dares,
    /// Rounds by the number of pieces at their end.
    pub pieces: Vec<Pieces>,
    /// How rounds ended.
    pub ends: Vec<Count>,
    /// The fastest win by each route of each day.
    pub best: Vec<Best>,
    /// Events by kind.
    pub events: Vec<Count>,
    /// What the figures rest on.
    pub basis: Basis,
}

/// Visits, rounds and wins.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Totals {
    /// Visits.
    pub visits: u64,
    /// Visits with a round.
    pub visits_played: u64,
    /// Visits with a round that was won.
    pub visits_won: u64,
    /// How many of all visits that is, 0 to 1; nothing without a visit.
    pub share_won: Option<f64>,
    /// Rounds, and how they were won.
    pub rounds: Wins,
    /// Half of the visits that won had played for so long, or less, when they first did [s].
    pub median_to_first_win: Option<f64>,
}

/// Those of one stand.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StandTotals {
    /// Its name.
    pub stand: String,
    /// What happened there.
    #[serde(flatten)]
    pub totals: Totals,
}

/// Those of one day.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DayTotals {
    /// The day on which the visits began.
    pub day: Day,
    /// What happened in them.
    #[serde(flatten)]
    pub totals: Totals,
}

/// Rounds, and how many of them were won by which route; the others were not won.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Wins {
    /// All, won or not.
    pub all: u64,
    /// Won whole.
    pub squeeze: u64,
    /// Won by shaving.
    pub shave: u64,
    /// Won by some of both.
    pub mix: u64,
}

/// How many of a kind there are.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Count {
    /// Which kind.
    pub name: String,
    /// How many.
    pub count: u64,
}

/// What began in an hour of the day.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Hour {
    /// Visits.
    pub visits: u64,
    /// Rounds.
    pub rounds: u64,
}

/// What was played in a level.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelFigures {
    /// Its name, as it stands in the logbooks.
    pub level: String,
    /// Its hash, in hexadecimal: the same level made easier has another one.
    pub level_hash: String,
    /// Rounds.
    pub rounds: Wins,
    /// Half of its rounds that were won took so long, or less [s].
    pub median_win: Option<f64>,
    /// Where hands were, if its rounds were run again.
    pub hands: Option<Heat>,
}

/// Where hands were: the room of a level in square cells.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Heat {
    /// How many rounds this is of.
    pub rounds: u64,
    /// The axis across and the axis up the map: x and y in the plane; in space, seen from above, x and z.
    pub axes: [usize; 2],
    /// Least coordinates of the room along them [m].
    pub low: [f32; 2],
    /// Width of a cell [m].
    pub cell: f32,
    /// Number of cells along the first axis.
    pub columns: usize,
    /// For how long a hand was in each cell, all rounds together [s]: row by row along the first axis, the least
    /// coordinates first.
    pub seconds: Vec<f64>,
}

/// How long it took.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Times {
    /// Of how many visits this is known.
    pub visits: u64,
    /// A tenth took so long, or less; a quarter; half; three quarters; nine tenths [s].
    pub quantiles: Option<[f64; 5]>,
    /// Visits by time.
    pub bins: Vec<Bin>,
}

/// Visits that took at least and less than so long.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct Bin {
    /// At least so long [s].
    pub from: f64,
    /// Less than that [s]; for the last bin there is no limit.
    pub to: Option<f64>,
    /// How many visits.
    pub visits: u64,
}

/// The route of a visit's first win, and that of its next one.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Switching {
    /// By the route of the first win (squeeze, shave, mix): all visits that won so, and by which route they won next; the
    /// others did not win again.
    pub after: [Wins; 3],
    /// Visits whose next win went another way than the first.
    pub switched: u64,
    /// How many of them nobody had suggested it to, in a round after the first win and up to the next.
    pub switched_undared: u64,
}

/// What came of a suggestion to try the other route.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Dares {
    /// Rounds before which it was made.
    pub rounds: u64,
    /// Won as it was suggested.
    pub won_as_dared: u64,
    /// Won another way.
    pub won_otherwise: u64,
    /// Visits in which it was made.
    pub visits: u64,
    /// Visits that won as was suggested, in a round before which it was.
    pub visits_as_dared: u64,
}

/// Rounds that ended in so many pieces.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Pieces {
    /// At least so many.
    pub from: u32,
    /// At most so many; for the last there is no limit.
    pub to: Option<u32>,
    /// The rounds.
    pub rounds: Wins,
}

/// A fast win.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Best {
    /// The day of its visit.
    pub day: Day,
    /// By which route.
    pub route: Route,
    /// How long it took [s].
    pub seconds: f64,
    /// The round.
    pub round: Id,
    /// Its level.
    pub level: String,
    /// [`LevelFigures::level_hash`].
    pub level_hash: String,
    /// Its stand.
    pub stand: String,
}

/// What the figures rest on.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Basis {
    /// Logbooks that were read.
    pub files: u64,
    /// Rows that stood in one of them already.
    pub repeated_rows: u64,
    /// Visits without an end: they were cut off, or go on.
    pub visits_without_end: u64,
    /// Visits during which the clock went backwards.
    pub visits_with_clock_back: u64,
    /// Whether rounds were run again.
    pub is_rerun: bool,
    /// Rounds that came out as they were written.
    pub rerun: u64,
    /// Rounds that were counted although they could not be run again: they have no replay, or other rules or another level
    /// than this program.
    pub not_rerun: u64,
    /// Rounds that were not counted anywhere.
    pub refused: Vec<Refused>,
}

/// A round that was not counted.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Refused {
    /// Which.
    pub round: Id,
    /// Its stand.
    pub stand: String,
    /// Why.
    pub reason: Reason,
    /// More about it.
    pub detail: String,
}

/// Why a round was not counted.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// What it says of itself cannot all be true.
    Contradictory,
    /// Its replay cannot be read.
    Unreadable,
    /// Its replay goes another way than it was written.
    Astray,
    /// Its replay ends another way than its row says.
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

    /// Those that were won.
    pub fn won(&self) -> u64 {
        self.squeeze + self.shave + self.mix
    }

    /// By squeezing, by shaving, by both, and not won.
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
