//! Summary of a day.

use serde::{Deserialize, Serialize};

/// Counts of the visits and rounds that began at a given moment or later, by the clock.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Today {
    /// Visits that began.
    pub visits: u64,
    /// Rounds that began.
    pub rounds: u64,
    /// Rounds that were won, by any route.
    pub wins: u64,
    /// Rounds won by squeezing the whole body in.
    pub squeezed: u64,
    /// Rounds won by shaving bits off the body.
    pub shaved: u64,
    /// Rounds won by a mix of squeezing and shaving.
    pub mixed: u64,
    /// Rounds that were restarted before they were won.
    pub retries: u64,
    /// Median playing time to the first win of a visit, including the rounds before the win [s]. For an even
    /// count, the lower of the two middle values. `None` if no visit won.
    pub median_to_first_win: Option<f32>,
}
