//! The ball that stands for a surface element where bodies touch each other.

use crate::body::{Bodies, Body};
use crate::dim::{Dim, Point};
use crate::handle::BodySlot;
use crate::ids::{ElementId, Id, NodeId, PieceId, Table, id};
use crate::solve::Row;
use crate::vector::{plus, scaled};

/// Neighbours are of one piece, and no more than so many voxels apart on any axis as it was built: as far as paths are looked
/// for at rest, 1 + MARGIN + 2 STRAY widths of a voxel. With fewer a skin would be listed as close to itself all the time.
pub const NEAR: u16 = 2;

id! {
    /// The number of a contact sphere among those of all bodies.
    pub SphereId
}

impl SphereId {
    /// That of none.
    pub const NONE: Self = Self(u32::MAX);
}

/// The ball around a surface element.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ContactSphere {
    /// The slot of its body.
    pub body: BodySlot,
    /// Element id.
    pub element: ElementId,
    /// Piece number.
    pub piece: PieceId,
    /// Half a voxel [m].
    pub radius: f32,
    /// Whether its piece sleeps.
    pub asleep: bool,
    /// Its bare faces: bit 2 · axis + side.
    bare: u8,
    /// Its voxel.
    voxel: [i16; 3],
    /// The voxels around it that share a node with it: bit x + 3 y + 9 z, each from 0 to 2.
    bound: u32,
    /// Its corner nodes; the first four in 2D.
    pub nodes: [NodeId; 8],
}

/// The mean of the rows of a sphere's corner nodes.
#[inline(always)]
pub fn mean<D: Dim, I: Id>(rows: &Table<I, Row>, nodes: &[I; 8]) -> Row {
    let mut sum = rows[nodes[0]];
    for &node in &nodes[1..D::CORNERS] {
        sum = plus(sum, rows[node]);
    }
    scaled(sum, 1.0 / D::CORNERS as f32)
}

impl ContactSphere {
    /// That of an element of the body in a slot, if it is at the surface.
    pub fn of<D: Dim>(slot: BodySlot, body: &Body<D>, id: ElementId) -> Option<Self> {
        let bare = *body.cache.bare.get(id.index())?;
        if bare == 0 {
            return None;
        }
        let element = body.truth.mesh.element(id)?;
        let mut nodes = [NodeId(0); 8];
        nodes[..D::CORNERS].copy_from_slice(&element.nodes);
        let piece = body.truth.pieces.of_element(id);
        Some(Self {
            body: slot,
            element: id,
            piece,
            radius: 0.5 * body.truth.grid.voxel_size(),
            asleep: body.truth.pieces.list[piece].asleep,
            bare,
            voxel: element.cell.at.map(|k| k as i16),
            bound: body.cache.bound[id],
            nodes,
        })
    }

    /// Body and element.
    pub fn key(&self) -> (BodySlot, ElementId) {
        (self.body, self.element)
    }

    /// Its voxel.
    pub fn voxel(&self) -> Point {
        self.voxel.map(i32::from)
    }

    /// Where in its body it is.
    pub fn site(&self) -> Site {
        Site {
            body: self.body,
            voxel: self.voxel,
            bound: self.bound,
        }
    }

    /// The mean of something at its corners.
    #[inline]
    pub fn mean<D: Dim>(&self, rows: &Table<NodeId, Row>) -> Row {
        mean::<D, _>(rows, &self.nodes)
    }

    /// Whether it is a piece of its own.
    pub fn is_crumb<D: Dim>(&self) -> bool {
        self.bare.count_ones() as usize == 2 * D::N
    }

    /// Whether a bare face of it has none opposite.
    pub fn leads_out(&self) -> bool {
        (self.bare ^ self.bare >> 1) & 0b1_0101 != 0
    }

    /// From its middle out of the body, through the bare faces; nothing for a crumb or a sheet.
    pub fn outward<D: Dim>(&self, position: &Table<NodeId, Row>) -> Row {
        let mut sum = [0.0; 4];
        for corner in 0..D::CORNERS {
            let is_bare = |axis: usize, side: usize| f32::from(self.bare >> (2 * axis + side) & 1);
            // The middle of a face less that of all corners: half a step across.
            let weight: f32 = (0..D::N)
                .map(|axis| {
                    let out = is_bare(axis, 1) - is_bare(axis, 0);
                    if corner >> axis & 1 == 1 { out } else { -out }
                })
                .sum();
            let at = position[self.nodes[corner]];
            sum = plus(sum, scaled(at, weight / D::CORNERS as f32));
        }
        sum
    }

    /// One over the mass that a push on it meets [1/kg].
    #[inline]
    pub fn inverse_mass<D: Dim>(&self, bodies: &Bodies<D>) -> f32 {
        let all = &bodies.at(self.body).state.inverse_mass;
        let nodes = self.nodes[..D::CORNERS].iter();
        let sum: f32 = nodes.map(|&node| all[node]).sum();
        sum / (D::CORNERS * D::CORNERS) as f32
    }
}

/// Where in its body the element of a sphere is, and what it hangs together with there.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Site {
    pub body: BodySlot,
    pub voxel: [i16; 3],
    /// As of the sphere.
    pub bound: u32,
}

impl Site {
    /// Whether the body itself keeps the two at their distance, so that contact need not: neighbours
    /// that share a node, and those one voxel apart that each share one with the same voxel between
    /// them.
    ///
    /// ```text
    ///   a─u─b   held      a┃b   not held: the lips of a crack,      a┃ ┃b   not held: a slot
    ///                     u─u   though u holds both                 u───u
    /// ```
    #[inline(always)]
    pub fn is_held_to(&self, other: &Self) -> bool {
        if self.body != other.body {
            return false;
        }
        let along = |axis: usize| {
            let step = i32::from(other.voxel[axis]) - i32::from(self.voxel[axis]);
            (step + 2).clamp(-1, 5) as u32
        };
        let (x, y, z) = (along(0), along(1), along(2));
        if x.max(y).max(z) > 4 {
            return false;
        }
        let (common, turn) = COMMON[(x + 5 * y + 25 * z) as usize];
        self.bound & other.bound.rotate_left(turn) & common != 0
    }
}

/// For each way from a voxel to another one no more than two steps away on any axis, x + 5 y + 25 z from
/// −2: the voxels around the first that can bind the two, which are also around the second, and by how much
/// bits for the second are turned to stand where they do for the first. Of neighbours it is the second
/// itself, which each has among those that it is bound to.
const COMMON: [(u32, u32); 125] = common();

const fn common() -> [(u32, u32); 125] {
    let mut all = [(0, 0); 125];
    let mut way = 0;
    while way < 125 {
        let step = [way % 5 - 2, way / 5 % 5 - 2, way / 25 - 2];
        let shift = step[0] + 3 * step[1] + 9 * step[2];
        let is_near = step[0] * step[0] <= 1 && step[1] * step[1] <= 1 && step[2] * step[2] <= 1;
        let mut seen = 0;
        let mut bit = 0;
        while bit < 27 {
            let at = [bit % 3 - step[0], bit / 3 % 3 - step[1], bit / 9 - step[2]];
            let is_seen =
                at[0] >= 0 && at[0] < 3 && at[1] >= 0 && at[1] < 3 && at[2] >= 0 && at[2] < 3;
            if is_seen && (!is_near || bit == MIDDLE + shift) {
                seen |= 1 << bit;
            }
            bit += 1;
        }
        all[way as usize] = (seen, shift.rem_euclid(32) as u32);
        way += 1;
    }
    all
}

/// The bit of the voxel itself among those around it.
const MIDDLE: i32 = 13;
