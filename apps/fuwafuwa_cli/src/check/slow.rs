//! Slow motion: bodies that sag, float or slide slowly must not be stopped by sleep or by hidden damping.

use super::bar::fix_where;
use super::parallel;
use super::slope::{coulomb, slide};
use super::statics::Statics;
use crate::report::{Findings, Outcome, Progress};
use anyhow::Result;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Material, RigidBody, Shape, SoftBody, Vec3, Velocity, VoxelGrid,
    World, WorldConfig,
};

/// Length and thickness of the cantilever [voxels]. It is 1 m long.
const CANTILEVER: [usize; 2] = [64, 4];
/// Gravity on the cantilever [m/s²]. Its tip sags by some 4 cm.
const WEAK_GRAVITY: f32 = 0.05;
/// Maximum time in which the cantilever may sag [s].
const SAGGING: usize = 120;
/// Maximum relative deviation of the cantilever's sag from its static solution.
const SAG_TOLERANCE: f64 = 0.02;
/// Speed of the floating bodies [m/s].
const FLOATING: f32 = 0.02;
/// Slopes of the frictionless planes, as tangents of their angles.
const SLOPES: [f32; 2] = [0.015, 0.01];
/// Maximum relative deviation of a speed.
const SPEED_TOLERANCE: f64 = 0.01;

/// Lets bodies sag, float and slide slowly.
pub fn check(progress: &Progress) -> Result<Findings> {
    let case = "cantilever 64 x 4, gravity 0.05, sag / static solution".to_owned();
    let sag = sag(progress)?;
    let mut outcomes = vec![Outcome::near(case, sag, 1.0, SAG_TOLERANCE)];
    for (dim, soft, rigid) in [
        (2, float::<Dim2>(false, 20)?, float::<Dim2>(true, 20)?),
        (3, float::<Dim3>(false, 20)?, float::<Dim3>(true, 20)?),
    ] {
        for (body, speed) in [("soft", soft), ("rigid", rigid)] {
            let case = format!("floating {dim}D, {body} body at 2 cm/s, speed after 20 s / before");
            outcomes.push(Outcome::near(case, speed, 1.0, SPEED_TOLERANCE));
        }
    }
    let mut cases = Vec::new();
    for dim in [2, 3] {
        for rigid in [false, true] {
            cases.extend(SLOPES.map(|slope| (dim, rigid, slope)));
        }
    }
    let found = parallel::each(&cases, progress, |&(dim, rigid, slope)| match dim {
        2 => slide::<Dim2>(rigid, 0.0, slope, 10.0),
        _ => slide::<Dim3>(rigid, 0.0, slope, 10.0),
    })?;
    for ((dim, rigid, slope), slide) in cases.into_iter().zip(found) {
        let block = if rigid { "rigid" } else { "soft" };
        let case = format!("frictionless slope {slope} {dim}D, {block} block, speed / theory");
        let ratio = slide.speed / (10.0 * coulomb(0.0, slope));
        outcomes.push(Outcome::near(case, ratio, 1.0, SPEED_TOLERANCE));
    }
    Ok(outcomes.into())
}

/// Returns the sag of the cantilever's tip when it has fallen asleep, or after [`SAGGING`], relative to its
/// static solution.
fn sag(progress: &Progress) -> Result<f64> {
    let mut world = World::<Dim2>::new(WorldConfig {
        gravity: -Vec3::Y.truncate() * WEAK_GRAVITY,
        ..WorldConfig::default()
    })?;
    let material = Material {
        elasticity: Elasticity::new(5e4, 0.3)?,
        strength: f32::INFINITY,
        ..Material::default()
    };
    let [length, thickness] = CANTILEVER;
    let grid = VoxelGrid::from_fn([length, thickness, 1], 1.0 / length as f32, |_| 1)?;
    let mut body = SoftBody::<Dim2>::new(grid, &[material])?;
    fix_where(&mut body, |at| at[0] == 0);
    let nodes: Vec<_> = body.mesh().nodes().collect();
    let statics = Statics::new(body.mesh(), material.elasticity, |node, _| node.at[0] == 0);
    let mut load = vec![0.0; body.mesh().node_capacity() * 2];
    for &(id, _) in &nodes {
        let mass = f64::from(body.node_state(id).2);
        load[id.index() * 2 + 1] = -mass * f64::from(WEAK_GRAVITY);
    }
    let (tip, _) = *nodes
        .iter()
        .find(|(_, node)| node.at[..2] == [length as i32, 0])
        .expect("the beam has a corner");
    let expected = statics.solve(&load, vec![0.0; load.len()], progress)?[tip.index() * 2 + 1];
    let start = f64::from(body.node_state(tip).0.y);
    let body = world.add_soft_body(body)?;
    for _ in 0..60 * SAGGING {
        world.step();
        progress.show_if_slow();
        if world[body].piece_views()[0].asleep {
            break;
        }
    }
    Ok((f64::from(world[body].node_state(tip).0.y) - start) / expected)
}

/// Returns the speed of a free body after some `seconds` without gravity, relative to its speed at the start.
fn float<D: Dim>(rigid: bool, seconds: usize) -> Result<f64> {
    let mut world = World::<D>::new(WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    })?;
    let velocity = Velocity::linear(D::Vector::from_vec3(Vec3::X * FLOATING));
    if rigid {
        let body = RigidBody::dynamic(Shape::ball(0.5), 1.0);
        world.add_rigid_body(body.with_velocity(velocity))?;
    } else {
        let body = SoftBody::new(VoxelGrid::ball(8, 1.0)?, &[Material::default()])?;
        world.add_soft_body(body.with_velocity(velocity))?;
    }
    let centre = |world: &World<D>| -> f64 {
        let soft = world.soft_bodies().map(|(_, body)| body.centre_of_mass());
        let rigid = world.rigid_bodies().map(|(_, body)| body.position());
        let at = soft.chain(rigid).next().expect("the world has a body");
        f64::from(at.to_vec3().x)
    };
    for _ in 0..60 * (seconds - 1) {
        world.step();
    }
    let before = centre(&world);
    for _ in 0..60 {
        world.step();
    }
    Ok((centre(&world) - before) / f64::from(FLOATING))
}
