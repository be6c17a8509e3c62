//! Summary of a visit from its rounds.

use tamaire_play::Route;

/// Values of a round that the summary of its visit needs.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RoundSummary {
    /// Index of the visit.
    pub visit: u32,
    /// Number of the round within the visit, from 1.
    pub number: u32,
    /// Time at which the round began [ms of UTC].
    pub began_ms: i64,
    /// Playing time [s].
    pub seconds: f32,
    /// Route by which the round was won, if it was.
    pub route: Option<Route>,
    /// Route suggested before the round.
    pub dare: Option<Route>,
}

/// Summary of a visit.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct VisitSummary {
    /// Number of rounds.
    pub rounds: u64,
    /// Number of won rounds.
    pub wins: u64,
    /// Route of the first win.
    pub first: Option<Route>,
    /// Playing time up to the first win [s].
    pub to_first_win: Option<f64>,
    /// Route of the second win.
    pub next: Option<Route>,
    /// Whether a route was suggested between the first and the second win.
    pub is_next_dared: bool,
    /// Whether a route was suggested in any round.
    pub is_dared: bool,
    /// Whether a round was won by the route suggested before it.
    pub is_won_as_dared: bool,
    /// Whether a round began, by the clock, before the round preceding it.
    pub is_clock_back: bool,
}

impl VisitSummary {
    /// Returns the summary of all rounds of a visit, which must be sorted by number.
    pub fn of(plays: &[RoundSummary]) -> Self {
        let mut story = Self::default();
        let mut played = 0.0;
        let mut dared_since = false;
        for play in plays {
            story.rounds += 1;
            played += f64::from(play.seconds);
            story.is_dared |= play.dare.is_some();
            dared_since |= play.dare.is_some();
            let Some(route) = play.route else {
                continue;
            };
            story.wins += 1;
            story.is_won_as_dared |= play.dare == Some(route);
            match (story.first, story.next) {
                (None, _) => {
                    (story.first, story.to_first_win) = (Some(route), Some(played));
                    dared_since = false;
                }
                (Some(_), None) => {
                    (story.next, story.is_next_dared) = (Some(route), dared_since);
                }
                _ => {}
            }
        }
        let mut pairs = plays.windows(2);
        story.is_clock_back = pairs.any(|pair| pair[1].began_ms < pair[0].began_ms);
        story
    }

    /// Returns whether the second win took another route than the first.
    pub fn is_switched(&self) -> bool {
        self.next.is_some() && self.next != self.first
    }
}
