//! Contact events, sensors and layers.

use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Dim, Dim2, Dim3, Event, Layers, Material, ObjectRef, RigidBody, RigidBodyHandle, Rotation,
    Shape, SoftBody, SoftBodyHandle, Vector, VoxelGrid, World, WorldConfig,
};

const UP: Vector = Vector::Y;

fn floored<D: Dim>() -> (World<D>, RigidBodyHandle) {
    let mut world = World::new(WorldConfig::default()).unwrap();
    let floor = RigidBody::fixed(Shape::half_space(UP, Vector::ZERO), 0.5);
    let floor = world.add_rigid_body(floor).unwrap();
    (world, floor)
}

/// A ball 1 m wide that does not tear, with its low corner at a height [m].
fn ball<D: Dim>(world: &mut World<D>, height: f32) -> SoftBodyHandle {
    let rubber = Material {
        elasticity: Elasticity {
            young: 5e4,
            poisson: 0.3,
        },
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        ..Material::default()
    };
    let grid = VoxelGrid::<D>::ball(10, 1.0).unwrap();
    let body = SoftBody::new(grid, &[rubber]).unwrap();
    world.add_soft_body(body.translated(Vector::new(0.0, height, 0.0)))
}

fn crate_of(height: f32, half: f32) -> RigidBody {
    let shape = Shape::Box {
        centre: Vector::new(0.5, height, 0.5),
        half: Vector::splat(half),
    };
    RigidBody::dynamic(shape, 1.0)
}

fn of_body(party: ObjectRef, body: SoftBodyHandle) -> bool {
    matches!(party, ObjectRef::Piece { body: found, .. } if found == body)
}

/// A ball falls for 0.45 s, rests, and is lifted again: each contact begins once, the first with the speed of
/// the fall, and ends once.
fn contacts_begin_and_end<D: Dim>() {
    let (mut world, floor) = floored::<D>();
    let id = ball(&mut world, 1.0);
    let (mut began, mut ended) = (Vec::new(), 0);
    for tick in 0..500 {
        if tick == 450 {
            world
                .translate_body(id, Vector::new(0.0, 2.0, 0.0))
                .unwrap();
        }
        world.step();
        for event in world.events() {
            match *event {
                Event::ContactStarted {
                    both,
                    normal,
                    speed,
                    at,
                } => {
                    assert!(of_body(both[0], id) && both[1] == ObjectRef::RigidBody(floor));
                    assert_eq!(normal, UP);
                    assert!(at[1] < 0.1);
                    began.push((tick, speed));
                }
                Event::ContactEnded { both } => {
                    assert!(of_body(both[0], id));
                    ended += 1;
                }
                _ => {}
            }
        }
    }
    let (first, speed) = began[0];
    // √(2 g h), h = 1 m
    assert!(
        (26..30).contains(&first) && (speed - 4.43).abs() < 0.3,
        "{first} {speed}"
    );
    assert_eq!(
        began.len(),
        ended,
        "each contact of the bouncing ball must end"
    );
    assert!(ended < 30, "{ended}");
    let asleep = world.soft_bodies()[id].piece_views();
    assert_eq!(asleep.len(), 1);
}

#[test]
fn contact_events_report_begin_with_speed_and_end() {
    contacts_begin_and_end::<Dim2>();
    contacts_begin_and_end::<Dim3>();
}

#[test]
fn sleeping_body_keeps_contact_until_removed() {
    let (mut world, _) = floored::<Dim3>();
    let id = world.add_rigid_body(crate_of(0.3, 0.25)).unwrap();
    let mut ends = 0;
    for _ in 0..240 {
        world.step();
        let ended = |event: &&Event| matches!(event, Event::ContactEnded { .. });
        ends += world.events().iter().filter(ended).count();
    }
    assert!(world.rigid_bodies()[id].is_asleep());
    assert_eq!(ends, 0);
    world.remove_rigid_body(id).unwrap();
    world.step();
    let told = world.events().iter().any(
        |event| matches!(event, Event::ContactEnded { both } if both.contains(&ObjectRef::RigidBody(id))),
    );
    assert!(told, "{:?}", world.events());
}

