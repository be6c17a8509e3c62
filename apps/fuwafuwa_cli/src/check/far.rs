//! Far from the origin: at the edge of its range, a body at rest must have the same shape as at the origin;
//! beyond it, the body must be refused.

use super::motion::centre;
use super::parallel;
use crate::report::{Findings, Outcome, Progress};
use anyhow::Result;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Material, RigidBody, Shape, SoftBody, VoxelGrid, World,
    WorldConfig,
};

/// Width of the body [m].
const WIDTH: f32 = 0.1;
/// Mass damping [1/s]: a quarter of critical damping of the softest body, so that no vibration is left after
/// [`DURATION`].
const DAMPING: f32 = 60.0;
/// Time in which a body comes to rest [s].
const DURATION: f32 = 2.0;
/// Greatest distance between the positions of a node, relative to the centre of mass [voxels].
const TOLERANCE: f64 = 0.01;

/// Compares the shape at the edge of the range with that at the origin, in 2D and 3D, of soft and hard bodies.
pub fn check(progress: &Progress) -> Result<Findings> {
    let cases = [(2, 16, 1e3), (2, 16, 4e3), (3, 12, 1e3), (3, 12, 4e3)];
    let found = parallel::each(&cases, progress, |&(dim, n, young)| match dim {
        2 => measure::<Dim2>(n, young),
        _ => measure::<Dim3>(n, young),
    })?;
    let mut outcomes = Vec::new();
    for ((dim, n, young), (off, is_refused)) in cases.into_iter().zip(found) {
        let case = |what: &str| format!("far {dim}D, n = {n}, {young} Pa, {what}");
        outcomes.push(Outcome::at_most(
            case("shape at 8192 voxels, voxels"),
            off,
            TOLERANCE,
        ));
        let refused = f64::from(u8::from(is_refused));
        outcomes.push(Outcome::near(case("refused beyond"), refused, 1.0, 0.0));
    }
    Ok(outcomes.into())
}

/// Returns the largest difference of the shapes [voxels], and whether the body is refused beyond its range.
fn measure<D: Dim>(n: usize, young: f64) -> Result<(f64, bool)> {
    let range = body::<D>(n, young)?.range();
    let near = shape(body::<D>(n, young)?, D::Vector::ZERO)?;
    let far = shape(body::<D>(n, young)?, D::Vector::X * (range - 2.0 * WIDTH))?;
    let pairs = near.iter().zip(&far);
    let apart = pairs.map(|(a, b)| {
        let squares = (0..3).map(|axis| (a[axis] - b[axis]) * (a[axis] - b[axis]));
        squares.sum::<f64>().sqrt()
    });
    let most = apart.fold(0.0, f64::max);
    let mut world = World::<D>::new(WorldConfig::default())?;
    let beyond = body::<D>(n, young)?.translated(D::Vector::X * range);
    let is_refused = world.add_soft_body(beyond).is_err();
    Ok((most * n as f64 / f64::from(WIDTH), is_refused))
}

fn body<D: Dim>(n: usize, young: f64) -> Result<SoftBody<D>> {
    let material = Material {
        elasticity: Elasticity {
            young,
            ..Material::default().elasticity
        },
        damping: Damping {
            mass: DAMPING,
            ..Material::default().damping
        },
        strength: f32::INFINITY,
        ..Material::default()
    };
    // A ball could come to rest with another side below, and with friction the shape at rest would not be unique.
    Ok(SoftBody::new(VoxelGrid::cube(n, WIDTH)?, &[material])?)
}

/// Returns the positions of the nodes of a body at rest on a floor at `at`, relative to the centre of mass [m].
fn shape<D: Dim>(body: SoftBody<D>, at: D::Vector) -> Result<Vec<[f64; 3]>> {
    let mut world = World::<D>::new(WorldConfig {
        sleep: false,
        ..WorldConfig::default()
    })?;
    let floor = RigidBody::fixed(Shape::half_space(D::Vector::Y, at));
    world.add_rigid_body(floor.with_friction(0.0))?;
    let id = world.add_soft_body(body.translated(at))?;
    for _ in 0..(60.0 * DURATION) as usize {
        world.step();
    }
    let body = &world[id];
    let centre = centre(body);
    let nodes = body.mesh().nodes().map(|(node, _)| body.node_state(node).0);
    let offsets = nodes.map(|at| (at.to_vec3().as_dvec3() - centre).to_array());
    Ok(offsets.collect())
}
