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

use super::parallel;
use super::shooting::{integrate, root};
use crate::plot::{Curve, Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Context, Result, ensure};
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Damping, Dim2, Grip, Material, Shape, SoftBody, StiffBodies, Vec2, VoxelGrid, World,
    WorldConfig,
};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Size of the bar [voxels]. It is 1 m long.
const SIZE: [usize; 2] = [80, 4];
/// Tip loads α = P L² / E' I.
const TIP_LOADS: [f64; 6] = [0.5, 1.0, 2.0, 3.0, 5.0, 10.0];
/// Own weights γ = q L³ / E' I.
const WEIGHTS: [f64; 6] = [0.5, 1.0, 2.0, 3.0, 5.0, 10.0];
/// Known solutions: tip load α, own weight γ, and drop, shortening and tip angle [°] with four
/// digits. Tip loads: K. E. Bisshopp, D. C. Drucker, *Large deflection of cantilever beams*, Quarterly of
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
/// Lowest frequency of the bar [Hz]. It sets Young's modulus.
pub const FREQUENCY: f64 = 1.0;
/// Poisson's ratio.
pub const POISSON: f64 = 0.3;
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

/// Straight bar in plane strain, 1 m long, along the x axis with its left end at x = 0.
pub struct Bar {
    size: [usize; 2],
    material: Material,
}

impl Bar {
    /// Returns a bar with a size [voxels]. Its lowest frequency, while clamped at one end, is [`FREQUENCY`].
    pub fn new(size: [usize; 2], damping: Damping) -> Self {
        let usual = Material::default();
        // ω = k² √(E' I / ρ A), with the root k of cos k cosh k = −1 and L = 1 m.
        let thickness = size[1] as f64 / size[0] as f64;
        let wave_speed = TAU * FREQUENCY * 12f64.sqrt() / (1.875_104 * 1.875_104 * thickness);
        let modulus = f64::from(usual.density) * wave_speed * wave_speed;
        let material = unbreakable(modulus, damping);
        Self { size, material }
    }

    /// Modulus E' = E / (1 − ν²) of bending in plane strain [Pa].
    pub fn modulus(&self) -> f64 {
        plane_strain(self.material.elasticity)
    }

    /// Thickness [m].
    pub fn thickness(&self) -> f64 {
        self.size[1] as f64 / self.size[0] as f64
    }

    /// Returns the bar, clamped at its left end.
    pub fn body(&self) -> Result<SoftBody<Dim2>> {
        let [length, thickness] = self.size;
        let grid = VoxelGrid::from_fn([length, thickness, 1], 1.0 / length as f32, |_| 1)?;
        let mut body = SoftBody::new(grid, &[self.material])?;
        fix_where(&mut body, |at| at[0] == 0);
        Ok(body)
    }

    /// Returns the gravity [m/s²] at which the weight per length q of the bar is `weight` · E' I / L³.
    pub fn gravity(&self, weight: f64) -> f64 {
        let thickness = self.thickness();
        let stiffness = self.modulus() * thickness * thickness / 12.0;
        weight * stiffness / f64::from(self.material.density)
    }
}

/// Returns a material that does not tear, with the default density, a Poisson's ratio of [`POISSON`], and a modulus of
/// bending in plane strain [Pa].
pub fn unbreakable(modulus: f64, damping: Damping) -> Material {
    Material {
        elasticity: Elasticity {
            young: modulus * (1.0 - POISSON * POISSON),
            poisson: POISSON,
        },
        damping,
        strength: f32::INFINITY,
        ..Material::default()
    }
}

/// Returns the modulus of bending in plane strain, E / (1 − ν²) [Pa].
pub fn plane_strain(elasticity: Elasticity) -> f64 {
    elasticity.young / (1.0 - elasticity.poisson * elasticity.poisson)
}

/// Returns a configuration with a gravity [m/s²], without sleep, in which no body is scaled.
pub fn still(gravity: Vec2) -> WorldConfig<Dim2> {
    WorldConfig {
        gravity,
        sleep: false,
        stiff_bodies: StiffBodies::Exact,
        ..WorldConfig::default()
    }
}

/// Fixes the nodes at the lattice points that `is_fixed` returns true for.
pub fn fix_where(body: &mut SoftBody<Dim2>, is_fixed: impl Fn([i32; 2]) -> bool) {
    let nodes: Vec<_> = body.mesh().nodes().collect();
    for (id, _) in nodes
        .into_iter()
        .filter(|(_, node)| is_fixed([node.at[0], node.at[1]]))
    {
        body.fix_node(id);
    }
}

/// Returns the position [m] of the node at a lattice point.
///
/// # Errors
/// If the body has no node there.
pub fn place(body: &SoftBody<Dim2>, at: [usize; 2]) -> Result<Vec2> {
    let point = at.map(|coordinate| coordinate as i32);
    let mut nodes = body.mesh().nodes();
    let node = nodes.find(|(_, node)| node.at[..2] == point);
    let (id, _) = node.with_context(|| format!("the body has no node at {at:?}"))?;
    Ok(body.node_state(id).0)
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
