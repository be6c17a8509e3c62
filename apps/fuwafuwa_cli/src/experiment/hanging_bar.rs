//! Bar that hangs at its upper end and is stretched by its own weight.
//!
//! ```text
//!   ▓▓▓
//!   ┌─┐ ↓ x     u(x) = ρ g (L x − x²/2) / E,  elongation ρ g L² / 2E,  stress ρ g (L − x)
//!   │ │
//!   └─┘
//! ```
//!
//! Poisson's ratio is 0, so that the clamp does not disturb the stress, and the strain is small. The stress is Young's
//! modulus times the strain between neighbouring nodes of the surface. S. P. Timoshenko, J. N. Goodier, *Theory of
//! Elasticity*, §86.

use super::{Bound, Record, Role, Row, Setup};
use crate::check::bar::still;
use crate::plot::{Curve, Plot, Points};
use crate::report::Progress;
use anyhow::Result;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{Damping, Dim3, Material, SoftBody, Vec3, VoxelGrid, World};
use std::time::Instant;

/// Voxels across the bar and along it. It is 1 m long.
const SIZE: [usize; 2] = [4, 32];
/// Strain ρ g L / E at the upper end.
const STRAIN: f64 = 0.02;
/// Lowest frequency of the vibration along the bar [Hz], √(E/ρ) / 4L, which is damped critically.
const FREQUENCY: f64 = 1.0;
/// Time after which the bar is at rest [s].
const SETTLING: f64 = 4.0;
/// Largest relative deviations of the displacement and of the stress.
const TOLERANCES: [f64; 2] = [0.01, 0.03];

/// Hangs the bar.
pub fn run(_: &Progress) -> Result<Record> {
    let start = Instant::now();
    let (moved, substeps) = hang()?;
    let setup = Setup {
        n: SIZE[0],
        substeps: Some(substeps),
        seconds: start.elapsed().as_secs_f64(),
    };
    let row = |what: &str, reference: f64, computed: f64, tolerance: f64| Row {
        case: format!("hanging bar, {what}"),
        role: Role::Verification,
        reference: Some(reference),
        spread: None,
        computed,
        bound: Bound::Relative(tolerance),
        setup,
    };
    let mut record = Record::default();
    let end = moved[SIZE[1]];
    record
        .rows
        .push(row("elongation E / ρ g L²", 0.5, end, TOLERANCES[0]));
    let middle = moved[SIZE[1] / 2];
    record.rows.push(row(
        "displacement at half length, E / ρ g L²",
        0.375,
        middle,
        TOLERANCES[0],
    ));
    let stress = |k: usize| (moved[k + 1] - moved[k]) * SIZE[1] as f64;
    let place = |k: usize| (k as f64 + 0.5) / SIZE[1] as f64;
    for k in [SIZE[1] / 8, SIZE[1] / 2, 7 * SIZE[1] / 8] {
        let what = format!("stress / ρ g L at x = {} L", place(k));
        record
            .rows
            .push(row(&what, 1.0 - place(k), stress(k), TOLERANCES[1]));
    }
    record.plots.push(Plot {
        x: "place x / L".into(),
        y: "stress / ρ g L".into(),
        curves: vec![Curve::sampled(0.0..=1.0, |x| 1.0 - x).named("exact")],
        points: vec![Points::new(
            "computed",
            (0..SIZE[1]).map(|k| (place(k), stress(k))),
        )],
        ..Plot::default()
    });
    Ok(record)
}

/// Returns the displacement of the nodes along an edge of the bar, from the clamp to the end, in units of ρ g L² / E,
/// and the number of substeps.
fn hang() -> Result<(Vec<f64>, u32)> {
    let [across, along] = SIZE;
    let usual = Material::default();
    let density = f64::from(usual.density);
    let young = density * (4.0 * FREQUENCY) * (4.0 * FREQUENCY);
    let material = Material {
        elasticity: Elasticity::new(young, 0.0)?,
        damping: Damping::at(1.0, FREQUENCY as f32),
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        ..usual
    };
    let voxel = 1.0 / along as f32;
    let grid = VoxelGrid::<Dim3>::from_fn([across, along, across], voxel, |_| 1)?;
    let mut body = SoftBody::new(grid, &[material])?;
    let nodes: Vec<_> = body
        .mesh()
        .nodes()
        .map(|(id, node)| (id, node.at))
        .collect();
    let clamp = along as i32;
    nodes
        .iter()
        .filter(|(_, at)| at[1] == clamp)
        .for_each(|&(id, _)| body.fix_node(id));
    let mut world = World::new(still(Vec3::NEG_Y * (STRAIN * young / density) as f32))?;
    let body = world.add_soft_body(body)?;
    for _ in 0..(60.0 * SETTLING) as u32 {
        world.step();
    }
    let mut moved = vec![0.0; along + 1];
    for &(id, at) in nodes.iter().filter(|(_, at)| at[0] == 0 && at[2] == 0) {
        let down = f64::from(at[1] as f32 * voxel) - f64::from(world[body].node_state(id).0.y);
        moved[along - at[1] as usize] = down / STRAIN;
    }
    Ok((moved, world.substeps()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bar_hangs_as_long_as_in_theory() {
        let (moved, _) = hang().unwrap();
        for (k, found) in moved.into_iter().enumerate() {
            let x = k as f64 / SIZE[1] as f64;
            assert!((found - (x - 0.5 * x * x)).abs() < 0.005, "{x} {found}");
        }
    }
}
