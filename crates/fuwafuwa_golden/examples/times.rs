//! How long each golden scene takes on one thread [ms], one a line: what `cargo xtask wasm` compares
//! Node with.

use std::time::Instant;

fn main() {
    for scene in &fuwafuwa_golden::SCENES {
        let start = Instant::now();
        assert_eq!((scene.run)(), scene.golden, "{}", scene.name);
        println!("{:.1}", 1000.0 * start.elapsed().as_secs_f64());
    }
}
