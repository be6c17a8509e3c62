//! Helpers shared by the checks of moving bodies.

use anyhow::Result;
use fuwafuwa::Grading;
use fuwafuwa::Law;
use fuwafuwa::Vector;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{Dim, Material, NodeId, SoftBody, VoxelGrid};

/// Returns a soft material without damping that does not tear.
pub fn material() -> Material {
    Material {
        elasticity: Elasticity {
            young: 5000.0,
            poisson: 0.3,
        },
        density: 100.0,
        damping: 0.0,
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
/// centre of a body 1 m across.
pub fn arrange<D: Dim>(body: &mut SoftBody<D>, state: impl Fn(Vector) -> (Vector, Vector)) {
    let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in nodes {
        let (position, velocity) = state(at_rest(body, id));
        body.set_node_state(id, position, velocity);
    }
}

/// Returns the rest position of a node relative to the centre of a body 1 m across [m].
pub fn at_rest<D: Dim>(body: &SoftBody<D>, id: NodeId) -> Vector {
    let (at, size) = (body.mesh().node(id).at, body.grid().voxel_size());
    [0, 1, 2].map(|axis| match axis {
        axis if axis < D::N => at[axis] as f32 * size - 0.5,
        _ => 0.0,
    })
}

/// Returns the length of a vector.
pub fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|k| k * k).sum::<f64>().sqrt()
}
