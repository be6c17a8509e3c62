//! Momentum: releases (splits of nodes) and remodelling must not change the momentum of a body.

use super::motion::{arrange, ball, material};
use super::parallel;
use super::random::Random;
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, anyhow};
use fuwafuwa::{Dim, Dim2, Dim3, DimVector, Grading, Point, Vec3};

/// Bodies in which nodes are released: number of dimensions and voxels across.
const BODIES: [(usize, usize); 3] = [(2, 32), (3, 12), (3, 16)];
/// Number of releases, each at a random point along a random axis.
const RELEASES: usize = 1000;
/// Number of releases after which one substep is simulated.
const BETWEEN_STEPS: usize = 10;
/// Maximum change of mass, linear or angular momentum, relative to the initial value.
const TOLERANCE: f64 = 1e-4;

/// Measures the drift of mass, linear and angular momentum over random releases.
pub fn check(progress: &Progress) -> Result<Findings> {
    let found = parallel::each(&BODIES, progress, |&(dim, n)| match dim {
        2 => drifts::<Dim2>(n, RELEASES),
        _ => drifts::<Dim3>(n, RELEASES),
    })?;
    let mut outcomes = Vec::new();
    for ((dim, n), drifts) in BODIES.iter().zip(found) {
        for (name, drift) in ["mass", "linear momentum", "angular momentum"]
            .iter()
            .zip(drifts)
        {
            let case = format!("{name} {dim}D, n = {n}, drift in {RELEASES} releases");
            outcomes.push(Outcome::at_most(case, drift, TOLERANCE));
        }
    }
    Ok(outcomes.into())
}

/// Returns the relative changes of mass, linear and angular momentum caused by `releases` random releases.
fn drifts<D: Dim>(n: usize, releases: usize) -> Result<[f64; 3]> {
    let mut body = ball::<D>(n, material(), Grading::Graded)?;
    arrange(&mut body, |rest| {
        let [x, y, z] = rest.to_array();
        (
            Vec3::new(x * 1.05, y * 0.95, z),
            Vec3::new(1.0 + 2.0 * y, 0.5 - x + z, 0.3 * x),
        )
    })?;
    let (mass, before) = (body.total_mass(), body.momentum());
    let mut random = Random::new(n as u64);
    for release in 0..releases {
        let mut at: Point = [0; 3];
        at.iter_mut()
            .take(D::N)
            .for_each(|k| *k = random.below(n as i32));
        let axis = random.below(D::N as i32) as usize;
        let far = (0..D::CORNERS).filter(|octant| octant >> axis & 1 == 1);
        let side = far.fold(0, |mask, octant| mask | 1 << octant);
        body.release(&[(at, side)]);
        if release % BETWEEN_STEPS == 0 {
            body.advance(body.longest_substep() as f32, D::Vector::ZERO);
        }
    }
    let mesh = body.mesh().validate(body.grid(), body.connectivity());
    mesh.map_err(|defect| anyhow!("the mesh after {releases} releases: {defect}"))?;
    let change = body.momentum().less(before);
    Ok([
        (body.total_mass() / mass - 1.0).abs(),
        change.linear.length() / before.linear.length(),
        change.angular.length() / before.angular.length(),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn releases_preserve_mass_and_momentum() {
        for drifts in [drifts::<Dim2>(24, RELEASES), drifts::<Dim3>(12, RELEASES)] {
            let [mass, linear, angular] = drifts.unwrap();
            assert!(mass < 1e-5 && linear < TOLERANCE && angular < TOLERANCE);
        }
    }
}
