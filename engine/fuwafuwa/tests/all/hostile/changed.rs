//! Changes, additions and removals of objects between two ticks.

use super::*;

#[test]
fn replaced_body_may_have_fewer_nodes_and_pieces() {
    let mut world = world::<Dim2>();
    let mut dust = ball(16);
    dust.crumble();
    let id = world.add_soft_body(dust).unwrap();
    step(&mut world, 20);
    *world.soft_body_mut(id).unwrap() = ball(8);
    step(&mut world, 5);
    assert_finite(&world);
}

/// Returns a world with a body asleep on a floor.
fn sleeper() -> World<Dim2> {
    let mut world = world::<Dim2>();
    let damped = Material {
        damping: Damping::at(0.5, 4.0),
        ..Material::default()
    };
    let grid = VoxelGrid::ball(16, 1.0).unwrap();
    let id = world
        .add_soft_body(SoftBody::new(grid, &[damped]).unwrap())
        .unwrap();
    for _ in 0..900 {
        world.step();
        if world[id].piece_views()[0].asleep {
            return world;
        }
    }
    panic!("the body does not fall asleep");
}

#[test]
fn sleeping_body_wakes_when_changed() {
    let mut thrown = sleeper();
    let id = thrown.nth_soft_body(0).unwrap();
    let body = thrown.soft_body_mut(id).unwrap();
    *body = body.clone().with_velocity(Vec2::new(0.0, 5.0));
    let woke = Event::WokeUp {
        body: id,
        piece: PieceId(0),
    };
    assert!(thrown.events().contains(&woke));
    step(&mut thrown, 10);
    assert!(thrown[id].piece_views()[0].low.y > 0.3);

    let mut crumbled = sleeper();
    let id = crumbled.nth_soft_body(0).unwrap();
    crumbled.soft_body_mut(id).unwrap().crumble();
    let before = crumbled[id].piece_views();
    step(&mut crumbled, 10);
    let after = crumbled[id].piece_views();
    let frozen = before
        .iter()
        .zip(&after)
        .filter(|(before, after)| before.centre == after.centre);
    assert!(
        after.len() > 100 && frozen.count() == 0,
        "no crumb may hang in the air"
    );
}

#[test]
fn sleeping_body_falls_when_floor_is_removed() {
    let mut world = sleeper();
    let (floor, _) = world.rigid_bodies().next().unwrap();
    world.remove(floor).unwrap();
    assert_eq!(world.rigid_bodies().count(), 0);
    step(&mut world, 30);
    let body = world.nth_soft_body(0).unwrap();
    let view = world[body].piece_views()[0];
    assert!(!view.asleep && view.high.y < 0.5, "{view:?}");
}

#[test]
fn sleeping_body_wakes_when_added_elsewhere() {
    let mut world = sleeper();
    let id = world.nth_soft_body(0).unwrap();
    let body = world.remove(id).unwrap();
    let id = world
        .add_soft_body(body.translated(Vec2::new(0.0, 3.0)))
        .unwrap();
    step(&mut world, 30);
    let view = world[id].piece_views()[0];
    assert!(!view.asleep && view.low.y < 2.5, "{view:?}");
}

#[test]
fn mass_scale_follows_substeps_of_world() {
    let stiff = Material {
        elasticity: fuwafuwa::inspect::Elasticity {
            young: 1e6,
            poisson: 0.3,
        },
        ..Material::default()
    };
    let world_of = |max_substeps| {
        let settings = WorldConfig {
            max_substeps,
            ..WorldConfig::default()
        };
        World::<Dim2>::new(settings).unwrap()
    };
    let (mut poor, mut rich) = (world_of(16), world_of(1024));
    let body = SoftBody::new(VoxelGrid::ball(16, 1.0).unwrap(), &[stiff]).unwrap();
    let id = poor.add_soft_body(body).unwrap();
    let mass_scale = poor[id].mass_scale();
    assert!(mass_scale > 5.0);
    let id = rich.add_soft_body(poor.remove(id).unwrap()).unwrap();
    assert_eq!(rich[id].mass_scale(), 1.0);
    let id = poor.add_soft_body(rich.remove(id).unwrap()).unwrap();
    assert_eq!(poor[id].mass_scale(), mass_scale);
}

