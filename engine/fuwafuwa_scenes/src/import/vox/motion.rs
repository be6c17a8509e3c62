//! Rotations by right angles, reflections and translations.

/// Motion of a node: a rotation, which may contain a reflection, then a translation in voxels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Motion {
    /// Column of the entry that is not 0, for each row of the rotation matrix.
    axes: [u8; 3],
    /// Value of that entry, 1 or −1.
    signs: [i8; 3],
    translation: [i64; 3],
}

impl Motion {
    pub const NONE: Self = Self {
        axes: [0, 1, 2],
        signs: [1; 3],
        translation: [0; 3],
    };

    /// Creates a motion from a rotation packed in a byte, and a translation.
    ///
    /// ```text
    ///   bits 0-1  column of the entry that is not 0 in the first row of the matrix
    ///   bits 2-3  the same for the second row; the remaining column belongs to the third row
    ///   bits 4-6  whether the entry is −1, for each row
    /// ```
    ///
    /// Returns `None` if the byte is no rotation.
    pub fn of(rotation: u8, translation: [i32; 3]) -> Option<Self> {
        let (first, second) = (rotation & 3, rotation >> 2 & 3);
        if first == 3 || second == 3 || first == second {
            return None;
        }
        Some(Self {
            axes: [first, second, 3 - first - second],
            signs: [4, 5, 6].map(|bit| 1 - 2 * (rotation >> bit & 1) as i8),
            translation: translation.map(i64::from),
        })
    }

    /// Returns the motion that applies `inner` first, then `self`.
    pub fn after(&self, inner: &Self) -> Self {
        Self {
            axes: self.axes.map(|axis| inner.axes[usize::from(axis)]),
            signs: [0, 1, 2].map(|row| self.signs[row] * inner.signs[usize::from(self.axes[row])]),
            translation: self.moved(inner.translation),
        }
    }

    /// Moves a point.
    fn moved(&self, point: [i64; 3]) -> [i64; 3] {
        [0, 1, 2].map(|row| {
            let along = i64::from(self.signs[row]) * point[usize::from(self.axes[row])];
            along + self.translation[row]
        })
    }

    /// Moves the unit cube with its low corner at `voxel`. Returns the low corner of the moved cube.
    pub fn moved_voxel(&self, voxel: [i64; 3]) -> [i64; 3] {
        let [low, high] = [voxel, voxel.map(|k| k + 1)].map(|corner| self.moved(corner));
        [0, 1, 2].map(|axis| low[axis].min(high[axis]))
    }
}
