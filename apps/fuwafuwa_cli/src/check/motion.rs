//! Helpers shared by the checks of moving bodies.

use anyhow::Result;
use fuwafuwa::glam::DVec3;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Damping, Dim, DimVector, Grading, Law, Material, NodeId, SoftBody, SoftBodyHandle, Vec3,
    Velocity, VoxelGrid, World,
};

/// Returns a soft material without damping that does not tear.
pub fn material() -> Material {
    Material {
        elasticity: Elasticity {
            young: 5000.0,
            poisson: 0.3,
        },
        density: 100.0,
        damping: Damping::NONE,
        strength: f32::INFINITY,
        ..Material::default()
    }
}

/// Returns a disc or a ball 1 m across with `n` voxels across.
pub fn ball<D: Dim>(n: usize, material: Material, grading: Grading) -> Result<SoftBody<D>> {
    let grid = VoxelGrid::ball(n, 1.0)?;
    Ok(SoftBody::with_options(
        grid,
        &[material],
        Law::CorotationalVem,
        grading,
    )?)
}

/// Sets position [m] and velocity [m/s] of every node as a function of its rest position [m], relative to the
/// centre of a body 1 m across. In 2D third coordinates are 0 and ignored.
///
/// # Errors
/// If a position or velocity is not finite.
pub fn arrange<D: Dim>(body: &mut SoftBody<D>, state: impl Fn(Vec3) -> (Vec3, Vec3)) -> Result<()> {
    let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in nodes {
        let (position, velocity) = state(at_rest(body, id));
        body.set_node_state(
            id,
            D::Vector::from_vec3(position),
            D::Vector::from_vec3(velocity),
        )?;
    }
    Ok(())
}

/// Returns the rest position of a node relative to the centre of a body 1 m across [m].
pub fn at_rest<D: Dim>(body: &SoftBody<D>, id: NodeId) -> Vec3 {
    let (at, size) = (body.mesh().node(id).at, body.grid().voxel_size());
    let mut rest = Vec3::ZERO;
    for axis in 0..D::N {
        rest[axis] = at[axis] as f32 * size - 0.5;
    }
    rest
}

/// Returns the centre of mass of a body [m].
pub fn centre<D: Dim>(body: &SoftBody<D>) -> DVec3 {
    let states = body.mesh().nodes().map(|(id, _)| body.node_state(id));
    let moments = states.map(|(at, _, mass)| at.to_vec3().as_dvec3() * f64::from(mass));
    moments.sum::<DVec3>() / body.total_mass()
}

/// Gives a body a velocity [m/s].
pub fn throw<D: Dim>(world: &mut World<D>, body: SoftBodyHandle, linear: D::Vector) -> Result<()> {
    let velocity = Velocity {
        linear,
        ..Velocity::default()
    };
    Ok(world.set_velocity(body, velocity)?)
}
