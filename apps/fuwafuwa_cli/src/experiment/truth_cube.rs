//! The Truth Cube: a cube of soft silicone is compressed between plates.
//!
//! ```text
//!   ▀▀▀▀▀▀▀▀▀▀  plate, moves down
//!    ┌──────┐
//!    │      │   80 mm
//!    └──────┘
//!   ▄▄▄▄▄▄▄▄▄▄  plate
//! ```
//!
//! A. E. Kerdok et al., *Truth cube: establishing physical standards for soft tissue simulation*, Medical Image Analysis 7
//! (2003), [doi:10.1016/S1361-8415(03)00008-2](https://doi.org/10.1016/S1361-8415(03)00008-2). The cube has beads at a
//! pitch of 10 mm, whose displacements were measured at compressions of 5, 12.5 and 18.25 %. The tables of these
//! displacements were not available, and the paper gives no forces. The compressions are those of the paper; the forces
//! are those of an incompressible neo-Hookean material with Young's modulus E = 15 kPa:
//!
//! ```text
//! slip, uniform strain, stretch λ        F = E/3 A (λ⁻² − λ)
//! bonded ends [Gent and Lindley 1959]    F (1 + 2 S²) = 1.125 F,   loaded area / free area S = 1/4
//! ```
//!
//! Gent and Lindley assume a flat block; for a cube, their formula is an estimate, which is 8 % too low: linear finite
//! elements (an eighth of the cube, 4³, 6³ and 8³ quadratic elements with 27 nodes, Poisson's ratio 0.49) give the factors
//! 1.250, 1.238 and 1.233, which tend to 1.22 for fine elements. The row at 5 % has a bound around this factor; at larger
//! compressions the factor is not known.
//!
//! The cube is 1 m across here; forces at rest scale with the squared width. Its density does not matter at rest.

use super::{Bound, Record, Role, Row, Setup};
use crate::check::bar::still;
use crate::check::parallel;
use crate::plot::{Curve, Plot, Points};
use crate::report::Progress;
use anyhow::Result;
use fuwafuwa::{
    Damping, Dim3, Elasticity, Grip, GripHandle, Material, RigidBody, RigidBodyHandle, Shape,
    SoftBody, StressLaw, Vec3, VoxelGrid, World, WorldConfig,
};
use std::time::Instant;

/// Width of the cube of the paper [m].
const WIDTH: f64 = 0.08;
/// Young's modulus [Pa] and Poisson's ratio, the largest that the engine allows.
const YOUNG: f64 = 15e3;
const POISSON: f64 = 0.49;
/// Compressions, as shares of the width.
const COMPRESSIONS: [f64; 3] = [0.05, 0.125, 0.1825];
/// Voxels across the cube.
const ACROSS: usize = 16;
/// Density [kg/m³].
const DENSITY: f32 = 100.0;
/// Factor of the force of bonded ends [Gent and Lindley 1959].
const BONDED: f64 = 1.0 + 2.0 / 16.0;
/// Factor of the force of bonded ends at small strains by finite elements.
const BONDED_ELEMENTS: f64 = 1.22;
/// Largest relative deviation of forces with slip, and of forces with bonded ends from finite elements.
const TOLERANCE: f64 = 0.07;
/// Time in which the plate moves from one compression to the next, and time in which the cube settles [s].
const MOVING: f64 = 0.3;
const SETTLING: f64 = 1.0;
/// Mass damping, about critical for the lowest frequency of the cube, and drag of the whole cube [1/s].
const DAMPING: f32 = 30.0;
const DRAG: f32 = 10.0;
/// Number of ticks over which a force is averaged.
const MEAN: u32 = 12;

/// Returns the force [N] on the cube of the paper with slip, at a compression.
fn force_with_slip(compression: f64) -> f64 {
    let stretch = 1.0 - compression;
    YOUNG / 3.0 * WIDTH * WIDTH * (stretch.powi(-2) - stretch)
}

