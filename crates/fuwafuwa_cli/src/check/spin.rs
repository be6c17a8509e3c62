//! Spin: a free body that turns keeps its angular momentum.

use super::motion::{arrange, ball, length, material};
use super::parallel;
use crate::report::{Outcome, Progress};
use anyhow::Result;
use fuwafuwa::pyramid::Grading;
use fuwafuwa::world::TICK;
use fuwafuwa::{Dim, Dim2, Dim3, Material, Settings, World};

/// Dimensions, voxels across, and damping of the bodies.
const BODIES: [(usize, usize, f32); 4] = [(2, 32, 0.0), (2, 32, 0.08), (3, 24, 0.0), (3, 24, 0.08)];
/// Share of the angular momentum that must be left.
const KEPT: f64 = 0.999;
/// How long a body spins [s].
const DURATION: f32 = 5.0;

/// Angular momentum along its first direction, after some seconds at 5 rad/s.
pub fn check(progress: &Progress) -> Result<Vec<Outcome>> {
    let found = parallel::each(&BODIES, progress, |&(dim, n, damping)| match dim {
        2 => kept::<Dim2>(n, damping),
        _ => kept::<Dim3>(n, damping),
    })?;
    let outcome = |(&(dim, n, damping), kept): (&(usize, usize, f32), f64)| {
        let case = format!("spin {dim}D, n = {n}, damping {damping}, kept after {DURATION} s");
        Outcome::within(case, kept, KEPT..=2.0 - KEPT)
    };
    Ok(BODIES.iter().zip(found).map(outcome).collect())
}

fn kept<D: Dim>(n: usize, damping: f32) -> Result<f64> {
    let material = Material {
        damping,
        ..material()
    };
    let mut body = ball::<D>(n, material, Grading::Graded)?;
    // 5 rad/s about (0, 4, 3) / 5; in 2D about the third axis.
    let spin = if D::N == 3 {
        [0.0, 4.0, 3.0]
    } else {
        [0.0, 0.0, 5.0]
    };
    arrange(&mut body, |[x, y, z]| {
        let velocity = [
            spin[1] * z - spin[2] * y,
            spin[2] * x - spin[0] * z,
            spin[0] * y - spin[1] * x,
        ];
        ([x, y, z], velocity)
    });
    let mut world = World::<D>::new(Settings {
        gravity: [0.0; 3],
        drag: 0.0,
        most_substeps: 1024,
    })?;
    world.add_body(body);
    let before = world.bodies()[0].momentum().angular;
    for _ in 0..(DURATION / TICK).round() as usize {
        world.step();
    }
    let after = world.bodies()[0].momentum().angular;
    let along: f64 = (0..3).map(|axis| before[axis] * after[axis]).sum();
    Ok(along / (length(before) * length(before)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_ball_keeps_its_spin() {
        assert!(kept::<Dim3>(8, 0.0).unwrap() > KEPT);
    }
}
