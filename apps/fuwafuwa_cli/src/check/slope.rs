//! Slopes: blocks on inclined planes must slide as Coulomb's law says, or rest.
//!
//! ```text
//!             ▗▄
//!         ▗▄▄▄██▌      v = g (sin a − μ cos a) t,  if tan a > μ, otherwise v = 0
//!       ▗▟▙▄▀▀▘
//!    a ▄▛▀▘
//!   ▗▄▛▀
//! ```

use super::parallel;
use crate::plot::{Curve, Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, ensure};
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Material, RigidBody, Rotation, Shape, SoftBody, Vec3,
    VoxelGrid, World, WorldConfig,
};

/// Friction coefficients of the planes.
const FRICTIONS: [f32; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];
/// Slopes of the planes, as tangents of their angles. Blocks rest or slide on each of them. A block as high as
/// it is long would topple beyond 1.
const SLOPES: [f32; 3] = [0.1, 0.3, 0.7];
/// Damping of the soft blocks on the steepest slope; the others have default damping. An elastic block with
/// little damping flutters where friction takes up much of its weight, as elastic bodies do under Coulomb's law
/// [Adams 1995]: it hops down the slope. Substeps a tenth as long leave the hops as they are, and so does half of
/// either term.
const STEEP_DAMPING: Damping = Damping {
    mass: 50.0,
    stiffness: 1e-3,
};
/// Sliding time [s].
const DURATION: f64 = 10.0;
/// Maximum relative deviation of a sliding block's speed from theory.
const TOLERANCE: f64 = 0.01;
/// Maximum distance by which a resting block may creep [voxels].
const CREEP: f64 = 0.05;
/// Gravity [m/s²].
const GRAVITY: f64 = 9.81;
/// Length of a block [m] and its number of voxels. In ten seconds a block reaches up to 56 m/s. Nodes move at
/// most by one voxel in each of 960 substeps a second, here at 120 m/s.
const LENGTH: f32 = 1.0;
const VOXELS: usize = 8;

/// Motion of a block on a slope.
#[derive(Copy, Clone, Debug)]
pub struct Slide {
    /// Speed down the slope at the end [m/s].
    pub speed: f64,
    /// Distance down the slope in the second half of the time [m]. The first half lets the block settle.
    pub crept: f64,
}

/// One case: dimension, whether the block is rigid, friction coefficient, slope.
type Case = (usize, bool, f32, f32);

/// Lets soft and rigid blocks slide in 2D and in 3D.
pub fn check(progress: &Progress) -> Result<Findings> {
    let mut cases: Vec<Case> = Vec::new();
    for dim in [2, 3] {
        for rigid in [false, true] {
            for slope in SLOPES {
                cases.extend(FRICTIONS.map(|friction| (dim, rigid, friction, slope)));
            }
        }
    }
    let found = parallel::each(
        &cases,
        progress,
        |&(dim, rigid, friction, slope)| match dim {
            2 => slide::<Dim2>(rigid, friction, slope, DURATION),
            _ => slide::<Dim3>(rigid, friction, slope, DURATION),
        },
    )?;
    let series = |friction: f32| {
        let of = cases
            .iter()
            .zip(&found)
            .filter(move |(case, _)| case.2 == friction);
        let points = of.map(|(case, slide)| (f64::from(case.3), slide.speed));
        Points::new(format!("friction {friction}"), points)
    };
    let steepest = f64::from(SLOPES.into_iter().fold(0.0, f32::max));
    let theory = |friction: f32| {
        let speed = move |slope: f64| (coulomb(friction, slope as f32) * DURATION).max(0.0);
        Curve::sampled(0.0..=steepest, speed).named(format!("friction {friction}"))
    };
    let plot = Plot {
        x: "slope".into(),
        y: "speed after 10 s [m/s]".into(),
        curves: FRICTIONS.map(theory).into(),
        points: FRICTIONS.map(series).into(),
        ..Plot::default()
    };
    let outcomes = cases.iter().zip(found.iter().copied());
    Ok(Findings {
        outcomes: { outcomes.map(|(case, slide)| outcome(*case, slide)) }.collect(),
        plots: vec![plot],
    })
}

