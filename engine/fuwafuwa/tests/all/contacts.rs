//! Contact events, sensors and layers.

use crate::vectors::vector;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Contact, Dim, Dim2, Dim3, DimVector, Event, Layers, Material, ObjectRef, PieceId, RigidBody,
    RigidBodyHandle, Rotation, Shape, SoftBody, SoftBodyHandle, Vec3, Velocity, VoxelGrid, World,
    WorldConfig,
};
use std::collections::BTreeSet;

fn floored<D: Dim>() -> (World<D>, RigidBodyHandle) {
    let mut world = World::new(WorldConfig::default()).unwrap();
    let floor =
        RigidBody::fixed(Shape::half_space(D::Vector::Y, D::Vector::ZERO)).with_friction(0.5);
    let floor = world.add_rigid_body(floor).unwrap();
    (world, floor)
}

/// Adds a ball 1 m wide that does not tear, with its lowest point at a height [m].
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
    world
        .add_soft_body(body.translated(vector(0.0, height, 0.0)))
        .unwrap()
}

fn crate_of<D: Dim>(height: f32, half: f32) -> RigidBody<D> {
    let shape = Shape::cuboid(D::Vector::splat(half));
    RigidBody::dynamic(shape.translated(vector(0.5, height, 0.5)), 1.0)
}

fn of_body(party: ObjectRef, body: SoftBodyHandle) -> bool {
    matches!(party, ObjectRef::Piece { body: found, .. } if found == body)
}

/// Checks the contact events of a ball that falls for 0.45 s, bounces, comes to rest, and is lifted. Every
/// contact that begins must end. The first contact begins at the speed of the fall.
fn contacts_begin_and_end<D: Dim>() {
    let (mut world, floor) = floored::<D>();
    let id = ball(&mut world, 1.0);
    let (mut began, mut ended) = (Vec::new(), 0);
    for tick in 0..500 {
        if tick == 450 {
            // It does not come back before the end.
            world.translate(id, vector(0.0, 5.0, 0.0)).unwrap();
        }
        world.step();
        for event in world.events() {
            match *event {
                Event::ContactStarted(contact) => {
                    let pair = contact.pair;
                    assert!(of_body(pair[0], id) && pair[1] == ObjectRef::RigidBody(floor));
                    assert_eq!(contact.normal, D::Vector::Y);
                    assert!(contact.point[1] < 0.1);
                    assert!(world.events().contains(&Event::ContactForce(contact)));
                    began.push((tick, contact.speed));
                }
                Event::ContactEnded { pair } => {
                    assert!(of_body(pair[0], id));
                    ended += 1;
                }
                _ => {}
            }
        }
    }
    let (first, speed) = began[0];
    // A free fall by h = 1 m ends at the speed √(2 g h) = 4.43 m/s. The skin, half a voxel higher, falls a little
    // further and swings after the first touch.
    assert!(
        (26..30).contains(&first) && (speed - 4.43).abs() < 0.5,
        "{first} {speed}"
    );
    assert_eq!(
        began.len(),
        ended,
        "each contact of the bouncing ball must end"
    );
    assert!(ended < 30, "{ended}");
    let asleep = world[id].piece_views();
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
        let ended = |event: &&Event<Dim3>| matches!(event, Event::ContactEnded { .. });
        ends += world.events().iter().filter(ended).count();
    }
    assert!(world.rigid_body(id).unwrap().is_asleep());
    assert_eq!(ends, 0);
    world.remove(id).unwrap();
    world.step();
    let told = world.events().iter().any(
        |event| matches!(event, Event::ContactEnded { pair } if pair.contains(&ObjectRef::RigidBody(id))),
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
                Event::ContactForce(contact) => {
                    // The floor has the lower handle and comes first in the pair, so the normal points
                    // towards the floor.
                    assert_eq!(contact.pair, [floor, id].map(ObjectRef::RigidBody));
                    assert_eq!(contact.normal, Vec3::NEG_Y);
                    impulse += contact.impulse;
                }
                Event::ContactStarted(contact) => speed = speed.max(contact.speed),
                _ => {}
            }
        }
    }
    // The box of 1 kg came to rest, so the contact impulses cancel one second of gravity: 9.81 N s.
    assert!((impulse - 9.81).abs() < 0.3, "{impulse}");
    assert!((speed - 4.43).abs() < 0.3, "{speed}");
}

