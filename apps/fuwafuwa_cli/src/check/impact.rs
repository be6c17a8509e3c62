//! Impacts of many voxels per substep: no body passes through a plate, contacts keep momentum, and
//! an event reports each slowed impact. A pin on a fast carrier holds.

use super::motion::{centre, material, throw};
use super::parallel;
use super::scale::{TREATMENTS, name};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Context, Result, ensure};
use fuwafuwa::glam::DVec3;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Event, Joint, JointAnchor, Material, RigidBody, Shape, SoftBody,
    SoftBodyHandle, StiffBodies, Vec3, VoxelGrid, World, WorldConfig,
};

/// Bodies: number of dimensions, voxels across, and width [m].
const BODIES: [(usize, usize, f32); 6] = [
    (2, 32, 1.0),
    (2, 32, 0.05),
    (2, 16, 0.002),
    (3, 16, 1.0),
    (3, 16, 0.05),
    (3, 8, 0.002),
];
/// Speeds of the impacts [m/s].
const SPEEDS: [f32; 4] = [10.0, 30.0, 60.0, 300.0];
/// Thickness of the plate [m].
const PLATE: f32 = 0.02;
/// Maximum distance by which the surface of a body enters the plate [m]. The plate pushes it out to the nearer side.
const ENTERED: f64 = 0.4 * PLATE as f64;
/// Maximum distance from which the bodies start [m].
const DISTANCE: f32 = 2.0;
/// Maximum distance from which the bodies start [voxels]. From 8192 voxels on, bodies are out of range.
const VOXELS: f32 = 4000.0;
/// Maximum change of the momentum of two bodies that hit each other, relative to the momentum of one body.
/// Bodies of 2 mm that meet 1 m from the origin lose a percent by rounding.
const MOMENTUM: f64 = 0.02;
/// Maximum speed at which two bodies approach each other at the end, relative to that at the start.
const APPROACH: f64 = 0.9;
/// Speed up to which two bodies 1 m wide stay side by side [m/s]. At higher speeds their surfaces collapse and pass
/// partly through each other, which [`Event::ImpactSlowed`] reports.
const SEPARATE: f32 = 10.0;
/// Carriers: number of dimensions, and final speed [m/s].
const CARRIERS: [(usize, f32); 2] = [(2, 20.0), (3, 50.0)];
/// Maximum distance of a pinned point from its carrier [voxels].
const PINNED: f64 = 1.0;

/// Throws bodies at a plate and at each other, and pulls them by a pin.
pub fn check(progress: &Progress) -> Result<Findings> {
    let cases: Vec<_> = { BODIES.iter() }
        .flat_map(|&body| SPEEDS.map(|speed| (body, speed)))
        .flat_map(|(body, speed)| TREATMENTS.map(|treatment| (body, speed, treatment)))
        .collect();
    let found = parallel::each(
        &cases,
        progress,
        |&((dim, n, width), speed, treatment)| match dim {
            2 => both_impacts::<Dim2>(n, width, speed, treatment),
            _ => both_impacts::<Dim3>(n, width, speed, treatment),
        },
    )?;
    let mut outcomes = Vec::new();
    for (&((dim, n, width), speed, treatment), [thrown, pair]) in cases.iter().zip(&found) {
        let case = |what: &str| {
            format!(
                "{what} {dim}D, n = {n}, {} mm wide, {speed} m/s, {}",
                1e3 * width,
                name(treatment)
            )
        };
        let entered = case("thrown at a plate, entered [m]");
        outcomes.push(Outcome::at_most(entered, thrown.entered, ENTERED));
        if thrown.is_fast {
            let events = case("thrown at a plate, slowed impacts");
            outcomes.push(Outcome::within(events, thrown.slowed, 1.0..=f64::INFINITY));
        }
        if speed <= SEPARATE && width == 1.0 {
            let entered = case("two bodies, entered [widths]");
            outcomes.push(Outcome::at_most(entered, pair.entered, 1.0));
        }
        let approach = case("two bodies, approach speed kept");
        outcomes.push(Outcome::at_most(approach, pair.approach, APPROACH));
        let momentum = case("two bodies, change of momentum");
        outcomes.push(Outcome::at_most(momentum, pair.momentum, MOMENTUM));
    }
    let found = parallel::each(&CARRIERS, progress, |&(dim, speed)| match dim {
        2 => pinned::<Dim2>(speed),
        _ => pinned::<Dim3>(speed),
    })?;
    for ((dim, speed), gap) in CARRIERS.iter().zip(found) {
        let case = format!("pin on a carrier {dim}D, {speed} m/s, gap [voxels]");
        outcomes.push(Outcome::at_most(case, gap, PINNED));
    }
    Ok(outcomes.into())
}

