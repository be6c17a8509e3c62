//! Large deflections of a clamped bar: drop, shortening and tip angle against the elastica, the exact theory of a
//! slender bar that bends but does not stretch.
//!
//! ```text
//!   ▓┌────────┐___                    s from the tip, angle θ below the horizontal
//!   ▓└────────┘    ‾‾‾──┐ ↓ P         θ'' = −(α + γ s) cos θ,  θ' = 0 at the tip,  θ = 0 at the clamp
//!                       └─            α = P L² / E' I,  γ = q L³ / E' I
//! ```
//!
//! `P` is a dead load at the tip and `q` the weight per length. The engine is in plane strain in 2D, so the bar
//! bends with E' = E / (1 − ν²). The bar is 20 times as long as thick: shear and stretching then change the
//! deflection by some 0.3 %.

use super::bar::{Bar, FREQUENCY, place, still};
use super::parallel;
use super::shooting::{integrate, root};
use crate::plot::{Curve, Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, ensure};
use fuwafuwa::{Damping, Grip, Shape, Vec2, World};
use std::f64::consts::FRAC_PI_2;

/// Size of the bar [voxels]. It is 1 m long.
const SIZE: [usize; 2] = [80, 4];
/// Tip loads α = P L² / E' I.
const TIP_LOADS: [f64; 6] = [0.5, 1.0, 2.0, 3.0, 5.0, 10.0];
/// Own weights γ = q L³ / E' I.
const WEIGHTS: [f64; 6] = [0.5, 1.0, 2.0, 3.0, 5.0, 10.0];
/// Known solutions: tip load α, own weight γ, and drop, shortening and tip angle [°] with four digits. Tip loads: K. E. Bisshopp, D. C. Drucker, *Large deflection of cantilever beams*, Quarterly of
/// Applied Mathematics 3 (1945). Own weights have no closed form: an independent numerical solution with a tolerance
/// of 1e-9.
const KNOWN: [(f64, f64, [f64; 3]); 6] = [
    (0.5, 0.0, [0.1621, 0.0159, 14.01]),
    (1.0, 0.0, [0.3017, 0.0564, 26.43]),
    (10.0, 0.0, [0.8106, 0.5550, 81.95]),
    (0.0, 1.0, [0.1235, 0.0088, 9.46]),
    (0.0, 5.0, [0.4959, 0.1533, 39.94]),
    (0.0, 10.0, [0.7002, 0.3436, 60.31]),
];
/// Maximum difference from the known solutions: a unit of their last digit, of lengths and of angles [°].
const LAST_DIGIT: [f64; 3] = [1e-4, 1e-4, 1e-2];
/// Maximum relative deviation from the elastica.
const TOLERANCE: f64 = 0.02;
/// Time after which the bar is at rest [s]. Its vibrations are damped critically; 2 s give the same results.
const SETTLING: f64 = 3.0;

/// Shape of a bent bar of length 1.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Bent {
    /// Distance of the tip below the clamp.
    pub drop: f64,
    /// Horizontal distance of the tip from its place in the straight bar.
    pub shortening: f64,
    /// Slope of the bar at the tip [rad].
    pub angle: f64,
}

/// Compares bent bars with the elastica.
pub fn check(progress: &Progress) -> Result<Findings> {
    compare_with_known()?;
    let cases: Vec<(f64, f64)> = { TIP_LOADS.iter().map(|&load| (load, 0.0)) }
        .chain(WEIGHTS.iter().map(|&weight| (0.0, weight)))
        .collect();
    let found = parallel::each(&cases, progress, |&(load, weight)| bend(load, weight))?;
    let mut findings = Findings::default();
    for (&(load, weight), bent) in cases.iter().zip(&found) {
        let exact = elastica(load, weight);
        let name = match load > 0.0 {
            true => format!("elastica, tip load {load}"),
            false => format!("elastica, own weight {weight}"),
        };
        for (what, value, reference) in [
            ("drop / length", bent.drop, exact.drop),
            ("shortening / length", bent.shortening, exact.shortening),
            (
                "tip angle [°]",
                bent.angle.to_degrees(),
                exact.angle.to_degrees(),
            ),
        ] {
            let case = format!("{name}, {what}");
            findings
                .outcomes
                .push(Outcome::relative(case, value, reference, TOLERANCE));
        }
    }
    let (tip, own) = found.split_at(TIP_LOADS.len());
    findings.plots = vec![
        plot("tip load P L² / E'I", &TIP_LOADS, tip, |load| {
            elastica(load, 0.0)
        }),
        plot("own weight q L³ / E'I", &WEIGHTS, own, |weight| {
            elastica(0.0, weight)
        }),
    ];
    Ok(findings)
}

