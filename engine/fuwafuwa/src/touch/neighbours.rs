//! Who is so close to whom in their piece that a search for all pairs may leave the two out: either their body
//! holds them at their distance, or they are lips of a crack, which are known without a search. And who sleeps beside sleepers.

use super::path::Traveller;
use super::sphere::{NEAR, SphereId};
use super::spheres::Spheres;
use crate::body::Bodies;
use crate::dim::Dim;
use crate::handle::BodySlot;
use crate::ids::Table;
use crate::lanes::LANES;
use fearless_simd::{prelude::*, u16x8, u32x8};
use std::ops::Range;

/// Where in which piece contact spheres are, in columns, so that eight can be asked at once.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    /// The number that the first piece of each body has among those of all.
    first: Table<BodySlot, u32>,
    /// Those of their pieces.
    pieces: Vec<u32>,
    /// The voxels, axis by axis.
    voxels: [Vec<u16>; 3],
    /// How many of those before each are awake.
    awake: Vec<u32>,
}

/// The piece and the voxel of one sphere.
#[derive(Copy, Clone, Debug)]
pub struct PieceSite {
    piece: u32,
    voxel: [u16; 3],
}

impl Neighbours {
    /// Those of some spheres, in their order.
    pub fn of<D: Dim>(travellers: &[Traveller], spheres: &Spheres, bodies: &Bodies<D>) -> Self {
        let mut neighbours = Self::default();
        let mut count = 0;
        for body in bodies.slots() {
            neighbours.first.push(count);
            count += body.map_or(0, |body| body.truth.pieces.list.len()) as u32;
        }
        neighbours.awake.push(0);
        // Eight can be read from the last on.
        neighbours.pieces.resize(travellers.len() + LANES, u32::MAX);
        for column in &mut neighbours.voxels {
            column.resize(travellers.len() + LANES, 0);
        }
        for (at, traveller) in travellers.iter().enumerate() {
            let PieceSite { piece, voxel } = neighbours.site(traveller.sphere, spheres);
            neighbours.pieces[at] = piece;
            (0..3).for_each(|axis| neighbours.voxels[axis][at] = voxel[axis]);
            let awake = neighbours.awake[at] + u32::from(!traveller.asleep);
            neighbours.awake.push(awake);
        }
        neighbours
    }

    /// That of a sphere.
    pub fn site(&self, sphere: SphereId, spheres: &Spheres) -> PieceSite {
        let sphere = &spheres.list[sphere];
        PieceSite {
            piece: self.first[sphere.body] + sphere.piece.0,
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

    /// Whether all at some places sleep: of a heap that does, only what somebody comes near to is looked at.
    #[inline(always)]
    pub fn are_asleep(&self, places: &Range<usize>) -> bool {
        self.awake[places.start] == self.awake[places.end]
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