/// Result of an impact.
#[derive(Copy, Clone, Debug, Default)]
struct Impact {
    /// Largest distance by which a node was beyond the surface of the plate [m], or by which the centres of two
    /// bodies came closer than side by side, in widths.
    entered: f64,
    /// Whether the body moves by more than the limit of an impact per substep.
    is_fast: bool,
    /// Number of events of slowed impacts.
    slowed: f64,
    /// Speed at which two bodies approach each other at the end, relative to that at the start.
    approach: f64,
    /// Change of the total momentum, relative to that of one body.
    momentum: f64,
}

fn both_impacts<D: Dim>(
    n: usize,
    width: f32,
    speed: f32,
    treatment: StiffBodies,
) -> Result<[Impact; 2]> {
    Ok([
        on_plate::<D>(n, width, speed, treatment)?,
        on_each_other::<D>(n, width, speed, treatment)?,
    ])
}

/// Returns the distance [m] from which bodies with `n` voxels across start.
fn distance(n: usize, width: f32) -> f32 {
    DISTANCE.min(VOXELS * width / n as f32)
}

fn vector<D: Dim>(x: f32, y: f32, z: f32) -> D::Vector {
    D::Vector::from_vec3(Vec3::new(x, y, if D::N == 3 { z } else { 0.0 }))
}

fn world<D: Dim>(treatment: StiffBodies) -> Result<World<D>> {
    let gravity = D::Vector::ZERO;
    Ok(World::new(WorldConfig {
        gravity,
        stiff_bodies: treatment,
        ..WorldConfig::default()
    })?)
}

/// Adds a ball with its centre at `x`, `y` [m], which flies with a speed along y [m/s].
fn add_ball<D: Dim>(
    world: &mut World<D>,
    n: usize,
    width: f32,
    [x, y]: [f32; 2],
    speed: f32,
) -> Result<SoftBodyHandle> {
    let body = world.add_soft_body(SoftBody::new(VoxelGrid::ball(n, width)?, &[material()])?)?;
    let at = centre(&world[body]).as_vec3();
    world.translate(body, vector::<D>(x, y, 0.0) - D::Vector::from_vec3(at))?;
    throw(world, body, vector::<D>(0.0, speed, 0.0))?;
    Ok(body)
}

/// Steps for as long as a body at `speed` needs for twice a distance [m], and half a second. `look` is called after
/// each tick. Returns the number of events of slowed impacts, and the distance of a substep [m].
fn run<D: Dim>(
    world: &mut World<D>,
    distance: f32,
    speed: f32,
    mut look: impl FnMut(&mut World<D>),
) -> Result<(f64, f32)> {
    let ticks = (120.0 * distance / speed) as usize + 30;
    let (mut slowed, mut moved) = (0, 0.0);
    for _ in 0..ticks {
        let report = world.step();
        ensure!(report.quarantined == 0, "a body was quarantined");
        moved = speed / (60 * report.substeps) as f32;
        let events = world.events().iter();
        let events = events.filter(|event| matches!(event, Event::ImpactSlowed { .. }));
        slowed += events.count();
        look(world);
    }
    Ok((slowed as f64, moved))
}

