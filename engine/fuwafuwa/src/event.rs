//! What happened in a tick.

use crate::handle::{BodyId, JointId, KnifeId, RigidId};
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
        /// Which way it got away from that there, of length 1.
        normal: Vector,
        /// Along the normals, over the whole tick [N s].
        impulse: f32,
    },
    /// Rigid things pressed on each other, of which one is free.
    RigidTouched {
        /// The one that is free.
        rigid: RigidId,
        /// The other.
        with: RigidId,
        /// Where, at the strongest contact [m].
        at: Vector,
        /// Which way the first got away from the other there, of length 1.
        normal: Vector,
        /// Along the normals, over the whole tick [N s].
        impulse: f32,
    },
    /// Two began to touch.
    ContactBegan {
        /// Who.
        both: [Party; 2],
        /// Where, at the strongest contact [m].
        at: Vector,
        /// Which way the first got away from the second there, of length 1.
        normal: Vector,
        /// How fast they approached each other [m/s].
        speed: f32,
    },
    /// Two touch no more, or one of them is gone. What rests side by side still touches.
    ContactEnded {
        /// Who.
        both: [Party; 2],
    },
    /// Somebody came into a sensor.
    Entered {
        /// The sensor.
        sensor: RigidId,
        /// Who.
        who: Party,
    },
    /// Somebody left a sensor, or is gone, or the sensor is.
    Left {
        /// The sensor.
        sensor: RigidId,
        /// Who.
        who: Party,
    },
    /// A knife opened faces between voxels.
    Cut {
        /// The knife.
        knife: KnifeId,
        /// The body.
        body: BodyId,
        /// In the middle of its edge in there [m].
        at: Vector,
        /// How much it cut since it last told so, of all bodies that it was in, at rest [m²].
        area: f32,
        /// The work that it did since then, in all of them [J].
        work: f32,
    },
    /// A joint broke, or lost an end, and is gone.
    JointBroke {
        /// Which one it was.
        joint: JointId,
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
    /// A piece was [removed](crate::World::remove_piece) from the world.
    PieceRemoved {
        /// The body, which may be gone with it.
        body: BodyId,
        /// Number of the piece.
        piece: PieceId,
    },
    /// The last piece of a body was removed, and the body with it.
    BodyRemoved {
        /// Which one it was.
        body: BodyId,
    },
    /// Something rigid was removed because it [left a region](crate::World::remove_outside).
    RigidRemoved {
        /// Which one it was.
        rigid: RigidId,
    },
    /// A piece went out of hand and was stopped for good, so that it spoils nothing else.
    Quarantined {
        /// The body.
        body: BodyId,
        /// Number of the piece.
        piece: PieceId,
    },
}

impl Event {
    /// These pieces of a body came off.
    pub(crate) fn parted(body: BodyId, pieces: &[PieceId]) -> impl Iterator<Item = Self> {
        pieces
            .iter()
            .map(move |&piece| Self::Parted { body, piece })
    }
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

/// Who can touch and be touched.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Party {
    /// A piece of a soft body.
    Piece {
        /// The body.
        body: BodyId,
        /// Number of the piece.
        piece: PieceId,
    },
    /// Something rigid.
    Rigid(RigidId),
}

impl From<With> for Party {
    fn from(with: With) -> Self {
        match with {
            With::Obstacle(id) | With::Hand(id) | With::Free(id) => Self::Rigid(id),
            With::Piece { body, piece } => Self::Piece { body, piece },
        }
    }
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
