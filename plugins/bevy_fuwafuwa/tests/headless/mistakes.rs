//! Invalid requests are reported and leave everything else unchanged.

use super::{app, at, messages, run, transform, world};
use bevy_app::{App, Update};
use bevy_asset::Handle;
use bevy_ecs::bundle::Bundle;
use bevy_ecs::entity::Entity;
use bevy_fuwafuwa::asset::Voxels;
use bevy_fuwafuwa::component::WithoutMesh;
use bevy_fuwafuwa::fuwafuwa::{Error, Vec2, WorldConfig, glam};
use bevy_fuwafuwa::prelude::*;
use bevy_fuwafuwa::{Problem, Rejected};
use bevy_math::{Quat, Vec3};
use bevy_transform::components::Transform;

/// Spawns an invalid bundle beside a valid ball and returns the reported problem.
fn rejected(bad: impl Bundle) -> String {
    let mut app = app::<Dim2>();
    let ball = app
        .world_mut()
        .spawn((SoftBody2d::ball(8, 1.0), at(0.0, 2.0)))
        .id();
    let bad = app.world_mut().spawn(bad).id();
    app.update();
    let Some(Rejected(problem)) = app.world().get::<Rejected>(bad).cloned() else {
        panic!("the invalid body was accepted");
    };
    let rejections = messages::<Rejection>(&app);
    let texts = |own: &Rejection| (own.entity, own.problem.to_string());
    assert_eq!(
        rejections.iter().map(texts).collect::<Vec<_>>(),
        [(Some(bad), problem.to_string())]
    );
    run(&mut app, 10);
    assert!(
        transform(&app, ball).translation.y < 2.0,
        "the ball does not fall"
    );
    let own = world::<Dim2>(&app);
    assert_eq!(
        (
            own.engine().soft_bodies().count(),
            own.engine().rigid_bodies().count()
        ),
        (1, 0)
    );
    problem.to_string()
}

