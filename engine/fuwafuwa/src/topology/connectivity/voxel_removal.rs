//! Removal of voxels from the connectivity.

use super::{Connectivity, EMPTY};
use crate::foundation::dim::{Dim, Point};

impl<D: Dim> Connectivity<D> {
    /// Removes voxels. At each lattice point, the removed voxels must make up whole groups, so that the
    /// groups of the remaining voxels stay valid.
    pub(crate) fn remove_voxels(&mut self, voxels: &[Point]) {
        for &voxel in voxels {
            for octant in 0..D::CORNERS {
                // Lattice point that has the voxel in its octant `octant`.
                let mut at = voxel;
                (0..D::N).for_each(|axis| at[axis] += 1 - (octant >> axis & 1) as i32);
                let index = self.index(at);
                self.groups[index].put(octant, EMPTY);
            }
        }
    }
}
