//! How long each golden scene takes on one thread at the least of five times [ms], one a line: what `cargo xtask wasm`
//! compares Node with.

use std::time::Instant;

fn main() {
    for scene in &fuwafuwa_golden::SCENES {
        let time = |_| {
            let start = Instant::now();
            assert_eq!((scene.run)(), scene.golden, "{}", scene.name);
            1000.0 * start.elapsed().as_secs_f64()
        };
        println!("{:.1}", (0..5).map(time).fold(f64::INFINITY, f64::min));
    }
}
