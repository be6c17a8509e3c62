//! Messages of contacts and sensors, with their entities.

use super::{app, at, messages};
use bevy_ecs::entity::Entity;
use bevy_fuwafuwa::prelude::*;

fn block() -> Shape {
    Shape::Box {
        centre: [0.0; 3],
        half: [0.2; 3],
    }
}

#[test]
fn falling_box_passes_a_sensor_and_begins_one_contact_with_the_floor() {
    let mut app = app::<Dim3>();
    let floor = app.world_mut().spawn(RigidBody3d::floor()).id();
    let gate = RigidBody3d::fixed(block()).as_sensor();
    let gate = app.world_mut().spawn((gate, at(0.0, 1.2))).id();
    let free = RigidBody3d::dynamic(block(), 1.0);
    let free = app.world_mut().spawn((free, at(0.0, 2.2))).id();
    let (mut began, mut ended) = (Vec::new(), 0);
    let (mut entered, mut left): (Vec<Entity>, Vec<Entity>) = (Vec::new(), Vec::new());
    let mut touches = 0;
    for _ in 0..120 {
        app.update();
        began.extend(messages::<ContactBegan>(&app));
        ended += messages::<ContactEnded>(&app).len();
        let through = messages::<SensorEntered>(&app).into_iter();
        entered.extend(
            through
                .filter(|told| told.sensor == gate)
                .map(|told| told.who),
        );
        let out = messages::<SensorExited>(&app).into_iter();
        left.extend(out.filter(|told| told.sensor == gate).map(|told| told.who));
        let pressed = messages::<Touched>(&app);
        touches += pressed
            .iter()
            .filter(|told| told.body == floor && told.with == Some(free))
            .count();
    }
    assert_eq!((entered, left), (vec![free], vec![free]));
    assert_eq!((began.len(), ended), (1, 0), "{began:?}");
    // Bodies are in the order in which they entered: the floor was first.
    assert_eq!(began[0].both, [floor, free]);
    assert!(
        (5.5..6.6).contains(&began[0].speed),
        "speed after a fall of 2 m: {began:?}"
    );
    assert!(touches > 10, "{touches}");
}

#[test]
fn box_falls_through_the_floor_when_layers_exclude_it() {
    let mut app = app::<Dim3>();
    app.world_mut().spawn(RigidBody3d::floor());
    let ghost = Layers {
        memberships: 2,
        filters: 2,
    };
    let free = RigidBody3d::dynamic(block(), 1.0).with_layers(ghost);
    let free = app.world_mut().spawn((free, at(0.0, 0.5))).id();
    for _ in 0..60 {
        app.update();
    }
    assert!(super::transform(&app, free).translation.y < -2.0);
}
