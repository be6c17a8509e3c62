//! Crumbs under pressure: no crumb stays embedded in a larger piece.

use crate::vectors::vector;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Material, PieceId, RigidBody, Shape, SoftBody, Vec2, Vec3,
    Velocity, VoxelGrid, World, WorldConfig,
};
use glam::DVec3;

/// Minimum depth at which a crumb counts as embedded [voxels]: its centre must lie inside an element of
/// another piece, at least this far from the centres of all exposed faces.
const DEPTH: f32 = 0.6;
/// Maximum number of elements of a piece that counts as a crumb in these tests.
const SMALL: u32 = 16;

/// Returns twice the signed area of a triangle, or six times the signed volume of a tetrahedron.
fn volume<D: Dim>(points: &[Vec3]) -> f32 {
    let [a, b] = [1, 2].map(|k| points[k] - points[0]);
    match D::N {
        2 => a.x * b.y - a.y * b.x,
        _ => a.cross(b).dot(points[3] - points[0]),
    }
}

/// Returns whether a point is in a triangle or tetrahedron. The point is inside if replacing any corner by
/// the point keeps the sign of the volume.
fn is_in_simplex<D: Dim>(points: &[Vec3], at: Vec3) -> bool {
    let whole = volume::<D>(points);
    (0..=D::N).all(|corner| {
        let mut others = points.to_vec();
        others[corner] = at;
        volume::<D>(&others) / whole >= 0.0
    })
}

/// Returns whether a point is in a deformed cell. The cell is split into triangles or tetrahedra that share
/// the diagonal from its first to its last corner.
fn is_in_cell<D: Dim>(corners: &[Vec3], at: Vec3) -> bool {
    let simplices: &[[usize; 4]] = match D::N {
        2 => &[[0, 3, 1, 0], [0, 3, 2, 0]],
        _ => &[
            [0, 7, 1, 3],
            [0, 7, 1, 5],
            [0, 7, 2, 3],
            [0, 7, 2, 6],
            [0, 7, 4, 5],
            [0, 7, 4, 6],
        ],
    };
    simplices.iter().any(|simplex| {
        let points = simplex.map(|corner| corners[corner]);
        is_in_simplex::<D>(&points[..=D::N], at)
    })
}

/// Returns the crumbs embedded in larger pieces, as body index and piece number, and the total number of
/// crumbs.
fn crumbs_inside<D: Dim>(world: &World<D>) -> (Vec<(usize, PieceId)>, usize) {
    let views: Vec<_> = world
        .soft_bodies()
        .map(|(_, body)| body.piece_views())
        .collect();
    let crumbs = || {
        let all = views.iter().enumerate();
        let all = all.flat_map(|(body, views)| views.iter().map(move |view| (body, view)));
        all.filter(|(_, view)| view.element_count <= SMALL)
    };
    let mut inside = Vec::new();
    for (place, (_, body)) in world.soft_bodies().enumerate() {
        let size = body.grid().voxel_size();
        let faces: Vec<(PieceId, Vec3)> = body
            .facets()
            .map(|facet| {
                let corners = &facet.corners[..2 * (D::N - 1)];
                let sum = corners.iter().sum::<Vec3>();
                (facet.piece, sum * (1.0 / corners.len() as f32))
            })
            .collect();
        for view in body.element_views() {
            let count = views[place][view.piece.index()].element_count;
            let cells = match view.level {
                0 => 1,
                _ => view.children,
            };
            for child in (0..D::CORNERS).filter(|child| cells >> child & 1 == 1) {
                let corners = view.child_corners::<D>(child);
                for (own, crumb) in crumbs().filter(|(_, crumb)| crumb.element_count < count) {
                    let at = crumb.centre;
                    let is_beside = (0..D::N).any(|axis| {
                        corners.iter().all(|corner| corner[axis] < at[axis])
                            || corners.iter().all(|corner| corner[axis] > at[axis])
                    });
                    if is_beside || !is_in_cell::<D>(&corners, at) {
                        continue;
                    }
                    let mut faces = faces.iter().filter(|(piece, _)| *piece == view.piece);
                    if faces.all(|(_, face)| (*face - at).length() > DEPTH * size) {
                        inside.push((own, crumb.number));
                    }
                }
            }
        }
    }
    inside.sort_unstable();
    inside.dedup();
    (inside, crumbs().count())
}

/// Moves a hand along `goal`, a position [m] as a function of time [s], and checks the crumbs. No crumb may
/// stay embedded for more than `patience` ticks, or be embedded at the end. There must be at least `least`
/// crumbs at the end.
fn check<D: Dim>(
    mut world: World<D>,
    ticks: u16,
    patience: u32,
    least: usize,
    goal: impl Fn(f32) -> D::Vector,
) {
    let mut stays = std::collections::BTreeMap::new();
    for tick in 0..ticks {
        world
            .set_target_position(
                world.nth_target_follower(0).unwrap(),
                goal(f32::from(tick) / 60.0),
            )
            .unwrap();
        world.step();
        let (inside, _) = crumbs_inside(&world);
        stays.retain(|crumb, _| inside.contains(crumb));
        for crumb in inside {
            let stay = stays.entry(crumb).or_insert(0);
            *stay += 1;
            assert!(
                *stay <= patience,
                "{}D, tick {tick}: {crumb:?} stays embedded",
                D::N
            );
        }
    }
    let (inside, count) = crumbs_inside(&world);
    assert!(
        count >= least,
        "only {count} crumbs, expected at least {least}"
    );
    assert!(
        inside.is_empty(),
        "{inside:?} of {count} crumbs are embedded"
    );
}

