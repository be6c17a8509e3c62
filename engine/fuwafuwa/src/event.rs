//! Events of a tick and the report of a step.

use crate::foundation::arena::{JointHandle, KnifeHandle, RigidBodyHandle, SoftBodyHandle};
use crate::foundation::ids::PieceId;
use crate::rigid_body::shape::Vector;

/// Event of the last tick, for sounds, scores and effects.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Event {
    /// A node was split: a crack advanced, or a cut passed here.
    NodeSplit {
        /// The body.
        body: SoftBodyHandle,
        /// Position of the node [m].
        at: Vector,
        /// Elastic energy released [J]; 0 for an intentional cut.
        energy: f32,
    },
    /// A piece was detached from its body.
    PieceDetached {
        /// The body.
        body: SoftBodyHandle,
        /// Number of the new piece.
        piece: PieceId,
    },
    /// A piece pressed on something during the tick.
    Pressed {
        /// The body.
        body: SoftBodyHandle,
        /// Number of the piece.
        piece: PieceId,
        /// Object that it pressed on.
        with: With,
        /// Position of the strongest contact [m].
        at: Vector,
        /// Unit contact normal there, from the object towards the piece.
        normal: Vector,
        /// Normal impulse, summed over the contacts and substeps of the tick [N s].
        impulse: f32,
    },
    /// Two rigid bodies pressed on each other during the tick; at least the first one is dynamic.
    RigidPressed {
        /// The dynamic rigid body.
        rigid: RigidBodyHandle,
        /// Handle of the second rigid body.
        with: RigidBodyHandle,
        /// Position of the strongest contact [m].
        at: Vector,
        /// Unit contact normal there, from the second body towards the first.
        normal: Vector,
        /// Normal impulse, summed over the contacts and substeps of the tick [N s].
        impulse: f32,
    },
    /// Two contact participants began to touch.
    ContactStarted {
        /// The participants, in ascending order.
        both: [ObjectRef; 2],
        /// Position of the strongest contact [m].
        at: Vector,
        /// Unit contact normal there, from the second participant towards the first.
        normal: Vector,
        /// Highest approach speed [m/s].
        speed: f32,
    },
    /// Two contact participants stopped touching, or one of them was removed. Participants at rest side by
    /// side still touch.
    ContactEnded {
        /// The participants, in ascending order.
        both: [ObjectRef; 2],
    },
    /// A sensor was entered.
    SensorEntered {
        /// The sensor.
        sensor: RigidBodyHandle,
        /// The piece or rigid body that entered.
        who: ObjectRef,
    },
    /// A sensor was exited, or the participant or the sensor was removed.
    SensorExited {
        /// The sensor.
        sensor: RigidBodyHandle,
        /// The piece or rigid body that left.
        who: ObjectRef,
    },
    /// A knife opened faces between voxels.
    Cut {
        /// The knife.
        knife: KnifeHandle,
        /// The body.
        body: SoftBodyHandle,
        /// Middle of the part of the cutting edge that is inside the body [m].
        at: Vector,
        /// Area cut since the last such event of this knife, in all bodies, measured at rest [m²].
        area: f32,
        /// Work done since the last such event of this knife, in all bodies [J].
        work: f32,
    },
    /// A joint broke or lost one of its anchors, and was removed.
    JointBroke {
        /// Handle of the removed joint.
        joint: JointHandle,
    },
    /// A piece fell asleep.
    FellAsleep {
        /// The body.
        body: SoftBodyHandle,
        /// Number of the piece.
        piece: PieceId,
    },
    /// A sleeping piece was woken.
    WokeUp {
        /// The body.
        body: SoftBodyHandle,
        /// Number of the piece.
        piece: PieceId,
    },
    /// A piece was [removed](crate::World::remove_piece) from the world.
    PieceRemoved {
        /// The body. If this was its last piece, the handle is stale.
        body: SoftBodyHandle,
        /// Number of the piece.
        piece: PieceId,
    },
    /// The last piece of a body was removed, and the body with it.
    BodyRemoved {
        /// Handle of the removed body.
        body: SoftBodyHandle,
    },
    /// A rigid body was removed because it [left a region](crate::World::remove_outside).
    RigidRemoved {
        /// Handle of the removed rigid body.
        rigid: RigidBodyHandle,
    },
    /// A piece became non-finite or too fast. It was stopped for good, so that it cannot affect the rest of
    /// the world.
    Quarantined {
        /// The body.
        body: SoftBodyHandle,
        /// Number of the piece.
        piece: PieceId,
    },
}

impl Event {
    /// Returns the events for pieces detached from a body.
    pub(crate) fn parted(body: SoftBodyHandle, pieces: &[PieceId]) -> impl Iterator<Item = Self> {
        pieces
            .iter()
            .map(move |&piece| Self::PieceDetached { body, piece })
    }
}

/// Object that a piece presses on.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum With {
    /// A fixed rigid body.
    Obstacle(RigidBodyHandle),
    /// A kinematic or coupled rigid body.
    Hand(RigidBodyHandle),
    /// A dynamic rigid body.
    Free(RigidBodyHandle),
    /// Another piece, or the same piece where it folds onto itself.
    Piece {
        /// The body.
        body: SoftBodyHandle,
        /// Number of the piece.
        piece: PieceId,
    },
}

/// Participant of a contact or a sensor overlap.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ObjectRef {
    /// A piece of a soft body.
    Piece {
        /// The body.
        body: SoftBodyHandle,
        /// Number of the piece.
        piece: PieceId,
    },
    /// A rigid body.
    RigidBody(RigidBodyHandle),
}

impl From<With> for ObjectRef {
    fn from(with: With) -> Self {
        match with {
            With::Obstacle(id) | With::Hand(id) | With::Free(id) => Self::RigidBody(id),
            With::Piece { body, piece } => Self::Piece { body, piece },
        }
    }
}

/// Summary of one tick.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StepReport {
    /// Number of substeps.
    pub substeps: u32,
    /// Number of split nodes.
    pub nodes_split: u32,
    /// Number of detached pieces.
    pub pieces_detached: u32,
    /// Number of inverted elements in the last substep; they recover by themselves.
    pub inverted: u32,
    /// Number of pieces that were stopped by the quarantine.
    pub quarantined: u32,
}
