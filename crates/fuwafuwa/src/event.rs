//! What happened in a tick.

use crate::handle::{BodyId, RigidId};
use crate::ids::PieceId;
use crate::shape::Vector;

/// Something that happened in the last tick, for sound, score and show.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Event {
    /// Voxels stopped sharing a node: a crack went on.
    Released {
        /// The body.
        body: BodyId,
        /// Where [m].
        at: Vector,
        /// Elastic energy set free [J]; 0 where it was cut on purpose.
        energy: f32,
    },
    /// A piece came off.
    Parted {
        /// The body.
        body: BodyId,
        /// Number of the new piece.
        piece: PieceId,
    },
    /// Things pressed on each other.
    Touched {
        /// The body.
        body: BodyId,
        /// Number of the piece.
        piece: PieceId,
        /// What it pressed on.
        with: With,
        /// Where, at the strongest contact [m].
        at: Vector,
        /// Along the normals, over the whole tick [N s].
        impulse: f32,
    },
    /// A piece came to rest.
    FellAsleep {
        /// The body.
        body: BodyId,
        /// Number of the piece.
        piece: PieceId,
    },
    /// A resting piece was disturbed.
    Woke {
        /// The body.
        body: BodyId,
        /// Number of the piece.
        piece: PieceId,
    },
    /// A piece went out of hand and was stopped for good, so that it spoils nothing else.
    Quarantined {
        /// The body.
        body: BodyId,
        /// Number of the piece.
        piece: PieceId,
    },
}

/// What a piece can press on.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum With {
    /// Something rigid that stands still.
    Obstacle(RigidId),
    /// A hand.
    Hand(RigidId),
    /// Something rigid that is free.
    Free(RigidId),
    /// Another piece, or itself.
    Piece {
        /// The body.
        body: BodyId,
        /// Number of the piece.
        piece: PieceId,
    },
}

/// What a tick did.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StepReport {
    /// Substeps in the tick.
    pub substeps: u32,
    /// Nodes that were released.
    pub released: u32,
    /// Pieces that came off.
    pub parted: u32,
    /// Elements that were inside out in its last substep; they turn themselves back.
    pub inverted: u32,
    /// Pieces that went out of hand and were stopped.
    pub quarantined: u32,
}
