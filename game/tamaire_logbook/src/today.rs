//! Summary of a day.

use serde::{Deserialize, Serialize};

/// Counts of everything since a moment, by the clock.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Today {
    /// Visits that began.
    pub visits: u64,
    /// Rounds that began.
    pub rounds: u64,
    /// Number of those rounds that were won, by any route.
    pub wins: u64,
    /// Rounds won by squeezing the whole body in.
    pub squeezed: u64,
    /// Won by shaving.
    pub shaved: u64,
    /// Rounds won by a mix of both.
    pub mixed: u64,
    /// Rounds that were restarted before they were won.
    pub retries: u64,
    /// Median time to the first win of a visit [s]: the seconds of its rounds up to and including the first
    /// won one. For an even count, the lower of the two middle values. `None` if no visit won.
    pub median_to_first_win: Option<f32>,
}
