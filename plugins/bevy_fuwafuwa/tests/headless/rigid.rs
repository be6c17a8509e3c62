//! Dynamic rigid bodies and rotation.

use super::{app, at, messages, run, transform, world};
use bevy_app::App;
use bevy_ecs::bundle::Bundle;
use bevy_ecs::entity::Entity;
use bevy_fuwafuwa::Dimension;
use bevy_fuwafuwa::component::RigidBodyId;
use bevy_fuwafuwa::convert::{
    bevy_rotation, bevy_vector, bevy_velocity, engine_rotation, engine_vector,
};
use bevy_fuwafuwa::fuwafuwa::{
    DimVector, RigidBody as EngineBody, RigidBodyRef, SoftBody as Body, World, WorldConfig, glam,
};
use bevy_fuwafuwa::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::components::Transform;

const SIDE: f32 = 0.4;

fn block<D: Dimension>() -> Shape<D> {
    Shape::cuboid(D::Vector::splat(0.5 * SIDE))
}

fn slab<D: Dimension>() -> Shape<D> {
    Shape::cuboid(engine_vector(Vec3::new(2.0, 0.1, 2.0)))
}

/// Returns an app without gravity.
fn weightless<D: Dimension>() -> App {
    let mut app = app::<D>();
    app.insert_resource(SoftWorldConfig::<D>(WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    }));
    app
}

fn spawn(app: &mut App, bundle: impl Bundle) -> Entity {
    app.world_mut().spawn(bundle).id()
}

fn rigid<D: Dimension>(app: &App, entity: Entity) -> RigidBodyRef<'_, D> {
    let world = world::<D>(app);
    let id = world.rigid_body_of(entity).expect("the body has entered");
    assert_eq!(world.entity_of_rigid_body(id), Some(entity));
    world.engine().rigid_body(id).unwrap()
}

/// Checks that a tilted box falls and sleeps on the floor, and that its transform equals the pose in the
/// engine.
fn falls_and_sleeps<D: Dimension>() {
    let mut app = app::<D>();
    spawn(&mut app, RigidBody::<D>::floor());
    let askew = at(3.0, 1.0)
        .with_rotation(Quat::from_rotation_z(0.4))
        .with_scale(Vec3::splat(2.0));
    let askew = (
        RigidBody::<D>::dynamic(block(), 5.0),
        askew,
        Velocity::default(),
    );
    let fallen = spawn(&mut app, askew);
    let (mut sleeps, mut ticks) = (Vec::new(), 0);
    while ticks < 300 {
        run(&mut app, 1);
        ticks += 1;
        let own = rigid::<D>(&app, fallen);
        let now = transform(&app, fallen);
        assert_eq!(now.translation, bevy_vector(own.position()));
        assert_eq!(now.rotation, bevy_rotation(own.rotation()));
        assert_eq!(now.scale, Vec3::splat(2.0));
        let velocity = app.world().get::<Velocity>(fallen).copied();
        assert_eq!(velocity, Some(bevy_velocity(own.velocity())));
        sleeps.extend(messages::<FellAsleep>(&app));
    }
    assert!(rigid::<D>(&app, fallen).is_asleep());
    let (body, piece) = (fallen, None);
    assert!(sleeps.contains(&FellAsleep { body, piece }), "{sleeps:?}");
    let height = transform(&app, fallen).translation.y;
    assert!(
        (height - SIDE).abs() < 0.01,
        "the box of twice the size rests at height {height}"
    );
}

#[test]
fn box_transform_equals_the_engine_until_it_sleeps() {
    falls_and_sleeps::<Dim2>();
    falls_and_sleeps::<Dim3>();
}

