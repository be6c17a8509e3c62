//! Moving bodies: forces compared with the reference implementation of each law, momentum, angular momentum
//! and energy.
#![allow(clippy::needless_range_loop)] // an axis indexes several vectors at once

use fuwafuwa::inspect::forces;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Error, Grading, Law, Material, NodeId, SoftBody, Vec2, Vec3,
    VoxelGrid,
};
use glam::DVec3;

fn ball<D: Dim>(n: usize, law: Law) -> SoftBody<D> {
    let grid = VoxelGrid::ball(n, 1.0).unwrap();
    SoftBody::with_options(grid, &[Material::default()], law, Grading::Graded).unwrap()
}

/// Sets position and velocity of every node to those that `state` returns for its rest position [m], relative
/// to the centre of a body 1 m wide.
fn arrange<D: Dim>(body: &mut SoftBody<D>, state: impl Fn(Vec3) -> (Vec3, Vec3)) {
    let nodes: Vec<_> = body.mesh().nodes().collect();
    let size = body.grid().voxel_size();
    for (id, node) in nodes {
        let mut rest = D::Vector::ZERO;
        for axis in 0..D::N {
            rest[axis] = node.at[axis] as f32 * size - 0.5;
        }
        let (position, velocity) = state(rest.to_vec3());
        let [position, velocity] = [position, velocity].map(D::Vector::from_vec3);
        body.set_node_state(id, position, velocity).unwrap();
    }
}

/// Returns linear and angular momentum about the origin.
fn momentum<D: Dim>(body: &SoftBody<D>) -> (DVec3, DVec3) {
    let (mut linear, mut angular) = (DVec3::ZERO, DVec3::ZERO);
    for (id, _) in body.mesh().nodes() {
        let (x, v, mass) = body.node_state(id);
        let [x, v] = [x, v].map(|vector| vector.to_vec3().as_dvec3());
        let mass = f64::from(mass);
        linear += mass * v;
        angular += mass * x.cross(v);
    }
    (linear, angular)
}

/// Checks the forces on a bent, rotated body. The element batches of the body, in single precision, must
/// agree with the reference implementation of the law in double precision.
fn check_forces_against_the_law<D: Dim>(law: Law) {
    let mut body = ball::<D>(16, law);
    arrange(&mut body, |Vec3 { x, y, z }| {
        let bent = Vec3::new(x * 1.1 + 0.2 * y * y, y * 0.8 + 0.1 * x, z + 0.2 * x * y);
        let turned = Vec3::new(
            0.8 * bent.x - 0.6 * bent.y,
            0.6 * bent.x + 0.8 * bent.y,
            bent.z,
        );
        (turned, Vec3::ZERO)
    });
    // A substep of zero length computes the forces without moving nodes. Repeated substeps let the element
    // rotations converge.
    for _ in 0..8 {
        body.advance(0.0, D::Vector::ZERO);
    }
    let mut expected = vec![DVec3::ZERO; body.mesh().node_capacity()];
    for (_, element) in body.mesh().elements() {
        let positions: Vec<DVec3> = element
            .nodes
            .iter()
            .map(|&node| body.node_state(node).0.to_vec3().as_dvec3())
            .collect();
        let size = f64::from(element.cell.width()) / 16.0;
        let all = forces(
            law,
            Material::default().elasticity.into(),
            body.mesh().element_class(element),
            size,
            &positions,
        );
        for (&node, force) in element.nodes.iter().zip(all) {
            expected[node.index()] += force;
        }
    }
    let largest = expected
        .iter()
        .map(|force| force.length())
        .fold(0.0, f64::max);
    for (id, node) in body.mesh().nodes() {
        let found = body.force_on(id).to_vec3().as_dvec3();
        let want = expected[id.index()];
        let error = (found - want).length();
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

/// Checks that a free ball with an angular velocity of 5 rad/s keeps its angular momentum for five seconds.
#[test]
fn spinning_ball_preserves_angular_momentum() {
    let mut body = ball::<Dim3>(12, Law::CorotationalVem);
    arrange(&mut body, |at @ Vec3 { x, y, z }| {
        (at, Vec3::new(4.0 * z - 3.0 * y, 3.0 * x, -4.0 * x))
    });
    let (_, before) = momentum(&body);
    for _ in 0..5 * 960 {
        body.advance(1.0 / 960.0, Vec3::ZERO);
    }
    let (_, after) = momentum(&body);
    let kept = before.dot(after) / before.length_squared();
    assert!((0.999..1.001).contains(&kept), "kept {kept}");
}

/// Checks that mass and momentum of a moving body are preserved when it is cut repeatedly.
fn check_releases_keep_momentum<D: Dim>(n: i32) {
    let mut body = ball::<D>(n as usize, Law::CorotationalVem);
    arrange(&mut body, |Vec3 { x, y, z }| {
        let velocity = Vec3::new(1.0 + 2.0 * y, 0.5 - x + z, 0.3 * x);
        (Vec3::new(x * 1.05, y * 0.95, z), velocity)
    });
    let mass = |body: &SoftBody<D>| -> f64 {
        body.mesh()
            .nodes()
            .map(|(id, _)| f64::from(body.node_state(id).2))
            .sum()
    };
    let (mass_before, (before, spin_before)) = (mass(&body), momentum(&body));
    for step in 0..1000 {
        let at = [
            step * 7 % n,
            step * 5 % n,
            if D::N == 3 { step * 3 % n } else { 0 },
        ];
        let side = [0b1010_1010, 0b1100_1100, 0b1111_0000][step as usize % D::N];
        body.release(&[(at, side)]);
        if step % 10 == 0 {
            body.advance(1.0 / 960.0, D::Vector::ZERO);
        }
    }
    body.mesh()
        .validate(body.grid(), body.connectivity())
        .unwrap();
    let (after, spin_after) = momentum(&body);
    let drift = (after - before).length() / before.length();
    let spin = (spin_after - spin_before).length() / spin_before.length();
    assert!((mass(&body) / mass_before - 1.0).abs() < 1e-5);
    assert!(drift < 1e-4, "linear momentum drifts by {drift}");
    assert!(spin < 1e-4, "angular momentum drifts by {spin}");
}

#[test]
fn release_preserves_mass_and_momentum() {
    check_releases_keep_momentum::<Dim2>(24);
    check_releases_keep_momentum::<Dim3>(12);
}

#[test]
fn body_rejects_invalid_material_and_node_state() {
    let grid = || VoxelGrid::<Dim2>::cube(2, 1.0).unwrap();
    let missing = SoftBody::new(grid(), &[]).map(|_| ());
    assert_eq!(
        missing,
        Err(Error::MissingMaterial {
            number: 1,
            given: 0
        })
    );
    let weightless = Material {
        density: 0.0,
        ..Material::default()
    };
    let refused = SoftBody::new(grid(), &[weightless]).map(|_| ());
    let message = refused.unwrap_err().to_string();
    assert_eq!(
        message,
        "material 1: density must be positive and finite, given 0.0"
    );
    let mut body = SoftBody::new(grid(), &[Material::default()]).unwrap();
    let nowhere = body.set_node_state(NodeId(0), Vec2::new(f32::NAN, 0.0), Vec2::ZERO);
    assert!(nowhere.is_err());
}
