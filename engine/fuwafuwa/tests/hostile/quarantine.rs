//! Quarantine: a non-finite or too fast piece is stopped at its last valid position.

use super::*;
use fuwafuwa::Vector;

/// A non-finite body is stopped, returned to its last finite position, and reported.
#[test]
fn non_finite_body_is_quarantined() {
    for nowhere in [f32::NAN, f32::INFINITY] {
        let mut world = world::<Dim2>();
        world.add_soft_body(ball(12).translated(Vector::new(nowhere, 0.0, 0.0)));
        world.add_soft_body(
            ball(12)
                .translated(Vector::new(3.0, 0.0, 0.0))
                .with_velocity(Vector::new(0.0, nowhere, 0.0)),
        );
        let report = world.step();
        assert_eq!(report.quarantined, 2);
        assert_finite(&world);
        step(&mut world, 5);
        assert_finite(&world);
        let centres = world
            .soft_bodies()
            .map(|(_, body)| body)
            .map(|body| body.piece_views()[0].centre);
        let expected = [[0.5, 0.5, 0.0], [3.5, 0.5, 0.0]];
        for (centre, expected) in centres.zip(expected) {
            let apart = (0..2).map(|axis| (centre[axis] - expected[axis]).abs());
            assert!(apart.fold(0.0, f32::max) < 0.01, "{centre:?}");
        }
    }
}

/// Regression: positions were restored by node ids that a release in the same tick had given to other nodes
/// or to none, which stretched elements to the origin.
#[test]
fn quarantine_restores_positions_of_torn_piece() {
    let mut world = world::<Dim2>();
    world.add_soft_body(ball(24).translated([5.0, 0.0, 0.0]));
    let hand = RigidBody::coupled(Shape::ball(0.08))
        .at([5.5, 1.1, 0.0])
        .with_motion_type(MotionType::Kinematic);
    let hand = world.add_rigid_body(hand).unwrap();
    let mut both = 0;
    for tick in 0..40u16 {
        world
            .set_target_position(hand, [5.5, 1.1 - 0.03 * f32::from(tick), 0.0])
            .unwrap();
        world.step();
        let mut doomed = world.clone();
        let body = doomed
            .soft_body_mut(doomed.nth_soft_body(0).unwrap())
            .unwrap();
        *body = body.clone().with_velocity(Vector::splat(f32::NAN));
        let report = doomed.step();
        both += u32::from(report.nodes_split > 0 && report.quarantined > 0);
        assert_finite(&doomed);
        let body = doomed.soft_bodies().next().unwrap().1;
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
        world.add_soft_body(ball(16).translated(Vector::new(x, 0.0, 0.0)));
        let hand = RigidBody::coupled(Shape::ball(0.1)).at(Vector::new(x + 0.5, 0.95, 0.0));
        let drive = [MotionType::Kinematic, MotionType::default()][place];
        world.add_rigid_body(hand.with_motion_type(drive)).unwrap();
    }
    step(&mut world, 10);
    let body = world
        .soft_body_mut(world.nth_soft_body(0).unwrap())
        .unwrap();
    *body = body.clone().with_velocity(Vector::splat(f32::NAN));
    assert_eq!(world.step().quarantined, 1);
    assert_finite(&world);
    let forces = world
        .target_followers()
        .flat_map(|(_, hand)| hand.reactions());
    for reaction in forces {
        let is_finite = reaction.contact.is_finite() && reaction.coupling.is_finite();
        assert!(is_finite, "{reaction:?}");
    }
}

#[test]
fn piece_detached_from_quarantined_one_is_quarantined() {
    let mut world = world::<Dim2>();
    let id = world.add_soft_body(ball(12).with_velocity([f32::NAN, 0.0, 0.0]));
    world.step();
    world
        .cut(id, &Blade::segment([0.5, -1.0], [0.5, 2.0]))
        .unwrap();
    let views = world[id].piece_views();
    assert_eq!(views.len(), 2);
    assert!(views.iter().all(|view| view.asleep && view.quarantined));
}

#[test]
fn quarantined_body_supports_others() {
    let mut world = World::new(WorldConfig::default()).unwrap();
    world.add_soft_body(bar([24, 4]).translated(Vector::new(f32::INFINITY, 0.0, 0.0)));
    world.add_soft_body(bar([6, 6]).translated(Vector::new(0.27, 0.25, 0.0)));
    step(&mut world, 30);
    let view = &world[world.nth_soft_body(1).unwrap()].piece_views()[0];
    assert!(
        view.low[1] > 0.05,
        "the bar fell through the quarantined one: {view:?}"
    );
}

#[test]
fn bodies_collide_after_quarantine_of_another() {
    for nowhere in [f32::NAN, f32::INFINITY] {
        let mut world = about_to_meet();
        world.add_soft_body(bar([2, 2]).translated(Vector::new(nowhere, -3.0, 0.0)));
        assert_eq!(world.step().quarantined, 1);
        assert_they_meet(world);
    }
}