#[test]
fn soft_ball_contact_names_the_entity_of_the_box() {
    let mut app = app::<Dim3>();
    spawn(&mut app, RigidBody3d::floor());
    let firm = SoftMaterials::from(SoftMaterial {
        strength: 1e6,
        ..SoftMaterial::default()
    });
    let ball = spawn(&mut app, (SoftBody3d::ball(8, 1.0), firm, at(0.0, 0.5)));
    let on_top = (RigidBody3d::dynamic(block(), 2.0), at(0.0, 1.25));
    let on_top = spawn(&mut app, on_top);
    let (mut touches, mut heights) = (0, Vec::new());
    for _ in 0..60 {
        app.update();
        heights.push(transform(&app, on_top).translation.y);
        touches += messages::<ContactForce>(&app)
            .iter()
            .filter(|contact| (contact.body, contact.other) == (ball, Some(on_top)))
            .filter(|contact| contact.impulse > 0.0)
            .count();
    }
    assert!(touches > 5, "{touches}");
    assert!(
        heights.iter().all(|height| *height > 0.5),
        "the box bounces on the ball and stays above it: {heights:?}"
    );
}

#[test]
fn fixed_body_is_rotated_by_its_transform() {
    let mut app = app::<Dim3>();
    let slope = at(0.0, 0.0).with_rotation(Quat::from_rotation_z(-0.5));
    let slope = spawn(&mut app, (RigidBody3d::fixed(slab()), slope));
    let ball = RigidBody3d::dynamic(Shape::ball(0.2), 1.0);
    let ball = spawn(&mut app, (ball, at(0.0, 0.4)));
    run(&mut app, 30);
    let down = transform(&app, ball).translation;
    assert!(
        down.x > 0.3 && down.y < 0.3,
        "the ball does not roll down: {down}"
    );
    let before = app.world().get::<RigidBodyId>(slope).copied();
    // The test rotates the slope until the ball falls past it. The slope keeps its handle in the engine.
    let upright = at(0.0, 0.0).with_rotation(Quat::from_rotation_z(1.5));
    app.world_mut().entity_mut(slope).insert(upright);
    run(&mut app, 60);
    assert_eq!(app.world().get::<RigidBodyId>(slope).copied(), before);
    let fallen = transform(&app, ball).translation;
    assert!(fallen.y < down.y - 2.0, "{fallen}");
}

#[test]
fn rotating_kinematic_table_carries_a_box() {
    let mut app = app::<Dim3>();
    let table = RigidBody3d::fixed(slab())
        .with_motion_type(MotionType::Kinematic)
        .with_friction(0.8);
    let table = spawn(&mut app, table);
    let rider = (
        RigidBody3d::dynamic(block(), 1.0),
        at(1.0, 0.1 + 0.5 * SIDE),
    );
    let rider = spawn(&mut app, rider);
    run(&mut app, 30);
    for tick in 1..=60 {
        let turned = Transform::from_rotation(Quat::from_rotation_y(0.01 * tick as f32));
        app.world_mut().entity_mut(table).insert(turned);
        app.update();
    }
    let expect = Quat::from_rotation_y(0.6);
    let own = bevy_rotation(rigid::<Dim3>(&app, table).rotation());
    assert!(own.angle_between(expect) < 1e-4, "{own}");
    let now = transform(&app, rider);
    assert!(now.rotation.angle_between(expect) < 0.05, "{now:?}");
    let place = expect * Vec3::new(1.0, 0.3, 0.0);
    assert!(now.translation.distance(place) < 0.05, "{now:?}");
}

