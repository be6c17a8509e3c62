//! Determinism: the app and the engine give the same hash.

use super::{app, at, run, world};
use bevy_fuwafuwa::convert::engine_vector;
use bevy_fuwafuwa::fuwafuwa::{RigidBody, SoftBody as Body, Vec2, World, WorldConfig};
use bevy_fuwafuwa::prelude::*;
use bevy_math::Vec3;

/// Number of voxels across each ball, and its x and y [m].
const BALLS: [(usize, f32, f32); 3] = [(16, 0.0, 0.6), (12, 0.7, 1.6), (8, -0.4, 2.6)];
const TICKS: usize = 90;

fn hand_at(tick: usize) -> Vec3 {
    Vec3::new(0.2, 3.0 - 0.03 * tick as f32, 0.0)
}

fn hash_of_app() -> u64 {
    let mut app = app::<Dim2>();
    app.world_mut().spawn(RigidBody2d::floor());
    // An extra component puts one entity into another archetype. This must not change the order in which
    // bodies enter.
    for (n, (across, x, y)) in BALLS.into_iter().enumerate() {
        let mut ball = app
            .world_mut()
            .spawn((SoftBody2d::ball(across, 1.0), at(x, y)));
        if n == 1 {
            ball.insert(Velocity::default());
        }
    }
    let hand = (RigidBody2d::kinematic_ball(0.15), at(0.2, 3.0));
    let hand = app.world_mut().spawn(hand).id();
    for tick in 0..TICKS {
        let to = hand_at(tick);
        app.world_mut().entity_mut(hand).insert(at(to.x, to.y));
        app.update();
    }
    world::<Dim2>(&app).engine().hash()
}

#[test]
fn app_has_the_hash_of_the_engine() -> Result<(), Box<dyn std::error::Error>> {
    let mut world = World::<Dim2>::new(WorldConfig::default())?;
    let floor = Shape::half_space(Vec2::Y, Vec2::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor).with_friction(0.5))?;
    for (across, x, y) in BALLS {
        let body = Body::new(VoxelGrid::ball(across, 1.0)?, &[SoftMaterial::default()])?;
        world
            .add_soft_body(
                body.translated(Vec2::splat(-0.5))
                    .translated(Vec2::new(x, y)),
            )
            .unwrap();
    }
    let hand = RigidBody::kinematic(Shape::ball(0.15)).at(engine_vector(hand_at(0)));
    let hand = world.add_rigid_body(hand)?;
    let mut released = 0;
    for tick in 0..TICKS {
        world.set_target_position(hand, engine_vector(hand_at(tick)))?;
        released += world.step().nodes_split;
    }
    assert!(
        released > 0,
        "no node was split, so the comparison proves nothing"
    );
    assert_eq!(hash_of_app(), world.hash());
    Ok(())
}

#[test]
fn writeback_does_not_change_the_hash() {
    let mut app = app::<Dim2>();
    let ball = (SoftBody2d::ball(16, 1.0), at(0.0, 2.0), Velocity::default());
    let ball = app.world_mut().spawn(ball).id();
    app.world_mut().spawn(RigidBody2d::floor());
    run(&mut app, 20);
    // Inserting a component again with the same value must not change the simulation.
    let same = super::transform(&app, ball);
    app.world_mut().entity_mut(ball).insert(same);
    run(&mut app, 20);
    assert_eq!(hash_of_falling(), world::<Dim2>(&app).engine().hash());
}

fn hash_of_falling() -> u64 {
    let mut app = app::<Dim2>();
    app.world_mut()
        .spawn((SoftBody2d::ball(16, 1.0), at(0.0, 2.0)));
    app.world_mut().spawn(RigidBody2d::floor());
    run(&mut app, 40);
    world::<Dim2>(&app).engine().hash()
}
