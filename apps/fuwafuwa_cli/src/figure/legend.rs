//! Helpers shared by the legends.

use fuwafuwa_painter::{Role, Sample};

/// Returns one legend entry for each of the first `levels` levels.
pub fn level_entries(levels: u8) -> Vec<(Sample, &'static str)> {
    const NAMES: [&str; 6] = [
        "level 0", "level 1", "level 2", "level 3", "level 4", "level 5",
    ];
    let sample = |level| Sample::Area(Role::Level(level), Role::Edge);
    (0..levels).map(sample).zip(NAMES).collect()
}
