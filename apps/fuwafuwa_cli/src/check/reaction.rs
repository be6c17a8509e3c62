//! Reactions: supports must carry the weight of what lies or hangs on them, also while it sleeps, and a
//! stretched bar must pull with Young's modulus times area times strain.

use super::parallel;
use crate::report::{Findings, Outcome, Progress};
use anyhow::Result;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimAngular, DimVector, Grip, Material, RigidBody, Shape, SoftBody, Vec3,
    VoxelGrid, World, WorldConfig,
};

/// Acceleration of gravity of the default world [m/s²].
const GRAVITY: f64 = 9.81;
/// Young's modulus of bars [Pa].
const YOUNG: f64 = 4e5;
/// Strain of the stretched bar.
const STRAIN: f64 = 0.02;
/// Relative tolerance. A body falls asleep after it was slower than the speed after 4 ms of free fall for half a
/// second. The mean force in this time differs from the weight by the change of the momentum over the time, at
/// most 2 · 4 ms / 0.5 s.
const TOLERANCE: f64 = 0.016;

/// Measures reactions in 2D and 3D, relative to theory.
pub fn check(progress: &Progress) -> Result<Findings> {
    let found = parallel::each(&[2, 3], progress, |&dim| match dim {
        2 => measure::<Dim2>(),
        _ => measure::<Dim3>(),
    })?;
    let mut outcomes = Vec::new();
    for (dim, ratios) in [2, 3].into_iter().zip(found) {
        for (what, ratio) in ratios {
            let case = format!("reaction {dim}D, {what}, / theory");
            outcomes.push(Outcome::near(case, ratio, 1.0, TOLERANCE));
        }
    }
    Ok(outcomes.into())
}

fn measure<D: Dim>() -> Result<Vec<(&'static str, f64)>> {
    let mut ratios = Vec::new();
    ratios.push(("floor under a sleeping ball", floor::<D>()?));
    let [force, moment] = cantilever::<D>()?;
    ratios.push(("grip of a sleeping cantilever, force", force));
    ratios.push(("grip of a sleeping cantilever, moment", moment));
    ratios.push(("force of a stretched bar", stretched::<D>()?));
    Ok(ratios)
}

/// Returns the force on a floor under a sleeping ball, divided by the weight of the ball.
fn floor<D: Dim>() -> Result<f64> {
    let mut world = World::<D>::new(WorldConfig::default())?;
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    let floor = world.add_rigid_body(RigidBody::fixed(floor))?;
    let material = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    let ball = SoftBody::new(VoxelGrid::ball(12, 0.5)?, &[material])?;
    let weight = GRAVITY * ball.total_mass();
    world.add_soft_body(ball)?;
    step_until_asleep(&mut world);
    Ok(-f64::from(world.reaction(floor)?.force[1]) / weight)
}

/// Returns the force and the moment that hold a cantilever, divided by its weight and by weight times half of
/// its length.
fn cantilever<D: Dim>() -> Result<[f64; 2]> {
    let mut world = World::<D>::new(WorldConfig::default())?;
    let bar = bar::<D>()?;
    let weight = GRAVITY * bar.total_mass();
    let bar = world.add_soft_body(bar)?;
    let grip = world.add_grip(Grip::still(bar, left_end()))?;
    step_until_asleep(&mut world);
    let root = D::Vector::from_vec3(Vec3::new(0.0, 0.1, 0.1));
    let reaction = world.grip(grip)?.reaction().about(root);
    let moment = f64::from(reaction.torque.to_vec3().z);
    Ok([
        f64::from(reaction.force[1]) / weight,
        moment / (weight * 0.4),
    ])
}

/// Returns the force that stretches a bar, divided by E A ε.
fn stretched<D: Dim>() -> Result<f64> {
    let gravity = D::Vector::ZERO;
    let mut world = World::<D>::new(WorldConfig {
        gravity,
        ..WorldConfig::default()
    })?;
    let bar = world.add_soft_body(bar::<D>()?)?;
    let clamp = RigidBody::kinematic(Shape::ball(0.01)).with_sensor(true);
    let clamp = world.add_rigid_body(clamp)?;
    world.add_grip(Grip::still(bar, left_end()))?;
    let right = Shape::half_space(-D::Vector::X, D::Vector::X * 0.79);
    let pulled = world.add_grip(Grip::carried(bar, right, clamp))?;
    for tick in 1..=120 {
        let stretch = 0.8 * STRAIN as f32 * tick as f32 / 120.0;
        world.set_target_position(clamp, D::Vector::X * stretch)?;
        world.step();
    }
    step_until_asleep(&mut world);
    let area = if D::N == 3 { 0.2 * 0.2 } else { 0.2 };
    let force = f64::from(world.grip(pulled)?.reaction().force[0]);
    Ok(force / (YOUNG * area * STRAIN))
}

fn left_end<D: Dim>() -> Shape<D> {
    Shape::half_space(D::Vector::X, D::Vector::X * 0.01)
}

/// Returns a bar of 0.8 × 0.2 (× 0.2) m without transverse contraction.
fn bar<D: Dim>() -> Result<SoftBody<D>> {
    let depth = if D::N == 3 { 4 } else { 1 };
    let material = Material {
        elasticity: Elasticity {
            young: YOUNG,
            poisson: 0.0,
        },
        strength: f32::INFINITY,
        ..Material::default()
    };
    let grid = VoxelGrid::from_fn([16, 4, depth], 0.05, |_| 1)?;
    Ok(SoftBody::new(grid, &[material])?)
}

/// Steps until all bodies sleep, for 30 s at most.
fn step_until_asleep<D: Dim>(world: &mut World<D>) {
    for _ in 0..1800 {
        world.step();
        let mut pieces = world
            .soft_bodies()
            .flat_map(|(_, body)| body.pieces().list.iter());
        if pieces.all(|piece| piece.asleep) {
            break;
        }
    }
}
