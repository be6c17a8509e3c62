//! Stack: ten boxes on top of each other must stand still.

use super::motion::material;
use super::parallel;
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, ensure};
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Material, RigidBody, Shape, SoftBody, Vec3, VoxelGrid, World,
    WorldConfig,
};

/// Number of bodies in a stack.
const BODIES: usize = 10;
/// Voxels across a body.
const VOXELS: usize = 4;
/// Width of a body [m].
const WIDTH: f32 = 0.1;
/// Young's modulus of the bodies [Pa]. A column of this height buckles under its own weight below ρ g A h³ /
/// (7.84 I) [Greenhill 1881], which is 1.5e5 Pa here.
const YOUNG: f64 = 2.4e5;
/// Simulated time [s].
const DURATION: f32 = 60.0;
/// Time after which the stack must stand still [s].
const SETTLED: f32 = 5.0;
/// Maximum sideways distance of a body from its initial position [widths of a body].
const LEANING: f64 = 0.05;
/// Maximum motion of a body after [`SETTLED`] [widths of a body].
const MOTION: f64 = 0.01;

/// Measurements of a stack, in widths of a body.
struct Stack {
    leaning: f64,
    motion: f64,
}

/// Simulates stacks of boxes in 2D and 3D.
pub fn check(progress: &Progress) -> Result<Findings> {
    let found = parallel::each(&[2, 3], progress, |&dim| match dim {
        2 => stand::<Dim2>(BODIES, DURATION),
        _ => stand::<Dim3>(BODIES, DURATION),
    })?;
    let mut outcomes = Vec::new();
    for (dim, stack) in [2, 3].into_iter().zip(found) {
        let case =
            |what: &str| format!("stack {dim}D, {BODIES} bodies, {what} in {DURATION} s, widths");
        outcomes.push(Outcome::at_most(case("leaning"), stack.leaning, LEANING));
        outcomes.push(Outcome::at_most(case("motion"), stack.motion, MOTION));
    }
    Ok(outcomes.into())
}

fn stand<D: Dim>(bodies: usize, duration: f32) -> Result<Stack> {
    let mut world = World::<D>::new(WorldConfig::default())?;
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor).with_friction(0.5))?;
    let material = Material {
        elasticity: Elasticity {
            young: YOUNG,
            ..material().elasticity
        },
        damping: Material::default().damping,
        ..material()
    };
    for place in 0..bodies {
        let body = SoftBody::new(VoxelGrid::cube(VOXELS, WIDTH)?, &[material])?;
        world.add_soft_body(body.translated(D::Vector::Y * (WIDTH * place as f32)))?;
    }
    let centres = |world: &World<D>| -> Vec<Vec3> {
        let bodies = world.soft_bodies();
        bodies
            .map(|(_, body)| body.piece_views()[0].centre)
            .collect()
    };
    let put = centres(&world);
    let mut settled = put.clone();
    let (mut leaning, mut motion) = (0.0f32, 0.0f32);
    for tick in 0..(60.0 * duration) as usize {
        let report = world.step();
        ensure!(report.nodes_split == 0, "a body of the stack tore");
        let now = centres(&world);
        if tick == (60.0 * SETTLED) as usize {
            settled.clone_from(&now);
        }
        for place in 0..bodies {
            let gone = |from: &[Vec3], axis: usize| (now[place][axis] - from[place][axis]).abs();
            let sideways = (0..D::N).filter(|&axis| axis != 1);
            leaning = sideways.fold(leaning, |most, axis| most.max(gone(&put, axis)));
            if tick > (60.0 * SETTLED) as usize {
                motion = (0..D::N).fold(motion, |most, axis| most.max(gone(&settled, axis)));
            }
        }
    }
    Ok(Stack {
        leaning: f64::from(leaning / WIDTH),
        motion: f64::from(motion / WIDTH),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stack_of_two_bodies_stands_still() {
        let stack = stand::<Dim2>(2, SETTLED + 1.0).unwrap();
        assert!(stack.leaning <= LEANING && stack.motion <= MOTION);
    }
}
