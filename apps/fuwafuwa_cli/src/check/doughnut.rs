//! Doughnut: a ring squeezed shut by two hands must not pass through itself.

use super::motion::material;
use super::parallel;
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, ensure};
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Material, NodeId, RigidBody, Shape, SoftBody, Vec3, VoxelGrid,
    World, WorldConfig,
};

/// Number of dimensions, voxels across the ring, and speed of each hand [m/s]. At the highest speed, opposite
/// sides of the hole approach each other by ten ring diameters per second.
const CASES: [(usize, usize, f32); 12] = [
    (2, 24, 0.25),
    (2, 24, 2.0),
    (2, 24, 5.0),
    (2, 48, 0.25),
    (2, 48, 2.0),
    (2, 48, 5.0),
    (3, 24, 0.25),
    (3, 24, 2.0),
    (3, 24, 5.0),
    (3, 32, 0.25),
    (3, 32, 2.0),
    (3, 32, 5.0),
];
/// Radius of the hands [m].
const HAND: f32 = 0.4;
/// Final distance between the surfaces of the hands [m]. The two sides of the ring are together 0.5 m thick,
/// so the hands compress the ring after its hole is shut.
const LEFT: f32 = 0.4;
/// Time for which the hands wait at their final distance [s].
const WAIT: f32 = 2.0;
/// Half width of the strip in the middle of the ring in which the penetration is measured [m].
const MIDDLE: f32 = 0.1;
/// Maximum penetration of one side of the hole into the other [voxels].
const DEPTH: f64 = 0.5;
/// Maximum gap between opposite sides of the hole at their closest approach [voxels]. A larger gap means that
/// the hole was not squeezed shut.
const SHUT: f64 = 2.0;

/// Squeezes rings of several sizes, slowly and fast.
pub fn check(progress: &Progress) -> Result<Findings> {
    let depths = parallel::each(&CASES, progress, |&(dim, n, speed)| match dim {
        2 => squeeze::<Dim2>(n, speed),
        _ => squeeze::<Dim3>(n, speed),
    })?;
    let outcome = |(&(dim, n, speed), depth): (&(usize, usize, f32), f64)| {
        let case = format!("doughnut {dim}D n = {n}, {speed} m/s, self-penetration in voxels");
        Outcome::within(case, depth, -SHUT..=DEPTH)
    };
    let outcomes: Vec<Outcome> = CASES.iter().zip(depths).map(outcome).collect();
    Ok(outcomes.into())
}

/// Squeezes a ring and returns the maximum penetration of the upper side of the hole into the lower one
/// [voxels]. A negative result is the smallest gap.
fn squeeze<D: Dim>(n: usize, speed: f32) -> Result<f64> {
    let mut world = World::<D>::new(WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    })?;
    let material = Material {
        damping: Material::default().damping,
        ..material()
    };
    let grid = VoxelGrid::<D>::ring(n, 1.0)?;
    let (voxel, plane) = (grid.voxel_size(), plane_of(&grid));
    let ring = world.add_soft_body(SoftBody::new(grid, &[material])?)?;
    let sides = [-1.0, 1.0];
    let middle_of = |side: f32, apart: f32| {
        let height = 0.5 + side * (HAND + 0.5 * apart);
        D::Vector::from_vec3(Vec3::new(0.5, height, plane))
    };
    let mut hands = Vec::new();
    for side in sides {
        let hand = RigidBody::kinematic(Shape::ball(HAND)).at(middle_of(side, 1.0));
        hands.push(world.add_rigid_body(hand)?);
    }
    let holes = sides.map(|side| hole_side(&world[ring], side));
    let (mut apart, mut waited, mut deepest) = (1.0, 0.0, f32::NEG_INFINITY);
    while waited < WAIT {
        apart -= 2.0 * speed / 60.0;
        if apart < LEFT {
            (apart, waited) = (LEFT, waited + 1.0 / 60.0);
        }
        for (&hand, side) in hands.iter().zip(sides) {
            world.set_target_position(hand, middle_of(side, apart))?;
        }
        let report = world.step();
        ensure!(report.quarantined == 0, "the ring was quarantined");
        let [low, high] = holes.each_ref().map(|nodes| places(&world[ring], nodes));
        let slips = |at: &Vec3| (at.z - plane).abs() > voxel;
        ensure!(
            !low.iter().chain(&high).any(slips),
            "one side of the ring slipped past the other"
        );
        deepest = deepest.max(overlap(&low, &high));
    }
    Ok(f64::from(deepest / voxel))
}

