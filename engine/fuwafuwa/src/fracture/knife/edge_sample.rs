//! Samples of a cutting edge and their state in the tissue.

use super::material_point::Spot;
use crate::foundation::arena::SoftBodyHandle;
use crate::foundation::dim::Point;
use crate::foundation::hash::hash_state;
use crate::foundation::ids::NodeId;
use glam::Vec3;

/// Maximum number of intervals between samples. It suffices for 256 voxels, a quarter of the largest grid.
pub const MOST_SAMPLES: usize = 512;

/// Element that a sample may enter.
#[derive(Copy, Clone, Debug)]
pub struct Near {
    pub body: SoftBodyHandle,
    pub voxel: Point,
    /// A node of the element, and the reach of the element from it [m].
    pub node: NodeId,
    pub reach: f32,
}

/// Sample of a cutting edge.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sample {
    /// Body and rest position that the sample is in.
    pub inside: Option<(SoftBodyHandle, Spot)>,
    /// Body and rest position up to which the swept area was counted. A sweep leaves the value unchanged
    /// while tissue holds the sample.
    pub passed: Option<(SoftBodyHandle, Spot)>,
    /// World-space position at the last sweep [m].
    pub before: Vec3,
    /// Whether the sample has advanced through tissue since the last sweep, and whether through whole tissue.
    pub slid: bool,
    pub cut: bool,
}

hash_state! { struct Sample { inside, passed, before, slid, cut } }

impl Sample {
    /// Returns the rest position in a body at the last sweep.
    pub fn passed_in(&self, body: SoftBodyHandle) -> Option<Spot> {
        let passed = self.passed.filter(|(own, _)| *own == body);
        passed.map(|(_, spot)| spot)
    }

    /// Returns the present rest position in a body.
    pub fn inside_of(&self, body: SoftBodyHandle) -> Option<Spot> {
        let inside = self.inside.filter(|(own, _)| *own == body);
        inside.map(|(_, spot)| spot)
    }

    /// Returns whether tissue has held the sample since the last sweep.
    pub fn is_stuck(&self) -> bool {
        self.inside.is_some() && !self.slid
    }

    /// Returns whether a sample that was read from a file is valid.
    #[cfg(feature = "serde")]
    pub fn is_sound(&self) -> bool {
        let spots = [self.inside, self.passed].into_iter().flatten();
        self.before.is_finite() && { spots }.all(|(_, spot)| spot.at.is_finite())
    }
}
