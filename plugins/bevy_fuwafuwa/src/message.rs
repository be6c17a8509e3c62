//! Messages about the events of a tick, with the entities involved.
//!
//! Read them with Bevy's `MessageReader`. Bodies without an entity, which were added directly to the engine,
//! send none; `SoftWorld::engine().events()` has the events of all bodies.

use crate::problem::Problem;
use bevy_ecs::entity::Entity;
use bevy_ecs::message::Message;
use bevy_math::Vec3;
use fuwafuwa::{JointHandle, KnifeHandle, PieceId};

/// A node of the mesh was split into two, so that a crack grew.
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct NodeSplit {
    /// The soft body.
    pub body: Entity,
    /// Position, world space [m].
    pub point: Vec3,
    /// Released elastic energy [J]: at a crack tip, the energy release rate times the opened area. 0 if the split
    /// was an explicit cut.
    pub energy: f32,
}

/// A piece was detached.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct PieceDetached {
    /// The soft body.
    pub body: Entity,
    /// Id of the new piece.
    pub piece: PieceId,
}

/// Two bodies pressed on each other during the tick. Soft bodies come before rigid ones, as in
/// [`Contact::pair`](fuwafuwa::Contact::pair) of the engine.
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct ContactForce {
    /// The first body of the contact, or the second body if the first one has no entity.
    pub body: Entity,
    /// Piece of `body`; `None` for a rigid body.
    pub piece: Option<PieceId>,
    /// The other body: rigid, soft, or equal to `body` if that body touches itself. `None` if the other body
    /// has no entity.
    pub other: Option<Entity>,
    /// Piece of `other` if it is a soft body.
    pub other_piece: Option<PieceId>,
    /// Position of the strongest contact, world space [m].
    pub point: Vec3,
    /// Unit normal at the strongest contact; points away from `other`.
    pub normal: Vec3,
    /// Normal impulse, summed over the tick [N s].
    pub impulse: f32,
}

/// Two bodies began to touch.
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct ContactStarted {
    /// The two bodies.
    pub pair: [Entity; 2],
    /// Pieces of the two bodies, in the order of `pair`; `None` for a rigid body.
    pub pieces: [Option<PieceId>; 2],
    /// Position of the strongest contact, world space [m].
    pub point: Vec3,
    /// Unit normal at the strongest contact; points from the second body to the first.
    pub normal: Vec3,
    /// Approach speed [m/s].
    pub speed: f32,
}

/// A contact between two bodies ended. A contact at rest does not end. The message is not sent if one of the
/// bodies was despawned.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct ContactEnded {
    /// The two bodies.
    pub pair: [Entity; 2],
    /// Pieces of the two bodies, in the order of `pair`; `None` for a rigid body.
    pub pieces: [Option<PieceId>; 2],
}

/// A body entered a sensor.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct SensorEntered {
    /// The sensor.
    pub sensor: Entity,
    /// The body that entered.
    pub entity: Entity,
    /// Piece of `entity` that entered; `None` for a rigid body.
    pub piece: Option<PieceId>,
}

/// A body left a sensor. The message is not sent if the body or the sensor was despawned.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct SensorExited {
    /// The sensor.
    pub sensor: Entity,
    /// The body that left.
    pub entity: Entity,
    /// Piece of `entity` that left; `None` for a rigid body.
    pub piece: Option<PieceId>,
}

/// A joint of the engine broke or lost one of its bodies, and was removed.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct JointBroke {
    /// The removed joint.
    pub joint: JointHandle,
}

/// A knife of the engine cut through a soft body.
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct Cut {
    /// The knife.
    pub knife: KnifeHandle,
    /// The soft body.
    pub body: Entity,
    /// Position, world space [m].
    pub point: Vec3,
    /// Area cut since the previous message of this knife, summed over all bodies [m²].
    pub area: f32,
    /// Work done since the previous message of this knife, summed over all bodies [J].
    pub work: f32,
}

/// A piece, a soft body or a rigid body was removed through the engine. The message is sent in the next tick;
/// the entity is not despawned.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct Removed {
    /// The soft or rigid body.
    pub body: Entity,
    /// The removed piece; `None` if the whole body was removed.
    pub piece: Option<PieceId>,
}

/// A piece or a dynamic rigid body fell asleep.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct FellAsleep {
    /// The soft or rigid body.
    pub body: Entity,
    /// The piece; `None` for a rigid body.
    pub piece: Option<PieceId>,
}

/// A sleeping piece or dynamic rigid body woke up.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct WokeUp {
    /// The soft or rigid body.
    pub body: Entity,
    /// The piece; `None` for a rigid body.
    pub piece: Option<PieceId>,
}

/// A piece hit something too fast for the substeps, and was slowed while the impact lasts; see
/// [`Event::ImpactSlowed`](fuwafuwa::Event::ImpactSlowed).
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct ImpactSlowed {
    /// The soft body.
    pub body: Entity,
    /// The piece.
    pub piece: PieceId,
    /// Smallest share of its velocity by which the piece moved, 0 to 1.
    pub share: f32,
}

/// Two bodies were placed inside each other, and are moved apart.
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct Overlapped {
    /// The two bodies.
    pub pair: [Entity; 2],
    /// Pieces of the two bodies, in the order of `pair`; `None` for a rigid body.
    pub pieces: [Option<PieceId>; 2],
    /// Depth of the overlap [m].
    pub depth: f32,
}

/// A body left the range of positions in which its shape is right, or a rigid body was stopped at the limit.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct LeftRange {
    /// The soft or rigid body.
    pub body: Entity,
    /// The piece; `None` for a rigid body.
    pub piece: Option<PieceId>,
}

/// The scale of a soft body that requires more substeps than the world allows began to act, changed or ended; see
/// [`Event::StiffBodyScaled`](fuwafuwa::Event::StiffBodyScaled).
#[derive(Message, Copy, Clone, Debug, PartialEq)]
pub struct StiffBodyScaled {
    /// The soft body.
    pub body: Entity,
    /// Factor on the inertia of deformation; 1 = unchanged.
    pub mass_scale: f32,
    /// Factor on Young's modulus; 1 = unchanged.
    pub stiffness_scale: f32,
}

/// A piece got non-finite positions or velocities and was stopped permanently.
#[derive(Message, Copy, Clone, Debug, PartialEq, Eq)]
pub struct Quarantined {
    /// The soft body.
    pub body: Entity,
    /// The piece.
    pub piece: PieceId,
}

/// A request could not be carried out and was ignored.
#[derive(Message, Clone, Debug, PartialEq)]
pub struct Rejection {
    /// Entity that made the request; `None` for a changed configuration.
    pub entity: Option<Entity>,
    /// Reason why the request was ignored.
    pub problem: Problem,
}
