//! What happened in a tick, with the entities it happened to.
//!
//! They are Bevy's buffered messages, for a `MessageReader`. Bodies that have no entity, because they were put into the
//! engine by hand, send none; the engine's own events are `SoftWorld::engine().events()`.

use crate::problem::Problem;
use bevy_ecs::entity::Entity;
use bevy_ecs::message::Message;
use bevy_math::Vec3;
use fuwafuwa::{JointId, KnifeId, PieceId};

/// Voxels stopped sharing a node: a crack went on.
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct Torn {
    /// The soft body.
    pub body: Entity,
    /// Where in the world [m].
    pub at: Vec3,
    /// Elastic energy set free [J]; 0 where it was cut on purpose.
    pub energy: f32,
}

/// A piece came off.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct Parted {
    /// The soft body.
    pub body: Entity,
    /// Number of the new piece.
    pub piece: PieceId,
}

/// Something soft pressed on something in the tick, or something rigid that is free on something rigid.
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct Touched {
    /// The soft body, or what is free.
    pub body: Entity,
    /// Number of its piece; what is rigid has none.
    pub piece: Option<PieceId>,
    /// What it pressed on: something rigid, a soft body, or itself; none where that has no entity.
    pub with: Option<Entity>,
    /// Number of the piece that it pressed on, of a soft body.
    pub with_piece: Option<PieceId>,
    /// Where in the world, at the strongest contact [m].
    pub at: Vec3,
    /// Which way it got away from that there, of length 1.
    pub normal: Vec3,
    /// Along the normals, over the whole tick [N s].
    pub impulse: f32,
}

/// Two began to touch.
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct ContactBegan {
    /// Who.
    pub both: [Entity; 2],
    /// Numbers of their pieces; what is rigid has none.
    pub pieces: [Option<PieceId>; 2],
    /// Where in the world, at the strongest contact [m].
    pub at: Vec3,
    /// Which way the first got away from the second there, of length 1.
    pub normal: Vec3,
    /// How fast they approached each other [m/s].
    pub speed: f32,
}

/// Two touch no more. What rests side by side still touches; of what was despawned nothing is told.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct ContactEnded {
    /// Who.
    pub both: [Entity; 2],
    /// Numbers of their pieces; what is rigid has none.
    pub pieces: [Option<PieceId>; 2],
}

/// Somebody came into a sensor.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct Entered {
    /// The sensor.
    pub sensor: Entity,
    /// Who.
    pub who: Entity,
    /// Number of the piece; what is rigid has none.
    pub piece: Option<PieceId>,
}

/// Somebody left a sensor; of what was despawned nothing is told.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct Left {
    /// The sensor.
    pub sensor: Entity,
    /// Who.
    pub who: Entity,
    /// Number of the piece; what is rigid has none.
    pub piece: Option<PieceId>,
}

/// A joint of the engine's world broke, or lost an end, and is gone.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct JointBroke {
    /// Which one it was.
    pub joint: JointId,
}

/// A knife of the engine's world went on through a soft body.
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct Cut {
    /// The knife.
    pub knife: KnifeId,
    /// The soft body.
    pub body: Entity,
    /// Where in the world [m].
    pub at: Vec3,
    /// How much it cut since it told of that last, of all bodies that it was in [m²].
    pub area: f32,
    /// The work that it did in that time, in all of them [J].
    pub work: f32,
}

/// A piece, a soft body or something rigid was taken out of the engine's world by hand. It is told in the next tick, and the
/// entity stays.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct Removed {
    /// The soft body, or what is rigid.
    pub body: Entity,
    /// Number of the piece; none when nothing is left.
    pub piece: Option<PieceId>,
}

/// A piece came to rest, or something rigid that is free.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct FellAsleep {
    /// The soft body, or what is rigid.
    pub body: Entity,
    /// Number of the piece; what is rigid has none.
    pub piece: Option<PieceId>,
}

/// A resting piece was disturbed, or something rigid that is free.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct Woke {
    /// The soft body, or what is rigid.
    pub body: Entity,
    /// Number of the piece; what is rigid has none.
    pub piece: Option<PieceId>,
}

/// A piece went out of hand and was stopped for good.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct Quarantined {
    /// The soft body.
    pub body: Entity,
    /// Number of the piece.
    pub piece: PieceId,
}

/// Something was asked and not done; all else went on.
#[derive(Message, Clone, Debug, PartialEq)]
pub struct Rejection {
    /// Who it was asked for; none when it was settings.
    pub entity: Option<Entity>,
    /// Why it was not done.
    pub problem: Problem,
}
