//! Contact sphere of a surface element.

use crate::foundation::arena::BodySlot;
use crate::foundation::dim::{Dim, Point};
use crate::foundation::ids::{ElementId, Id, IndexVec, NodeId, PieceId, id};
use crate::soft_body::element_forces::Row;
use crate::soft_body::{SoftBodies, SoftBody};

/// Maximum distance of neighbours in a piece on each axis at rest [voxels]. It covers the search distance of
/// resting spheres, 1 + MARGIN + 2 SLACK = 2 voxels. With less, adjacent surface elements would be listed as
/// pairs all the time.
pub const NEAR: u16 = 2;

id! {
    /// Number of a contact sphere among those of all bodies.
    pub SphereId
}

impl SphereId {
    /// Marks a missing sphere.
    pub const NONE: Self = Self(u32::MAX);
}

/// Contact sphere of a surface element.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ContactSphere {
    /// Slot of the body.
    pub body: BodySlot,
    /// Element id.
    pub element: ElementId,
    /// Piece number.
    pub piece: PieceId,
    /// Radius: half a voxel [m].
    pub radius: f32,
    /// Whether the piece sleeps.
    pub asleep: bool,
    /// Bare faces: bit 2 · axis + side.
    bare: u8,
    /// Voxel of the element.
    voxel: [i16; 3],
    /// Neighbouring voxels that share a node with this one: bit x + 3 y + 9 z, with coordinates from 0 to 2.
    bound: u32,
    /// Corner nodes; only the first four in 2D.
    pub nodes: [NodeId; 8],
}

/// Returns the mean of the rows of a sphere's corner nodes.
#[inline(always)]
pub fn mean<D: Dim, I: Id>(rows: &IndexVec<I, Row>, nodes: &[I; 8]) -> Row {
    let mut sum = rows[nodes[0]];
    for &node in &nodes[1..D::CORNERS] {
        sum += rows[node];
    }
    sum * (1.0 / D::CORNERS as f32)
}

impl ContactSphere {
    /// Returns the contact sphere of an element, if the element is at the surface.
    pub fn of<D: Dim>(slot: BodySlot, body: &SoftBody<D>, id: ElementId) -> Option<Self> {
        let bare = body.exposed_faces(id)?;
        if bare == 0 {
            return None;
        }
        let element = body.mesh().element(id)?;
        let mut nodes = [NodeId(0); 8];
        nodes[..D::CORNERS].copy_from_slice(&element.nodes);
        let piece = body.pieces().of_element(id);
        Some(Self {
            body: slot,
            element: id,
            piece,
            radius: 0.5 * body.grid().voxel_size(),
            asleep: body.pieces().list[piece].asleep,
            bare,
            voxel: element.cell.at.map(|k| k as i16),
            bound: body.connected_voxels(id),
            nodes,
        })
    }

    /// Returns the stable key: body and element.
    pub fn key(&self) -> (BodySlot, ElementId) {
        (self.body, self.element)
    }

    /// Returns the voxel of the element.
    pub fn voxel(&self) -> Point {
        self.voxel.map(i32::from)
    }

    /// Returns the location of the sphere in its body.
    pub fn site(&self) -> Site {
        Site {
            body: self.body,
            voxel: self.voxel,
            bound: self.bound,
        }
    }

    /// Returns the mean of a quantity over the corner nodes.
    #[inline]
    pub fn mean<D: Dim>(&self, rows: &IndexVec<NodeId, Row>) -> Row {
        mean::<D, _>(rows, &self.nodes)
    }

    /// Returns whether the voxel of the sphere is a crumb: a piece of its own.
    pub fn is_crumb<D: Dim>(&self) -> bool {
        self.bare.count_ones() as usize == 2 * D::N
    }

    /// Returns whether a bare face has no bare face opposite, so that the sphere has an outward direction.
    pub fn leads_out(&self) -> bool {
        (self.bare ^ self.bare >> 1) & 0b1_0101 != 0
    }

    /// Returns the vector from the centre out of the body through the bare faces [m]; 0 for a crumb or a
    /// sheet.
    pub fn outward<D: Dim>(&self, position: &IndexVec<NodeId, Row>) -> Row {
        let mut sum = Row::ZERO;
        for corner in 0..D::CORNERS {
            let is_bare = |axis: usize, side: usize| f32::from(self.bare >> (2 * axis + side) & 1);
            // Each bare face adds the vector from the centre of the element to the centre of the face, which
            // is half the vector between opposite faces.
            let weight: f32 = (0..D::N)
                .map(|axis| {
                    let out = is_bare(axis, 1) - is_bare(axis, 0);
                    if corner >> axis & 1 == 1 { out } else { -out }
                })
                .sum();
            let at = position[self.nodes[corner]];
            sum += at * (weight / D::CORNERS as f32);
        }
        sum
    }

    /// Returns the inverse effective mass of the sphere [1/kg].
    #[inline]
    pub fn inverse_mass<D: Dim>(&self, bodies: &SoftBodies<D>) -> f32 {
        let all = bodies.at(self.body).inverse_masses();
        let nodes = self.nodes[..D::CORNERS].iter();
        let sum: f32 = nodes.map(|&node| all[node]).sum();
        sum / (D::CORNERS * D::CORNERS) as f32
    }
}

/// Location of a sphere's element in its body, and its connections to neighbouring voxels.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Site {
    pub body: BodySlot,
    pub voxel: [i16; 3],
    /// Copy of [`ContactSphere::bound`].
    pub bound: u32,
}

impl Site {
    /// Returns whether the body itself keeps two spheres apart, so that no contact is required. This is true
    /// for neighbours that share a node, and for spheres one voxel apart if each shares a node with the same
    /// voxel between them.
    ///
    /// ```text
    ///   a─u─b   held      a┃b   not held: opposite crack faces,     a┃ ┃b   not held: a slot
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

/// Table for [`Site::is_held_to`]: a mask and a rotation for each offset of up to two voxels per axis,
/// indexed x + 5 y + 25 z from −2. The mask holds the voxels that are around both spheres and can connect
/// them, seen from the first. For direct neighbours it holds only the second voxel, because each sphere's own
/// bits include its voxel. The rotation aligns the bits of the second sphere with those of the first.
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

/// Bit of the voxel itself in a mask.
const MIDDLE: i32 = 13;
