//! Entering and leaving the world, pausing, queries, and removals.

use super::{app, at, messages, run, transform, world};
use bevy_app::{App, Update};
use bevy_ecs::entity::Entity;
use bevy_ecs::resource::Resource;
use bevy_ecs::schedule::IntoScheduleConfigs;
use bevy_ecs::system::ResMut;
use bevy_fuwafuwa::component::SoftBodyId;
use bevy_fuwafuwa::fuwafuwa::{Blade, Knife, PieceSize, QueryFilter, RigidBody, Vec2};
use bevy_fuwafuwa::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::Mesh2d;

fn ball(app: &mut App, height: f32) -> Entity {
    let ball = (SoftBody2d::ball(8, 1.0), at(0.0, height));
    app.world_mut().spawn(ball).id()
}

#[test]
fn body_leaves_the_world_when_despawned_or_its_component_is_removed() {
    let mut app = app::<Dim2>();
    let floor = app.world_mut().spawn(RigidBody2d::floor()).id();
    let [low, high, top] = [1.0, 3.0, 5.0].map(|height| ball(&mut app, height));
    app.update();
    let id = world::<Dim2>(&app)
        .soft_body_of(high)
        .expect("the body has entered");
    assert_eq!(world::<Dim2>(&app).entity_of_soft_body(id), Some(high));
    assert_eq!(app.world().get::<SoftBodyId>(high), Some(&SoftBodyId(id)));

    app.world_mut().despawn(low);
    app.world_mut().despawn(floor);
    app.world_mut().entity_mut(high).remove::<SoftBody2d>();
    app.update();
    let own = world::<Dim2>(&app);
    assert_eq!(
        (
            own.engine().soft_bodies().count(),
            own.engine().rigid_bodies().count()
        ),
        (1, 0)
    );
    assert_eq!(
        (own.soft_body_of(low), own.soft_body_of(high)),
        (None, None)
    );
    assert_eq!(own.entity_of_soft_body(id), None);
    assert!(own.soft_body_of(top).is_some());
    let entity = app.world().entity(high);
    assert!(!entity.contains::<SoftBodyId>() && !entity.contains::<Mesh2d>());

    // A body despawned before the tick never enters the world. A body component inserted again replaces the
    // body.
    let brief = ball(&mut app, 9.0);
    app.world_mut().despawn(brief);
    app.world_mut()
        .entity_mut(top)
        .insert(SoftBody2d::ball(10, 1.0));
    app.update();
    let own = world::<Dim2>(&app);
    assert_eq!(own.engine().soft_bodies().count(), 1);
    let size = own
        .soft_body_of(top)
        .map(|id| own.engine()[id].grid().size());
    assert_eq!(size, Some([10, 10, 1]));
}

#[test]
fn paused_world_runs_only_requested_ticks() {
    let mut app = app::<Dim2>();
    let ball = ball(&mut app, 1.0);
    run(&mut app, 5);
    app.world_mut().resource_mut::<SoftWorld<Dim2>>().pause();
    let before = transform(&app, ball);
    run(&mut app, 5);
    assert_eq!(
        (transform(&app, ball), world::<Dim2>(&app).engine().ticks()),
        (before, 5)
    );
    app.world_mut()
        .resource_mut::<SoftWorld<Dim2>>()
        .step_once();
    run(&mut app, 5);
    assert_eq!(world::<Dim2>(&app).engine().ticks(), 6);
    app.world_mut().resource_mut::<SoftWorld<Dim2>>().resume();
    run(&mut app, 5);
    assert_eq!(world::<Dim2>(&app).engine().ticks(), 11);
    assert!(transform(&app, ball).translation.y < before.translation.y);
}

#[derive(Resource, Default)]
struct Seen(Vec<Option<(Entity, f32)>>);

