//! Regression tests: a comment that begins with "Regression" describes the former fault.

use crate::vectors::vector;
use fuwafuwa::{
    Blade, Damping, Dim, Dim2, Dim3, DimVector, Event, Material, RigidBody, Shape, SoftBody, Vec2,
    Vec3, Velocity, VoxelGrid, World, WorldConfig,
};
use std::time::Duration;

fn weightless<D: Dim>() -> World<D> {
    let settings = WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    };
    World::new(settings).expect("the configuration is valid")
}

fn ball<D: Dim>(n: usize) -> SoftBody<D> {
    let grid = VoxelGrid::ball(n, 1.0).expect("a ball is not empty");
    SoftBody::new(grid, &[Material::default()]).expect("the material is valid")
}

/// Regression: a second cut along the same blade split no node, but reported the split nodes of the first cut
/// again, with events.
fn check_cut_twice<D: Dim>(n: usize, [blade, across]: [Blade<D>; 2]) {
    let mut world = weightless::<D>();
    let id = world.add_soft_body(ball(n)).unwrap();
    let first = world.cut(id, &blade).unwrap();
    let points = (n - 1) * (D::N - 1);
    assert!(first >= points && first < n * n, "{first}");
    let told = |world: &World<D>| {
        let is_release = |event: &&Event<D>| matches!(event, Event::NodeSplit { .. });
        world.events().iter().filter(is_release).count()
    };
    assert_eq!(told(&world), first);
    assert_eq!(world[id].pieces().list.len(), 2);
    assert_eq!((world.cut(id, &blade).unwrap(), told(&world)), (0, first));
    // A blade that crosses the first cut splits only nodes that the first cut did not split.
    assert!(world.cut(id, &across).unwrap() >= points);
    assert_eq!(world.cut(id, &across).unwrap(), 0);
    assert_eq!(world[id].pieces().list.len(), 4);
}

#[test]
fn cut_releases_nothing_along_same_blade() {
    let upright = Blade::segment(Vec2::new(0.5, -1.0), Vec2::new(0.5, 2.0));
    let level = Blade::segment(Vec2::new(-1.0, 0.5), Vec2::new(2.0, 0.5));
    check_cut_twice::<Dim2>(16, [upright, level]);
    let [x, y, z] = Vec3::AXES.map(|axis| axis * 3.0);
    let upright = Blade::parallelogram(Vec3::new(0.5, -1.0, -1.0), y, z);
    let level = Blade::parallelogram(Vec3::new(-1.0, 0.5, -1.0), x, z);
    check_cut_twice::<Dim3>(8, [upright, level]);
}

/// Moves every node of a body from its position to the position that `to` returns for it.
fn place(body: &mut SoftBody<Dim3>, to: impl Fn(Vec3) -> Vec3) {
    let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in ids {
        let at = to(body.node_state(id).0);
        body.set_node_state(id, at, Vec3::ZERO).unwrap();
    }
}

/// Returns five rotations of the unit cube as functions of a point: half turns about the grid's axes and
/// about a diagonal, and one rotation by nearly half a turn.
fn turns() -> [fn(Vec3) -> Vec3; 5] {
    [
        |Vec3 { x, y, z }| Vec3::new(x, 1.0 - y, 1.0 - z),
        |Vec3 { x, y, z }| Vec3::new(1.0 - x, y, 1.0 - z),
        |Vec3 { x, y, z }| Vec3::new(1.0 - x, 1.0 - y, z),
        |Vec3 { x, y, z }| Vec3::new(y, x, 1.0 - z),
        // Rotation by about 143°, the angle with the cosine −0.8.
        |Vec3 { x, y, z }| Vec3::new(-0.8 * x - 0.6 * y, 0.6 * x - 0.8 * y, z),
    ]
}

fn fastest<D: Dim>(body: &SoftBody<D>) -> f32 {
    let nodes = body.mesh().nodes();
    let speeds = nodes.map(|(id, _)| body.node_state(id).1.length());
    speeds.fold(0.0, f32::max)
}

/// Regression: the iteration for the rotation of an element started at the identity and did not converge at
/// half a turn. A ball placed upside down tore itself into 42 pieces.
#[test]
fn body_stays_whole_when_turned_by_half_turn() {
    for turn in turns() {
        let mut world = weightless::<Dim3>();
        let mut body = ball(12);
        place(&mut body, turn);
        let id = world.add_soft_body(body).unwrap();
        for _ in 0..10 {
            assert_eq!(world.step().nodes_split, 0);
        }
        assert!(fastest(&world[id]) < 1e-3, "{}", fastest(&world[id]));
    }
}

/// Regression: for new elements in a rotated body, the iteration for the element's rotation did not converge
/// at half a turn. A cut through a body placed upside down hurled the body about.
#[test]
fn cut_keeps_turned_body_at_rest() {
    for turn in turns() {
        let mut world = weightless::<Dim3>();
        let mut body = ball(16);
        place(&mut body, turn);
        let from = body.piece_views()[0].centre;
        let id = world.add_soft_body(body).unwrap();
        world.step();
        let blade = Blade::parallelogram(from, Vec3::new(0.3, 1.0, 0.0), Vec3::Z);
        assert!(world.cut(id, &blade).unwrap() > 20);
        for _ in 0..5 {
            assert_eq!(world.step().nodes_split, 0);
        }
        assert!(fastest(&world[id]) < 1e-2, "{}", fastest(&world[id]));
    }
}

/// Regression: detached voxels were removed one by one from the front of a list of all voxels, in quadratic
/// time. A ball of 64 voxels across took a minute.
#[test]
#[allow(clippy::disallowed_types)] // the test measures time
fn crumble_takes_linear_time() {
    let mut body = ball::<Dim3>(64);
    let start = std::time::Instant::now();
    body.crumble();
    let elapsed = start.elapsed();
    assert!(elapsed < Duration::from_secs(20), "{elapsed:?}");
}