#[test]
fn rigid_contact_event_reports_impulse_and_speed() {
    let (mut world, floor) = floored::<Dim3>();
    let id = world.add_rigid_body(crate_of(1.25, 0.25)).unwrap();
    let (mut impulse, mut speed) = (0.0, 0.0f32);
    for _ in 0..60 {
        world.step();
        for event in world.events() {
            match *event {
                Event::RigidPressed {
                    rigid,
                    with,
                    normal,
                    impulse: felt,
                    ..
                } => {
                    assert_eq!((rigid, with, normal), (id, floor, UP));
                    impulse += felt;
                }
                Event::ContactStarted { speed: found, .. } => speed = speed.max(found),
                _ => {}
            }
        }
    }
    // The box came to rest, so the impulse equals that of gravity in one second.
    assert!((impulse - 9.81).abs() < 0.3, "{impulse}");
    assert!((speed - 4.43).abs() < 0.3, "{speed}");
}

/// A body that falls through a sensor enters and exits it without contact.
fn sensors_tell<D: Dim>() {
    let (mut world, _) = floored::<D>();
    let gate = Shape::Box {
        centre: Vector::new(0.5, 2.5, 0.5),
        half: Vector::new(4.0, 0.2, 2.0),
    };
    let mut gate = RigidBody::fixed(gate, 0.5);
    gate.is_sensor = true;
    let gate = world.add_rigid_body(gate).unwrap();
    let soft = ball(&mut world, 3.0);
    let free = world.add_rigid_body(crate_of(5.5, 0.2)).unwrap();
    // Beside the ball, so that it does not bounce back.
    world
        .set_rigid_body_pose(free, Vector::new(3.0, 5.5, 0.5), Rotation::NONE)
        .unwrap();
    let (mut entered, mut left) = (Vec::new(), Vec::new());
    for _ in 0..60 {
        world.step();
        for event in world.events() {
            match *event {
                Event::SensorEntered { sensor, who } if sensor == gate => entered.push(who),
                Event::SensorExited { sensor, who } if sensor == gate => left.push(who),
                Event::ContactStarted { both, .. } => {
                    assert!(!both.contains(&ObjectRef::RigidBody(gate)))
                }
                _ => {}
            }
        }
    }
    assert_eq!(entered.len(), 2, "{entered:?}");
    assert!(of_body(entered[0], soft) && entered[1] == ObjectRef::RigidBody(free));
    assert_eq!(left, entered);
}

#[test]
fn sensor_reports_entered_and_exited_bodies() {
    sensors_tell::<Dim2>();
    sensors_tell::<Dim3>();
}

/// Two balls, one above the other, collide or not depending on their layers; the floor supports both.
fn layers_part<D: Dim>() {
    for (filters, meets) in [(u32::MAX, true), (1, false)] {
        let (mut world, _) = floored::<D>();
        let low = ball(&mut world, 0.0);
        let high = ball(&mut world, 1.2);
        let ghost = Layers {
            memberships: 2,
            filters,
        };
        world.set_layers(low, ghost).unwrap();
        world.set_layers(high, ghost).unwrap();
        let crate_id = world.add_rigid_body(crate_of(2.6, 0.2)).unwrap();
        for _ in 0..90 {
            world.step();
        }
        let [low, high] = [low, high].map(|id| world.soft_bodies()[id].centre_of_mass()[1]);
        assert_eq!(high - low > 0.5, meets, "{low} {high}");
        assert!(low > 0.3 && high > 0.3);
        // The box collides with the balls in both cases.
        assert!(world.rigid_bodies()[crate_id].position()[1] > 0.8 || meets);
    }
}

#[test]
fn layers_filter_contacts() {
    layers_part::<Dim2>();
    layers_part::<Dim3>();
    let (mut world, floor) = floored::<Dim3>();
    let id = world.add_rigid_body(crate_of(0.5, 0.2)).unwrap();
    world
        .change_rigid(floor, |floor| floor.layers.memberships = 2)
        .unwrap();
    world.change_rigid(id, |it| it.layers.filters = 1).unwrap();
    for _ in 0..60 {
        world.step();
    }
    assert!(world.rigid_bodies()[id].position()[1] < -3.0);
}

#[test]
fn user_data_persists_until_removal() {
    let (mut world, floor) = floored::<Dim2>();
    let id = ball(&mut world, 0.0);
    world.set_user_data(id, 7).unwrap();
    world
        .change_rigid(floor, |floor| floor.user_data = 9)
        .unwrap();
    world.step();
    assert_eq!(world.soft_bodies()[id].user_data(), 7);
    assert_eq!(world.rigid_bodies()[floor].user_data, 9);
    world.remove_soft_body(id).unwrap();
    assert!(
        world.set_user_data(id, 1).is_err() && world.set_layers(id, Layers::default()).is_err()
    );
}
