//! What became of a visit, from its rounds.

use tamaire_play::Route;

/// What is kept of a round until its visit is told.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Play {
    /// The place of its visit.
    pub visit: u32,
    /// Which of its visit it was.
    pub number: u32,
    /// When it began [ms].
    pub began_ms: i64,
    /// How long it was played [s].
    pub seconds: f32,
    /// How it was won, if it was.
    pub route: Option<Route>,
    /// The route that was suggested before it.
    pub dare: Option<Route>,
}

/// What became of a visit.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Story {
    /// Rounds.
    pub rounds: u64,
    /// Rounds that were won.
    pub wins: u64,
    /// The route of the first win.
    pub first: Option<Route>,
    /// For how long was played up to the first win [s].
    pub to_first_win: Option<f64>,
    /// The route of the next win.
    pub next: Option<Route>,
    /// Whether a route was suggested between those two wins.
    pub is_next_dared: bool,
    /// Whether a route was suggested at all.
    pub is_dared: bool,
    /// Whether a round was won as was suggested before it.
    pub is_won_as_dared: bool,
    /// Whether a round began, by the clock, before an earlier one did.
    pub is_clock_back: bool,
}

impl Story {
    /// The story of all rounds of a visit, in the order of their numbers.
    pub fn of(plays: &[Play]) -> Self {
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

    /// Whether the next win went another way than the first.
    pub fn is_switched(&self) -> bool {
        self.next.is_some() && self.next != self.first
    }
}
