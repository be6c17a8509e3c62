//! A place of an edge, and what it knows of the tissue that it is in.

use super::inside::Spot;
use crate::dim::Point;
use crate::handle::BodyId;
use crate::ids::NodeId;
use crate::shape::Vector;
#[cfg(feature = "serde")]
use crate::vector::is_finite;

/// The most spaces between samples on an edge: up to 256 voxels, a quarter of the largest grid, they stand close enough.
pub const MOST_SAMPLES: usize = 512;

/// An element that a sample may come into.
#[derive(Copy, Clone, Debug)]
pub struct Near {
    pub body: BodyId,
    pub voxel: Point,
    /// One of its nodes, and how far from that it reaches [m].
    pub node: NodeId,
    pub reach: f32,
}

/// A place of an edge.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sample {
    /// In whom it is, and where.
    pub inside: Option<(BodyId, Spot)>,
    /// Where it was in whom when its swath was last looked at: the swath ends there.
    pub passed: Option<(BodyId, Spot)>,
    /// Where it was then [m].
    pub before: Vector,
    /// Whether it went on through tissue since then, and through some that was whole.
    pub slid: bool,
    pub cut: bool,
}

impl Sample {
    /// Where it was in a body at rest when its swath was last looked at.
    pub fn passed_in(&self, body: BodyId) -> Option<Spot> {
        let passed = self.passed.filter(|(own, _)| *own == body);
        passed.map(|(_, spot)| spot)
    }

    /// Where it is in a body.
    pub fn inside_of(&self, body: BodyId) -> Option<Spot> {
        let inside = self.inside.filter(|(own, _)| *own == body);
        inside.map(|(_, spot)| spot)
    }

    /// Whether tissue held it since its swath was last looked at.
    pub fn is_stuck(&self) -> bool {
        self.inside.is_some() && !self.slid
    }

    /// Whether what was read from a file may be one.
    #[cfg(feature = "serde")]
    pub fn is_sound(&self) -> bool {
        let spots = [self.inside, self.passed].into_iter().flatten();
        is_finite(self.before) && { spots }.all(|(_, spot)| is_finite(spot.at))
    }
}