#[test]
fn written_transform_moves_the_body_at_once() {
    let mut app = weightless::<Dim3>();
    // The middle of the box is 1 m from the origin of the entity, and the transform rotates the box about
    // that origin.
    let shape = block().translated(glam::Vec3::X);
    let spin = Velocity {
        linear: Vec3::Y,
        angular: Vec3::Z,
    };
    let thrown = (RigidBody3d::dynamic(shape, 1.0), at(0.0, 0.0), spin);
    let thrown = spawn(&mut app, thrown);
    run(&mut app, 60);
    let middle = |app: &App| bevy_vector(rigid::<Dim3>(app, thrown).position());
    assert!(middle(&app).distance(Vec3::new(1.0, 1.0, 0.0)) < 0.01);
    let now = transform(&app, thrown);
    assert!(now.rotation.angle_between(Quat::from_rotation_z(1.0)) < 0.01);
    assert!((now.translation + now.rotation * Vec3::X).distance(middle(&app)) < 1e-5);

    let there = at(-5.0, 0.0).with_rotation(Quat::from_rotation_z(std::f32::consts::FRAC_PI_2));
    app.world_mut().entity_mut(thrown).insert(there);
    app.update();
    let expect = Vec3::new(-5.0, 1.0 + 1.0 / 60.0, 0.0);
    assert!(middle(&app).distance(expect) < 1e-3, "{}", middle(&app));
    let velocity = bevy_vector(rigid::<Dim3>(&app, thrown).velocity().linear);
    assert!(velocity.distance(Vec3::Y) < 1e-3, "{velocity}");

    // Writing the transform also moves a coupled body at once. Afterwards the body is pulled back to its
    // target.
    let hand = RigidBody3d::kinematic_ball(0.1).with_motion_type(MotionType::default());
    let hand = spawn(
        &mut app,
        (hand, at(0.0, 9.0), TargetPosition(Vec3::Y * 9.0)),
    );
    run(&mut app, 5);
    app.world_mut().entity_mut(hand).insert(at(0.0, 8.0));
    app.update();
    let height = transform(&app, hand).translation.y;
    assert!((8.0..8.9).contains(&height), "{height}");
    run(&mut app, 60);
    let height = transform(&app, hand).translation.y;
    assert!((height - 9.0).abs() < 0.01, "{height}");
}

#[test]
fn plugin_keeps_z_in_2d() {
    let mut app = weightless::<Dim2>();
    let flat = (RigidBody2d::dynamic(block(), 1.0), at(0.0, 0.0));
    let flat = spawn(&mut app, flat);
    run(&mut app, 60);
    assert!(rigid::<Dim2>(&app, flat).is_asleep());
    let behind = Transform::from_xyz(0.0, 0.0, -3.0);
    app.world_mut().entity_mut(flat).insert(behind);
    app.update();
    assert!(
        rigid::<Dim2>(&app, flat).is_asleep(),
        "a change of z woke it"
    );
    let moved = behind.with_rotation(Quat::from_rotation_z(0.2));
    app.world_mut().entity_mut(flat).insert(moved);
    run(&mut app, 2);
    let now = transform(&app, flat);
    assert_eq!(now.translation, behind.translation);
    assert!(now.rotation.angle_between(moved.rotation) < 1e-6);
    assert!(!rigid::<Dim2>(&app, flat).is_asleep());
}

#[test]
fn sleeping_box_accepts_impulse_and_velocity() {
    let mut app = weightless::<Dim3>();
    let resting = (
        RigidBody3d::dynamic(block(), 2.0),
        at(0.0, 0.0),
        Velocity::default(),
    );
    let resting = spawn(&mut app, resting);
    run(&mut app, 60);
    assert!(rigid::<Dim3>(&app, resting).is_asleep());
    let push = ExternalImpulse {
        impulse: Vec3::new(2.0, 0.0, 0.0),
        point: Vec3::new(0.0, 0.1, 0.0),
        radius: 0.0,
    };
    app.world_mut().entity_mut(resting).insert(push);
    app.update();
    assert!(app.world().get::<ExternalImpulse>(resting).is_none());
    let (body, piece) = (resting, None);
    assert_eq!(messages::<WokeUp>(&app), [WokeUp { body, piece }]);
    let velocity = app.world().get::<Velocity>(resting).copied();
    let Velocity { linear, angular } = velocity.unwrap_or_default();
    assert!(linear.distance(Vec3::X) < 1e-3 && angular.z < -0.5);
    let thrown = Velocity {
        linear: Vec3::NEG_Y,
        angular: Vec3::ZERO,
    };
    app.world_mut().entity_mut(resting).insert(thrown);
    app.update();
    let linear = bevy_vector(rigid::<Dim3>(&app, resting).velocity().linear);
    assert!(linear.distance(Vec3::NEG_Y) < 1e-3, "{linear}");
}