/// Compresses a cube with slip and one with bonded ends.
pub fn experiment(progress: &Progress) -> Result<Record> {
    let found = parallel::each(&[false, true], progress, |&is_bonded| {
        let start = Instant::now();
        let (forces, substeps) = compress(is_bonded)?;
        Ok((forces, substeps, start.elapsed().as_secs_f64()))
    })?;
    let mut record = Record::default();
    let mut points = Vec::new();
    for ((forces, substeps, seconds), is_bonded) in found.into_iter().zip([false, true]) {
        let ends = if is_bonded { "bonded ends" } else { "slip" };
        let setup = Setup {
            n: ACROSS,
            substeps: Some(substeps),
            seconds,
        };
        for (&compression, &force) in COMPRESSIONS.iter().zip(&forces) {
            let bounded = Bound::Relative(TOLERANCE);
            let references: &[(&str, f64, Bound)] = match is_bonded {
                false => &[("neo-Hookean", 1.0, bounded)],
                true if compression == COMPRESSIONS[0] => &[
                    ("Gent and Lindley", BONDED, Bound::None),
                    ("finite elements", BONDED_ELEMENTS, bounded),
                ],
                true => &[("Gent and Lindley", BONDED, Bound::None)],
            };
            for &(theory, factor, bound) in references {
                let percent = 100.0 * compression;
                record.rows.push(Row {
                    case: format!("truth cube, {ends}, force at {percent} % [N], {theory}"),
                    role: Role::Verification,
                    reference: Some(factor * force_with_slip(compression)),
                    spread: None,
                    computed: force,
                    bound,
                    setup,
                });
            }
        }
        points.push(Points::new(ends, COMPRESSIONS.into_iter().zip(forces)));
    }
    let curve = |factor: f64| Curve::sampled(0.0..=0.2, move |at| factor * force_with_slip(at));
    record.plots.push(Plot {
        x: "compression / width".into(),
        y: "force [N]".into(),
        curves: vec![curve(1.0).named("slip"), curve(BONDED).named("bonded ends")],
        points,
        ..Plot::default()
    });
    Ok(record)
}

/// Means by which a plate holds the cube.
enum Plate {
    Touching(RigidBodyHandle),
    Bonded(GripHandle, RigidBodyHandle),
}

impl Plate {
    /// Returns the vertical force [N] of the plate on the cube.
    fn force(&self, world: &World<Dim3>) -> Result<f64> {
        match *self {
            Self::Touching(plate) => {
                let plate = world.rigid_body(plate)?;
                let count = plate.reactions().len().max(1) as f64;
                let forces = plate.reactions().map(|one| f64::from(one.contact.y));
                Ok(-forces.sum::<f64>() / count)
            }
            Self::Bonded(grip, _) => Ok(f64::from(world.grip(grip)?.reaction().force.y)),
        }
    }

    fn body(&self) -> RigidBodyHandle {
        match *self {
            Self::Touching(plate) | Self::Bonded(_, plate) => plate,
        }
    }
}

/// Returns the forces [N] on the cube of the paper at all compressions, and the number of substeps in 1/60 s.
fn compress(is_bonded: bool) -> Result<(Vec<f64>, u32)> {
    let config = WorldConfig {
        drag: DRAG,
        ..still(Vec3::ZERO)
    };
    let tick = f64::from(config.tick);
    let mut world = World::<Dim3>::new(config)?;
    let material = Material {
        elasticity: Elasticity::new(YOUNG, POISSON)?,
        stress_law: StressLaw::NeoHookean,
        density: DENSITY,
        damping: Damping {
            mass: DAMPING,
            stiffness: 0.0,
        },
        friction: 0.0,
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        ..Material::default()
    };
    let body = SoftBody::new(VoxelGrid::cube(ACROSS, 1.0)?, &[material])?;
    let body = world.add_soft_body(body.translated(Vec3::new(-0.5, 0.0, -0.5)))?;
    let mut plate = |height: f32, normal: Vec3| -> Result<Plate> {
        let shape = Shape::cuboid(Vec3::new(2.0, 0.5, 2.0));
        let plate = RigidBody::kinematic(shape).with_friction(0.0);
        let at = Vec3::new(0.0, height - 0.5 * normal.y, 0.0);
        let plate = world.add_rigid_body(plate.at(at).with_sensor(is_bonded))?;
        if !is_bonded {
            return Ok(Plate::Touching(plate));
        }
        let face = Shape::half_space(normal, Vec3::Y * height + 1e-3 * normal);
        let grip = world.add_grip(Grip::carried(body, face, plate))?;
        Ok(Plate::Bonded(grip, plate))
    };
    let plates = [plate(0.0, Vec3::Y)?, plate(1.0, Vec3::NEG_Y)?];
    let (mut before, mut forces) = (0.0, Vec::new());
    for compression in COMPRESSIONS {
        let (moving, settling) = ((MOVING / tick) as u32, (SETTLING / tick) as u32);
        let mut force = 0.0;
        for count in 1..=moving + settling {
            let share = (f64::from(count) / f64::from(moving)).min(1.0);
            let height = 1.0 - before - (compression - before) * share;
            let at = Vec3::new(0.0, height as f32 + 0.5, 0.0);
            world.set_target_position(plates[1].body(), at)?;
            world.step();
            if count + MEAN > moving + settling {
                let [below, above] = [plates[0].force(&world)?, plates[1].force(&world)?];
                force += 0.5 * (below - above) / f64::from(MEAN);
            }
        }
        before = compression;
        forces.push(force * WIDTH * WIDTH);
    }
    Ok((forces, world.substeps()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_with_slip_are_those_of_the_derivation() {
        for (compression, force) in COMPRESSIONS.into_iter().zip([5.06, 13.8, 21.7]) {
            assert!((force_with_slip(compression) / force - 1.0).abs() < 5e-3);
        }
    }
}
