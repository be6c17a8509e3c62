//! Prints the time of each golden scene on one thread [ms], one per line. `cargo xtask wasm` compares the
//! times under Node with these.
//!
//! `times [RUNS]` takes the minimum of RUNS runs, by default five.

use std::time::Instant;

fn main() {
    let runs = std::env::args()
        .nth(1)
        .map_or(5, |runs| runs.parse().expect("RUNS must be a number"));
    for scene in &determinism_checks::golden::SCENES {
        let time = |_| {
            let start = Instant::now();
            assert_eq!((scene.run)(), scene.golden, "{}", scene.name);
            1000.0 * start.elapsed().as_secs_f64()
        };
        println!("{:.1}", (0..runs).map(time).fold(f64::INFINITY, f64::min));
    }
}
