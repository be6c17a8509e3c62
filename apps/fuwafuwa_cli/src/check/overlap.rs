//! Overlap: objects placed inside each other must be reported, come apart without being thrown, and stay awake
//! until then.

use super::parallel;
use crate::report::{Findings, Outcome, Progress};
use anyhow::Result;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Event, Material, RigidBody, Shape, SoftBody, Vec3, VoxelGrid,
    World, WorldConfig,
};

/// Voxels across a ball.
const VOXELS: usize = 12;
/// Width of the grid of a ball [m].
const WIDTH: f32 = 0.5;
/// Simulated time [s].
const DURATION: f32 = 10.0;
/// Highest speed, as root mean square over a body [m/s]: that at which overlaps are resolved.
const TOP_SPEED: f64 = 0.5;
/// Depth that may be left [voxels].
const DEPTH: f64 = 0.75;

/// What the ball is placed in.
#[derive(Copy, Clone, Debug)]
enum Case {
    /// A ball, so many metres beside it.
    Ball(f32),
    /// A floor that cuts the ball in half.
    Floor,
    /// A small rigid box in the middle of the ball.
    Box,
    /// A wall through the middle of the ball.
    Wall,
}

/// Measurements after a ball was placed in something.
struct Found {
    reports: f64,
    slept: f64,
    top: f64,
    depth: f64,
}

/// Places balls in other objects, in 2D and 3D, without gravity.
pub fn check(progress: &Progress) -> Result<Findings> {
    let cases = [
        Case::Ball(0.22),
        Case::Ball(0.0),
        Case::Floor,
        Case::Box,
        Case::Wall,
    ];
    let cases: Vec<(usize, Case)> = [2, 3]
        .into_iter()
        .flat_map(|dim| cases.map(|case| (dim, case)))
        .collect();
    let found = parallel::each(&cases, progress, |&(dim, case)| match dim {
        2 => measure::<Dim2>(case, DURATION),
        _ => measure::<Dim3>(case, DURATION),
    })?;
    let mut outcomes = Vec::new();
    for ((dim, case), found) in cases.into_iter().zip(found) {
        let name = |what: &str| format!("overlap {dim}D, {case:?}, {what}");
        outcomes.push(Outcome::near(name("reports"), found.reports, 1.0, 0.0));
        outcomes.push(Outcome::at_most(
            name("ticks asleep inside"),
            found.slept,
            0.0,
        ));
        outcomes.push(Outcome::at_most(
            name("top speed, m/s"),
            found.top,
            TOP_SPEED,
        ));
        outcomes.push(Outcome::at_most(
            name("depth left, voxels"),
            found.depth,
            DEPTH,
        ));
    }
    Ok(outcomes.into())
}

fn measure<D: Dim>(case: Case, duration: f32) -> Result<Found> {
    let gravity = D::Vector::ZERO;
    let mut world = World::<D>::new(WorldConfig {
        gravity,
        ..WorldConfig::default()
    })?;
    let material = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    let ball = || SoftBody::new(VoxelGrid::ball(VOXELS, WIDTH)?, &[material]);
    let mut bodies = vec![world.add_soft_body(ball()?)?];
    let vector = |x: f32, y: f32, z: f32| D::Vector::from_vec3(Vec3::new(x, y, z));
    let half = 0.5 * WIDTH;
    let shape = match case {
        Case::Ball(_) => None,
        Case::Floor => Some(Shape::half_space(D::Vector::Y, D::Vector::ZERO)),
        Case::Box => Some(Shape::cuboid(D::Vector::splat(0.06))),
        Case::Wall => Some(Shape::cuboid(vector(0.05, 0.6, 0.6))),
    };
    let shape = shape.map(|shape| shape.translated(vector(half, half, half)));
    if let Some(shape) = shape {
        world.add_rigid_body(RigidBody::fixed(shape))?;
    }
    if let Case::Ball(offset) = case {
        bodies.push(world.add_soft_body(ball()?.translated(D::Vector::X * offset))?);
    }
    let mut found = Found {
        reports: 0.0,
        slept: 0.0,
        top: 0.0,
        depth: 0.0,
    };
    // Width of a ball without the empty margin of its grid.
    let width = world[bodies[0]].piece_views()[0];
    let width = width.high.x - width.low.x;
    for _ in 0..(60.0 * duration) as usize {
        world.step();
        let events = world.events().iter();
        let overlapped = events.filter(|event| matches!(event, Event::Overlapped { .. }));
        found.reports += overlapped.count() as f64;
        let size = f64::from(WIDTH) / VOXELS as f64;
        found.depth = match shape {
            None => {
                let [a, b] = [0, 1].map(|k: usize| world[bodies[k]].centre_of_mass());
                f64::from(width - (a - b).length()) / size
            }
            Some(shape) => {
                let body = &world[bodies[0]];
                let nodes = body.mesh().nodes().map(|(node, _)| body.node_state(node).0);
                let depth = nodes.map(|at| -shape.distance(at).0);
                f64::from(depth.fold(f32::NEG_INFINITY, f32::max)) / size
            }
        };
        for &id in &bodies {
            let body = &world[id];
            found.top = found
                .top
                .max((2.0 * body.kinetic_energy() / body.total_mass()).sqrt());
            let asleep = body.pieces().list.iter().all(|piece| piece.asleep);
            found.slept += f64::from(u8::from(asleep && found.depth > DEPTH));
        }
    }
    Ok(found)
}
