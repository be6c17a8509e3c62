//! Who is so close to whom in their piece that a search for all pairs may leave the two out: either their body
//! holds them at their distance, or they are lips of a crack, which are known without a search.

use super::sphere::NEAR;
use super::spheres::Spheres;
use crate::body::Bodies;
use crate::dim::Dim;
use crate::lanes::LANES;
use fearless_simd::{prelude::*, u16x8, u32x8};

/// Where in which piece contact spheres are, in columns, so that eight can be asked at once.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    /// The number that the first piece of each body has among those of all.
    first: Vec<u32>,
    /// Those of their pieces.
    pieces: Vec<u32>,
    /// The voxels, axis by axis.
    voxels: [Vec<u16>; 3],
}

/// The piece and the voxel of one sphere.
#[derive(Copy, Clone, Debug)]
pub struct PieceSite {
    piece: u32,
    voxel: [u16; 3],
}

impl Neighbours {
    /// Those of the spheres at these places, in their order.
    pub fn of<D: Dim>(places: &[u32], spheres: &Spheres, bodies: &Bodies<D>) -> Self {
        let mut neighbours = Self::default();
        let mut count = 0;
        for body in bodies.places() {
            neighbours.first.push(count);
            count += body.map_or(0, |body| body.truth.pieces.list.len()) as u32;
        }
        // Eight can be read from the last on.
        neighbours.pieces.resize(places.len() + LANES, u32::MAX);
        for column in &mut neighbours.voxels {
            column.resize(places.len() + LANES, 0);
        }
        for (at, &place) in places.iter().enumerate() {
            let PieceSite { piece, voxel } = neighbours.site(place, spheres);
            neighbours.pieces[at] = piece;
            (0..3).for_each(|axis| neighbours.voxels[axis][at] = voxel[axis]);
        }
        neighbours
    }

    /// A sphere, given by its place among all.
    pub fn site(&self, place: u32, spheres: &Spheres) -> PieceSite {
        let sphere = &spheres.list[place as usize];
        PieceSite {
            piece: self.first[sphere.body as usize] + sphere.piece.0,
            voxel: sphere.voxel().map(|along| along as u16),
        }
    }

    /// The one so many places from the first.
    #[inline(always)]
    pub fn at(&self, at: usize) -> PieceSite {
        PieceSite {
            piece: self.pieces[at],
            voxel: self.voxels.each_ref().map(|column| column[at]),
        }
    }

    /// Which of the eight from the `first` on are neighbours of a sphere, as a mask.
    #[inline(always)]
    pub fn of_eight<S: Simd>(&self, simd: S, own: PieceSite, first: usize) -> u64 {
        let eight = first..first + LANES;
        let pieces = u32x8::from_slice(simd, &self.pieces[eight.clone()]);
        let same = pieces.simd_eq(own.piece).to_bitmask();
        if same == 0 {
            return 0;
        }
        // From 0 on where it is near: what is less wraps round.
        let along = |axis: usize| {
            let column = u16x8::from_slice(simd, &self.voxels[axis][eight.clone()]);
            column - u16x8::splat(simd, own.voxel[axis].wrapping_sub(NEAR))
        };
        let furthest = along(0).max(along(1)).max(along(2));
        same & furthest.simd_le(2 * NEAR).to_bitmask()
    }
}

impl PieceSite {
    /// Whether the two are neighbours.
    pub fn is_neighbour(&self, other: &Self) -> bool {
        let mut axes = self.voxel.iter().zip(other.voxel);
        self.piece == other.piece && axes.all(|(&own, other)| own.abs_diff(other) <= NEAR)
    }
}
