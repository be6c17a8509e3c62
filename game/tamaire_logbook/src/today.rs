//! What came of a day.

use serde::{Deserialize, Serialize};

/// What happened since a moment, by the clock.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Today {
    /// Visits that began.
    pub visits: u64,
    /// Rounds that began.
    pub rounds: u64,
    /// How many of them were won, by whatever route.
    pub wins: u64,
    /// Won whole.
    pub squeezed: u64,
    /// Won by shaving.
    pub shaved: u64,
    /// Won by some of both.
    pub mixed: u64,
    /// Rounds that were begun again before they were won.
    pub retries: u64,
    /// Half of the visits that won had played for so long, or less, when they first did [s]: their rounds up to and with that
    /// one. Nothing where none won.
    pub median_to_first_win: Option<f32>,
}
