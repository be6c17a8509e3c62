//! Layer of gel under a rigid dish: at a critical weight the flat surface becomes unstable and ripples.
//!
//! ```text
//!   ▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓  dish
//!   ░░░░░░░░░░░░░░░░░░░░░░░░░  h          γ = ρ g h / µ,  q = 2π h / wavelength
//!   ‾‾‾‾‾-____-‾‾‾‾‾-____-‾‾‾  surface    incompressible: γ = 2q (cosh² q + q²) / (sinh q cosh q − q)
//! ```
//!
//! S. Mora, T. Phou, J.-M. Fromental, Y. Pomeau, *Gravity driven instability in elastic solid layers*, Physical Review
//! Letters 113, arXiv 1405.3198 (2014), observed the instability in gels. The smallest critical γ of an incompressible
//! layer is 6.223, at q = 2.120. For the law of the engine and ν = 0.49, the second variation of the energy of the
//! stretched layer vanishes first at γ = 6.222 and q = 2.024. These numbers are from finite elements along the depth, in a
//! program that is not part of this project; for ν = 0.4999 it gives 6.225. The measurements of the paper are not compared.
//!
//! A small sinusoidal acceleration bends the surface. The ripple is half the difference between two runs with opposite
//! accelerations, so that the base state cancels. Its inverse amplitude falls linearly with the weight, to 0 at the
//! critical weight [Southwell 1932]. The strip is glued to walls at its ends, and the nodes at the walls are where the base
//! state has them. The ripple has an envelope of half a cosine, which raises the critical weight by 0.2 %.
//!
//! The elements are graded. Their hourglass stiffness grows with the tension, which is 6 µ at the dish; without this growth,
//! the layer ripples at 0.7 of the critical weight. Uniform elements deviate by 0.3 %.

use super::patch::rubber;
use super::{Bound, Record, Role, Row, Setup};
use crate::check::bar::{fix_where, still};
use crate::check::parallel;
use crate::check::shooting::root;
use crate::plot::{Curve, Plot, Points};
use crate::report::Progress;
use anyhow::{Result, ensure};
use fuwafuwa::{Damping, Dim2, Grading, Hooks, Law, SoftBody, Vec2, VoxelGrid, World};
use std::f64::consts::{PI, TAU};
use std::time::Instant;

/// Voxels across the layer, and its thickness [m].
const N: usize = 16;
const THICKNESS: f64 = 0.125;
/// Wavelengths along the strip.
const WAVES: f64 = 8.5;
/// Poisson's ratio.
const POISSON: f64 = 0.49;
/// Critical γ and its wavenumber q, for the law of the engine.
const CRITICAL: f64 = 6.222;
const WAVENUMBER: f64 = 2.024;
/// Smallest critical γ of an incompressible layer, and its wavenumber q.
const INCOMPRESSIBLE: [f64; 2] = [6.223, 2.120];
/// Weights, relative to the critical one.
const WEIGHTS: [f64; 5] = [0.0, 0.4, 0.7, 0.85, 0.95];
/// Amplitude of the acceleration, relative to the gravity at the critical weight. It leaves ripples of at most a few
/// per cent of the thickness.
const PUSH: f64 = 1e-3;
/// Mass damping [1/s] and time of settling [s]. The slowest ripple, at the weight 0.95, decays in about 0.2 s.
const DAMPING: f32 = 60.0;
const SETTLING: f64 = 1.2;
/// Largest relative deviation of the critical weight.
const TOLERANCE: f64 = 0.03;

/// Hangs layers of increasing weight.
pub fn run(progress: &Progress) -> Result<Record> {
    ensure!(
        (lowest() - INCOMPRESSIBLE[0]).abs() < 1e-3,
        "critical weight of an incompressible layer: expected {}, computed {}",
        INCOMPRESSIBLE[0],
        lowest()
    );
    let start = Instant::now();
    let cases: Vec<(f64, f64)> = WEIGHTS
        .iter()
        .flat_map(|&weight| [(weight, -1.0), (weight, 1.0)])
        .collect();
    let found = parallel::each(&cases, progress, |&(weight, sign)| ripple(weight, sign))?;
    let seconds = start.elapsed().as_secs_f64();
    let inverse: Vec<f64> = { found.chunks(2) }
        .map(|pair| 2.0 / (pair[1].0 - pair[0].0))
        .collect();
    // Extrapolates the line through the last two points to 0.
    let last = WEIGHTS.len() - 1;
    let [(w0, f0), (w1, f1)] = [last - 1, last].map(|k| (WEIGHTS[k] * CRITICAL, inverse[k]));
    let computed = w1 + f1 * (w1 - w0) / (f0 - f1);
    let setup = Setup {
        n: N,
        substeps: Some(found[0].1),
        seconds,
    };
    let mut record = Record::default();
    for (what, reference, bound) in [
        (
            "finite elements along the depth, ν = 0.49",
            CRITICAL,
            Bound::Relative(TOLERANCE),
        ),
        (
            "theory, ν = 0.5",
            INCOMPRESSIBLE[0],
            Bound::Relative(TOLERANCE),
        ),
    ] {
        record.rows.push(Row {
            case: format!("gel layer, critical weight ρ g h / µ, {what}"),
            role: Role::Verification,
            reference: Some(reference),
            spread: None,
            computed,
            bound,
            setup,
        });
    }
    let relative = |k: usize| (WEIGHTS[k] * CRITICAL, inverse[k] / inverse[0]);
    record.plots.push(Plot {
        x: "weight ρ g h / µ".into(),
        y: "stiffness against ripples / that without weight".into(),
        curves: vec![
            Curve::new([(0.0, 1.0), (CRITICAL, 0.0)]).named("line to the critical weight"),
        ],
        points: vec![Points::new("computed", (0..WEIGHTS.len()).map(relative))],
        ..Plot::default()
    });
    Ok(record)
}