fn outcome((dim, rigid, friction, slope): Case, slide: Slide) -> Outcome {
    let block = if rigid { "rigid" } else { "soft" };
    let case = format!("slope {dim}D, {block} block, slope {slope}, friction {friction}");
    if slope > friction {
        let theory = coulomb(friction, slope) * DURATION;
        Outcome::near(
            format!("{case}, speed / theory"),
            slide.speed / theory,
            1.0,
            TOLERANCE,
        )
    } else {
        let crept = slide.crept.abs() * VOXELS as f64 / f64::from(LENGTH);
        Outcome::at_most(format!("{case}, voxels crept"), crept, CREEP)
    }
}

/// Returns the acceleration of a sliding block [m/s²].
pub fn coulomb(friction: f32, slope: f32) -> f64 {
    let (friction, slope) = (f64::from(friction), f64::from(slope));
    GRAVITY * (slope - friction) / (1.0 + slope * slope).sqrt()
}

/// Lets a block slide down a plane for `duration` [s].
pub fn slide<D: Dim>(rigid: bool, friction: f32, slope: f32, duration: f64) -> Result<Slide> {
    let mut world = World::<D>::new(WorldConfig::default())?;
    // The slope falls in the direction of the first axis.
    let cosine = 1.0 / (1.0 + slope * slope).sqrt();
    let normal = Vec3::new(slope * cosine, cosine, 0.0);
    let down = Vec3::new(cosine, -slope * cosine, 0.0);
    let vector = D::Vector::from_vec3;
    let plane = Shape::half_space(vector(normal), D::Vector::ZERO);
    world.add_rigid_body(RigidBody::fixed(plane).with_friction(friction))?;
    let turn = Rotation::about(-Vec3::Z, slope.atan());
    let size = Vec3::new(LENGTH, 0.5 * LENGTH, LENGTH);
    let centre = |world: &World<D>| -> f64 {
        let soft = world.soft_bodies().map(|(_, body)| body.centre_of_mass());
        let dynamic = world
            .rigid_bodies()
            .skip(1)
            .map(|(_, body)| body.position());
        let at = soft.chain(dynamic).next().expect("the world has a block");
        f64::from(at.to_vec3().dot(down))
    };
    if rigid {
        let shape = Shape::cuboid(vector(0.5 * size));
        let block = RigidBody::dynamic(shape, 50.0).with_friction(friction);
        let block = block.at(vector(normal * (0.5 * size.y))).rotated(turn);
        world.add_rigid_body(block)?;
    } else {
        let material = Material {
            elasticity: Elasticity::new(5e4, 0.3)?,
            friction,
            damping: if slope > 0.5 {
                STEEP_DAMPING
            } else {
                Damping::default()
            },
            strength: f32::INFINITY,
            ..Material::default()
        };
        let cells = [VOXELS, VOXELS / 2, D::depth(VOXELS)];
        let grid = VoxelGrid::from_fn(cells, LENGTH / VOXELS as f32, |_| 1)?;
        let block = SoftBody::new(grid, &[material])?;
        world.add_soft_body(block.rotated_about(turn, D::Vector::ZERO))?;
    }
    let ticks = (60.0 * duration) as usize;
    let (mut before, mut half, mut now) = (0.0, 0.0, centre(&world));
    for tick in 1..=ticks {
        let report = world.step();
        ensure!(report.quarantined == 0, "the block was quarantined");
        (before, now) = (now, centre(&world));
        if tick == ticks / 2 {
            half = now;
        }
    }
    Ok(Slide {
        speed: (now - before) * 60.0,
        crept: now - half,
    })
}