fn weightless<D: Dim>() -> World<D> {
    let settings = WorldConfig {
        gravity: D::Vector::ZERO,
        drag: 1.0,
        max_substeps: 64,
        ..WorldConfig::default()
    };
    World::new(settings).unwrap()
}

/// A hand presses dust, a body of many crumbs, into a second body against a wall, grinds back and forth, and
/// retreats. Checks that no dust stays embedded.
fn check_grinding<D: Dim>(n: usize, least: usize) {
    let mut world = weightless::<D>();
    let wall = Shape::half_space(-D::Vector::X, vector(1.05, 0.0, 0.0));
    world
        .add_rigid_body(RigidBody::fixed(wall).with_friction(0.2))
        .unwrap();
    let tough = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    let ball = |n, width| SoftBody::new(VoxelGrid::<D>::ball(n, width).unwrap(), &[tough]).unwrap();
    world.add_soft_body(ball(n, 1.0)).unwrap();
    let mut dust = ball(n / 3, 0.33);
    dust.crumble();
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    world
        .add_soft_body(dust.translated(vector(-0.36, 0.33, depth - 0.17)))
        .unwrap();
    world
        .add_rigid_body(RigidBody::coupled(Shape::ball(0.2)).at(vector(-0.55, 0.5, depth)))
        .unwrap();
    check(world, 240, 45, least, |seconds| {
        let in_and_out = seconds.min(0.8) - (seconds - 2.2).max(0.0);
        let turn = 2.0 * (seconds - 0.8).clamp(0.0, 1.4);
        // The hand moves down by 0.15 m and back up, twice a second.
        let to_and_fro = 0.3 * ((turn - turn.floor() - 0.5).abs() - 0.5);
        vector(-0.55 + 1.25 * in_and_out, 0.5 + to_and_fro, depth)
    });
}

#[test]
fn dust_leaves_body_after_grinding() {
    check_grinding::<Dim2>(48, 150);
    check_grinding::<Dim3>(18, 50);
}

/// A hand pushes a disc against a wall and tears it in two. Crumbs that come off the disc must not stay
/// embedded in the halves.
#[test]
fn crumbs_stay_outside_halves_of_torn_disc() {
    let mut world = weightless::<Dim2>();
    let wall = Shape::half_space(Vec2::NEG_X, Vec2::new(1.15, 0.0));
    world
        .add_rigid_body(RigidBody::fixed(wall).with_friction(0.2))
        .unwrap();
    let disc = VoxelGrid::ball(64, 1.0).unwrap();
    world
        .add_soft_body(SoftBody::new(disc, &[Material::default()]).unwrap())
        .unwrap();
    world
        .add_rigid_body(RigidBody::coupled(Shape::ball(0.08)).at(Vec2::new(-0.3, 0.55)))
        .unwrap();
    check(world, 150, 30, 20, |seconds| {
        Vec2::new(-0.3 + 0.9 * seconds.min(1.5), 0.55)
    });
}

/// Checks that dust, a body of many crumbs that starts inside another body, drifts out slowly and preserves
/// momentum.
fn check_way_out<D: Dim>(n: usize) {
    let mut world = World::<D>::new(WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    })
    .unwrap();
    let ball = |n, width| VoxelGrid::<D>::ball(n, width).unwrap();
    let tough = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    let mut dust = SoftBody::new(ball(n / 4, 0.25), &[tough]).unwrap();
    dust.crumble();
    let depth = if D::N == 3 { 0.37 } else { 0.0 };
    let dust = world
        .add_soft_body(dust.translated(vector(0.1, 0.37, depth)))
        .unwrap();
    world
        .add_soft_body(SoftBody::new(ball(n, 1.0), &[tough]).unwrap())
        .unwrap();
    let (before, count) = crumbs_inside(&world);
    assert!(5 * before.len() > 4 * count, "{} of {count}", before.len());
    for tick in 0..60 {
        world.step();
        for crumb in world[dust].piece_views() {
            let speed = crumb.velocity.length();
            assert!(speed < 2.0, "tick {tick}: {speed} m/s");
        }
        // Checks the momentum in the first ticks, in which the crumbs escape.
        if tick < 9 {
            let bodies = world.soft_bodies();
            let linear = bodies.map(|(_, body)| body.momentum().linear);
            let linear = linear.sum::<DVec3>();
            let most = 1e-3 * world[dust].total_mass();
            assert!(
                linear.abs().max_element() < most,
                "tick {tick}: {linear:?} kg m/s"
            );
        }
    }
    let (after, _) = crumbs_inside(&world);
    assert!(
        after.is_empty(),
        "{} of {count} crumbs are embedded",
        after.len()
    );
}