/// Throws a ball at a plate.
fn on_plate<D: Dim>(n: usize, width: f32, speed: f32, treatment: StiffBodies) -> Result<Impact> {
    let mut world = world::<D>(treatment)?;
    let plate = Shape::Box {
        centre: vector::<D>(0.0, -0.5 * PLATE, 0.0),
        half: vector::<D>(3.0, 0.5 * PLATE, 3.0),
    };
    world.add_rigid_body(RigidBody::fixed(plate))?;
    let distance = distance(n, width);
    let at = [0.013 * width, distance + 0.5 * width];
    let body = add_ball(&mut world, n, width, at, -speed)?;
    let mut entered = 0.0f64;
    let (slowed, moved) = run(&mut world, distance, speed, |world| {
        let pieces = world[body].piece_views().into_iter();
        let lowest = pieces.map(|piece| piece.low.y);
        entered = entered.max(f64::from(-lowest.fold(f32::INFINITY, f32::min)));
    })?;
    Ok(Impact {
        entered,
        is_fast: moved > (width / n as f32).min(0.5 * PLATE),
        slowed,
        ..Impact::default()
    })
}

/// Throws two balls at each other.
fn on_each_other<D: Dim>(
    n: usize,
    width: f32,
    speed: f32,
    treatment: StiffBodies,
) -> Result<Impact> {
    let mut world = world::<D>(treatment)?;
    let distance = distance(n, width);
    let apart = 0.5 * (distance + width);
    let balls = [
        add_ball(&mut world, n, width, [0.0, apart], -0.5 * speed)?,
        add_ball(&mut world, n, width, [0.03 * width, -apart], 0.5 * speed)?,
    ];
    let one = world[balls[0]].total_mass() * f64::from(0.5 * speed);
    let total = |world: &World<D>| -> DVec3 {
        balls
            .iter()
            .map(|&ball| world[ball].momentum().linear)
            .sum()
    };
    let before = total(&world);
    let (mut entered, mut momentum) = (0.0f64, 0.0f64);
    let (slowed, moved) = run(&mut world, distance, speed, |world| {
        let apart = centre(&world[balls[0]]).y - centre(&world[balls[1]]).y;
        entered = entered.max(1.0 - apart / f64::from(width));
        momentum = momentum.max((total(world) - before).length() / one);
    })?;
    let [upper, lower] =
        balls.map(|ball| world[ball].momentum().linear.y / world[ball].total_mass());
    Ok(Impact {
        entered,
        is_fast: moved > width / n as f32,
        slowed,
        approach: (lower - upper) / f64::from(speed),
        momentum,
    })
}

/// Pulls a ball by a pin at its centre, with a carrier that reaches a speed in half a second. Returns the largest
/// distance of the pinned point from the carrier [voxels].
fn pinned<D: Dim>(speed: f32) -> Result<f64> {
    let mut world = World::<D>::new(WorldConfig::default())?;
    let n = if D::N == 2 { 32 } else { 16 };
    let unbreakable = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    let body = world.add_soft_body(SoftBody::new(VoxelGrid::ball(n, 1.0)?, &[unbreakable])?)?;
    let at = D::Vector::from_vec3(centre(&world[body]).as_vec3());
    let carrier = world.add_rigid_body(
        RigidBody::kinematic(Shape::Ball {
            centre: at,
            radius: 0.01,
        })
        .with_sensor(true),
    )?;
    let anchor = JointAnchor::on(body, at).within(0.1);
    let joint = world.add_joint(Joint::pin(anchor, JointAnchor::on(carrier, at)))?;
    let (mut gap, mut moved) = (0.0f32, 0.0);
    for tick in 0..90 {
        let now = speed * (tick as f32 / 30.0).min(1.0);
        moved += now / 60.0;
        world.set_target_position(carrier, at + vector::<D>(moved, 0.0, 0.0))?;
        world.step();
        let both = world.joint_anchor_positions(joint)?;
        let [first, second] = both.context("the pin lost its body")?;
        gap = gap.max((first - second).to_vec3().length());
    }
    Ok(f64::from(gap) * n as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ball_does_not_pass_a_thin_plate() {
        let impact = on_plate::<Dim2>(16, 0.05, 300.0, StiffBodies::MassScaled).unwrap();
        assert!(
            impact.entered < ENTERED && impact.is_fast && impact.slowed > 0.0,
            "{impact:?}"
        );
    }

    #[test]
    fn fast_balls_keep_their_momentum() {
        let impact = on_each_other::<Dim2>(16, 0.1, 100.0, StiffBodies::MassScaled).unwrap();
        let is_hit = impact.slowed > 0.0 && impact.approach < APPROACH;
        assert!(is_hit && impact.momentum < MOMENTUM, "{impact:?}");
    }
}