#[test]
fn removal_keeps_other_handles_valid() {
    let mut world = world::<Dim2>();
    let (mut bodies, mut hands) = (Vec::new(), Vec::new());
    for place in 0..3u8 {
        let x = 2.0 * f32::from(place);
        let body = ball(8 + 4 * usize::from(place)).translated(Vec2::new(x, 0.0));
        bodies.push(world.add_soft_body(body).unwrap());
        let hand = RigidBody::coupled(Shape::ball(0.1)).at(Vec2::new(x + 0.5, 1.1));
        let hand = world.add_rigid_body(hand).unwrap();
        world
            .set_target_position(hand, Vec2::new(x + 0.5, 0.8))
            .unwrap();
        hands.push(hand);
    }
    step(&mut world, 10);
    let removed = world.remove(bodies[1]).unwrap();
    assert_eq!(removed.grid().size()[0], 12);
    let removed = world.remove(hands[0]).unwrap();
    assert!(removed.position.x < 1.0);
    step(&mut world, 30);
    assert_finite(&world);
    let kept = world.soft_bodies();
    let sizes = kept.map(|(_, body)| body.grid().size()[0]);
    assert_eq!(sizes.collect::<Vec<_>>(), [8, 16]);
    let with = |event: &Event<Dim2>| match *event {
        Event::ContactForce(contact) => Some((contact.pair[0].soft_body()?, contact.pair[1])),
        _ => None,
    };
    let touched: Vec<_> = world.events().iter().filter_map(with).collect();
    let hand = |n: usize| ObjectRef::RigidBody(hands[n]);
    assert!(touched.contains(&(bodies[2], hand(2))), "{touched:?}");
    assert!(!touched.contains(&(bodies[0], hand(0))), "{touched:?}");
}

/// The handle of a removed object stays invalid when another object takes its arena slot.
#[test]
fn stale_handle_is_rejected() {
    let mut world = world::<Dim2>();
    let ball = world.add_soft_body(ball(8)).unwrap();
    let hand = world
        .add_rigid_body(RigidBody::coupled(Shape::ball(0.1)).at(Vec2::new(3.0, 1.0)))
        .unwrap();
    let floor = world.rigid_bodies().map(|(id, _)| id).next().unwrap();
    assert!(
        world.set_target_position(floor, Vec2::ZERO).is_err(),
        "a fixed body has no target"
    );
    let body = world.remove(ball).unwrap();
    world.remove(hand).unwrap();
    let heir = world.add_soft_body(body).unwrap();
    world
        .add_rigid_body(RigidBody::coupled(Shape::ball(0.1)).at(Vec2::new(3.0, 1.0)))
        .unwrap();
    let error = world.soft_body(ball).unwrap_err().to_string();
    assert!(
        error.starts_with("stale soft body handle: slot 0"),
        "{error}"
    );
    assert!(world.soft_body_mut(ball).is_err() && world.remove(ball).is_err());
    let blade = Blade::segment(Vec2::ZERO, Vec2::ONE);
    assert!(world.cut(ball, &blade).is_err());
    assert!(world.set_target_position(hand, Vec2::ZERO).is_err());
    assert!(world.remove(hand).is_err());
    assert!(world.soft_body(heir).is_ok());
    step(&mut world, 5);
}

/// Three cubes sleep in a stack, and a fourth cube sleeps beside the stack. When the lowest cube is removed,
/// only the fourth cube stays asleep. The topmost cube must wake immediately: at first the middle cube falls
/// too slowly to wake it.
#[test]
fn removal_wakes_only_bodies_in_contact() {
    let mut world = world::<Dim2>();
    let damped = Material {
        damping: Damping::at(0.5, 4.0),
        ..Material::default()
    };
    let cube = |at: Vec2| {
        let grid = VoxelGrid::cube(8, 0.1).unwrap();
        let body = SoftBody::new(grid, &[damped]).unwrap();
        body.translated(at)
    };
    let places = [(0.0, 0.0), (0.0, 0.101), (0.0, 0.202), (2.0, 0.0)];
    let ids = places.map(|at| world.add_soft_body(cube(at.into())).unwrap());
    let sleeps = |world: &World<Dim2>, n: usize| world[ids[n]].piece_views()[0].asleep;
    for _ in 0..1200 {
        world.step();
        if (0..4).all(|n| sleeps(&world, n)) {
            break;
        }
    }
    assert!(
        (0..4).all(|n| sleeps(&world, n)),
        "all cubes must fall asleep"
    );
    world.remove(ids[0]).unwrap();
    assert!(!sleeps(&world, 1) && !sleeps(&world, 2) && sleeps(&world, 3));
    step(&mut world, 60);
    let low = |n: usize| world[ids[n]].piece_views()[0].low.y;
    assert!(low(1) < 0.01 && low(2) < 0.11, "the upper cubes must fall");
    assert!(sleeps(&world, 3));
}

