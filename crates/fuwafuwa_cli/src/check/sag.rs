//! Sag: how far the top of a disc or a ball sinks under its weight, graded against uniform.
//!
//! The lowest layer of nodes is held. Both bodies have the same voxels, for a disc of few voxels is
//! another disc than one of many, and stands on another foot: what is compared is the placing of
//! elements and nothing else. The weight is small, so the law is linearised at rest; the sag that
//! is shown is that for a game's material and a gravity of 1 m/s².

use super::motion::material;
use super::parallel;
use super::statics::Statics;
use crate::report::{Outcome, Progress};
use anyhow::Result;
use fuwafuwa::pyramid::{Grading, Pyramid};
use fuwafuwa::sharing::Sharing;
use fuwafuwa::{Dim, Dim2, Dim3, Mesh, VoxelGrid};

/// Voxels across the discs.
const DISCS: [usize; 5] = [16, 32, 64, 128, 256];
/// Voxels across the balls.
const BALLS: [usize; 4] = [8, 16, 32, 64];
/// Largest deviation from the uniform body.
const TOLERANCE: f64 = 0.02;

/// Sag of graded bodies relative to that of uniform ones.
pub fn check(progress: &Progress) -> Result<Vec<Outcome>> {
    let discs = DISCS.map(|n| (2, n));
    let mut cases: Vec<(usize, usize)> = discs.into_iter().chain(BALLS.map(|n| (3, n))).collect();
    // The slowest last.
    cases.sort_by_key(|&(dim, n)| n.pow(dim as u32) * n);
    let found = parallel::each(&cases, progress, |&(dim, n)| match dim {
        2 => sags::<Dim2>(n, progress),
        _ => sags::<Dim3>(n, progress),
    })?;
    let mut outcomes: Vec<((usize, usize), Outcome)> = Vec::new();
    for (&(dim, n), [graded, uniform]) in cases.iter().zip(found) {
        let outcome = Outcome::near(
            format!(
                "sag {dim}D, n = {n}, graded / uniform ({:.2} mm)",
                1e3 * uniform
            ),
            graded / uniform,
            1.0,
            TOLERANCE,
        );
        outcomes.push(((dim, n), outcome));
    }
    outcomes.sort_by_key(|&(case, _)| case);
    Ok(outcomes.into_iter().map(|(_, outcome)| outcome).collect())
}

fn sags<D: Dim>(n: usize, progress: &Progress) -> Result<[f64; 2]> {
    Ok([
        sag::<D>(n, Grading::Graded, progress)?,
        sag::<D>(n, Grading::Uniform, progress)?,
    ])
}

/// How far the top sinks [m].
fn sag<D: Dim>(n: usize, grading: Grading, progress: &Progress) -> Result<f64> {
    let material = material();
    let grid = VoxelGrid::<D>::ball(n, 1.0)?;
    let sharing = Sharing::new(&grid);
    let mesh = Mesh::grade(&grid, &sharing, &Pyramid::new(&grid, &sharing, grading))?;
    let heights: Vec<i32> = mesh.nodes().map(|(_, node)| node.at[1]).collect();
    let lowest = heights.iter().copied().min().unwrap_or(0);
    let highest = heights.iter().copied().max().unwrap_or(0);
    let statics = Statics::new(&mesh, material.elasticity, |node| node.at[1] == lowest);
    let mut load = vec![0.0; mesh.node_capacity() * D::N];
    for (_, element) in mesh.elements() {
        let half = 0.5 * f64::from(element.cell.width());
        let child = (0..D::N).fold(f64::from(material.density), |mass, _| mass * half);
        let shares = &mesh.stencil(element).volumes;
        for (&node, share) in element.nodes.iter().zip(shares) {
            load[node as usize * D::N + 1] -= child * share;
        }
    }
    let still = vec![0.0; load.len()];
    let moved = statics.solve(&load, still, progress)?;
    let top = mesh.nodes().filter(|(_, node)| node.at[1] == highest);
    let sunk: Vec<f64> = top.map(|(id, _)| -moved[id as usize * D::N + 1]).collect();
    // In voxels: a load grows with their volume, a stiffness with their width in space only.
    let voxel = f64::from(grid.voxel_size());
    Ok(sunk.iter().sum::<f64>() / sunk.len() as f64 * voxel * voxel)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_disc_sags_like_its_voxels() {
        let [graded, uniform] = sags::<Dim2>(16, &Progress::new()).unwrap();
        assert!(uniform > 1e-3 && (graded / uniform - 1.0).abs() < TOLERANCE);
    }
}
