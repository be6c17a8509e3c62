//! What can be tied, and how.

use crate::handle::{BodyId, BodySlot, RigidId, RigidSlot};
use crate::ids::PieceId;
use crate::shape::Vector;

/// What something is tied at. All places are where they are in the world when it is tied.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum End {
    /// A position in the world [m].
    Position(Vector),
    /// A place of something rigid, on it or not.
    Rigid {
        /// The rigid thing.
        rigid: RigidId,
        /// Where [m].
        at: Vector,
    },
    /// The middle of some nodes of a soft body.
    Soft {
        /// The body.
        body: BodyId,
        /// Where [m].
        at: Vector,
        /// Nodes within this distance [m], or the nearest one where there is none. The more there are, the less is torn
        /// off by a pull.
        radius: f32,
    },
}

/// How two ends are tied.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Tie {
    /// They stay together, and may turn. Two soft or two other ends that are apart are drawn together; a soft end is held
    /// where it is.
    Pin,
    /// They are drawn to be so far apart.
    Spring {
        /// [N/m], positive.
        stiffness: f32,
        /// [N s/m], 0 or more.
        damping: f32,
        /// At rest [m], 0 or more.
        length: f32,
    },
    /// They are at most so far apart.
    Rope {
        /// [m], positive.
        length: f32,
    },
}

/// Who sleeps and has to wake, because the other end of a joint moves.
#[derive(Debug, Default)]
pub(crate) struct Woken {
    pub(crate) pieces: Vec<(BodySlot, PieceId)>,
    pub(crate) rigids: Vec<RigidSlot>,
}