#[test]
fn embedded_dust_drifts_out_slowly() {
    check_way_out::<Dim2>(48);
    check_way_out::<Dim3>(16);
}

/// Lets a single voxel vibrate from a slight expansion, and returns the speed of its fastest node after one
/// second [m/s].
fn left_of_a_swing<D: Dim>(poisson: f64, substeps: u32) -> f32 {
    const WIDE: usize = 32;
    let elasticity = Elasticity {
        young: 20_000.0,
        poisson,
    };
    let material = Material {
        elasticity,
        ..Material::default()
    };
    let settings = WorldConfig {
        gravity: D::Vector::ZERO,
        drag: 0.0,
        max_substeps: substeps,
        ..WorldConfig::default()
    };
    let mut world = World::<D>::new(settings).unwrap();
    // The grid holds a large block and a separate voxel. The separate voxel has the same damping rate as the
    // block.
    let mut size = [WIDE; 3];
    size[D::N..].fill(1);
    let grid = VoxelGrid::from_fn(size, 1.0 / WIDE as f32, |at| {
        u8::from(at == [0; 3] || at[0] as usize > WIDE / 2)
    });
    let soft = world
        .add_soft_body(SoftBody::new(grid.unwrap(), &[material]).unwrap())
        .unwrap();
    let body = world.soft_body_mut(soft).unwrap();
    let views = body.piece_views();
    let crumb = views.iter().find(|view| view.element_count == 1).unwrap();
    let ids = body.mesh().nodes().map(|(id, _)| id);
    let nodes: Vec<_> = ids
        .filter(|&id| body.pieces().of_node(id) == crumb.number)
        .collect();
    for &node in &nodes {
        let (at, _, _) = body.node_state(node);
        let away = at - D::Vector::from_vec3(crumb.centre);
        body.set_node_state(node, at, away * 0.1).unwrap();
    }
    for _ in 0..60 {
        world.step();
    }
    let speeds = nodes.iter().map(|&node| world[soft].node_state(node).1);
    speeds.map(D::Vector::length).fold(0.0, f32::max)
}

#[test]
fn crumb_vibration_decays_for_any_material_and_substeps() {
    for poisson in [0.0, 0.3, 0.45] {
        for substeps in [8, 16, 64] {
            let plane = left_of_a_swing::<Dim2>(poisson, substeps);
            let space = left_of_a_swing::<Dim3>(poisson, substeps);
            let fast = plane.max(space);
            assert!(fast < 1e-3, "{poisson}, {substeps}: {plane}, {space} m/s");
        }
    }
}

/// Drops a heavy block on a sleeping crumb, and returns the maximum depth to which the crumb sinks into the
/// floor [voxels].
fn depth_of_a_sleeper<D: Dim>(size: usize, speed: f32) -> f32 {
    const VOXEL: f32 = 1.0 / 32.0;
    let settings = WorldConfig {
        max_substeps: 8,
        ..WorldConfig::default()
    };
    let mut world = World::<D>::new(settings).unwrap();
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.4))
        .unwrap();
    let crumb = VoxelGrid::<D>::cube(1, VOXEL).unwrap();
    let crumb = world
        .add_soft_body(SoftBody::new(crumb, &[Material::default()]).unwrap())
        .unwrap();
    let sleeps = |world: &World<D>| world[crumb].pieces().list[PieceId(0)].asleep;
    for _ in 0..90 {
        world.step();
    }
    assert!(sleeps(&world));
    let block = VoxelGrid::<D>::cube(size, size as f32 * VOXEL).unwrap();
    let mut heavy = Material::default();
    heavy.density *= 10.0;
    let block = SoftBody::new(block, &[heavy]).unwrap();
    let thrown = block.with_velocity(Velocity::linear(vector(0.0, -speed, 0.0)));
    world
        .add_soft_body(thrown.translated(vector(-0.3 * VOXEL, 4.0 * VOXEL, -0.2 * VOXEL)))
        .unwrap();
    let mut lowest = f32::INFINITY;
    for _ in 0..20 {
        world.step();
        let body = &world[crumb];
        let nodes = body.mesh().nodes();
        lowest = nodes.fold(lowest, |low, (id, _)| low.min(body.node_state(id).0[1]));
    }
    assert!(!sleeps(&world), "the block must wake the crumb");
    -lowest / VOXEL
}

#[test]
fn sleeping_crumb_stays_above_floor_when_hit() {
    for size in [2, 4, 8] {
        for speed in [1.0, 2.0] {
            let plane = depth_of_a_sleeper::<Dim2>(size, speed);
            let space = depth_of_a_sleeper::<Dim3>(size, speed);
            let depth = plane.max(space);
            assert!(depth < 0.5, "{size}, {speed} m/s: {plane}, {space} voxels");
        }
    }
}
