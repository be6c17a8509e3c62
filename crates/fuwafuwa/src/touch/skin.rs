//! The ball that stands for the skin of a surface element, and where it stands in its body.

use crate::body::Body;
use crate::dim::{Dim, Point, voxel_around};
use crate::sharing::Sharing;
use crate::solve::Row;
use crate::vector::{plus, scaled};

/// The ball around a surface element that stands for its skin.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Skin {
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
    /// Its corner nodes; the first four in 2D.
    pub nodes: [u32; 8],
}

/// Where a skin stands in its body: what tells neighbours from those that may touch it.
#[derive(Copy, Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Site {
    body: u32,
    /// The voxels around it that shared a node with it when its nodes last changed: bit x + 3 y + 9 z,
    /// each from 0 to 2. If one of two skins says no, they share none: what is cut changes.
    bound: u32,
    /// Its voxel.
    cell: [i16; 3],
}

/// The mean of the rows of a skin's corner nodes.
#[inline(always)]
pub fn mean<D: Dim>(rows: &[Row], nodes: &[u32; 8]) -> Row {
    let mut sum = rows[nodes[0] as usize];
    for &node in &nodes[1..D::CORNERS] {
        sum = plus(sum, rows[node as usize]);
    }
    scaled(sum, 1.0 / D::CORNERS as f32)
}

impl Skin {
    /// The mean of something at its corners.
    #[inline]
    pub fn mean<D: Dim>(&self, rows: &[Row]) -> Row {
        mean::<D>(rows, &self.nodes)
    }

    /// The same skin in the piece that its element is of now.
    pub fn followed<D: Dim>(&self, bodies: &[Body<D>]) -> Self {
        let pieces = &bodies[self.body as usize].pieces;
        let piece = pieces.of_element(self.element);
        let asleep = pieces.list[piece as usize].asleep;
        Self {
            piece,
            asleep,
            ..*self
        }
    }

    /// Whether its piece sleeps now.
    pub fn sleeps<D: Dim>(&self, bodies: &[Body<D>]) -> bool {
        let pieces = &bodies[self.body as usize].pieces;
        pieces.list[self.piece as usize].asleep
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
    pub fn inverse_mass<D: Dim>(&self, bodies: &[Body<D>]) -> f32 {
        let all = &bodies[self.body as usize].inverse_mass;
        let nodes = self.nodes[..D::CORNERS].iter();
        let sum: f32 = nodes.map(|&node| all[node as usize]).sum();
        sum / (D::CORNERS * D::CORNERS) as f32
    }

    /// Body and element in one number.
    pub fn key(&self) -> u64 {
        u64::from(self.body) << 32 | u64::from(self.element)
    }
}

impl Site {
    /// That of a voxel in the body of this number.
    pub fn new<D: Dim>(body: u32, voxel: Point, sharing: &Sharing<D>) -> Self {
        let mut bound = 0;
        for octant in 0..D::CORNERS {
            // The lattice point that sees the voxel in this octant.
            let mut at = voxel;
            (0..D::N).for_each(|axis| at[axis] += 1 - (octant >> axis & 1) as i32);
            let group = sharing.groups(at).group_of(octant);
            for other in (0..D::CORNERS).filter(|other| group >> other & 1 == 1) {
                let near = voxel_around::<D>(at, other);
                let [x, y, z] = [0, 1, 2].map(|axis: usize| near[axis] - voxel[axis] + 1);
                bound |= 1 << (x + 3 * y + 9 * z);
            }
        }
        Self {
            body,
            bound,
            cell: voxel.map(|k| k as i16),
        }
    }

    /// Its voxel.
    pub fn voxel(&self) -> Point {
        self.cell.map(i32::from)
    }

    /// Whether both have a node in common.
    #[inline(always)]
    pub fn is_bound_to(&self, other: &Self) -> bool {
        let [x, y, z] = [0, 1, 2].map(|axis: usize| other.cell[axis] - self.cell[axis] + 1);
        let is_beside = |k: i16| (0..3).contains(&k);
        if self.body != other.body || !(is_beside(x) && is_beside(y) && is_beside(z)) {
            return false;
        }
        let bit = x + 3 * y + 9 * z;
        self.bound >> bit & other.bound >> (26 - bit) & 1 == 1
    }
}

/// The skins of a body, which stands at a place among all, each with its voxel.
pub fn skins_of<D: Dim>(
    (place, body): (usize, &Body<D>),
) -> impl Iterator<Item = (Skin, Point)> + '_ {
    let ids = body.mesh.elements().map(|(id, _)| id);
    ids.filter_map(move |id| skin_of(place as u32, body, id))
}

/// The skin of an element of a body, if it has one, and its voxel.
pub fn skin_of<D: Dim>(place: u32, body: &Body<D>, id: u32) -> Option<(Skin, Point)> {
    let element = body.mesh.element(id)?;
    let bare = body.bare[id as usize];
    if bare == 0 {
        return None;
    }
    let mut nodes = [0; 8];
    nodes[..D::CORNERS].copy_from_slice(&element.nodes);
    let piece = body.pieces.of_element(id);
    let skin = Skin {
        body: place,
        element: id,
        piece,
        radius: 0.5 * body.grid.voxel_size(),
        asleep: body.pieces.list[piece as usize].asleep,
        bare,
        nodes,
    };
    Some((skin, element.cell.at))
}
