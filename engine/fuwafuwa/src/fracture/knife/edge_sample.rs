//! Samples of a cutting edge and their state in the tissue.

use super::material_point::MaterialPoint;
use crate::foundation::arena::SoftBodyHandle;
use crate::foundation::dim::Point;
use crate::foundation::hash::{Hash, HashState};
use crate::foundation::ids::NodeId;
use glam::Vec3;

/// Maximum number of intervals between adjacent samples of an edge. With two samples per voxel, it suffices
/// for an edge 256 voxels long, a quarter of the width of the largest grid.
pub const MAX_SAMPLES: usize = 512;

/// Element that a sample may enter before the next search.
#[derive(Copy, Clone, Debug)]
pub struct Near {
    pub body: SoftBodyHandle,
    pub voxel: Point,
    /// First corner node of the element.
    pub node: NodeId,
    /// Distance from `node` within which the element may contain the sample [m].
    pub reach: f32,
}

/// Sample of a cutting edge.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sample {
    /// Body that contains the sample, and the rest position of the sample there.
    pub inside: Option<(SoftBodyHandle, MaterialPoint)>,
    /// Body and rest position up to which the area swept by the sample is already counted. Stays unchanged
    /// while tissue holds the sample.
    pub passed: Option<(SoftBodyHandle, MaterialPoint)>,
    /// World-space position of the sample when `passed` last changed [m].
    pub before: Vec3,
    /// Whether the sample has advanced through tissue since the last sweep.
    pub slid: bool,
    /// Whether the sample has advanced through uncut tissue since the last sweep.
    pub cut: bool,
    /// Mean speed of the sample through a material with rate toughening in the last sweeps [m/s]; 0 in other materials.
    pub speed: f32,
}

impl HashState for Sample {
    fn hash_state(&self, hash: &mut Hash) {
        let Self {
            inside,
            passed,
            before,
            slid,
            cut,
            speed,
        } = self;
        inside.hash_state(hash);
        passed.hash_state(hash);
        before.hash_state(hash);
        slid.hash_state(hash);
        cut.hash_state(hash);
        // Edges in other materials have the hash of earlier versions.
        if *speed != 0.0 {
            speed.hash_state(hash);
        }
    }
}

/// Weight of the last sweep in the mean speed of a sample. The speed within a single sweep fluctuates with the
/// vibrations of the tissue.
const LAST_SWEEP: f32 = 0.1;

impl Sample {
    /// Returns the rest position in `body` up to which the area swept by the sample is already counted.
    pub fn passed_in(&self, body: SoftBodyHandle) -> Option<MaterialPoint> {
        let passed = self.passed.filter(|(own, _)| *own == body);
        passed.map(|(_, point)| point)
    }

    /// Returns the present rest position of the sample in `body`.
    pub fn inside_of(&self, body: SoftBodyHandle) -> Option<MaterialPoint> {
        let inside = self.inside.filter(|(own, _)| *own == body);
        inside.map(|(_, point)| point)
    }

    /// Updates the mean speed at the end of a sweep of `since` seconds. `size` is the voxel size of the body that the
    /// sample is in, if a material there has rate toughening.
    pub fn update_speed(&mut self, since: f32, size: Option<f32>) {
        let Some(size) = size else {
            self.speed = 0.0;
            return;
        };
        let way = match (self.passed, self.inside) {
            (Some((from, start)), Some((to, end))) if from == to && !self.is_stuck() => {
                (end.at - start.at).length() * size
            }
            _ => 0.0,
        };
        self.speed += (way / since - self.speed) * LAST_SWEEP;
    }

    /// Returns whether tissue has held the sample since the last sweep.
    pub fn is_stuck(&self) -> bool {
        self.inside.is_some() && !self.slid
    }

    /// Returns whether a sample that was read from a file is valid.
    #[cfg(feature = "serde")]
    pub fn is_sound(&self) -> bool {
        let spots = [self.inside, self.passed].into_iter().flatten();
        self.before.is_finite() && self.speed.is_finite() && { spots }
            .all(|(_, point)| point.at.is_finite())
    }
}
