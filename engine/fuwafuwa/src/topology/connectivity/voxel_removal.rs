//! Removal of voxels.

use super::{Connectivity, EMPTY};
use crate::foundation::dim::{Dim, Point};

impl<D: Dim> Connectivity<D> {
    /// Removes voxels. At each point they must be whole groups, so that the remaining voxels keep their
    /// grouping.
    pub(crate) fn take_out(&mut self, voxels: &[Point]) {
        for &voxel in voxels {
            for octant in 0..D::CORNERS {
                // Lattice point around which the voxel is in this octant.
                let mut at = voxel;
                (0..D::N).for_each(|axis| at[axis] += 1 - (octant >> axis & 1) as i32);
                let index = self.index(at);
                self.groups[index].put(octant, EMPTY);
            }
        }
    }
}
