//! Kinematic and coupled rigid bodies: soft bodies at rest on them, targets, knives.

use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Error, Event, Knife, Material, MotionType, RigidBody, Shape,
    SoftBody, Vec2, VoxelGrid, World, WorldConfig,
};

/// Checks that a soft ball falls asleep on a kinematic table at rest, and wakes when the table rises.
fn check_rest<D: Dim>() {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let table = Shape::cuboid(D::Vector::splat(1.0)).translated(D::Vector::Y * -1.0);
    let table = world.add_rigid_body(RigidBody::kinematic(table)).unwrap();
    let ball = VoxelGrid::<D>::ball(12, 0.5).unwrap();
    let ball = SoftBody::new(ball, &[Material::default()]).unwrap();
    let ball = ball.translated(D::Vector::Y * 0.01);
    let ball = world.add_soft_body(ball).unwrap();
    let is_asleep = |world: &World<D>| world[ball].piece_views()[0].asleep;
    let has_ended = |world: &World<D>| {
        let mut events = world.events().iter();
        events.any(|event| matches!(event, Event::ContactEnded { .. }))
    };
    let (mut slept, mut ended) = (false, false);
    for _ in 0..900 {
        world.step();
        slept |= is_asleep(&world);
        ended |= slept && has_ended(&world);
    }
    assert!(is_asleep(&world) && !ended);
    assert_eq!(world.contacts_of(ball).unwrap().count(), 1);
    for tick in 1..60 {
        let height = D::Vector::Y * (0.005 * tick as f32);
        world.set_target_position(table, height).unwrap();
        world.step();
    }
    assert!(!is_asleep(&world));
    assert!(world[ball].centre_of_mass()[1] > 0.4);
}

#[test]
fn soft_body_sleeps_on_still_kinematic_body_and_keeps_its_contact() {
    check_rest::<Dim2>();
    check_rest::<Dim3>();
}

#[test]
fn set_motion_type_keeps_target_if_only_a_parameter_changes() {
    let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
    let hand = world.add_rigid_body(RigidBody::coupled(Shape::ball(0.1)));
    let hand = hand.unwrap();
    world.set_target_position(hand, Vec2::X).unwrap();
    let stiffer = MotionType::Coupled {
        mass: 2.0,
        stiffness: 6000.0,
        damping: 0.9,
        max_force: 1000.0,
    };
    world.set_motion_type(hand, stiffer).unwrap();
    assert_eq!(world.rigid_body(hand).unwrap().target_position(), Vec2::X);
    world.set_motion_type(hand, MotionType::Kinematic).unwrap();
    assert_eq!(
        world.rigid_body(hand).unwrap().target_position(),
        Vec2::ZERO
    );
}

#[test]
fn holder_of_knife_stays_kinematic_or_coupled() {
    let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
    let holder = world.add_rigid_body(RigidBody::coupled(Shape::ball(0.1)));
    let holder = holder.unwrap();
    let knife = Knife::new(holder, [Vec2::ZERO; 2], Vec2::NEG_Y);
    let knife = world.add_knife(knife).unwrap();
    assert!(world.set_motion_type(holder, MotionType::Kinematic).is_ok());
    let refused = world.set_motion_type(holder, MotionType::Fixed);
    assert!(matches!(
        refused,
        Err(Error::InvalidParameter { field, .. }) if field == "motion_type"
    ));
    world.remove(knife).unwrap();
    assert!(world.set_motion_type(holder, MotionType::Fixed).is_ok());
}