/// Checks that a body that falls through a sensor enters and exits the sensor without contact.
fn sensors_tell<D: Dim>() {
    let (mut world, _) = floored::<D>();
    let gate = Shape::cuboid(vector(4.0, 0.2, 2.0)).translated(vector(0.5, 2.5, 0.5));
    let gate = RigidBody::fixed(gate).with_friction(0.5).with_sensor(true);
    let gate = world.add_rigid_body(gate).unwrap();
    let soft = ball(&mut world, 3.0);
    let free = world.add_rigid_body(crate_of(5.5, 0.2)).unwrap();
    // Moves the rigid box to one side, so that it does not bounce off the soft ball.
    world
        .set_pose(free, vector(3.0, 5.5, 0.5), Rotation::NONE)
        .unwrap();
    let (mut entered, mut left) = (Vec::new(), Vec::new());
    for _ in 0..60 {
        world.step();
        for event in world.events() {
            match *event {
                Event::SensorEntered { sensor, object } if sensor == gate => entered.push(object),
                Event::SensorExited { sensor, object } if sensor == gate => left.push(object),
                Event::ContactStarted(contact) => {
                    assert!(!contact.pair.contains(&ObjectRef::RigidBody(gate)))
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

/// Checks sensors of all shapes with pieces that fly through them. The sensor events must agree with a test
/// of every node against every sensor.
fn sensors_agree_with_test_of_every_node<D: Dim>() {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let mut seed = 7u32;
    let mut random = |low: f32, high: f32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        low + (high - low) * (seed >> 8) as f32 / (1u32 << 24) as f32
    };
    let mut point =
        || -> D::Vector { vector(random(0.0, 4.0), random(0.0, 4.0), random(0.0, 1.0)) };
    let plane = Shape::half_space(vector(0.6, 0.8, 0.0), vector(1.0, 0.5, 0.0));
    let mut sensors = vec![plane];
    for _ in 0..3 {
        let (radius, half) = (0.3, vector(0.5, 0.1, 0.4));
        let centre = point();
        sensors.push(Shape::Ball { centre, radius });
        let centre = point();
        sensors.push(Shape::Box { centre, half });
        let (from, to) = (point(), point());
        sensors.push(Shape::Capsule { from, to, radius });
        let rotation = Rotation::in_plane(0.7);
        let centre = point();
        sensors.push(Shape::OrientedBox {
            centre,
            half,
            rotation,
        });
    }
    for shape in sensors {
        let sensor = RigidBody::fixed(shape).with_friction(0.5);
        world.add_rigid_body(sensor.with_sensor(true)).unwrap();
    }
    for k in 0..4 {
        let grid = VoxelGrid::<D>::ball(6, 1.0).unwrap();
        let mut body = SoftBody::new(grid, &[Material::default()]).unwrap();
        if k % 2 == 0 {
            body.crumble();
        }
        let body = world.add_soft_body(body.translated(point())).unwrap();
        let velocity = vector::<D::Vector>(2.0, 4.0, 0.5) - point();
        world
            .add_velocity(body, Velocity::linear(velocity))
            .unwrap();
        let layers = Layers {
            memberships: if k == 3 { 2 } else { 1 },
            filters: if k == 3 { 2 } else { u32::MAX },
        };
        world.set_layers(body, layers).unwrap();
    }
    let (mut inside, mut changes) = (BTreeSet::new(), 0);
    for tick in 0..60 {
        world.step();
        for event in world.events() {
            match *event {
                Event::SensorEntered { sensor, object } => assert!(inside.insert((sensor, object))),
                Event::SensorExited { sensor, object } => assert!(inside.remove(&(sensor, object))),
                _ => continue,
            }
            changes += 1;
        }
        let mut expected = BTreeSet::new();
        for (sensor, rigid) in world.rigid_bodies() {
            for (body, soft) in world.soft_bodies() {
                for (node, _) in soft.mesh().nodes() {
                    let is_inside = rigid.shape().distance(soft.node_state(node).0).0 < 0.0;
                    if is_inside && soft.layers().meet(rigid.layers()) {
                        let piece = soft.pieces().of_node(node);
                        expected.insert((sensor, ObjectRef::Piece { body, piece }));
                    }
                }
            }
        }
        assert_eq!(inside, expected, "tick {tick}");
    }
    assert!(changes > 100, "{changes}");
}

#[test]
fn sensor_events_agree_with_test_of_every_node() {
    sensors_agree_with_test_of_every_node::<Dim2>();
    sensors_agree_with_test_of_every_node::<Dim3>();
}

/// Checks that two balls, one above the other, collide only if their layers allow it. The floor supports both
/// balls in either case.
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
        let [low, high] = [low, high].map(|id| world[id].centre_of_mass()[1]);
        assert_eq!(high - low > 0.5, meets, "{low} {high}");
        assert!(low > 0.25 && high > 0.25, "{filters}: {low} {high}");
        // The box collides with the balls, even if the layers of the balls keep them from colliding with each
        // other.
        assert!(world.rigid_body(crate_id).unwrap().position()[1] > 0.8 || meets);
    }
}

#[test]
fn layers_filter_contacts() {
    layers_part::<Dim2>();
    layers_part::<Dim3>();
    let (mut world, floor) = floored::<Dim3>();
    let id = world.add_rigid_body(crate_of(0.5, 0.2)).unwrap();
    let [own, other] = [floor, id].map(|id| world.rigid_body(id).unwrap().layers());
    let (memberships, filters) = (2, 1);
    world
        .set_layers(floor, Layers { memberships, ..own })
        .unwrap();
    world.set_layers(id, Layers { filters, ..other }).unwrap();
    for _ in 0..60 {
        world.step();
    }
    assert!(world.rigid_body(id).unwrap().position()[1] < -3.0);
}

#[test]
fn user_data_persists_until_removal() {
    let (mut world, floor) = floored::<Dim2>();
    let id = ball(&mut world, 0.0);
    world.set_user_data(id, 7).unwrap();
    world.set_user_data(floor, 9).unwrap();
    world.step();
    assert_eq!(world[id].user_data(), 7);
    assert_eq!(world.rigid_body(floor).unwrap().user_data(), 9);
    world.remove(id).unwrap();
    assert!(
        world.set_user_data(id, 1).is_err() && world.set_layers(id, Layers::default()).is_err()
    );
}

/// Returns the objects in contact with `object`.
fn partners<D: Dim>(world: &World<D>, object: ObjectRef) -> Vec<ObjectRef> {
    let contacts = world.contacts_of(object).unwrap();
    contacts
        .map(|contact| contact.other(object).unwrap())
        .collect()
}

/// Checks the contacts of a soft ball that lies on the floor and carries a box. Another ball lies beside it.
fn contacts_of_stack<D: Dim>() {
    let (mut world, floor) = floored::<D>();
    let body = ball(&mut world, 0.0);
    let beside = ball(&mut world, 0.0);
    world.translate(beside, vector(3.0, 0.0, 0.0)).unwrap();
    let load = world.add_rigid_body(crate_of(1.3, 0.25)).unwrap();
    assert_eq!(world.contacts_of(body).unwrap().count(), 0, "no tick yet");
    let piece = PieceId(0);
    let [lower, lone] = [body, beside].map(|body| ObjectRef::Piece { body, piece });
    let [floor, crate_ref] = [floor, load].map(ObjectRef::RigidBody);
    let mut ticks = 0;
    while partners(&world, lower).len() < 2 || partners(&world, lone).is_empty() {
        world.step();
        ticks += 1;
        assert!(
            ticks < 300,
            "the ball must touch the floor and the box at the same time"
        );
    }
    assert_eq!(partners(&world, lower), [floor, crate_ref]);
    assert_eq!(partners(&world, crate_ref), [lower]);
    assert_eq!(partners(&world, floor), [lower, lone]);
    for contact in world.contacts_of(body).unwrap() {
        // The floor pushes the ball up, and the box pushes it down.
        let up = if contact.pair[1] == floor { 1.0 } else { -1.0 };
        assert_eq!(contact.pair[0], lower);
        assert!(up * contact.normal[1] > 0.9, "{contact:?}");
        assert!(contact.impulse > 0.0 && contact.speed >= 0.0);
        let forces = world.events().contains(&Event::ContactForce(*contact));
        assert!(forces, "{contact:?}");
    }
    // Contacts with a removed object are no longer listed.
    world.remove(load).unwrap();
    assert_eq!(partners(&world, lower), [floor]);
    assert!(world.contacts_of(load).is_err());
    let missing = ObjectRef::Piece {
        body,
        piece: PieceId(7),
    };
    assert!(world.contacts_of(missing).is_err());
    world.remove(body).unwrap();
    assert!(world.contacts_of(body).is_err() && world.contacts_of(lower).is_err());
    assert_eq!(partners(&world, floor), [lone]);
    world.step();
    assert!(!partners(&world, floor).contains(&lower));
}

#[test]
fn contacts_of_returns_partners_until_they_are_removed() {
    contacts_of_stack::<Dim2>();
    contacts_of_stack::<Dim3>();
}

#[test]
fn sleeping_contact_is_listed_and_survives_a_clone() {
    let (mut world, floor) = floored::<Dim3>();
    let id = world.add_rigid_body(crate_of(0.3, 0.25)).unwrap();
    for _ in 0..240 {
        world.step();
    }
    assert!(world.rigid_body(id).unwrap().is_asleep());
    let contact = *world.contacts_of(id).unwrap().next().unwrap();
    assert_eq!(contact.other(id), Some(ObjectRef::RigidBody(floor)));
    // The contact keeps the impulse of the last tick before the box fell asleep, when the floor carried its
    // mass of 1 kg.
    assert!(
        (contact.impulse / (9.81 / 60.0) - 1.0).abs() < 0.1,
        "{contact:?}"
    );
    world.step();
    let is_force = |event: &Event<Dim3>| matches!(event, Event::ContactForce(_));
    assert!(
        !world.events().iter().any(is_force),
        "a sleeper sends no force"
    );
    let contacts = |world: &World<Dim3>| world.contacts_of(id).unwrap().copied().collect();
    let known: Vec<Contact<Dim3>> = contacts(&world);
    assert_eq!(known, [contact]);
    assert_eq!(known, contacts(&world.clone()));
}

/// Checks that two pieces that press on each other send one contact event per tick. The piece with the lower
/// handle must come first.
fn pieces_press<D: Dim>() {
    let (mut world, floor) = floored::<D>();
    let bodies = [0.0, 1.02].map(|height| ball(&mut world, height));
    let [low, high] = bodies.map(|body| ObjectRef::Piece {
        body,
        piece: PieceId(0),
    });
    let mut impulse = 0.0;
    for _ in 0..30 {
        world.step();
        let forces = world.events().iter().filter_map(|event| match event {
            Event::ContactForce(contact) if contact.pair == [low, high] => Some(contact),
            Event::ContactForce(contact) => {
                assert!(
                    contact.pair[1] == ObjectRef::RigidBody(floor),
                    "{contact:?}"
                );
                None
            }
            _ => None,
        });
        let forces: Vec<&Contact<D>> = forces.collect();
        assert!(forces.len() <= 1, "{forces:?}");
        for contact in forces {
            // The normal points from the upper ball to the lower one, which is the first object of the pair.
            assert!(contact.normal[1] < -0.5, "{contact:?}");
            assert!(partners(&world, low).contains(&high));
            assert!(partners(&world, high).contains(&low));
            impulse += contact.impulse;
        }
    }
    assert!(impulse > 0.0);
}

#[test]
fn contact_force_of_two_pieces_is_one_event_with_normal_towards_the_first() {
    pieces_press::<Dim2>();
    pieces_press::<Dim3>();
}
