//! Faults that there were, each with what brought it about.

use fuwafuwa::{
    Blade, Dim, Dim2, Dim3, Event, Material, MotionType, RigidBody, Shape, SoftBody, VoxelGrid,
    World, WorldConfig,
};
use std::time::Duration;

fn weightless<D: Dim>() -> World<D> {
    let gravity = [0.0; 3];
    let settings = WorldConfig {
        gravity,
        ..WorldConfig::default()
    };
    World::new(settings).expect("the settings are good")
}

fn ball<D: Dim>(n: usize) -> SoftBody<D> {
    let grid = VoxelGrid::ball(n, 1.0).expect("a ball is not empty");
    SoftBody::new(grid, &[Material::default()]).expect("the material is good")
}

/// Along the same blade, all that can be released was released the first time; the next ones told of
/// as many nodes again, with events.
fn check_cut_twice<D: Dim>(n: usize) {
    let mut world = weightless::<D>();
    world.add_soft_body(ball(n));
    let blade = Blade {
        from: [0.5, -1.0, -1.0],
        across: [0.0, 3.0, 0.0],
        along: [0.0, 0.0, 3.0],
    };
    let first = world.cut(world.nth_soft_body(0).unwrap(), &blade).unwrap();
    let points = (n - 1) * (D::N - 1);
    assert!(first >= points && first < n * n, "{first}");
    let told = |world: &World<D>| {
        let is_release = |event: &&Event| matches!(event, Event::NodeSplit { .. });
        world.events().iter().filter(is_release).count()
    };
    assert_eq!(told(&world), first);
    assert_eq!(world.soft_bodies().first().unwrap().pieces().list.len(), 2);
    assert_eq!(
        (
            world.cut(world.nth_soft_body(0).unwrap(), &blade).unwrap(),
            told(&world)
        ),
        (0, first)
    );
    // A blade that crosses it releases only what it adds.
    let across = Blade {
        from: [-1.0, 0.5, -1.0],
        across: [3.0, 0.0, 0.0],
        along: [0.0, 0.0, 3.0],
    };
    assert!(world.cut(world.nth_soft_body(0).unwrap(), &across).unwrap() >= points);
    assert_eq!(
        world.cut(world.nth_soft_body(0).unwrap(), &across).unwrap(),
        0
    );
    assert_eq!(world.soft_bodies().first().unwrap().pieces().list.len(), 4);
}

#[test]
fn a_second_cut_along_a_blade_releases_nothing() {
    check_cut_twice::<Dim2>(16);
    check_cut_twice::<Dim3>(8);
}

/// Puts every node of a body elsewhere.
fn place<D: Dim>(body: &mut SoftBody<D>, to: impl Fn([f32; 3]) -> [f32; 3]) {
    let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in ids {
        let at = to(body.node_state(id).0);
        assert!(body.set_node_state(id, at, [0.0; 3]));
    }
}

/// Half a turn about an axis of the grid, about a diagonal of it, and nearly so.
fn turns() -> [fn([f32; 3]) -> [f32; 3]; 5] {
    [
        |[x, y, z]| [x, 1.0 - y, 1.0 - z],
        |[x, y, z]| [1.0 - x, y, 1.0 - z],
        |[x, y, z]| [1.0 - x, 1.0 - y, z],
        |[x, y, z]| [y, x, 1.0 - z],
        // By the angle whose cosine is −0.8.
        |[x, y, z]| [-0.8 * x - 0.6 * y, 0.6 * x - 0.8 * y, z],
    ]
}

fn fastest<D: Dim>(body: &SoftBody<D>) -> f32 {
    let speeds = body.mesh().nodes().map(|(id, _)| {
        let speed = body.node_state(id).1;
        speed.iter().map(|k| k * k).sum::<f32>().sqrt()
    });
    speeds.fold(0.0, f32::max)
}

