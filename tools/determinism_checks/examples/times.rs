//! How long each golden scene takes on one thread [ms], one a line: what `cargo xtask wasm` compares Node with. `times [RUNS]`: at
//! the least of so many, five unless told.

use std::time::Instant;

fn main() {
    let runs = std::env::args()
        .nth(1)
        .map_or(5, |runs| runs.parse().expect("a number"));
    for scene in &determinism_checks::golden::SCENES {
        let time = |_| {
            let start = Instant::now();
            assert_eq!((scene.run)(), scene.golden, "{}", scene.name);
            1000.0 * start.elapsed().as_secs_f64()
        };
        println!("{:.1}", (0..runs).map(time).fold(f64::INFINITY, f64::min));
    }
}