/// Checks that a coupled plate presses a ball down, and that the floor later stops the plate.
#[test]
fn coupled_box_and_capsule_push_and_stop_at_floor() {
    for shape in [
        Shape::cuboid(Vec2::new(0.5, 0.1)),
        Shape::capsule(Vec2::new(-0.4, 0.0), Vec2::new(0.4, 0.0), 0.1),
    ] {
        let mut world = world::<Dim2>();
        let id = world.add_soft_body(ball(12)).unwrap();
        let plate = RigidBody::coupled(shape).at(Vec2::new(0.5, 1.2));
        let plate = world.add_rigid_body(plate).unwrap();
        for tick in 0..60u8 {
            let height = 1.2 - 0.015 * f32::from(tick);
            world
                .set_target_position(plate, Vec2::new(0.5, height))
                .unwrap();
            world.step();
        }
        let felt = world.rigid_body(plate).unwrap().reactions().last().unwrap();
        assert!(felt.contact.y > 5.0, "{felt:?}");
        let high = world[id].piece_views()[0].high.y;
        assert!(high < 0.9, "{shape:?}: the ball is {high} m high");
        // Moves the plate to the side of the ball, where only the floor can stop it.
        for _ in 0..60 {
            world
                .set_target_position(plate, Vec2::new(3.0, 0.4))
                .unwrap();
            world.step();
        }
        for _ in 0..60 {
            world
                .set_target_position(plate, Vec2::new(3.0, -0.4))
                .unwrap();
            world.step();
        }
        let low = world.rigid_body(plate).unwrap().position().y - 0.1;
        assert!(low.abs() < 0.01, "{shape:?}: {low} m above the floor");
        assert_finite(&world);
    }
}

#[test]
fn fixed_node_falls_when_freed() {
    let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
    let mut body = ball::<Dim2>(8);
    let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    nodes.iter().for_each(|&id| body.fix_node(id));
    let soft = world.add_soft_body(body).unwrap();
    let height = |world: &World<Dim2>| world[soft].piece_views()[0].centre.y;
    let start = height(&world);
    step(&mut world, 120);
    assert_eq!(height(&world), start);
    let body = world.soft_body_mut(soft).unwrap();
    nodes.iter().for_each(|&id| body.free_node(id));
    step(&mut world, 30);
    assert!(height(&world) < start - 1.0);
}

#[test]
fn replaced_body_has_no_contacts_with_itself() {
    let mut world = world::<Dim2>();
    let id = world.add_soft_body(bar([2, 7])).unwrap();
    world.step();
    *world.soft_body_mut(id).unwrap() = bar([2, 8]).with_velocity(Vec2::new(0.0, -4.0));
    let mut touches = 0;
    for _ in 0..30 {
        world.step();
        let is_own = |event: &&Event<Dim2>| {
            let own = ObjectRef::Piece {
                body: id,
                piece: PieceId(0),
            };
            matches!(event, Event::ContactForce(contact) if contact.pair == [own; 2])
        };
        touches += world.events().iter().filter(is_own).count();
    }
    assert!(
        touches < 10,
        "its neighbouring voxels push each other {touches} times"
    );
}

#[test]
fn small_voxels_collide_after_large_ones_are_added() {
    let mut world = about_to_meet();
    world.step();
    let grid = VoxelGrid::from_fn([2, 2, 1], 1.0, |_| 1).unwrap();
    let large = SoftBody::new(grid, &[Material::default()]).unwrap();
    world
        .add_soft_body(large.translated(Vec2::new(0.0, -9.0)))
        .unwrap();
    assert_they_meet(world);
}
