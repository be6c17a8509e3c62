//! Sag: how far the top of a disc or a ball sinks under its weight, graded against uniform.
//!
//! The lowest layer of nodes is held. Both bodies have the same voxels, for a disc of few voxels is
//! another disc than one of many: what is compared is the placing of elements, and nothing else.
//! The weight is a tenth of that on Earth, so that a ball does not crush the few voxels it stands on.
//!
//! Each body swings, and is stopped wherever its energy of motion is greatest, until next to
//! nothing of that is left: dynamic relaxation with kinetic damping.

use super::motion::{ball, material};
use super::parallel;
use crate::report::{Outcome, Progress};
use anyhow::{Result, bail};
use fuwafuwa::pyramid::Grading;
use fuwafuwa::{Body, Dim, Dim2, Dim3};

/// Voxels across the discs.
const DISCS: [usize; 5] = [16, 32, 64, 128, 256];
/// Voxels across the balls.
const BALLS: [usize; 4] = [8, 16, 32, 64];
/// Largest deviation from the uniform body.
const TOLERANCE: f64 = 0.02;
/// [m/s²]
const GRAVITY: f64 = 1.0;
/// Energy of motion that counts as rest, relative to the energy that sinking set free.
const REST: f64 = 1e-7;
/// A body that swings for so many steps will not settle.
const MOST_STEPS: usize = 400_000;

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

/// How far the top has sunk when the body is at rest [m].
fn sag<D: Dim>(n: usize, grading: Grading, progress: &Progress) -> Result<f64> {
    let mut body = ball::<D>(n, material(), grading)?;
    let nodes: Vec<(u32, i32)> = body
        .mesh()
        .nodes()
        .map(|(id, node)| (id, node.at[1]))
        .collect();
    let lowest = nodes.iter().map(|&(_, y)| y).min().unwrap_or(0);
    let highest = nodes.iter().map(|&(_, y)| y).max().unwrap_or(0);
    for &(id, y) in &nodes {
        if y == lowest {
            body.hold(id);
        }
    }
    let top: Vec<u32> = nodes
        .iter()
        .filter(|&&(_, y)| y == highest)
        .map(|&(id, _)| id)
        .collect();
    let duration = body.longest_substep() as f32;
    let weight = body.total_mass() * GRAVITY;
    let mut before = 0.0;
    for step in 0..MOST_STEPS {
        body.advance(duration, [0.0, -GRAVITY as f32, 0.0]);
        if step % 4 > 0 {
            continue;
        }
        progress.look();
        let energy = body.kinetic_energy();
        if energy < before {
            let sunk = mean_sag(&body, &top);
            if before < REST * weight * sunk {
                return Ok(sunk);
            }
            stop(&mut body, &nodes);
            before = 0.0;
        } else {
            before = energy;
        }
    }
    bail!("the body of {n} voxels across did not settle in {MOST_STEPS} steps")
}

fn mean_sag<D: Dim>(body: &Body<D>, top: &[u32]) -> f64 {
    let sunk = |&id: &u32| {
        let rest = body.mesh().node(id).at[1] as f32 * body.grid().voxel_size();
        f64::from(rest - body.node_state(id).0[1])
    };
    top.iter().map(sunk).sum::<f64>() / top.len() as f64
}

fn stop<D: Dim>(body: &mut Body<D>, nodes: &[(u32, i32)]) {
    for &(id, _) in nodes {
        let (position, _, _) = body.node_state(id);
        body.set_node_state(id, position, [0.0; 3]);
    }
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
