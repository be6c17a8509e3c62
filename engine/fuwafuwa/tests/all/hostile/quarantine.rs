//! Quarantine: a non-finite or too fast piece is frozen at its last valid position.

use super::*;

/// A non-finite body is frozen, reset to its last finite position, and reported.
#[test]
fn non_finite_body_is_quarantined() {
    for nowhere in [f32::NAN, f32::INFINITY] {
        let mut world = world::<Dim2>();
        world
            .add_soft_body(ball(12).with_velocity(Vec2::new(nowhere, 0.0)))
            .unwrap();
        world
            .add_soft_body(
                ball(12)
                    .translated(Vec2::new(3.0, 0.0))
                    .with_velocity(Vec2::new(0.0, nowhere)),
            )
            .unwrap();
        let report = world.step();
        assert_eq!(report.quarantined, 2);
        assert_finite(&world);
        step(&mut world, 5);
        assert_finite(&world);
        let bodies = world.soft_bodies();
        let centres = bodies.map(|(_, body)| body.piece_views()[0].centre);
        let expected = [Vec3::new(0.5, 0.5, 0.0), Vec3::new(3.5, 0.5, 0.0)];
        for (centre, expected) in centres.zip(expected) {
            let apart = (centre - expected).abs();
            assert!(apart.max_element() < 0.01, "{centre:?}");
        }
    }
}

/// Regression: the quarantine restored positions by node id, although a split in the same tick had freed node
/// ids or given them to other nodes. Elements were stretched to the origin.
#[test]
fn quarantine_restores_positions_of_torn_piece() {
    let mut world = world::<Dim2>();
    let id = world
        .add_soft_body(ball(24).translated(Vec2::new(5.0, 0.0)))
        .unwrap();
    let hand = RigidBody::kinematic(Shape::ball(0.08)).at(Vec2::new(5.5, 1.1));
    let hand = world.add_rigid_body(hand).unwrap();
    let mut both = 0;
    for tick in 0..40u16 {
        let goal = Vec2::new(5.5, 1.1 - 0.03 * f32::from(tick));
        world.set_target_position(hand, goal).unwrap();
        world.step();
        let mut doomed = world.clone();
        let body = doomed.soft_body_mut(id).unwrap();
        *body = body.clone().with_velocity(Vec2::splat(f32::NAN));
        let report = doomed.step();
        both += u32::from(report.nodes_split > 0 && report.quarantined > 0);
        assert_finite(&doomed);
        let body = &doomed[id];
        for (_, element) in body.mesh().elements() {
            let places = || element.nodes.iter().map(|&node| body.node_state(node).0);
            let width = element.cell.width() as f32 / 24.0;
            for axis in 0..2 {
                let low = places().map(|at| at[axis]).fold(f32::MAX, f32::min);
                let high = places().map(|at| at[axis]).fold(f32::MIN, f32::max);
                assert!(high - low < 6.0 * width, "tick {tick}: {low} to {high}");
            }
        }
    }
    assert!(both > 3, "{both} ticks with a release and a quarantine");
}

/// A non-finite body has no contacts: a hand and a neighbour beside it are unaffected.
#[test]
fn quarantine_leaves_neighbours_unaffected() {
    let mut world = world::<Dim2>();
    for (place, x) in [0.0, 0.97].into_iter().enumerate() {
        world
            .add_soft_body(ball(16).translated(Vec2::new(x, 0.0)))
            .unwrap();
        let hand = RigidBody::coupled(Shape::ball(0.1)).at(Vec2::new(x + 0.5, 0.95));
        let motion_type = [MotionType::Kinematic, MotionType::default()][place];
        world
            .add_rigid_body(hand.with_motion_type(motion_type))
            .unwrap();
    }
    step(&mut world, 10);
    let first = world.nth_soft_body(0).unwrap();
    let body = world.soft_body_mut(first).unwrap();
    *body = body.clone().with_velocity(Vec2::splat(f32::NAN));
    assert_eq!(world.step().quarantined, 1);
    assert_finite(&world);
    let hands = world.rigid_bodies().map(|(_, body)| body);
    for hand in hands.filter(|body| body.follows_target()) {
        for reaction in hand.reactions() {
            let is_finite = reaction.contact.is_finite() && reaction.coupling.is_finite();
            assert!(is_finite, "{reaction:?}");
        }
    }
}

#[test]
fn piece_detached_from_quarantined_one_is_quarantined() {
    let mut world = world::<Dim2>();
    let id = world
        .add_soft_body(ball(12).with_velocity(Vec2::new(f32::NAN, 0.0)))
        .unwrap();
    world.step();
    let blade = Blade::segment(Vec2::new(0.5, -1.0), Vec2::new(0.5, 2.0));
    world.cut(id, &blade).unwrap();
    let views = world[id].piece_views();
    assert_eq!(views.len(), 2);
    assert!(views.iter().all(|view| view.asleep && view.quarantined));
}

#[test]
fn quarantined_body_supports_others() {
    let mut world = World::new(WorldConfig::default()).unwrap();
    world
        .add_soft_body(bar([24, 4]).with_velocity(Vec2::new(f32::INFINITY, 0.0)))
        .unwrap();
    let upper = world
        .add_soft_body(bar([6, 6]).translated(Vec2::new(0.27, 0.25)))
        .unwrap();
    step(&mut world, 30);
    let view = world[upper].piece_views()[0];
    assert!(
        view.low.y > 0.05,
        "the bar fell through the quarantined one: {view:?}"
    );
}

#[test]
fn bodies_collide_after_quarantine_of_another() {
    for nowhere in [f32::NAN, f32::INFINITY] {
        let mut world = about_to_meet();
        let lost = bar([2, 2]).translated(Vec2::new(0.0, -3.0));
        world
            .add_soft_body(lost.with_velocity(Vec2::new(nowhere, 0.0)))
            .unwrap();
        assert_eq!(world.step().quarantined, 1);
        assert_they_meet(world);
    }
}