#[test]
fn queries_return_entities() {
    let mut app = app::<Dim2>();
    app.init_resource::<Seen>();
    let look = |queries: SoftQueries<Dim2>, mut seen: ResMut<Seen>| {
        let down = queries.ray_cast(
            Vec3::new(0.0, 10.0, 0.0),
            Vec3::NEG_Y,
            100.0,
            QueryFilter::default(),
        );
        seen.0
            .push(down.and_then(|hit| Some((hit.entity?, hit.distance))));
        let beside = queries.closest_point(Vec3::new(4.0, 0.5, 0.0), 1.0, QueryFilter::default());
        seen.0
            .push(beside.and_then(|hit| Some((hit.entity?, hit.distance))));
        let probe = Shape::ball(0.1).translated(Vec2::new(0.0, 3.0));
        let inside = queries.overlaps(&probe, QueryFilter::default()).unwrap();
        seen.0.push(inside.first().map(|&entity| (entity, 0.0)));
        let invalid = queries.overlaps(&Shape::ball(-0.1), QueryFilter::default());
        assert!(invalid.is_err());
    };
    app.add_systems(Update, look.after(FuwafuwaSystems::Writeback));
    let floor = app.world_mut().spawn(RigidBody2d::floor()).id();
    let ball = ball(&mut app, 3.0);
    app.update();
    let Some([Some(down), Some(beside), Some(inside)]) =
        app.world().resource::<Seen>().0.first_chunk::<3>()
    else {
        panic!("expected three hits");
    };
    assert!(down.0 == ball && (6.5..6.7).contains(&down.1), "{down:?}");
    assert!(
        beside.0 == floor && (beside.1 - 0.5).abs() < 1e-5,
        "{beside:?}"
    );
    assert_eq!(inside.0, ball);
}

#[test]
fn knife_cuts_and_engine_removals_send_messages() {
    let mut app = app::<Dim2>();
    app.world_mut().spawn(RigidBody2d::floor());
    let cube = SoftBody2d::cube(16, 1.0);
    let cube = app.world_mut().spawn((cube, at(0.0, 0.5))).id();
    app.update();
    let mut world = app.world_mut().resource_mut::<SoftWorld<Dim2>>();
    let engine = world.engine_mut();
    // The hand is a sensor and passes through the body, so only the edge of its knife touches the body.
    let hand = RigidBody::coupled(Shape::ball(0.05))
        .at(Vec2::new(0.03, 1.2))
        .with_sensor(true);
    let hand = engine.add_rigid_body(hand).unwrap();
    let knife = Knife::new(hand, [Vec2::ZERO; 2], Vec2::NEG_Y);
    let knife = engine.add_knife(knife).unwrap();
    let mut cuts: Vec<Cut> = Vec::new();
    for tick in 0..120 {
        let mut world = app.world_mut().resource_mut::<SoftWorld<Dim2>>();
        let target = Vec2::new(0.03, 1.2 - 0.01 * tick as f32);
        let engine = world.engine_mut();
        engine.set_target_position(hand, target).unwrap();
        app.update();
        cuts.extend(messages::<Cut>(&app));
    }
    assert!(
        cuts.iter()
            .all(|cut| (cut.knife, cut.body) == (knife, cube))
    );
    assert!(cuts.iter().map(|cut| cut.area).sum::<f32>() > 0.8);

    // Events of direct engine calls between two ticks are sent in the next tick.
    let mut world = app.world_mut().resource_mut::<SoftWorld<Dim2>>();
    let body = world.soft_body_of(cube).unwrap();
    let across = Blade::segment(Vec2::new(-2.0, 0.3), Vec2::new(2.0, 0.3));
    world.engine_mut().cut(body, &across).unwrap();
    app.update();
    assert!(!messages::<PieceDetached>(&app).is_empty());

    let mut world = app.world_mut().resource_mut::<SoftWorld<Dim2>>();
    let all = PieceSize::Mass(1e9);
    world.engine_mut().remove_small_pieces(all).unwrap();
    app.update();
    let removed: Vec<Removed> = messages(&app);
    let gone = Removed {
        body: cube,
        piece: None,
    };
    assert!(removed.len() > 1 && removed.contains(&gone), "{removed:?}");
    app.update();
    assert_eq!(
        messages::<Removed>(&app),
        [],
        "the message was sent more than once"
    );
}
