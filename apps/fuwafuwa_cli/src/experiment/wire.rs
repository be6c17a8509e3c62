//! A sharp edge through gelatine at three speeds must resist with the fracture energy of the material.
//!
//! Forte, D'Amico, Charalambides, Dini and Williams (2015, Food Hydrocolloids 46, 180) cut gels of gelatine with 10 % of
//! solids with wires: the fracture energy is 1.1 J/m² up to 10 mm/min, and grows with the root of the speed beyond. The
//! force of a sharp edge per width equals the fracture energy. The engine is given this fracture energy, and the forces on
//! the edge are compared with it; no measured force is compared. The block is similar to one of 20 mm: 1 m wide, with the same
//! ratio of fracture energy, stiffness and width. The speeds are 1, 10 and 100 times the speed up to which the energy is
//! constant, and slow beside the waves in the block.

use super::pull::still_world;
use super::{Bound, Record, Role, Row, Setup};
use crate::check::parallel;
use crate::plot::{Curve, Plot, Points};
use crate::report::Progress;
use anyhow::{Context, Result};
use fuwafuwa::{
    Damping, Dim2, Knife, Material, RateToughening, RigidBody, Shape, SoftBody, Vec2, VoxelGrid,
    library,
};
use std::time::Instant;

/// Speeds in the experiment [mm/min].
const SPEEDS: [f64; 3] = [10.0, 100.0, 1000.0];
/// Speed up to which the fracture energy is constant [mm/min], and in the simulation [m/s].
const SLOW: [f64; 2] = [10.0, 0.004];
/// Greatest deviation.
const BOUND: f64 = 0.15;
/// Voxels across the block.
const VOXELS: usize = 32;
/// Range of depths in which the force is averaged [m].
const RANGE: [f64; 2] = [0.2, 0.5];
/// Width of the block in the experiment [m].
const WIDTH: f64 = 0.02;

/// Compares the forces per width with the fracture energy.
pub fn run(progress: &Progress) -> Result<Record> {
    let found = parallel::each(&SPEEDS, progress, |&speed| force(speed))?;
    let row = |(&speed, &(computed, setup)): (&f64, &(f64, Setup))| Row {
        case: format!(
            "edge through gelatine at {speed} mm/min, force / width [N/m], given fracture energy"
        ),
        role: Role::Verification,
        reference: Some(given_energy(speed)),
        spread: None,
        computed,
        bound: Bound::Relative(BOUND),
        setup,
    };
    let points = SPEEDS
        .iter()
        .zip(&found)
        .map(|(&speed, &(force, _))| (speed, force));
    let curve = [1.0, 10.0, 100.0, 1000.0].map(|speed| (speed, given_energy(speed)));
    Ok(Record {
        rows: SPEEDS.iter().zip(&found).map(row).collect(),
        plots: vec![Plot {
            x: "speed [mm/min]".into(),
            y: "force / width [N/m]".into(),
            curves: vec![Curve::new(curve).named("given fracture energy")],
            points: vec![Points::new("computed", points)],
            is_log: [true, true],
            ..Plot::default()
        }],
    })
}

/// Returns the fracture energy [J/m²] that the material is given at a speed [mm/min]: 1.1, with the root of the speed beyond 10
/// mm/min.
fn given_energy(speed: f64) -> f64 {
    1.1 * (speed / SLOW[0]).max(1.0).sqrt()
}

/// Returns the force per width [N/m] of an edge at a speed [mm/min].
fn force(speed: f64) -> Result<(f64, Setup)> {
    let start = Instant::now();
    let record = library::find("gelatine-10").context("the library has gelatine")?;
    let gelatine = record.material();
    // Lengths are 1 / WIDTH times as large at the same stiffness.
    let scale = 1.0 / WIDTH;
    let material = Material {
        density: 30.0,
        damping: Damping::at(0.3, 10.0),
        strength: 1e6,
        toughness: (f64::from(gelatine.toughness) * scale.sqrt()) as f32,
        rate_toughening: RateToughening {
            speed: SLOW[1] as f32,
            exponent: gelatine.rate_toughening.exponent,
        },
        ..gelatine
    };
    let grid = VoxelGrid::from_fn([VOXELS, VOXELS, 1], 1.0 / VOXELS as f32, |_| 1)?;
    let mut body = SoftBody::<Dim2>::new(grid, &[material])?;
    let lowest: Vec<_> = { body.mesh().nodes() }
        .filter(|(_, node)| node.at[1] == 0)
        .map(|(id, _)| id)
        .collect();
    lowest.into_iter().for_each(|id| body.fix_node(id));
    let mut world = still_world::<Dim2>()?;
    world.add_soft_body(body)?;
    let tip = |height: f64| Vec2::new(0.4 + 0.3 / VOXELS as f32, height as f32);
    let top = 1.01;
    let holder = RigidBody::kinematic(Shape::ball(0.01)).at(tip(top));
    let holder = world.add_rigid_body(holder.with_sensor(true))?;
    let knife = world.add_knife(Knife::new(holder, [Vec2::ZERO; 2], Vec2::NEG_Y))?;
    let step = SLOW[1] * speed / SLOW[0] * f64::from(world.config().tick);
    let (mut sum, mut count, mut substeps) = (0.0, 0u32, 0);
    for tick in 1.. {
        let height = top - step * f64::from(tick);
        if height < 1.0 - RANGE[1] {
            break;
        }
        world.set_target_position(holder, tip(height))?;
        substeps = world.step().substeps;
        if height < 1.0 - RANGE[0] {
            sum += f64::from(world.knife(knife)?.force().y);
            count += 1;
        }
    }
    let setup = Setup {
        n: VOXELS,
        substeps: Some(substeps),
        seconds: start.elapsed().as_secs_f64(),
    };
    Ok((sum / f64::from(count) / scale, setup))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reference_is_the_fracture_energy_of_the_library() {
        let material = library::find("gelatine-10").unwrap().material();
        let toughening = material.rate_toughening;
        let energy = f64::from(material.fracture_energy());
        assert!((energy / given_energy(1.0) - 1.0).abs() < 0.01, "{energy}");
        assert_eq!(toughening.exponent, 0.5);
        // In mm/min.
        let slow = f64::from(toughening.speed) * 60e3;
        assert!((slow / SLOW[0] - 1.0).abs() < 0.01, "{slow}");
    }
}