#[test]
fn box_falls_when_its_support_is_despawned() {
    let mut app = app::<Dim2>();
    let floor = spawn(&mut app, RigidBody2d::floor());
    let low = (RigidBody2d::dynamic(block(), 1.0), at(0.0, 0.5 * SIDE));
    let low = spawn(&mut app, low);
    let high = (RigidBody2d::dynamic(block(), 1.0), at(0.0, 1.5 * SIDE));
    let high = spawn(&mut app, high);
    run(&mut app, 120);
    assert!(rigid::<Dim2>(&app, high).is_asleep());
    app.world_mut().despawn(low);
    run(&mut app, 60);
    assert_eq!(world::<Dim2>(&app).rigid_body_of(low), None);
    let height = transform(&app, high).translation.y;
    assert!((height - 0.5 * SIDE).abs() < 0.01, "{height}");
    app.world_mut().entity_mut(floor).remove::<RigidBody2d>();
    run(&mut app, 30);
    assert!(transform(&app, high).translation.y < 0.0);
    assert_eq!(world::<Dim2>(&app).engine().rigid_bodies().count(), 1);
}

/// Returns the initial rotation angle of box `n` [rad].
fn askew(n: usize) -> f32 {
    0.1 * n as f32
}

fn table_at(tick: usize) -> Quat {
    Quat::from_rotation_z(0.003 * tick as f32)
}

const TICKS: usize = 120;

fn hash_of_app<D: Dimension>() -> u64 {
    let mut app = app::<D>();
    let table = RigidBody::<D>::fixed(slab()).with_motion_type(MotionType::Kinematic);
    let table = spawn(&mut app, table);
    for n in 0..4 {
        let own = RigidBody::<D>::dynamic(block(), 2.0).with_restitution(0.3);
        let turned = Quat::from_rotation_z(askew(n));
        let place = at(0.0, 0.5 + n as f32).with_rotation(turned);
        spawn(&mut app, (own, place));
    }
    let ball = (SoftBody::<D>::ball(8, 1.0), at(1.0, 0.7));
    spawn(&mut app, ball);
    for tick in 0..TICKS {
        let turned = Transform::from_rotation(table_at(tick));
        app.world_mut().entity_mut(table).insert(turned);
        app.update();
    }
    world::<D>(&app).engine().hash()
}

fn hash_of_engine<D: Dimension>() -> Result<u64, Box<dyn std::error::Error>> {
    let mut world = World::<D>::new(WorldConfig::default())?;
    let table = world.add_rigid_body(EngineBody::kinematic(slab()))?;
    for n in 0..4 {
        let own = EngineBody::dynamic(block(), 2.0)
            .at(D::Vector::Y * (0.5 + n as f32))
            .rotated(engine_rotation(Quat::from_rotation_z(askew(n))))
            .with_restitution(0.3);
        world.add_rigid_body(own)?;
    }
    let body = Body::new(VoxelGrid::ball(8, 1.0)?, &[SoftMaterial::default()])?;
    let body = body.translated(D::Vector::splat(-0.5));
    world
        .add_soft_body(body.translated(engine_vector(Vec3::new(1.0, 0.7, 0.0))))
        .unwrap();
    for tick in 0..TICKS {
        world.set_target_rotation(table, engine_rotation(table_at(tick)))?;
        world.step();
    }
    Ok(world.hash())
}

#[test]
fn dynamic_boxes_have_the_hash_of_the_engine() -> Result<(), Box<dyn std::error::Error>> {
    assert_eq!(hash_of_app::<Dim2>(), hash_of_engine::<Dim2>()?);
    assert_eq!(hash_of_app::<Dim3>(), hash_of_engine::<Dim3>()?);
    Ok(())
}
