//! Motion written to entities, and motion requested by entities.

use super::{app, at, body, messages, run, transform, world};
use bevy_fuwafuwa::component::RigidBodyId;
use bevy_fuwafuwa::convert::{bevy_vector, engine_vector};
use bevy_fuwafuwa::fuwafuwa::{Damping, WorldConfig};
use bevy_fuwafuwa::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::components::Transform;

#[test]
fn ball_falls_touches_the_floor_and_sleeps() {
    let mut app = app::<Dim2>();
    let floor = app.world_mut().spawn(RigidBody2d::floor()).id();
    // With the default damping, an elastic ball bounces for longer than ten seconds; with the default strength, it
    // tears.
    let material = SoftMaterials::from(SoftMaterial {
        damping: Damping::at(0.3, 4.0),
        strength: f32::INFINITY,
        ..SoftMaterial::default()
    });
    let ball = (
        SoftBody2d::ball(16, 1.0),
        material,
        at(3.0, 1.0),
        Velocity::default(),
    );
    let ball = app.world_mut().spawn(ball).id();
    run(&mut app, 10);
    let speed = app.world().get::<Velocity>(ball).map(|own| own.linear.y);
    assert!(
        speed.is_some_and(|speed| (-1.7..-1.5).contains(&speed)),
        "{speed:?}"
    );

    let (mut has_touched, mut has_slept) = (false, false);
    for _ in 0..600 {
        app.update();
        let touches = messages::<ContactForce>(&app);
        has_touched |= touches
            .iter()
            .any(|touch| (touch.body, touch.other) == (ball, Some(floor)));
        has_slept |= messages::<FellAsleep>(&app)
            .iter()
            .any(|own| own.body == ball);
    }
    assert!(has_touched, "no contact");
    assert!(has_slept, "no sleep");
    let place = transform(&app, ball).translation;
    assert!(
        (place.x - 3.0).abs() < 0.02 && (0.3..0.45).contains(&place.y),
        "{place}"
    );
}

#[test]
fn transform_places_a_new_body_and_then_follows_it() {
    let mut app = app::<Dim3>();
    app.insert_resource(SoftWorldConfig::<Dim3>(WorldConfig {
        gravity: engine_vector(Vec3::ZERO),
        ..WorldConfig::default()
    }));
    let grid = VoxelGrid::<Dim3>::from_fn([8, 4, 4], 0.25, |_| 1);
    let pose = Transform {
        translation: Vec3::new(1.0, 2.0, 3.0),
        rotation: Quat::from_rotation_z(1.0),
        scale: Vec3::splat(0.5),
    };
    let spin = Velocity {
        linear: Vec3::X,
        angular: Vec3::new(0.0, 0.0, 0.6),
    };
    let stick = app
        .world_mut()
        .spawn((SoftBody3d::from(grid), pose, spin))
        .id();
    app.update();
    // With scale 0.5, the stick is 1 m long and 0.5 m wide and thick, so its volume is 0.25 m³.
    let volume = body::<Dim3>(&app, stick).total_mass() / 100.0;
    assert!((volume - 0.25).abs() < 1e-4, "{volume}");
    run(&mut app, 59);
    let now = transform(&app, stick);
    assert!(
        now.translation.distance(Vec3::new(2.0, 2.0, 3.0)) < 0.02,
        "{now:?}"
    );
    let expect = Quat::from_rotation_z(1.6);
    assert!(now.rotation.angle_between(expect) < 0.05, "{now:?}");
    assert_eq!(now.scale, pose.scale);
    let velocity = app
        .world()
        .get::<Velocity>(stick)
        .copied()
        .unwrap_or_default();
    assert!(velocity.linear.distance(Vec3::X) < 0.01, "{velocity:?}");
    assert!(
        velocity.angular.distance(spin.angular) < 0.05,
        "{velocity:?}"
    );

    // Writing the transform moves and rotates the body at once.
    let there = Transform {
        translation: Vec3::new(-5.0, 1.0, 0.0),
        rotation: Quat::from_rotation_x(0.5),
        ..now
    };
    app.world_mut()
        .entity_mut(stick)
        .insert((there, Velocity::default()));
    run(&mut app, 30);
    let now = transform(&app, stick);
    assert!(
        now.translation.distance(there.translation) < 0.02,
        "{now:?}"
    );
    assert!(now.rotation.angle_between(there.rotation) < 0.05, "{now:?}");
    let centre = bevy_vector(body::<Dim3>(&app, stick).centre_of_mass());
    assert!(centre.distance(there.translation) < 0.02, "{centre}");
}

#[test]
fn impulse_is_applied_once_and_negative_gravity_scale_lifts() {
    let mut app = app::<Dim2>();
    let push = ExternalImpulse {
        impulse: Vec3::new(20.0, 0.0, 0.0),
        point: Vec3::ZERO,
        radius: 2.0,
    };
    let soft = (
        SoftBody2d::ball(16, 1.0),
        push,
        GravityScale(-0.5),
        Velocity::default(),
    );
    let ball = app.world_mut().spawn(soft).id();
    run(&mut app, 10);
    assert!(app.world().get::<ExternalImpulse>(ball).is_none());
    let mass = body::<Dim2>(&app, ball).total_mass() as f32;
    let velocity = app.world().get::<Velocity>(ball).map(|own| own.linear);
    let expect = Vec3::new(20.0 / mass, 0.5 * 9.81 / 6.0, 0.0);
    assert!(
        velocity.is_some_and(|own| own.distance(expect) < 0.02),
        "{velocity:?} {expect}"
    );
}

#[test]
fn coupled_body_reaches_its_target_and_fixed_body_its_transform() {
    let mut app = app::<Dim3>();
    let hand = app
        .world_mut()
        .spawn((RigidBody3d::kinematic_ball(0.1), at(0.0, 5.0)))
        .id();
    let coupled = RigidBody3d::kinematic_ball(0.1).with_motion_type(MotionType::default());
    let coupled = (
        coupled,
        at(3.0, 5.0),
        TargetPosition(Vec3::new(3.0, 6.0, 0.0)),
    );
    let coupled = app.world_mut().spawn(coupled).id();
    let table = RigidBody3d::fixed(Shape::cuboid([0.5; 3].into()));
    let table = app.world_mut().spawn((table, at(9.0, 0.0))).id();
    app.update();
    app.world_mut().entity_mut(hand).insert(at(0.5, 5.0));
    app.world_mut().entity_mut(table).insert(at(9.0, 2.0));
    run(&mut app, 60);
    let place = |entity| {
        let world = world::<Dim3>(&app);
        let id = world.rigid_body_of(entity).expect("the body has entered");
        assert_eq!(
            app.world().get::<RigidBodyId>(entity),
            Some(&RigidBodyId(id))
        );
        assert_eq!(world.entity_of_rigid_body(id), Some(entity));
        let [low, high] = world.engine().rigid_body(id).unwrap().shape().bounds();
        0.5 * bevy_vector(low + high)
    };
    assert!(place(hand).distance(Vec3::new(0.5, 5.0, 0.0)) < 1e-4);
    assert!(place(coupled).distance(Vec3::new(3.0, 6.0, 0.0)) < 1e-2);
    assert!(
        transform(&app, coupled)
            .translation
            .distance(place(coupled))
            < 1e-6
    );
    assert_eq!(place(table), Vec3::new(9.0, 2.0, 0.0));
    assert_eq!(world::<Dim3>(&app).engine().rigid_bodies().count(), 3);
}
