//! Time from the button that drops a drawing to the first tick of its body, and time of a stroke.
//!
//! `cargo run --release -p tamaire_maker --example speed` prints the median of eleven runs for a full paper and a full
//! block [ms]. A stroke is drawn in a frame if it takes less than 16 ms.

use fuwafuwa::{DEFAULT_TICK, Vec3};
use std::error::Error;
use std::sync::Arc;
use std::time::Instant;
use tamaire_maker::body::put;
use tamaire_maker::draft::Draft;
use tamaire_maker::drawing::{Brush, Drawing};
use tamaire_maker::palette::Palette;
use tamaire_play::{AnyRound, InputFrame};

/// Number of runs.
const RUNS: usize = 11;

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "{:8} {:>10} {:>10} {:>10}",
        "drawing", "stroke", "line ends", "drop"
    );
    for (name, empty) in [("paper", Drawing::paper()), ("block", Drawing::block())] {
        let middle = 0.5 * Vec3::from(empty.size().map(|count| count as f32));
        let mut times = [const { Vec::new() }; 3];
        for _ in 0..RUNS {
            let mut drawing = empty.clone();
            drawing.stroke(middle, middle, 100.0, Brush::Draw(1));
            drawing.end_stroke();
            let began = Instant::now();
            drawing.stroke(middle, middle + 8.0 * Vec3::X, 4.5, Brush::Draw(2));
            let drawn = Instant::now();
            drawing.end_stroke();
            let ended = Instant::now();
            let mut draft = Draft::blank(if drawing.is_paper() { 2 } else { 3 });
            let dropped = Instant::now();
            let [low, high] = draft.scene().view.map(Vec3::from);
            let middle = 0.5 * (low + high);
            draft.change(|scene| {
                put(
                    scene,
                    Some(0),
                    &drawing,
                    &Palette::default(),
                    (middle, None),
                )
            });
            let mut round = AnyRound::new(Arc::new(draft.level()?));
            let report = round.step(InputFrame::default());
            assert_eq!(report.quarantined, 0, "the body moves");
            let spans = [drawn - began, ended - drawn, dropped.elapsed()];
            for (times, span) in times.iter_mut().zip(spans) {
                times.push(1e3 * span.as_secs_f64());
            }
        }
        let [stroke, ends, drop] = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            times[RUNS / 2]
        });
        println!("{name:8} {stroke:10.2} {ends:10.2} {drop:10.1}");
    }
    println!("a frame takes {:.1} ms", 1e3 * DEFAULT_TICK);
    Ok(())
}
