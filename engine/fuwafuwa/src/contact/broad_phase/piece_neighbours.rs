//! Neighbours: spheres of the same piece that are close at rest. The search for all pairs skips them, because
//! either elastic forces keep them apart, or they are on opposite crack faces, which are listed
//! separately. The module also finds ranges in which all spheres sleep.

use super::contact_sphere::{NEAR, SphereId};
use super::contact_spheres::Spheres;
use super::swept_path::SweptSphere;
use crate::foundation::arena::BodySlot;
use crate::foundation::dim::Dim;
use crate::foundation::ids::IndexVec;
use crate::math::lanes::LANES;
use crate::soft_body::SoftBodies;
use fearless_simd::{prelude::*, u16x8, u32x8};
use std::ops::Range;

/// Pieces and voxels of contact spheres, in columns, so that eight are compared at once.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    /// Number of each body's first piece among the pieces of all bodies.
    first: IndexVec<BodySlot, u32>,
    /// Piece of each sphere, numbered among the pieces of all bodies.
    pieces: Vec<u32>,
    /// Voxel coordinates, axis by axis.
    voxels: [Vec<u16>; 3],
    /// Number of awake spheres before each index. If it is equal at both ends of a range, all spheres in the
    /// range sleep.
    awake: Vec<u32>,
}

/// Piece and voxel of a sphere.
#[derive(Copy, Clone, Debug)]
pub struct PieceSite {
    piece: u32,
    voxel: [u16; 3],
}

impl Neighbours {
    /// Returns the table for swept spheres, in their order.
    pub fn of<D: Dim>(
        swept_spheres: &[SweptSphere],
        spheres: &Spheres,
        bodies: &SoftBodies<D>,
    ) -> Self {
        let mut neighbours = Self::default();
        let mut count = 0;
        for body in bodies.slots() {
            neighbours.first.push(count);
            count += body.map_or(0, |body| body.pieces().list.len()) as u32;
        }
        neighbours.awake.push(0);
        // Pads the columns, so that a SIMD read of eight values may start at any index.
        neighbours
            .pieces
            .resize(swept_spheres.len() + LANES, u32::MAX);
        for column in &mut neighbours.voxels {
            column.resize(swept_spheres.len() + LANES, 0);
        }
        for (at, swept) in swept_spheres.iter().enumerate() {
            let PieceSite { piece, voxel } = neighbours.site(swept.sphere, spheres);
            neighbours.pieces[at] = piece;
            (0..3).for_each(|axis| neighbours.voxels[axis][at] = voxel[axis]);
            let awake = neighbours.awake[at] + u32::from(!swept.asleep);
            neighbours.awake.push(awake);
        }
        neighbours
    }

    /// Returns the piece and voxel of a sphere.
    pub fn site(&self, sphere: SphereId, spheres: &Spheres) -> PieceSite {
        let sphere = &spheres.list[sphere];
        PieceSite {
            piece: self.first[sphere.body] + sphere.piece.0,
            voxel: sphere.voxel().map(|along| along as u16),
        }
    }

    /// Returns the piece and voxel of the sphere at index `at` of the columns.
    #[inline(always)]
    pub fn at(&self, at: usize) -> PieceSite {
        PieceSite {
            piece: self.pieces[at],
            voxel: self.voxels.each_ref().map(|column| column[at]),
        }
    }

    /// Returns whether all spheres in a range sleep. Two such ranges are not compared, so a sleeping heap
    /// costs comparisons only near awake spheres.
    #[inline(always)]
    pub fn are_asleep(&self, places: &Range<usize>) -> bool {
        self.awake[places.start] == self.awake[places.end]
    }

    /// Returns the mask of those among the eight spheres from index `first` on that are neighbours of the
    /// sphere at `own`.
    #[inline(always)]
    pub fn of_eight<S: Simd>(&self, simd: S, own: PieceSite, first: usize) -> u64 {
        let eight = first..first + LANES;
        let pieces = u32x8::from_slice(simd, &self.pieces[eight.clone()]);
        let same = pieces.simd_eq(own.piece).to_bitmask();
        if same == 0 {
            return 0;
        }
        // Coordinates relative to `own − NEAR`, the lowest coordinate of a neighbour. Lower coordinates wrap
        // around to large values, so that one comparison with 2 · NEAR tests both limits.
        let along = |axis: usize| {
            let column = u16x8::from_slice(simd, &self.voxels[axis][eight.clone()]);
            column - u16x8::splat(simd, own.voxel[axis].wrapping_sub(NEAR))
        };
        let furthest = along(0).max(along(1)).max(along(2));
        same & furthest.simd_le(2 * NEAR).to_bitmask()
    }
}

impl PieceSite {
    /// Returns whether two spheres are neighbours.
    pub fn is_neighbour(&self, other: &Self) -> bool {
        let mut axes = self.voxel.iter().zip(other.voxel);
        self.piece == other.piece && axes.all(|(&own, other)| own.abs_diff(other) <= NEAR)
    }
}
