//! Voxels that are taken out.

use super::{EMPTY, Sharing};
use crate::dim::{Dim, Point};

impl<D: Dim> Sharing<D> {
    /// Takes voxels out: whole groups, so that who is left is grouped as before.
    pub(crate) fn take_out(&mut self, voxels: &[Point]) {
        for &voxel in voxels {
            for octant in 0..D::CORNERS {
                // The lattice point that sees the voxel in this octant.
                let mut at = voxel;
                (0..D::N).for_each(|axis| at[axis] += 1 - (octant >> axis & 1) as i32);
                let index = self.index(at);
                self.groups[index].put(octant, EMPTY);
            }
        }
    }
}
