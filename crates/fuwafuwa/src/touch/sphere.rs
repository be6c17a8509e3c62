//! The ball that stands for a surface element where bodies touch each other.

use crate::body::Body;
use crate::dim::Dim;
use crate::solve::Row;
use crate::vector::{plus, scaled};

/// The ball around a surface element.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ContactSphere {
    /// Place among the bodies.
    pub body: u32,
    /// Element id.
    pub element: u32,
    /// Piece number.
    pub piece: u32,
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
    pub nodes: [u32; 8],
}

/// The mean of the rows of a sphere's corner nodes.
#[inline(always)]
pub fn mean<D: Dim>(rows: &[Row], nodes: &[u32; 8]) -> Row {
    let mut sum = rows[nodes[0] as usize];
    for &node in &nodes[1..D::CORNERS] {
        sum = plus(sum, rows[node as usize]);
    }
    scaled(sum, 1.0 / D::CORNERS as f32)
}

impl ContactSphere {
    /// That of an element of the body at a place among all, if it is at the surface.
    pub fn of<D: Dim>(place: u32, body: &Body<D>, id: u32) -> Option<Self> {
        let bare = body.bare[id as usize];
        if bare == 0 {
            return None;
        }
        let element = body.mesh.element(id)?;
        let mut nodes = [0; 8];
        nodes[..D::CORNERS].copy_from_slice(&element.nodes);
        let piece = body.pieces.of_element(id);
        Some(Self {
            body: place,
            element: id,
            piece,
            radius: 0.5 * body.grid.voxel_size(),
            asleep: body.pieces.list[piece as usize].asleep,
            bare,
            voxel: element.cell.at.map(|k| k as i16),
            bound: body.bound[id as usize],
            nodes,
        })
    }

    /// Body and element.
    pub fn key(&self) -> (u32, u32) {
        (self.body, self.element)
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
    pub fn mean<D: Dim>(&self, rows: &[Row]) -> Row {
        mean::<D>(rows, &self.nodes)
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
    pub fn outward<D: Dim>(&self, position: &[Row]) -> Row {
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
            let at = position[self.nodes[corner] as usize];
            sum = plus(sum, scaled(at, weight / D::CORNERS as f32));
        }
        sum
    }

    /// One over the mass that a push on it meets [1/kg].
    #[inline]
    pub fn inverse_mass<D: Dim>(&self, bodies: &[Body<D>]) -> f32 {
        let all = &bodies[self.body as usize].inverse_mass;
        let nodes = self.nodes[..D::CORNERS].iter();
        let sum: f32 = nodes.map(|&node| all[node as usize]).sum();
        sum / (D::CORNERS * D::CORNERS) as f32
    }
}

/// Where in its body the element of a sphere is, and what it hangs together with there.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Site {
    pub body: u32,
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
        let along = |axis: usize| i32::from(other.voxel[axis]) - i32::from(self.voxel[axis]);
        let step = [0, 1, 2].map(along);
        let [x, y, z] = step.map(i32::abs);
        let shift = step[0] + 3 * step[1] + 9 * step[2];
        match x.max(y).max(z) {
            0 | 1 => self.bound >> (MIDDLE + shift) & 1 == 1,
            2 => {
                let [x, y, z] = [0, 1, 2].map(|axis: usize| SEEN[axis][(step[axis] + 2) as usize]);
                let theirs = match shift {
                    0.. => other.bound << shift,
                    _ => other.bound >> -shift,
                };
                self.bound & theirs & x & y & z != 0
            }
            _ => false,
        }
    }
}

/// The bit of the voxel itself among those around it.
const MIDDLE: i32 = 13;

/// Of the voxels around one, those that are also around another one, which is −2 to 2 steps away on
/// an axis.
const SEEN: [[u32; 5]; 3] = [seen(0), seen(1), seen(2)];

const fn seen(axis: u32) -> [u32; 5] {
    let mut masks = [0; 5];
    let mut bit = 0;
    while bit < 27 {
        let along = (bit / 3u32.pow(axis) % 3) as i32;
        let mut step = -2;
        while step <= 2 {
            if along - step >= 0 && along - step < 3 {
                masks[(step + 2) as usize] |= 1 << bit;
            }
            step += 1;
        }
        bit += 1;
    }
    masks
}
