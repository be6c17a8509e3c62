//! What happened in a tick, with the entities it happened to.
//!
//! They are Bevy's buffered messages, for a `MessageReader`. Bodies that have no entity, because they were put into the
//! engine by hand, send none; the engine's own events are `SoftWorld::engine().events()`.

use crate::problem::Problem;
use bevy_ecs::entity::Entity;
use bevy_ecs::message::Message;
use bevy_math::Vec3;
use fuwafuwa::PieceId;

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

/// Something soft pressed on something in the tick. Of rigid things that press on each other nothing is told.
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct Touched {
    /// The soft body.
    pub body: Entity,
    /// Number of its piece.
    pub piece: PieceId,
    /// What it pressed on: something rigid, a soft body, or itself; none where that has no entity.
    pub with: Option<Entity>,
    /// Number of the piece that it pressed on, of a soft body.
    pub with_piece: Option<PieceId>,
    /// Where in the world, at the strongest contact [m].
    pub at: Vec3,
    /// Along the normals, over the whole tick [N s].
    pub impulse: f32,
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
