//! A tick, and what happened in it.

use crate::dimension::Dimension;
use crate::message::{FellAsleep, Parted, Quarantined, Torn, Touched, Woke};
use crate::world::SoftWorld;
use bevy_ecs::change_detection::ResMut;
use bevy_ecs::message::MessageWriter;
use bevy_ecs::system::SystemParam;
use bevy_math::Vec3;
use fuwafuwa::{Event, With};

/// Where all that happened is written down.
#[derive(SystemParam)]
pub struct Writers<'w> {
    torn: MessageWriter<'w, Torn>,
    parted: MessageWriter<'w, Parted>,
    touched: MessageWriter<'w, Touched>,
    fell_asleep: MessageWriter<'w, FellAsleep>,
    woke: MessageWriter<'w, Woke>,
    quarantined: MessageWriter<'w, Quarantined>,
}

/// Lets a tick pass, unless time stands still.
pub fn step<D: Dimension>(mut world: ResMut<SoftWorld<D>>, mut writers: Writers<'_>) {
    if world.tick() {
        for event in world.engine().events() {
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
    fn tell<D: Dimension>(&mut self, world: &SoftWorld<D>, event: Event) {
        let id = match event {
            Event::Released { body, .. }
            | Event::Parted { body, .. }
            | Event::Touched { body, .. }
            | Event::FellAsleep { body, .. }
            | Event::Woke { body, .. }
            | Event::Quarantined { body, .. } => body,
        };
        let Some(body) = world.entity_of_body(id) else {
            return;
        };
        match event {
            Event::Released { at, energy, .. } => {
                let at = Vec3::from(at);
                self.torn.write(Torn { body, at, energy });
            }
            Event::Parted { piece, .. } => {
                self.parted.write(Parted { body, piece });
            }
            Event::Touched {
                piece,
                with,
                at,
                impulse,
                ..
            } => {
                let (with, with_piece) = match with {
                    With::Obstacle(rigid) | With::Hand(rigid) | With::Free(rigid) => {
                        (world.entity_of_rigid(rigid), None)
                    }
                    With::Piece { body, piece } => (world.entity_of_body(body), Some(piece)),
                };
                self.touched.write(Touched {
                    body,
                    piece,
                    with,
                    with_piece,
                    at: at.into(),
                    impulse,
                });
            }
            Event::FellAsleep { piece, .. } => {
                let piece = Some(piece);
                self.fell_asleep.write(FellAsleep { body, piece });
            }
            Event::Woke { piece, .. } => {
                let piece = Some(piece);
                self.woke.write(Woke { body, piece });
            }
            Event::Quarantined { piece, .. } => {
                self.quarantined.write(Quarantined { body, piece });
            }
        }
    }
}