/// Returns the z coordinate of the ring's mid-plane [m].
fn plane_of<D: Dim>(grid: &VoxelGrid<D>) -> f32 {
    match D::N {
        2 => 0.0,
        _ => 0.5 * grid.size()[2] as f32 * grid.voxel_size(),
    }
}

/// Returns the surface nodes of the hole below (side −1) or above (side 1) its middle; in 3D, only those in
/// its mid-plane.
fn hole_side<D: Dim>(body: &SoftBody<D>, side: f32) -> Vec<NodeId> {
    let (voxel, plane) = (body.grid().voxel_size(), plane_of(body.grid()));
    let nodes = body.mesh().nodes().filter(|(id, node)| {
        let [x, y, z] = body.node_state(*id).0.to_vec3().to_array();
        let (x, y) = (x - 0.5, y - 0.5);
        let is_inner = x * x + y * y < 0.36 * 0.36 && (z - plane).abs() < 0.1 * voxel;
        let is_bare = (node.group.count_ones() as usize) < D::CORNERS;
        is_inner && is_bare && y * side > 0.0
    });
    nodes.map(|(id, _)| id).collect()
}

/// Returns the positions of nodes, sorted from left to right.
fn places<D: Dim>(body: &SoftBody<D>, nodes: &[NodeId]) -> Vec<Vec3> {
    let positions = nodes.iter().map(|&id| body.node_state(id).0);
    let mut places: Vec<Vec3> = positions.map(DimVector::to_vec3).collect();
    places.sort_by(|a, b| a.x.total_cmp(&b.x));
    places
}

/// Returns the maximum height of the `low` line above the `high` line near the middle of the ring [m].
/// Negative if the low line is below everywhere.
fn overlap(low: &[Vec3], high: &[Vec3]) -> f32 {
    let is_amid = |at: &&Vec3| (at.x - 0.5).abs() < MIDDLE;
    let mut deepest = f32::NEG_INFINITY;
    for at in high.iter().filter(is_amid) {
        for two in low.windows(2) {
            let [a, b] = [two[0], two[1]];
            if (a.x..b.x).contains(&at.x) {
                let line = a.y + (b.y - a.y) * (at.x - a.x) / (b.x - a.x);
                deepest = deepest.max(line - at.y);
            }
        }
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlap_is_positive_only_for_crossed_lines() {
        let line = |y| (0..5u8).map(move |k| Vec3::new(0.3 + 0.1 * f32::from(k), y, 0.0));
        let (low, high): (Vec<Vec3>, Vec<Vec3>) = (line(0.4).collect(), line(0.6).collect());
        assert!((overlap(&low, &high) + 0.2).abs() < 1e-6);
        assert!((overlap(&high, &low) - 0.2).abs() < 1e-6);
    }

    fn check_rest<D: Dim>() {
        let body = SoftBody::new(VoxelGrid::<D>::ring(24, 1.0).unwrap(), &[material()]).unwrap();
        let [low, high] = [-1.0, 1.0].map(|side| places(&body, &hole_side(&body, side)));
        assert!(
            (overlap(&low, &high) + 0.5).abs() < 0.1,
            "{}",
            overlap(&low, &high)
        );
    }

    #[test]
    fn overlap_is_negative_for_a_ring_at_rest() {
        check_rest::<Dim2>();
        check_rest::<Dim3>();
    }
}
