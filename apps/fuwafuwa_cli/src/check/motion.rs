//! What the checks of moving bodies have in common.

use anyhow::Result;
use fuwafuwa::law::{Elasticity, Law};
use fuwafuwa::pyramid::Grading;
use fuwafuwa::shape::Vector;
use fuwafuwa::{Dim, Material, NodeId, SoftBody, VoxelGrid};

/// A soft body that rings without damping and does not tear.
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

/// A disc or a ball 1 m across, of `n` voxels.
pub fn ball<D: Dim>(n: usize, material: Material, grading: Grading) -> Result<SoftBody<D>> {
    let grid = VoxelGrid::ball(n, 1.0)?;
    Ok(SoftBody::with_options(
        grid,
        &[material],
        Law::CorotationalVem,
        grading,
    )?)
}

/// Sets position [m] and velocity [m/s] of every node by its place at rest [m], which is measured
/// from the middle of a body 1 m across.
pub fn arrange<D: Dim>(body: &mut SoftBody<D>, state: impl Fn(Vector) -> (Vector, Vector)) {
    let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in nodes {
        let (position, velocity) = state(at_rest(body, id));
        body.set_node_state(id, position, velocity);
    }
}

/// Where a node is at rest, measured from the middle of a body 1 m across [m].
pub fn at_rest<D: Dim>(body: &SoftBody<D>, id: NodeId) -> Vector {
    let (at, size) = (body.mesh().node(id).at, body.grid().voxel_size());
    [0, 1, 2].map(|axis| match axis {
        axis if axis < D::N => at[axis] as f32 * size - 0.5,
        _ => 0.0,
    })
}

/// Length of a vector.
pub fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|k| k * k).sum::<f64>().sqrt()
}
