//! Who is so close to whom in their piece that no search in space is needed: either their body holds the two at
//! their distance, or they are lips of a crack, which the body knows.

use super::spheres::Spheres;
use crate::body::Body;
use crate::dim::Dim;
use crate::lanes::LANES;
use fearless_simd::{prelude::*, u16x8, u32x8};

/// Where in which piece contact spheres are, in columns, so that eight can be asked at once.
#[derive(Clone, Debug, Default)]
pub struct Kin {
    /// The number that the first piece of each body has among those of all.
    first: Vec<u32>,
    /// Those of their pieces.
    pieces: Vec<u32>,
    /// The voxels, axis by axis.
    voxels: [Vec<u16>; 3],
}

/// The piece and the voxel of one sphere.
#[derive(Copy, Clone, Debug)]
pub struct Relative {
    piece: u32,
    voxel: [u16; 3],
}

impl Kin {
    /// Those of the spheres at these places, in their order.
    pub fn of<D: Dim>(places: &[u32], spheres: &Spheres, bodies: &[Body<D>]) -> Self {
        let mut kin = Self::default();
        let mut count = 0;
        for body in bodies {
            kin.first.push(count);
            count += body.pieces.list.len() as u32;
        }
        // Eight can be read from the last on.
        kin.pieces.resize(places.len() + LANES, u32::MAX);
        for column in &mut kin.voxels {
            column.resize(places.len() + LANES, 0);
        }
        for (at, &place) in places.iter().enumerate() {
            let Relative { piece, voxel } = kin.relative(place, spheres);
            kin.pieces[at] = piece;
            (0..3).for_each(|axis| kin.voxels[axis][at] = voxel[axis]);
        }
        kin
    }

    /// A sphere, given by its place among all.
    pub fn relative(&self, place: u32, spheres: &Spheres) -> Relative {
        let sphere = &spheres.list[place as usize];
        Relative {
            piece: self.first[sphere.body as usize] + sphere.piece,
            voxel: sphere.voxel().map(|along| along as u16),
        }
    }

    /// The one so many places from the first.
    #[inline(always)]
    pub fn at(&self, at: usize) -> Relative {
        Relative {
            piece: self.pieces[at],
            voxel: self.voxels.each_ref().map(|column| column[at]),
        }
    }

    /// Which of the eight from the `first` on are of the same piece as a sphere and no more than two
    /// voxels away from it on any axis, as a mask.
    #[inline(always)]
    pub fn of_eight<S: Simd>(&self, simd: S, own: Relative, first: usize) -> u64 {
        let eight = first..first + LANES;
        let pieces = u32x8::from_slice(simd, &self.pieces[eight.clone()]);
        let same = pieces.simd_eq(own.piece).to_bitmask();
        if same == 0 {
            return 0;
        }
        // From 0 to 4 where it is near: what is less wraps round.
        let along = |axis: usize| {
            let column = u16x8::from_slice(simd, &self.voxels[axis][eight.clone()]);
            column - u16x8::splat(simd, own.voxel[axis].wrapping_sub(2))
        };
        let furthest = along(0).max(along(1)).max(along(2));
        same & furthest.simd_le(4).to_bitmask()
    }
}

impl Relative {
    /// Whether the two are of one piece, and no more than two voxels apart on any axis.
    pub fn is_near(&self, other: &Self) -> bool {
        let mut axes = self.voxel.iter().zip(other.voxel);
        self.piece == other.piece && axes.all(|(&own, other)| own.abs_diff(other) <= 2)
    }
}
