//! Point force on a half-space: displacement under the force, against the solution of Boussinesq.
//!
//! ```text
//!   ________↓ F________     u = F / 4πG · (z²/r³ + 2 (1 − ν)/r), the displacement along z
//!           ·  ↓ z
//!           ·               r² = x² + y² + z²
//! ```
//!
//! The body is a quarter of a block, with rollers on the planes of symmetry. The far faces are moved as in the exact
//! solution, so that the block behaves as a part of a half-space. The law of the engine is linearised at rest and solved
//! exactly. J. Boussinesq, *Application des potentiels* (1885); K. L. Johnson, *Contact Mechanics* (1985), §3.2.
//!
//! The force acts at one node. The displacement is compared from six voxels below the force on, where the size of the
//! loaded patch no longer matters. With 48 voxels instead of 32, the deviations at the same number of voxels below the
//! force change by at most 0.1 %.

use super::{Bound, Record, Role, Row, Setup};
use crate::check::statics::Statics;
use crate::plot::{Curve, Plot, Points};
use crate::report::Progress;
use anyhow::{Context, Result};
use fuwafuwa::inspect::{CellHierarchy, Connectivity, Elasticity, Mesh};
use fuwafuwa::{Dim3, Grading, Point, VoxelGrid};
use std::f64::consts::PI;
use std::time::Instant;

/// Width of the quarter of the block [voxels].
const N: usize = 32;
/// Poisson's ratio.
const POISSON: f64 = 0.3;
/// Depths below the force that have a row [voxels].
const DEPTHS: [usize; 4] = [6, 8, 12, 16];
/// Largest relative deviation of the displacement.
const TOLERANCE: f64 = 0.03;

/// Presses a block at a point.
pub fn run(progress: &Progress) -> Result<Record> {
    let start = Instant::now();
    let found = press(N, progress)?;
    let setup = Setup {
        n: N,
        substeps: None,
        seconds: start.elapsed().as_secs_f64(),
    };
    let at = |depth: f64| boussinesq(POISSON, [0.0, 0.0, depth])[2];
    let mut record = Record::default();
    for depth in DEPTHS {
        let (_, computed) = *{ found.iter() }
            .find(|(z, _)| *z == depth)
            .context("no node at the depth")?;
        record.rows.push(Row {
            case: format!("half-space, {depth} voxels below the force, u G s / F"),
            role: Role::Verification,
            reference: Some(at(depth as f64)),
            spread: None,
            computed,
            bound: Bound::Relative(TOLERANCE),
            setup,
        });
    }
    record.plots.push(Plot {
        x: "depth / voxel".into(),
        y: "displacement u G s / F".into(),
        curves: vec![Curve::sampled(1.0..=N as f64, at).named("exact")],
        points: vec![Points::new(
            "computed",
            found
                .iter()
                .filter(|(z, _)| *z > 0)
                .map(|&(z, u)| (z as f64, u)),
        )],
        is_log: [true; 2],
        ..Plot::default()
    });
    Ok(record)
}

/// Returns the displacement of a half-space with a Poisson's ratio at a point at a depth z, for G = 1 and a force of 1 along
/// z at the origin [Boussinesq 1885].
pub fn boussinesq(poisson: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let r = (x * x + y * y + z * z).sqrt();
    let across = (z / (r * r * r) - (1.0 - 2.0 * poisson) / (r * (r + z))) / (4.0 * PI);
    let along = (z * z / (r * r * r) + 2.0 * (1.0 - poisson) / r) / (4.0 * PI);
    [across * x, across * y, along]
}

/// Returns depth [voxels] and displacement of the nodes below the force, on the edge of a quarter of a block with `n`
/// voxels to each side.
fn press(n: usize, progress: &Progress) -> Result<Vec<(usize, f64)>> {
    let grid = VoxelGrid::<Dim3>::from_fn([n; 3], 1.0, |_| 1)?;
    let sharing = Connectivity::new(&grid);
    let hierarchy = CellHierarchy::new(&grid, &sharing, Grading::Graded);
    let mesh = Mesh::grade(&grid, &sharing, &hierarchy)?;
    let elasticity = Elasticity::new(2.0 * (1.0 + POISSON), POISSON)?;
    let far = n as i32;
    let is_far = |at: Point| at.contains(&far);
    let statics = Statics::new(&mesh, elasticity, |node, axis| {
        is_far(node.at) || (axis < 2 && node.at[axis] == 0)
    });
    let mut given = vec![0.0; mesh.node_capacity() * 3];
    let mut load = given.clone();
    for (id, node) in mesh.nodes() {
        let places = 3 * id.index()..3 * id.index() + 3;
        if is_far(node.at) {
            given[places].copy_from_slice(&boussinesq(POISSON, node.at.map(f64::from)));
        } else if node.at == [0; 3] {
            load[3 * id.index() + 2] = 0.25;
        }
    }
    let loaded = statics.solve(&load, vec![0.0; load.len()], progress)?;
    let moved = statics.solve_displaced(&given, progress)?;
    let below = mesh.nodes().filter(|(_, node)| node.at[..2] == [0, 0]);
    let mut found: Vec<(usize, f64)> = below
        .map(|(id, node)| {
            let place = 3 * id.index() + 2;
            (node.at[2] as usize, loaded[place] + moved[place])
        })
        .collect();
    found.sort_by_key(|&(depth, _)| depth);
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displacement_satisfies_equilibrium() {
        // Navier: ∇²u + ∇(div u) / (1 − 2ν) = 0.
        let at = [0.7, -0.4, 1.1];
        let step = 1e-3;
        let moved = |axes: &[(usize, f64)]| {
            let mut place = at;
            axes.iter().for_each(|&(axis, by)| place[axis] += by * step);
            boussinesq(POISSON, place)
        };
        let second = |k: usize, i: usize, j: usize| match i == j {
            true => {
                (moved(&[(i, 1.0)])[k] - 2.0 * boussinesq(POISSON, at)[k] + moved(&[(i, -1.0)])[k])
                    / (step * step)
            }
            false => {
                let corner = |a: f64, b: f64| moved(&[(i, a), (j, b)])[k];
                (corner(1.0, 1.0) - corner(1.0, -1.0) - corner(-1.0, 1.0) + corner(-1.0, -1.0))
                    / (4.0 * step * step)
            }
        };
        for k in 0..3 {
            let laplacian: f64 = (0..3).map(|i| second(k, i, i)).sum();
            let swelling: f64 = (0..3).map(|i| second(i, i, k)).sum();
            let rest = laplacian + swelling / (1.0 - 2.0 * POISSON);
            assert!(rest.abs() < 1e-5, "{k} {rest}");
        }
    }
}