#[test]
fn invalid_body_is_rejected_with_a_reason() {
    let ball = || SoftBody2d::ball(8, 1.0);
    let check = |problem: String, expect: &str| assert!(problem.contains(expect), "{problem}");
    check(rejected(SoftBody2d::ball(0, 1.0)), "empty");
    check(rejected(SoftBody2d::ball(8, f32::NAN)), "voxel");
    check(
        rejected(SoftBody2d::cube(100_000, 1.0)),
        "at most 1024 voxels",
    );
    let material = SoftMaterial {
        density: f32::NAN,
        ..SoftMaterial::default()
    };
    check(rejected((ball(), SoftMaterials::from(material))), "density");
    check(rejected((ball(), SoftMaterials(Vec::new()))), "material 1");
    check(rejected((ball(), at(f32::NAN, 0.0))), "finite translation");
    check(
        rejected((ball(), Transform::from_scale(Vec3::new(1.0, 2.0, 1.0)))),
        "same factor",
    );
    check(
        rejected((ball(), Transform::from_scale(Vec3::ZERO))),
        "positive",
    );
    check(
        rejected((
            ball(),
            Transform::from_rotation(Quat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
        )),
        "non-zero rotation",
    );
    let fast = Velocity {
        linear: Vec3::splat(f32::INFINITY),
        ..Velocity::default()
    };
    check(rejected((ball(), fast)), "linear");
    check(rejected((ball(), GravityScale(1e9))), "gravity_scale");
    let nowhere = Handle::<Voxels<Dim2>>::default();
    check(rejected(SoftBody2d::asset(nowhere)), "asset is not loading");
    check(rejected(RigidBody2d::kinematic_ball(-1.0)), "radius");
    let free = |mass| RigidBody2d::dynamic(Shape::cuboid(Vec2::ONE), mass);
    check(rejected(free(f32::NAN)), "mass");
    check(rejected(free(0.0)), "mass");
    check(
        rejected(RigidBody2d::floor().with_motion_type(MotionType::Dynamic { mass: 1.0 })),
        "shape",
    );
    check(rejected(free(1.0).with_restitution(2.0)), "restitution");
    check(rejected(free(1.0).with_friction(-1.0)), "friction");
    check(
        rejected((free(1.0), Transform::from_scale(Vec3::NAN))),
        "same factor",
    );
    check(rejected((free(1.0), at(f32::NAN, 0.0))), "finite");
    check(rejected((free(1.0), at(1e9, 0.0))), "position");
    check(rejected((free(1.0), fast)), "linear");
    let slow = Velocity {
        linear: Vec3::X,
        ..Velocity::default()
    };
    check(
        rejected((RigidBody2d::kinematic_ball(1.0), slow)),
        "dynamic",
    );
}

#[test]
fn rigid_body_is_unchanged_after_an_invalid_request() {
    let mut app = app::<Dim2>();
    app.insert_resource(SoftWorldConfig::<Dim2>(WorldConfig {
        gravity: Vec2::ZERO,
        ..WorldConfig::default()
    }));
    let free = RigidBody2d::dynamic(Shape::ball(0.2), 1.0);
    let free = (free, at(1.0, 2.0), Velocity::default());
    let free = app.world_mut().spawn(free).id();
    let wall = RigidBody2d::fixed(Shape::ball(0.2));
    let wall = app.world_mut().spawn((wall, at(9.0, 0.0))).id();
    app.update();
    let before = transform(&app, free);
    let check = |app: &mut App, entity: Entity, bad, expect: &str| {
        match bad {
            Bad::Place(place) => app.world_mut().entity_mut(entity).insert(place),
            Bad::Velocity(velocity) => app.world_mut().entity_mut(entity).insert(velocity),
            Bad::Push(push) => app.world_mut().entity_mut(entity).insert(push),
        };
        app.update();
        let rejections = messages::<Rejection>(app);
        let texts: Vec<String> = rejections
            .iter()
            .map(|own| own.problem.to_string())
            .collect();
        assert!(texts.len() == 1 && texts[0].contains(expect), "{texts:?}");
        assert_eq!(transform(app, free), before);
        app.update();
        assert_eq!(messages::<Rejection>(app), [], "reported more than once");
    };
    check(&mut app, free, Bad::Place(at(f32::NAN, 0.0)), "finite");
    check(&mut app, free, Bad::Place(at(1e9, 0.0)), "position");
    let large = before.with_scale(Vec3::splat(2.0));
    check(&mut app, free, Bad::Place(large), "keep its scale");
    let still = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    let still = before.with_rotation(still);
    check(&mut app, free, Bad::Place(still), "non-zero rotation");
    let velocity = Velocity {
        linear: Vec3::ZERO,
        angular: Vec3::NAN,
    };
    check(&mut app, free, Bad::Velocity(velocity), "angular");
    let push = ExternalImpulse {
        impulse: Vec3::X,
        point: Vec3::INFINITY,
        radius: 0.0,
    };
    check(&mut app, free, Bad::Push(push), "point");
    let push = ExternalImpulse {
        point: Vec3::ZERO,
        ..push
    };
    check(&mut app, wall, Bad::Push(push), "dynamic");
    let there = transform(&app, wall);
    check(&mut app, wall, Bad::Place(at(0.0, f32::NAN)), "finite");
    assert_eq!(transform(&app, wall), there);
}

/// Invalid value of a component of a body.
enum Bad {
    Place(Transform),
    Velocity(Velocity),
    Push(ExternalImpulse),
}

#[test]
fn soft_body_is_unchanged_after_an_invalid_request() {
    let mut app = app::<Dim3>();
    app.insert_resource(SoftWorldConfig::<Dim3>(WorldConfig {
        gravity: glam::Vec3::ZERO,
        ..WorldConfig::default()
    }));
    let ball = (SoftBody3d::ball(8, 1.0), at(0.0, 2.0), Velocity::default());
    let ball = app.world_mut().spawn(ball).id();
    app.update();
    let before = transform(&app, ball);
    let hash_without = world::<Dim3>(&app).engine().hash();
    let check = |app: &mut App, expect: &str| {
        app.update();
        let rejections = messages::<Rejection>(app);
        let texts: Vec<String> = rejections
            .iter()
            .map(|own| own.problem.to_string())
            .collect();
        assert!(texts.len() == 1 && texts[0].contains(expect), "{texts:?}");
        assert_eq!(transform(app, ball), before);
    };
    let bad = Transform::from_xyz(f32::INFINITY, 0.0, 0.0);
    app.world_mut().entity_mut(ball).insert(bad);
    check(&mut app, "finite translation");
    app.world_mut()
        .entity_mut(ball)
        .insert(before.with_scale(Vec3::splat(2.0)));
    check(&mut app, "keep its scale");
    let fast = Velocity {
        linear: Vec3::splat(f32::NAN),
        ..Velocity::default()
    };
    app.world_mut().entity_mut(ball).insert(fast);
    check(&mut app, "linear");
    let push = ExternalImpulse {
        impulse: Vec3::NAN,
        point: Vec3::ZERO,
        radius: 1.0,
    };
    app.world_mut().entity_mut(ball).insert(push);
    check(&mut app, "impulse");
    app.world_mut()
        .entity_mut(ball)
        .insert(GravityScale(f32::NAN));
    check(&mut app, "gravity_scale");
    app.world_mut()
        .resource_mut::<SoftWorldConfig<Dim3>>()
        .0
        .drag = -1.0;
    check(&mut app, "drag");
    app.update();
    assert_eq!(
        messages::<Rejection>(&app),
        [],
        "each problem is reported once"
    );
    assert_ne!(
        world::<Dim3>(&app).engine().hash(),
        hash_without,
        "the simulation continues"
    );
}

#[test]
fn entity_with_soft_and_rigid_body_is_rejected() {
    let mut app = app::<Dim2>();
    let both = (SoftBody2d::ball(8, 1.0), RigidBody2d::floor());
    let both = app.world_mut().spawn(both).id();
    app.update();
    let own = world::<Dim2>(&app);
    assert!(own.soft_body_of(both).is_some() && own.rigid_body_of(both).is_none());
    let twice = app.world().get::<Rejected>(both);
    assert_eq!(twice, Some(&Rejected(Problem::DuplicateBody)));
}

#[test]
fn rejected_body_enters_after_correction() {
    let mut app = app::<Dim2>();
    let ball = app.world_mut().spawn(SoftBody2d::ball(0, 1.0)).id();
    app.update();
    let expect = Rejected(Problem::Engine(Error::EmptyGrid));
    assert_eq!(app.world().get::<Rejected>(ball), Some(&expect));
    app.world_mut()
        .entity_mut(ball)
        .insert(SoftBody2d::ball(4, 1.0));
    app.update();
    assert_eq!(app.world().get::<Rejected>(ball), None);
    assert!(world::<Dim2>(&app).soft_body_of(ball).is_some());
}

#[test]
fn bodies_have_no_mesh_without_assets_or_with_without_mesh() {
    let mut app = App::new();
    app.add_plugins(FuwafuwaPlugin2d::default().in_schedule(Update));
    let ball = app.world_mut().spawn(SoftBody2d::ball(8, 1.0)).id();
    app.update();
    assert!(world::<Dim2>(&app).soft_body_of(ball).is_some());
    assert!(!app.world().entity(ball).contains::<bevy_mesh::Mesh2d>());

    let mut app = super::app::<Dim2>();
    let ball = app
        .world_mut()
        .spawn((SoftBody2d::ball(8, 1.0), WithoutMesh))
        .id();
    app.update();
    assert!(world::<Dim2>(&app).soft_body_of(ball).is_some());
    assert!(!app.world().entity(ball).contains::<bevy_mesh::Mesh2d>());
}