#[test]
fn crumble_detaches_every_voxel() {
    let mut body = ball::<Dim3>(24);
    let voxels = body.grid().solid_count();
    let parted = body.crumble();
    assert_eq!(parted.len(), voxels - 1);
    assert_eq!(body.pieces().list.len(), voxels);
    assert_eq!(body.mesh().node_count(), 8 * voxels);
    assert_eq!(
        body.mesh().validate(body.grid(), body.connectivity()),
        Ok(())
    );
}

/// Returns the positions, velocities and masses of all nodes of a body.
fn node_states<D: Dim>(body: &SoftBody<D>) -> Vec<(D::Vector, D::Vector, f32)> {
    let nodes = body.mesh().nodes();
    nodes.map(|(id, _)| body.node_state(id)).collect()
}

/// Regression: the strength of a material in the list that no voxel uses was considered, so that cracks grew
/// in a body of infinite strength.
#[test]
fn unused_weaker_material_has_no_effect_on_cracks() {
    let strong = Material {
        strength: f32::INFINITY,
        toughness: 20.0,
        ..Material::default()
    };
    let run = |materials: &[Material]| {
        let mut world = weightless::<Dim2>();
        let grid = VoxelGrid::ball(16, 1.0).expect("a ball is not empty");
        let id = world
            .add_soft_body(SoftBody::new(grid, materials).expect("the materials are valid"))
            .unwrap();
        let blade = Blade::segment(Vec2::new(0.5, 0.4), Vec2::new(0.5, 2.0));
        assert!(world.cut(id, &blade).unwrap() > 0);
        let hand = RigidBody::kinematic(Shape::ball(0.1)).at(Vec2::new(0.5, 1.1));
        let hand = world.add_rigid_body(hand).expect("the hand is valid");
        let mut released = 0;
        for tick in 0..40u8 {
            let goal = Vec2::new(0.5, 1.1 - 0.02 * f32::from(tick));
            world.set_target_position(hand, goal).unwrap();
            released += world.step().nodes_split;
        }
        (released, node_states(&world[id]))
    };
    let (released, states) = run(&[strong]);
    assert_eq!(released, 0);
    assert_eq!(run(&[strong, Material::default()]), (0, states));
}

/// Regression: a non-finite crumb inside another body put the other body into quarantine, too.
#[test]
fn quarantine_spares_ball_around_non_finite_crumb() {
    for nowhere in [f32::NAN, f32::INFINITY, 1e30] {
        let mut world = weightless::<Dim2>();
        let around = world.add_soft_body(ball(16)).unwrap();
        let grid = VoxelGrid::cube(1, 1.0 / 16.0).expect("a cube is not empty");
        let crumb = SoftBody::new(grid, &[Material::default()]).expect("the material is valid");
        let crumb = world
            .add_soft_body(crumb.translated(Vec2::new(0.45, 0.45)))
            .unwrap();
        for _ in 0..3 {
            world.step();
        }
        let crumb = world.soft_body_mut(crumb).unwrap();
        *crumb = crumb.clone().with_velocity(Vec2::new(0.0, nowhere));
        let mut quarantined = 0;
        for _ in 0..10 {
            quarantined += world.step().quarantined;
        }
        let pieces = &world[around].pieces().list;
        assert!(pieces.iter().all(|piece| !piece.quarantined), "{nowhere}");
        assert!(quarantined <= 1);
    }
}

/// Checks that results do not depend on the signs of zeros in the input. `f32::max` and `f32::min` of 0 and
/// −0 return either zero, depending on the machine.
fn check_zeros<D: Dim>(n: usize) {
    let run = |zero: f32| {
        let settings = WorldConfig {
            gravity: vector(zero, -9.81, zero),
            drag: zero,
            ..WorldConfig::default()
        };
        let mut world = World::<D>::new(settings).expect("the configuration is valid");
        let material = Material {
            damping: Damping {
                mass: zero,
                stiffness: zero,
            },
            friction: zero,
            strength: 200.0,
            toughness: 20.0,
            ..Material::default()
        };
        let grid = VoxelGrid::ball(n, 1.0).expect("a ball is not empty");
        let body = SoftBody::new(grid, &[material]).expect("the material is valid");
        let middle = body.clone().translated(vector(-0.5, zero, zero));
        let velocity = Velocity::linear(D::Vector::splat(zero));
        let id = world.add_soft_body(middle.with_velocity(velocity)).unwrap();
        let floor = Shape::HalfSpace {
            normal: vector(zero, 1.0, zero),
            offset: zero,
        };
        world
            .add_rigid_body(RigidBody::fixed(floor).with_friction(zero))
            .expect("the floor is valid");
        let hand = RigidBody::kinematic(Shape::ball(0.1)).at(vector(zero, 1.2, 0.5));
        let hand = world.add_rigid_body(hand).expect("the hand is valid");
        let mut released = 0;
        for tick in 0..40u8 {
            let goal = vector(zero, 1.2 - 0.02 * f32::from(tick), 0.5);
            world
                .set_target_position(hand, goal)
                .expect("the target is valid");
            released += world.step().nodes_split;
        }
        (released, node_states(&world[id]))
    };
    let plain = run(0.0);
    assert!(plain.0 > 0, "nothing tore");
    // The comparison accepts results that differ in the sign of zero, because 0 == −0.
    assert_eq!(run(-0.0), plain);
}

#[test]
fn simulation_is_independent_of_sign_of_zero() {
    check_zeros::<Dim2>(16);
    check_zeros::<Dim3>(8);
}
