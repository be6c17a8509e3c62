//! Self-buckling: a clamped column sways the slower the heavier it is, and buckles under its own weight at the load
//! of Greenhill.
//!
//! The squared frequency of a column falls almost linearly with its weight, to 0 at the critical weight
//! \[Southwell\]. The check measures it below the critical weight and extrapolates to 0. Gravity points along the
//! bar to its clamped end.

use super::bar::{Bar, FREQUENCY, still};
use super::damping::{Mode, Vibration, vibration_in};
use super::motion::arrange;
use super::parallel;
use super::shooting::{integrate, root};
use crate::plot::{Curve, Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, ensure};
use fuwafuwa::{DEFAULT_TICK, Damping, Vec2, Vec3, World};
use std::f64::consts::TAU;

/// Size of the column [voxels]. It is 1 m high.
const SIZE: [usize; 2] = [80, 4];
/// Weights, relative to the critical one.
const WEIGHTS: [f64; 6] = [0.0, 0.25, 0.5, 0.75, 0.85, 0.95];
/// Critical weight q L³ / E' I: 9/4 z², with the first zero z = 1.86635 of the Bessel function of order −1/3; A. G.
/// Greenhill, Proceedings of the Cambridge Philosophical Society 4 (1881).
const CRITICAL: f64 = 7.8373;
/// Squared frequency ω² ρ A L⁴ / E' I without weight: k⁴, with the first root k of cos k cosh k = −1.
const UNLOADED: f64 = 12.3624;
/// Maximum relative deviation of the critical weight. Also the maximum deviation of a squared frequency, in units of
/// that without weight.
const TOLERANCE: f64 = 0.02;
/// Amplitude of the sway [m].
const AMPLITUDE: f64 = 5e-3;
/// Damping ratio of the column without weight.
const RATIO: f32 = 0.05;
/// Number of measured periods.
const PERIODS: f64 = 2.0;

/// Measures the critical weight.
pub fn check(progress: &Progress) -> Result<Findings> {
    compare_with_published()?;
    let found = parallel::each(&WEIGHTS, progress, |&weight| sway(weight))?;
    let exact = |weight: f64| squared(weight * CRITICAL) / UNLOADED;
    let mut findings = Findings::default();
    for (&weight, &value) in WEIGHTS.iter().zip(&found) {
        let case = format!(
            "greenhill, weight / critical {weight}, squared frequency / that without weight"
        );
        findings
            .outcomes
            .push(Outcome::near(case, value, exact(weight), TOLERANCE));
    }
    // Extrapolates the line through the last two points to 0.
    let last = WEIGHTS.len() - 1;
    let [(w0, f0), (w1, f1)] = [last - 1, last].map(|k| (WEIGHTS[k] * CRITICAL, found[k]));
    let value = w1 + f1 * (w1 - w0) / (f0 - f1);
    let case = "greenhill, critical weight q L³ / E'I".into();
    findings
        .outcomes
        .push(Outcome::relative(case, value, CRITICAL, TOLERANCE));
    findings.plots.push(Plot {
        x: "own weight / critical weight".into(),
        y: "squared frequency / that without weight".into(),
        curves: vec![Curve::sampled(0.0..=1.0, exact).named("linearised beam theory")],
        points: vec![Points::new("measured", WEIGHTS.into_iter().zip(found))],
        ..Plot::default()
    });
    Ok(findings)
}

/// Compares the theory that is solved here with published numbers.
fn compare_with_published() -> Result<()> {
    for (what, computed, published) in [
        ("critical weight", critical(), CRITICAL),
        ("squared frequency without weight", squared(0.0), UNLOADED),
    ] {
        ensure!(
            (computed - published).abs() < 1e-4,
            "{what}: expected {published}, computed {computed}"
        );
    }
    Ok(())
}

/// Returns the condition at the free end of a column with a weight q L³ / E' I that vibrates with a squared
/// frequency ω² ρ A L⁴ / E' I: the determinant of moment and shear, 0 if both vanish.
fn at_free_end(weight: f64, squared: f64) -> f64 {
    // Deflection w and its derivatives: w'''' = ω² w − γ ((1 − x) w')'.
    let rate = |x: f64, [w, w1, w2, w3]: [f64; 4]| {
        [w1, w2, w3, squared * w - weight * ((1.0 - x) * w2 - w1)]
    };
    let [_, _, a2, a3] = integrate([0.0, 0.0, 1.0, 0.0], 1.0, rate);
    let [_, _, b2, b3] = integrate([0.0, 0.0, 0.0, 1.0], 1.0, rate);
    a2 * b3 - a3 * b2
}

/// Returns the squared frequency ω² ρ A L⁴ / E' I of a column that is lighter than the critical weight.
fn squared(weight: f64) -> f64 {
    root(0.0, 20.0, |squared| at_free_end(weight, squared))
}

/// Returns the critical weight q L³ / E' I.
fn critical() -> f64 {
    root(1.0, 20.0, |weight| at_free_end(weight, 0.0))
}

/// Returns the squared frequency of a column of the engine, relative to that of theory without weight. `weight` is
/// relative to the critical one.
fn sway(weight: f64) -> Result<f64> {
    let bar = Bar::new(SIZE, Damping::at(RATIO, FREQUENCY as f32));
    let gravity = bar.gravity(weight * CRITICAL);
    let mut body = bar.body()?;
    // Strain at the clamp in equilibrium: E' / ρ = gravity / strain for L = 1 m.
    let strain = weight * CRITICAL * bar.thickness() * bar.thickness() / 12.0;
    arrange(&mut body, |rest| {
        let x = f64::from(rest.x) + 0.5;
        let y = f64::from(rest.y) + 0.5 - 0.5 * bar.thickness();
        let (along, across) = Mode::ClampedBending.shape(x - 0.5, y);
        let compressed = strain * (x - 0.5 * x * x);
        let moved = [AMPLITUDE * along - compressed, AMPLITUDE * across];
        (
            rest + Vec3::new(moved[0] as f32, moved[1] as f32, 0.0),
            Vec3::ZERO,
        )
    })?;
    let mut world = World::new(still(-Vec2::X * gravity as f32))?;
    let body = world.add_soft_body(body)?;
    let frequency = TAU * FREQUENCY * (squared(weight * CRITICAL) / UNLOADED).sqrt();
    let tick = f64::from(DEFAULT_TICK);
    let middle = 0.5 * bar.thickness() - 0.5;
    let mut samples = Vec::new();
    for _ in 0..(PERIODS * TAU / frequency / tick) as usize {
        world.step();
        samples.push(f64::from(world[body].centre_of_mass().y) - middle);
    }
    let expected = Vibration {
        frequency,
        ratio: f64::from(RATIO) * TAU * FREQUENCY / frequency,
    };
    let found = vibration_in(&samples, tick, expected).frequency / (TAU * FREQUENCY);
    Ok(found * found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn theory_has_the_published_critical_weight() {
        compare_with_published().unwrap();
    }

    #[test]
    fn heavy_column_sways_slowly() {
        let found = sway(0.75).unwrap();
        assert!(
            (found - squared(0.75 * CRITICAL) / UNLOADED).abs() < TOLERANCE,
            "{found}"
        );
    }
}
