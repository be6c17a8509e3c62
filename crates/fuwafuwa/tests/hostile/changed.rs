//! What is changed, put in or taken out between two ticks.

use super::*;

#[test]
fn a_body_in_the_place_of_another_may_have_fewer_nodes_and_pieces() {
    let mut world = world::<Dim2>();
    let mut dust = ball(16);
    dust.crumble().unwrap();
    world.add_body(dust);
    step(&mut world, 20);
    *world.body_mut(0) = ball(8);
    step(&mut world, 5);
    assert_finite(&world);
}

/// A body on a floor, a while later.
fn sleeper() -> World<Dim2> {
    let mut world = world::<Dim2>();
    let damped = Material {
        damping: 0.5,
        ..Material::default()
    };
    let grid = VoxelGrid::ball(16, 1.0).unwrap();
    world.add_body(Body::new(grid, &[damped]).unwrap());
    for _ in 0..900 {
        world.step();
        if world.bodies()[0].piece_views()[0].asleep {
            return world;
        }
    }
    panic!("the body does not fall asleep");
}

#[test]
fn a_sleeper_changed_from_outside_wakes() {
    let mut thrown = sleeper();
    let body = thrown.body_mut(0);
    *body = body.clone().thrown([0.0, 5.0, 0.0]);
    let woke = |event: &Event| matches!(event, Event::Woke { body: 0, piece: 0 });
    assert!(thrown.events().iter().any(woke));
    step(&mut thrown, 10);
    assert!(thrown.bodies()[0].piece_views()[0].low[1] > 0.3);

    let mut crumbled = sleeper();
    crumbled.body_mut(0).crumble().unwrap();
    let before = crumbled.bodies()[0].piece_views();
    step(&mut crumbled, 10);
    let after = crumbled.bodies()[0].piece_views();
    let frozen = before
        .iter()
        .zip(&after)
        .filter(|(before, after)| before.centre == after.centre);
    assert!(
        after.len() > 100 && frozen.count() == 0,
        "no crumb hangs in the air"
    );
}

#[test]
fn what_leant_on_what_is_removed_falls() {
    let mut world = sleeper();
    world.remove_obstacle(0);
    assert!(world.obstacles().is_empty());
    step(&mut world, 30);
    let view = world.bodies()[0].piece_views()[0];
    assert!(!view.asleep && view.high[1] < 0.5, "{view:?}");
}

#[test]
fn a_sleeper_that_is_put_back_elsewhere_falls() {
    let mut world = sleeper();
    let body = world.remove_body(0).moved([0.0, 3.0, 0.0]);
    world.add_body(body);
    step(&mut world, 30);
    let view = world.bodies()[0].piece_views()[0];
    assert!(!view.asleep && view.low[1] < 2.5, "{view:?}");
}

#[test]
fn a_body_is_as_stiff_as_the_world_that_it_is_in_bears() {
    let stiff = Material {
        elasticity: fuwafuwa::Elasticity {
            young: 1e6,
            poisson: 0.3,
        },
        ..Material::default()
    };
    let world_of = |most_substeps| {
        let settings = Settings {
            most_substeps,
            ..Settings::default()
        };
        World::<Dim2>::new(settings).unwrap()
    };
    let (mut poor, mut rich) = (world_of(16), world_of(1024));
    poor.add_body(Body::new(VoxelGrid::ball(16, 1.0).unwrap(), &[stiff]).unwrap());
    let stiffness_scale = poor.bodies()[0].stiffness_scale();
    assert!(stiffness_scale < 0.2);
    rich.add_body(poor.remove_body(0));
    assert_eq!(rich.bodies()[0].stiffness_scale(), 1.0);
    poor.add_body(rich.remove_body(0));
    assert_eq!(poor.bodies()[0].stiffness_scale(), stiffness_scale);
}

#[test]
fn things_leave_and_the_rest_move_up() {
    let mut world = world::<Dim2>();
    for place in 0..3u8 {
        let x = 2.0 * f32::from(place);
        world.add_body(ball(8 + 4 * usize::from(place)).moved([x, 0.0, 0.0]));
        let hand = Manipulator::new([x + 0.5, 1.1, 0.0], 0.1);
        let hand = world.add_manipulator(hand).unwrap();
        world.set_goal(hand, [x + 0.5, 0.8, 0.0]);
    }
    step(&mut world, 10);
    assert_eq!(world.remove_body(1).grid().size()[0], 12);
    assert!(world.remove_manipulator(0).position()[0] < 1.0);
    step(&mut world, 30);
    assert_finite(&world);
    let sizes = world.bodies().iter().map(|body| body.grid().size()[0]);
    assert_eq!(sizes.collect::<Vec<_>>(), [8, 16]);
    let with = |event: &Event| match *event {
        Event::Touched { body, with, .. } => Some((body, with)),
        _ => None,
    };
    let touched: Vec<_> = world.events().iter().filter_map(with).collect();
    let hand = fuwafuwa::With::Manipulator;
    assert!(touched.contains(&(1, hand(1))), "{touched:?}");
    assert!(!touched.contains(&(0, hand(0))), "{touched:?}");
}

#[test]
fn a_held_node_that_is_let_go_falls() {
    let mut world = World::<Dim2>::new(Settings::default()).unwrap();
    let mut body = ball::<Dim2>(8);
    let nodes: Vec<u32> = body.mesh().nodes().map(|(id, _)| id).collect();
    nodes.iter().for_each(|&id| body.hold(id));
    world.add_body(body);
    let height = |world: &World<Dim2>| world.bodies()[0].piece_views()[0].centre[1];
    let start = height(&world);
    step(&mut world, 120);
    assert_eq!(height(&world), start);
    let body = world.body_mut(0);
    nodes.iter().for_each(|&id| body.let_go(id));
    step(&mut world, 30);
    assert!(height(&world) < start - 1.0);
}

#[test]
fn another_body_in_the_place_of_one_is_taken_for_what_it_is() {
    let mut world = world::<Dim2>();
    world.add_body(bar([2, 7]));
    world.step();
    *world.body_mut(0) = bar([2, 8]).thrown([0.0, -4.0, 0.0]);
    let mut touches = 0;
    for _ in 0..30 {
        world.step();
        let is_own = |event: &&Event| {
            let own = With::Piece { body: 0, piece: 0 };
            matches!(event, Event::Touched { with, .. } if *with == own)
        };
        touches += world.events().iter().filter(is_own).count();
    }
    assert!(
        touches < 10,
        "its neighbouring voxels push each other {touches} times"
    );
}

#[test]
fn small_voxels_still_meet_when_large_ones_came() {
    let mut world = about_to_meet();
    world.step();
    let grid = VoxelGrid::from_fn([2, 2, 1], 1.0, |_| 1).unwrap();
    let large = Body::new(grid, &[Material::default()]).unwrap();
    world.add_body(large.moved([0.0, -9.0, 0.0]));
    assert_they_meet(world);
}
