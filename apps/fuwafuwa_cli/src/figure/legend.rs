//! What legends have in common.

use fuwafuwa_painter::{Role, Sample};

/// The levels of a legend.
pub fn level_entries(levels: u8) -> Vec<(Sample, &'static str)> {
    const NAMES: [&str; 6] = [
        "level 0", "level 1", "level 2", "level 3", "level 4", "level 5",
    ];
    let sample = |level| Sample::Area(Role::Level(level), Role::Edge);
    (0..levels).map(sample).zip(NAMES).collect()
}
