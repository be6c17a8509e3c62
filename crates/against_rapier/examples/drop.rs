//! Prints how long Rapier takes for a frame of each scene, at the squash that is right for it.
//!
//! ```text
//! cargo run --release --package against_rapier --example drop
//! ```

use against_rapier::{
    Drop, Outcome, Result, Tear, drop_at_squash, drop_ball, drop_disc, tear_disc,
};

type Fall = fn(&Drop) -> Result<Outcome>;

fn main() -> Result<()> {
    let stiff = Drop::default();
    let soft = Drop {
        young: 5000.0,
        height: 0.2,
        gravity: 1.0,
        ..stiff
    };
    println!("scene           n  substeps  squash %   median ms 95 in 100 ms");
    for (name, scene, wanted) in [("stiff", stiff, 0.07), ("soft", soft, 0.095)] {
        for (shape, fall, n) in [
            ("disc", drop_disc as Fall, 32),
            ("disc", drop_disc, 64),
            ("ball", drop_ball, 8),
            ("ball", drop_ball, 16),
        ] {
            let found = drop_at_squash(fall, &Drop { n, ..scene }, wanted, 1..=64)?;
            let (median, high) = median_and_high(&found.outcome.milliseconds);
            let squash = 100.0 * found.outcome.peak_squash;
            let substeps = found.substeps;
            let remark = if found.reached {
                ""
            } else {
                "  not the squash wanted"
            };
            println!(
                "{name:<6}{shape:<5}{n:>6}{substeps:>10}{squash:>10.1}{median:>12.2}{high:>13.2}{remark}"
            );
        }
    }
    let torn = tear_disc(&Tear::default())?;
    let (cut, high_cut) = median_and_high(&torn.cut_milliseconds);
    let (median, high) = median_and_high(&torn.milliseconds);
    println!(
        "\ndisc of 64 voxels in {} pieces: frame {median:.1} ms (95 in 100 below {high:.1}); {} cuts, {cut:.2} ms (95 in 100 below {high_cut:.2})",
        torn.pieces,
        torn.cut_milliseconds.len(),
    );
    Ok(())
}

/// The median, and what 95 in 100 stay below: the very worst says more about what else the machine does.
fn median_and_high(milliseconds: &[f64]) -> (f64, f64) {
    let mut sorted = milliseconds.to_vec();
    sorted.sort_by(f64::total_cmp);
    (sorted[sorted.len() / 2], sorted[sorted.len() * 95 / 100])
}