/// The rotations of elements begin at none, where half a turn off they stood still: a ball that was put
/// upside down tore itself into 42 pieces.
#[test]
fn a_body_turned_round_stays_whole() {
    for turn in turns() {
        let mut world = weightless::<Dim3>();
        let mut body = ball(12);
        place(&mut body, turn);
        world.add_soft_body(body);
        for _ in 0..10 {
            assert_eq!(world.step().nodes_split, 0);
        }
        assert!(
            fastest(world.soft_bodies().first().unwrap()) < 1e-3,
            "{}",
            fastest(world.soft_bodies().first().unwrap())
        );
    }
}

/// So did new elements in a body that had turned: a cut through it upside down threw it about.
#[test]
fn a_cut_through_a_body_turned_round_moves_nothing() {
    for turn in turns() {
        let mut world = weightless::<Dim3>();
        let mut body = ball(16);
        place(&mut body, turn);
        let from = body.piece_views()[0].centre;
        world.add_soft_body(body);
        world.step();
        let (across, along) = ([0.3, 1.0, 0.0], [0.0, 0.0, 1.0]);
        assert!(
            world
                .cut(
                    world.nth_soft_body(0).unwrap(),
                    &Blade {
                        from,
                        across,
                        along
                    }
                )
                .unwrap()
                > 20
        );
        for _ in 0..5 {
            assert_eq!(world.step().nodes_split, 0);
        }
        assert!(
            fastest(world.soft_bodies().first().unwrap()) < 1e-2,
            "{}",
            fastest(world.soft_bodies().first().unwrap())
        );
    }
}

/// Each voxel that came off was taken from the front of a list of all: n = 48 took five times as long as
/// n = 32, of three times as many voxels, and n = 64 a minute.
#[test]
#[allow(clippy::disallowed_types)] // how long it takes is what is asked
fn crumbling_takes_as_long_as_there_are_voxels() {
    let mut body = ball::<Dim3>(64);
    let start = std::time::Instant::now();
    body.crumble().expect("the mesh stays whole");
    let elapsed = start.elapsed();
    assert!(elapsed < Duration::from_secs(20), "{elapsed:?}");
}

#[test]
fn all_of_a_body_crumbles() {
    let mut body = ball::<Dim3>(24);
    let voxels = body.grid().solid_count();
    let parted = body.crumble().expect("the mesh stays whole");
    assert_eq!(parted.len(), voxels - 1);
    assert_eq!(body.pieces().list.len(), voxels);
    assert_eq!(body.mesh().node_count(), 8 * voxels);
    assert_eq!(
        body.mesh().validate(body.grid(), body.connectivity()),
        Ok(())
    );
}

/// A hand that moved in space and was put into the plane went on along the third axis.
#[test]
fn a_hand_from_space_stays_in_the_plane() {
    let mut space = weightless::<Dim3>();
    let hand = RigidBody::coupled_ball([0.0, 0.0, 0.5], 0.1);
    space.add_rigid_body(hand).expect("the hand is good");
    space
        .set_target_position(space.nth_target_follower(0).unwrap(), [0.0, 0.0, 1.0])
        .unwrap();
    space.step();
    let hand = space
        .remove_rigid_body(space.nth_target_follower(0).unwrap())
        .unwrap();
    assert!(hand.velocity()[2] > 0.1);
    let mut plane = weightless::<Dim2>();
    plane.add_rigid_body(hand).expect("the hand is good");
    for _ in 0..3 {
        plane.step();
        let (_, hand) = plane.target_followers().next().unwrap();
        assert_eq!((hand.position()[2], hand.velocity()[2]), (0.0, 0.0));
    }
}

