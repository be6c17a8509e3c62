//! Runs a tick and sends its events as messages.

use crate::convert::bevy_vector;
use crate::dimension::Dimension;
use crate::message::{
    ContactEnded, ContactForce, ContactStarted, Cut, FellAsleep, ImpactSlowed, JointBroke,
    LeftRange, NodeSplit, Overlapped, PieceDetached, Quarantined, Removed, SensorEntered,
    SensorExited, StiffBodyScaled, WokeUp,
};
use crate::world::SoftWorld;
use bevy_ecs::change_detection::ResMut;
use bevy_ecs::message::MessageWriter;
use bevy_ecs::system::SystemParam;
use fuwafuwa::{Event, ObjectRef};

/// Writers of all messages.
#[derive(SystemParam)]
pub struct Writers<'w> {
    node_split: MessageWriter<'w, NodeSplit>,
    piece_detached: MessageWriter<'w, PieceDetached>,
    contact_force: MessageWriter<'w, ContactForce>,
    fell_asleep: MessageWriter<'w, FellAsleep>,
    woke_up: MessageWriter<'w, WokeUp>,
    impact_slowed: MessageWriter<'w, ImpactSlowed>,
    stiff_body_scaled: MessageWriter<'w, StiffBodyScaled>,
    quarantined: MessageWriter<'w, Quarantined>,
    overlapped: MessageWriter<'w, Overlapped>,
    left_range: MessageWriter<'w, LeftRange>,
    contact_started: MessageWriter<'w, ContactStarted>,
    contact_ended: MessageWriter<'w, ContactEnded>,
    sensor_entered: MessageWriter<'w, SensorEntered>,
    sensor_exited: MessageWriter<'w, SensorExited>,
    joint_broke: MessageWriter<'w, JointBroke>,
    cut: MessageWriter<'w, Cut>,
    removed: MessageWriter<'w, Removed>,
}

/// Runs a tick unless the world is paused.
pub fn step<D: Dimension>(mut world: ResMut<SoftWorld<D>>, mut writers: Writers<'_>) {
    let before = world.unsent_events();
    if world.tick() {
        for event in before.iter().chain(world.engine().events()) {
            writers.send(&world, *event);
        }
        for (body, is_asleep) in world.follow_sleep() {
            if is_asleep {
                writers.fell_asleep.write(FellAsleep { body, piece: None });
            } else {
                writers.woke_up.write(WokeUp { body, piece: None });
            }
        }
    }
}

impl Writers<'_> {
    /// Sends an event as a message. Sends nothing if a body in the event has no entity; only `ContactForce` allows
    /// one such body.
    fn send<D: Dimension>(&mut self, world: &SoftWorld<D>, event: Event<D>) -> Option<()> {
        let of_body = |body| world.entity_of_soft_body(body);
        let of = |object: ObjectRef| match object {
            ObjectRef::Piece { body, piece } => Some((of_body(body)?, Some(piece))),
            ObjectRef::RigidBody(rigid) => Some((world.entity_of_rigid_body(rigid)?, None)),
        };
        let both = |[first, second]: [ObjectRef; 2]| Some([of(first)?, of(second)?]);
        match event {
            Event::NodeSplit {
                body,
                point,
                energy,
            } => {
                let (body, point) = (of_body(body)?, bevy_vector(point));
                self.node_split.write(NodeSplit {
                    body,
                    point,
                    energy,
                });
            }
            Event::PieceDetached { body, piece } => {
                let body = of_body(body)?;
                self.piece_detached.write(PieceDetached { body, piece });
            }
            Event::ContactForce(contact) => {
                // If the first body of the contact has no entity, the message gives the second one as `body`.
                let [first, second] = contact.pair.map(of);
                let normal = bevy_vector(contact.normal);
                let ((body, piece), other, normal) = match first {
                    Some(first) => (first, second, normal),
                    None => (second?, None, -normal),
                };
                self.contact_force.write(ContactForce {
                    body,
                    piece,
                    other: other.map(|(other, _)| other),
                    other_piece: other.and_then(|(_, piece)| piece),
                    point: bevy_vector(contact.point),
                    normal,
                    impulse: contact.impulse,
                });
            }
            Event::ContactStarted(contact) => {
                let [(first, own), (second, other)] = both(contact.pair)?;
                self.contact_started.write(ContactStarted {
                    pair: [first, second],
                    pieces: [own, other],
                    point: bevy_vector(contact.point),
                    normal: bevy_vector(contact.normal),
                    speed: contact.speed,
                });
            }
            Event::ContactEnded { pair } => {
                let [(first, own), (second, other)] = both(pair)?;
                let (pair, pieces) = ([first, second], [own, other]);
                self.contact_ended.write(ContactEnded { pair, pieces });
            }
            Event::SensorEntered { sensor, object } => {
                let (sensor, (entity, piece)) = (world.entity_of_rigid_body(sensor)?, of(object)?);
                self.sensor_entered.write(SensorEntered {
                    sensor,
                    entity,
                    piece,
                });
            }
            Event::SensorExited { sensor, object } => {
                let (sensor, (entity, piece)) = (world.entity_of_rigid_body(sensor)?, of(object)?);
                self.sensor_exited.write(SensorExited {
                    sensor,
                    entity,
                    piece,
                });
            }
            Event::Cut {
                knife,
                body,
                point,
                area,
                work,
            } => {
                let (body, point) = (of_body(body)?, bevy_vector(point));
                self.cut.write(Cut {
                    knife,
                    body,
                    point,
                    area,
                    work,
                });
            }
            Event::JointBroke { joint } => {
                self.joint_broke.write(JointBroke { joint });
            }
            Event::FellAsleep { body, piece } => {
                let (body, piece) = (of_body(body)?, Some(piece));
                self.fell_asleep.write(FellAsleep { body, piece });
            }
            Event::WokeUp { body, piece } => {
                let (body, piece) = (of_body(body)?, Some(piece));
                self.woke_up.write(WokeUp { body, piece });
            }
            Event::PieceRemoved { body, piece } => {
                let (body, piece) = (of_body(body)?, Some(piece));
                self.removed.write(Removed { body, piece });
            }
            Event::SoftBodyRemoved { body } => {
                let body = of_body(body)?;
                self.removed.write(Removed { body, piece: None });
            }
            Event::RigidBodyRemoved { body } => {
                let body = world.entity_of_rigid_body(body)?;
                self.removed.write(Removed { body, piece: None });
            }
            Event::ImpactSlowed { body, piece, share } => {
                let body = of_body(body)?;
                self.impact_slowed
                    .write(ImpactSlowed { body, piece, share });
            }
            Event::Overlapped { pair, depth } => {
                let [(first, own), (second, other)] = both(pair)?;
                self.overlapped.write(Overlapped {
                    pair: [first, second],
                    pieces: [own, other],
                    depth,
                });
            }
            Event::LeftRange { object } => {
                let (body, piece) = of(object)?;
                self.left_range.write(LeftRange { body, piece });
            }
            Event::StiffBodyScaled {
                body,
                mass_scale,
                stiffness_scale,
            } => {
                let body = of_body(body)?;
                self.stiff_body_scaled.write(StiffBodyScaled {
                    body,
                    mass_scale,
                    stiffness_scale,
                });
            }
            Event::Quarantined { body, piece } => {
                let body = of_body(body)?;
                self.quarantined.write(Quarantined { body, piece });
            }
            // Ignores kinds of events that later versions of the engine add.
            _ => {}
        }
        Some(())
    }
}
