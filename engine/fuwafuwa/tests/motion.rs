//! Moving bodies: forces compared with the reference law, and invalid states. `fuwafuwa check` and its tests
//! compare momentum, angular momentum and energy.
#![allow(clippy::needless_range_loop)] // an axis indexes several vectors at once

use fuwafuwa::Grading;
use fuwafuwa::Law;
use fuwafuwa::inspect::forces;
use fuwafuwa::{BodyError, Dim, Dim2, Dim3, Material, NodeId, SoftBody, VoxelGrid};

fn ball<D: Dim>(n: usize, law: Law) -> SoftBody<D> {
    let grid = VoxelGrid::ball(n, 1.0).unwrap();
    SoftBody::with_options(grid, &[Material::default()], law, Grading::Graded).unwrap()
}

/// Sets the state of every node from its rest position [m], relative to the centre of a body 1 m wide.
fn arrange<D: Dim>(body: &mut SoftBody<D>, state: impl Fn([f32; 3]) -> ([f32; 3], [f32; 3])) {
    let nodes: Vec<_> = body.mesh().nodes().collect();
    let size = body.grid().voxel_size();
    for (id, node) in nodes {
        let rest = [0, 1, 2].map(|k| {
            if k < D::N {
                node.at[k] as f32 * size - 0.5
            } else {
                0.0
            }
        });
        let (position, velocity) = state(rest);
        assert!(body.set_node_state(id, position, velocity));
    }
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|k| k * k).sum::<f64>().sqrt()
}

/// Compares the element batches in single precision with the law in double precision, on a bent, rotated
/// body.
fn check_forces_against_the_law<D: Dim>(law: Law) {
    let mut body = ball::<D>(16, law);
    arrange(&mut body, |[x, y, z]| {
        let bent = [x * 1.1 + 0.2 * y * y, y * 0.8 + 0.1 * x, z + 0.2 * x * y];
        let turned = [
            0.8 * bent[0] - 0.6 * bent[1],
            0.6 * bent[0] + 0.8 * bent[1],
            bent[2],
        ];
        (turned, [0.0; 3])
    });
    // A step of zero length evaluates the forces; several let the rotations converge.
    for _ in 0..8 {
        body.advance(0.0, [0.0; 3]);
    }
    let mut expected = vec![[0.0f64; 3]; body.mesh().node_capacity()];
    for (_, element) in body.mesh().elements() {
        let positions: Vec<[f64; 3]> = element
            .nodes
            .iter()
            .map(|&node| body.node_state(node).0.map(f64::from))
            .collect();
        let size = f64::from(element.cell.width()) / 16.0;
        let all = forces(
            law,
            Material::default().elasticity,
            body.mesh().stencil(element),
            size,
            &positions,
        );
        for (&node, force) in element.nodes.iter().zip(all) {
            for axis in 0..3 {
                expected[node.index()][axis] += force[axis];
            }
        }
    }
    let largest = expected
        .iter()
        .map(|&force| length(force))
        .fold(0.0, f64::max);
    for (id, node) in body.mesh().nodes() {
        let found = body.force_on(id).map(f64::from);
        let want = expected[id.index()];
        let error = length([0, 1, 2].map(|axis: usize| found[axis] - want[axis]));
        assert!(
            error < 2e-4 * largest,
            "{law:?} at {:?}: expected {want:?}, found {found:?}",
            node.at
        );
    }
}

#[test]
fn element_batches_match_reference_law() {
    for law in [Law::CorotationalVem, Law::Endo2004] {
        check_forces_against_the_law::<Dim2>(law);
        check_forces_against_the_law::<Dim3>(law);
    }
}

#[test]
fn body_rejects_invalid_material_and_node_state() {
    let grid = || VoxelGrid::<Dim2>::cube(2, 1.0).unwrap();
    let missing = SoftBody::new(grid(), &[]).map(|_| ());
    assert_eq!(missing, Err(BodyError::MissingMaterial { number: 1 }));
    let weightless = Material {
        density: 0.0,
        ..Material::default()
    };
    let refused = SoftBody::new(grid(), &[weightless]).map(|_| ());
    let message = refused.unwrap_err().to_string();
    assert_eq!(
        message,
        "material 1: density = 0 must be positive and finite"
    );
    let mut body = SoftBody::new(grid(), &[Material::default()]).unwrap();
    assert!(!body.set_node_state(NodeId(0), [f32::NAN, 0.0, 0.0], [0.0; 3]));
}
