//! Messages of contacts and sensors, with their entities.

use super::{app, at, messages};
use bevy_ecs::entity::Entity;
use bevy_fuwafuwa::prelude::*;

fn block() -> Shape<Dim3> {
    Shape::cuboid([0.2; 3].into())
}

#[test]
fn falling_box_passes_a_sensor_and_starts_one_contact_with_the_floor() {
    let mut app = app::<Dim3>();
    let floor = app.world_mut().spawn(RigidBody3d::floor()).id();
    let gate = RigidBody3d::fixed(block()).with_sensor(true);
    let gate = app.world_mut().spawn((gate, at(0.0, 1.2))).id();
    let free = RigidBody3d::dynamic(block(), 1.0);
    let free = app.world_mut().spawn((free, at(0.0, 2.2))).id();
    let (mut started, mut ended) = (Vec::new(), 0);
    let (mut entered, mut exited): (Vec<Entity>, Vec<Entity>) = (Vec::new(), Vec::new());
    let mut touches = 0;
    for _ in 0..120 {
        app.update();
        started.extend(messages::<ContactStarted>(&app));
        ended += messages::<ContactEnded>(&app).len();
        let into_gate = messages::<SensorEntered>(&app).into_iter();
        let into_gate = into_gate.filter(|message| message.sensor == gate);
        entered.extend(into_gate.map(|message| message.entity));
        let out_of_gate = messages::<SensorExited>(&app).into_iter();
        let out_of_gate = out_of_gate.filter(|message| message.sensor == gate);
        exited.extend(out_of_gate.map(|message| message.entity));
        touches += messages::<ContactForce>(&app)
            .iter()
            .filter(|contact| (contact.body, contact.other) == (floor, Some(free)))
            .count();
    }
    assert_eq!((entered, exited), (vec![free], vec![free]));
    assert_eq!((started.len(), ended), (1, 0), "{started:?}");
    // The pair lists bodies in the order in which they entered the world, so the floor comes first.
    assert_eq!(started[0].pair, [floor, free]);
    assert!(
        (5.5..6.6).contains(&started[0].speed),
        "speed after a fall of 2 m: {started:?}"
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