/// Name of a part of a bent shape, and its value.
type Part = (&'static str, fn(Bent) -> f64);

/// Plots drop, shortening and tip angle over the load.
fn plot(x: &str, loads: &[f64], found: &[Bent], exact: impl Fn(f64) -> Bent) -> Plot {
    let values: [Part; 3] = [
        ("drop / length", |bent| bent.drop),
        ("shortening / length", |bent| bent.shortening),
        ("tip angle / 90°", |bent| bent.angle / FRAC_PI_2),
    ];
    let curve = |value: fn(Bent) -> f64| Curve::sampled(0.0..=10.0, |load| value(exact(load)));
    Plot {
        x: x.into(),
        y: "tip of the bar".into(),
        curves: values.map(|(name, value)| curve(value).named(name)).into(),
        points: { values.iter() }
            .map(|&(name, value)| {
                let points = loads.iter().zip(found);
                Points::new(name, points.map(|(&load, &bent)| (load, value(bent))))
            })
            .collect(),
        ..Plot::default()
    }
}

/// Returns the elastica under a tip load α = P L² / E' I and an own weight γ = q L³ / E' I.
pub fn elastica(load: f64, weight: f64) -> Bent {
    // State: angle θ, its derivative, and the place of the clamp relative to the tip. The integration begins at
    // the tip and searches the tip angle at which the bar is horizontal at the clamp.
    let from_tip = |angle: f64| {
        integrate([angle, 0.0, 0.0, 0.0], 1.0, |s, [theta, slope, ..]| {
            let bending = -(load + weight * s) * theta.cos();
            [slope, bending, theta.cos(), theta.sin()]
        })
    };
    let angle = root(0.0, FRAC_PI_2, |angle| from_tip(angle)[0]);
    let [_, _, reach, drop] = from_tip(angle);
    Bent {
        drop,
        shortening: 1.0 - reach,
        angle,
    }
}

/// Compares [`elastica`] with the known solutions.
fn compare_with_known() -> Result<()> {
    for (load, weight, known) in KNOWN {
        let Bent {
            drop,
            shortening,
            angle,
        } = elastica(load, weight);
        let found = [drop, shortening, angle.to_degrees()];
        let is_close = |k: usize| (found[k] - known[k]).abs() <= LAST_DIGIT[k];
        ensure!(
            (0..3).all(is_close),
            "elastica for tip load {load} and weight {weight}: expected {known:?}, computed {found:?}"
        );
    }
    Ok(())
}

/// Returns the shape of a bar of the engine under a tip load and its own weight, both dimensionless.
fn bend(load: f64, weight: f64) -> Result<Bent> {
    let bar = Bar::new(SIZE, Damping::at(1.0, FREQUENCY as f32));
    let thickness = bar.thickness();
    let stiffness = bar.modulus() * thickness * thickness * thickness / 12.0;
    let mut world = World::new(still(-Vec2::Y * bar.gravity(weight) as f32))?;
    let body = world.add_soft_body(bar.body()?)?;
    if load > 0.0 {
        let tip = Shape::half_space(-Vec2::X, Vec2::X * (1.0 - 1e-4));
        let force = -Vec2::Y * (load * stiffness) as f32;
        world.add_grip(Grip::force(body, tip, force))?;
    }
    for _ in 0..(60.0 * SETTLING) as u32 {
        world.step();
    }
    let [low, high] = [0, SIZE[1]].map(|y| place(&world[body], [SIZE[0], y]));
    let (low, high) = (low?, high?);
    let (tip, section) = (0.5 * (low + high), high - low);
    Ok(Bent {
        drop: 0.5 * thickness - f64::from(tip.y),
        shortening: 1.0 - f64::from(tip.x),
        angle: f64::from(section.x).atan2(f64::from(section.y)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elastica_has_the_known_shapes() {
        compare_with_known().unwrap();
    }

    #[test]
    fn bar_under_a_large_tip_load_bends_like_the_elastica() {
        let (bent, exact) = (bend(5.0, 0.0).unwrap(), elastica(5.0, 0.0));
        for (found, wanted) in [
            (bent.drop, exact.drop),
            (bent.shortening, exact.shortening),
            (bent.angle, exact.angle),
        ] {
            assert!(
                (found / wanted - 1.0).abs() < TOLERANCE,
                "{bent:?} {exact:?}"
            );
        }
    }
}