/// Returns the critical γ of an incompressible layer at a wavenumber.
fn incompressible(q: f64) -> f64 {
    let (sinh, cosh) = (q.sinh(), q.cosh());
    2.0 * q * (cosh * cosh + q * q) / (sinh * cosh - q)
}

/// Returns the smallest critical γ of an incompressible layer.
fn lowest() -> f64 {
    let slope = |q: f64| incompressible(q + 1e-5) - incompressible(q - 1e-5);
    incompressible(root(1.0, 4.0, slope))
}

/// Returns the depth below the dish of a point with a depth at rest, in thicknesses, in a layer that hangs with the
/// weight γ and no ripple: the stress (λ + 2µ) (l − 1) carries the weight below.
fn hanging(depth: f64, weight: f64) -> f64 {
    let stiffness = 2.0 + 2.0 * POISSON / (1.0 - 2.0 * POISSON);
    depth + weight / stiffness * (depth - 0.5 * depth * depth)
}

/// Returns the amplitude of the ripple [m] and the number of substeps, for a weight relative to the critical one, and the
/// sign of the acceleration.
fn ripple(weight: f64, sign: f64) -> Result<(f64, u32)> {
    let damping = Damping {
        mass: DAMPING,
        stiffness: 0.0,
    };
    let material = rubber(POISSON, damping)?;
    let voxel = THICKNESS / N as f64;
    let wavelength = TAU * THICKNESS / WAVENUMBER;
    let along = (WAVES * wavelength / voxel).round() as usize;
    let width = along as f64 * voxel;
    let grid = VoxelGrid::<Dim2>::from_fn([along, N, 1], voxel as f32, |_| 1)?;
    let mut body =
        SoftBody::with_options(grid, &[material], Law::CorotationalVem, Grading::Graded)?;
    let nodes: Vec<_> = body
        .mesh()
        .nodes()
        .map(|(id, node)| (id, node.at))
        .collect();
    let (right, top) = (along as i32, N as i32);
    fix_where(&mut body, |at| at[0] == 0 || at[0] == right || at[1] == top);
    let surface: Vec<_> = { body.mesh().nodes() }
        .filter(|(_, node)| node.at[1] == 0)
        .map(|(id, node)| (id, f64::from(node.at[0]) * voxel - 0.5 * width))
        .collect();
    let shape = move |x: f64| (TAU * x / wavelength).cos() * (PI * x / width).cos();
    for (id, at) in nodes {
        let x = f64::from(at[0]) * voxel - 0.5 * width;
        let depth = hanging(1.0 - f64::from(at[1]) / N as f64, weight * CRITICAL);
        let place = Vec2::new(x as f32, (-depth * THICKNESS) as f32);
        body.set_node_state(id, place, Vec2::ZERO)?;
    }
    let critical =
        CRITICAL * material.elasticity.shear_modulus() / (f64::from(material.density) * THICKNESS);
    let mut world = World::new(still(Vec2::NEG_Y * (weight * critical) as f32))?;
    let body = world.add_soft_body(body)?;
    let table: Vec<Vec2> = { 0..=along }
        .map(|k| shape(k as f64 * voxel - 0.5 * width))
        .map(|shape| Vec2::Y * (sign * PUSH * critical * shape) as f32)
        .collect();
    let push = |at: Vec2| {
        let place = (at.x + 0.5 * width as f32) / voxel as f32;
        table[(place.round().max(0.0) as usize).min(along)]
    };
    for _ in 0..(60.0 * SETTLING) as u32 {
        world.step_with(&mut Hooks {
            field: Some(&push),
            ..Hooks::default()
        });
    }
    let (mut above, mut below) = (0.0, 0.0);
    for (id, x) in surface {
        above += shape(x) * f64::from(world[body].node_state(id).0.y);
        below += shape(x) * shape(x);
    }
    Ok((above / below, world.substeps()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn incompressible_layer_has_the_known_critical_weight() {
        assert!((lowest() - INCOMPRESSIBLE[0]).abs() < 1e-3);
        assert!((incompressible(INCOMPRESSIBLE[1]) - INCOMPRESSIBLE[0]).abs() < 1e-3);
        // Short waves follow the half-space, γ = 2q.
        assert!((incompressible(20.0) / 40.0 - 1.0).abs() < 1e-6);
    }
}