/// A body whose surface bears anything tears nowhere, whatever else its list of materials holds. With a
/// weaker one in the list that no voxel had, its cracks went on.
#[test]
fn a_weaker_material_that_no_voxel_has_changes_nothing() {
    let strong = Material {
        strength: f32::INFINITY,
        toughness: 20.0,
        ..Material::default()
    };
    let run = |materials: &[Material]| {
        let mut world = weightless::<Dim2>();
        let grid = VoxelGrid::ball(16, 1.0).expect("a ball is not empty");
        world.add_soft_body(SoftBody::new(grid, materials).expect("the materials are good"));
        assert!(
            world
                .cut(
                    world.nth_soft_body(0).unwrap(),
                    &Blade::segment([0.5, 0.4], [0.5, 2.0])
                )
                .unwrap()
                > 0
        );
        let hand =
            RigidBody::coupled_ball([0.5, 1.1, 0.0], 0.1).with_motion_type(MotionType::Kinematic);
        world.add_rigid_body(hand).expect("the hand is good");
        let mut released = 0;
        for tick in 0..40u8 {
            world
                .set_target_position(
                    world.nth_target_follower(0).unwrap(),
                    [0.5, 1.1 - 0.02 * f32::from(tick), 0.0],
                )
                .unwrap();
            released += world.step().nodes_split;
        }
        (released, world.hash())
    };
    let (released, hash) = run(&[strong]);
    assert_eq!(released, 0);
    assert_eq!(run(&[strong, Material::default()]), (0, hash));
}

/// A crumb that is nowhere, inside another body, is quarantined alone.
#[test]
fn a_crumb_out_of_hand_inside_a_ball_leaves_the_ball() {
    for nowhere in [f32::NAN, f32::INFINITY, 1e30] {
        let mut world = weightless::<Dim2>();
        world.add_soft_body(ball(16));
        let grid = VoxelGrid::cube(1, 1.0 / 16.0).expect("a cube is not empty");
        let crumb = SoftBody::new(grid, &[Material::default()]).expect("the material is good");
        let crumb = world.add_soft_body(crumb.translated([0.45, 0.45, 0.0]));
        for _ in 0..3 {
            world.step();
        }
        let crumb = world.soft_body_mut(crumb).unwrap();
        *crumb = crumb.clone().with_velocity([0.0, nowhere, 0.0]);
        let mut quarantined = 0;
        for _ in 0..10 {
            quarantined += world.step().quarantined;
        }
        let ball = world.soft_bodies().first().unwrap();
        assert!(
            ball.pieces().list.iter().all(|piece| !piece.quarantined),
            "{nowhere}"
        );
        assert!(quarantined <= 1);
    }
}

/// Of 0 and −0, `f32::max` and `min` return either, as the machine has it. Whatever the signs of the zeros that go in,
/// what comes out is the same.
fn check_zeros<D: Dim>(n: usize) {
    let run = |zero: f32| {
        let settings = WorldConfig {
            gravity: [zero, -9.81, zero],
            drag: zero,
            ..WorldConfig::default()
        };
        let mut world = World::<D>::new(settings).expect("the settings are good");
        let material = Material {
            damping: zero,
            friction: zero,
            strength: 200.0,
            toughness: 20.0,
            ..Material::default()
        };
        let grid = VoxelGrid::ball(n, 1.0).expect("a ball is not empty");
        let body = SoftBody::new(grid, &[material]).expect("the material is good");
        let middle = body.clone().translated([-0.5, zero, zero]);
        world.add_soft_body(middle.with_velocity([zero; 3]));
        let normal = [zero, 1.0, zero];
        let floor = Shape::HalfSpace {
            normal,
            offset: zero,
        };
        world
            .add_rigid_body(RigidBody::fixed(floor, zero))
            .expect("the floor is good");
        let hand =
            RigidBody::coupled_ball([zero, 1.2, 0.5], 0.1).with_motion_type(MotionType::Kinematic);
        let hand = world.add_rigid_body(hand).expect("the hand is good");
        let mut released = 0;
        for tick in 0..40u8 {
            let goal = [zero, 1.2 - 0.02 * f32::from(tick), 0.5];
            world
                .set_target_position(hand, goal)
                .expect("the goal is good");
            released += world.step().nodes_split;
        }
        let body = world.soft_bodies().first().expect("there is one");
        let states = body.mesh().nodes().map(|(id, _)| body.node_state(id));
        (released, states.collect::<Vec<_>>())
    };
    let plain = run(0.0);
    assert!(plain.0 > 0, "nothing tore");
    // Which takes 0 and −0 for equal.
    assert_eq!(run(-0.0), plain);
}

#[test]
fn the_sign_of_a_zero_changes_nothing() {
    check_zeros::<Dim2>(16);
    check_zeros::<Dim3>(8);
}
