//! Runs a tick and sends its events as messages.

use crate::dimension::Dimension;
use crate::message::{
    ContactBegan, ContactEnded, Cut, FellAsleep, JointBroke, NodeSplit, PieceDetached, Quarantined,
    Removed, SensorEntered, SensorExited, Touched, Woke,
};
use crate::world::SoftWorld;
use bevy_ecs::change_detection::ResMut;
use bevy_ecs::message::MessageWriter;
use bevy_ecs::system::SystemParam;
use bevy_math::Vec3;
use fuwafuwa::{Event, ObjectRef};

/// Writers of all messages.
#[derive(SystemParam)]
pub struct Writers<'w> {
    torn: MessageWriter<'w, NodeSplit>,
    parted: MessageWriter<'w, PieceDetached>,
    touched: MessageWriter<'w, Touched>,
    fell_asleep: MessageWriter<'w, FellAsleep>,
    woke: MessageWriter<'w, Woke>,
    quarantined: MessageWriter<'w, Quarantined>,
    contact_began: MessageWriter<'w, ContactBegan>,
    contact_ended: MessageWriter<'w, ContactEnded>,
    entered: MessageWriter<'w, SensorEntered>,
    left: MessageWriter<'w, SensorExited>,
    joint_broke: MessageWriter<'w, JointBroke>,
    cut: MessageWriter<'w, Cut>,
    removed: MessageWriter<'w, Removed>,
}

/// Runs a tick unless the world is paused.
pub fn step<D: Dimension>(mut world: ResMut<SoftWorld<D>>, mut writers: Writers<'_>) {
    let before = world.unsent_events();
    if world.tick() {
        for event in before.iter().chain(world.engine().events()) {
            writers.tell(&world, *event);
        }
        for (body, is_asleep) in world.follow_sleep() {
            if is_asleep {
                writers.fell_asleep.write(FellAsleep { body, piece: None });
            } else {
                writers.woke.write(Woke { body, piece: None });
            }
        }
    }
}

impl Writers<'_> {
    /// Sends an event as a message. Sends nothing if a body in the event has no entity; only `Touched` allows
    /// one such body.
    fn tell<D: Dimension>(&mut self, world: &SoftWorld<D>, event: Event) -> Option<()> {
        let of_body = |body| world.entity_of_body(body);
        let of = |object: ObjectRef| match object {
            ObjectRef::Piece { body, piece } => Some((of_body(body)?, Some(piece))),
            ObjectRef::RigidBody(rigid) => Some((world.entity_of_rigid(rigid)?, None)),
        };
        match event {
            Event::NodeSplit {
                body,
                point,
                energy,
            } => {
                let (body, at) = (of_body(body)?, point.into());
                self.torn.write(NodeSplit { body, at, energy });
            }
            Event::PieceDetached { body, piece } => {
                let body = of_body(body)?;
                self.parted.write(PieceDetached { body, piece });
            }
            Event::ContactForce(contact) => {
                // If the first body has no entity, the second one takes its place as `body`.
                let [first, second] = contact.pair.map(of);
                let normal = Vec3::from(contact.normal);
                let ((body, piece), with, normal) = match first {
                    Some(first) => (first, second, normal),
                    None => (second?, None, -normal),
                };
                self.touched.write(Touched {
                    body,
                    piece,
                    with: with.map(|(with, _)| with),
                    with_piece: with.and_then(|(_, piece)| piece),
                    at: contact.point.into(),
                    normal,
                    impulse: contact.impulse,
                });
            }
            Event::ContactStarted(contact) => {
                let [first, second] = contact.pair;
                let ((first, own), (second, other)) = (of(first)?, of(second)?);
                self.contact_began.write(ContactBegan {
                    both: [first, second],
                    pieces: [own, other],
                    at: contact.point.into(),
                    normal: contact.normal.into(),
                    speed: contact.speed,
                });
            }
            Event::ContactEnded {
                pair: [first, second],
            } => {
                let ((first, own), (second, other)) = (of(first)?, of(second)?);
                let (both, pieces) = ([first, second], [own, other]);
                self.contact_ended.write(ContactEnded { both, pieces });
            }
            Event::SensorEntered { sensor, object } => {
                let (sensor, (who, piece)) = (world.entity_of_rigid(sensor)?, of(object)?);
                self.entered.write(SensorEntered { sensor, who, piece });
            }
            Event::SensorExited { sensor, object } => {
                let (sensor, (who, piece)) = (world.entity_of_rigid(sensor)?, of(object)?);
                self.left.write(SensorExited { sensor, who, piece });
            }
            Event::Cut {
                knife,
                body,
                point,
                area,
                work,
            } => {
                let (body, at) = (of_body(body)?, point.into());
                self.cut.write(Cut {
                    knife,
                    body,
                    at,
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
                self.woke.write(Woke { body, piece });
            }
            Event::PieceRemoved { body, piece } => {
                let (body, piece) = (of_body(body)?, Some(piece));
                self.removed.write(Removed { body, piece });
            }
            Event::SoftBodyRemoved { body } => {
                let body = of_body(body)?;
                self.removed.write(Removed { body, piece: None });
            }
            Event::RigidBodyRemoved { rigid } => {
                let body = world.entity_of_rigid(rigid)?;
                self.removed.write(Removed { body, piece: None });
            }
            Event::Quarantined { body, piece } => {
                let body = of_body(body)?;
                self.quarantined.write(Quarantined { body, piece });
            }
            // Events that the engine adds later have no message yet.
            _ => {}
        }
        Some(())
    }
}
