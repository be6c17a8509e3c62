//! Contact sphere of a surface element.

use crate::foundation::arena::BodySlot;
use crate::foundation::dim::{Dim, Point};
use crate::foundation::ids::{ElementId, Id, IndexVec, NodeId, PieceId, id};
use crate::soft_body::element_forces::Row;
use crate::soft_body::{SoftBodies, SoftBody};

/// Maximum distance along each axis, in the undeformed body, between two spheres of a piece that count as
/// neighbours [voxels]. The full search for pairs skips neighbours. Its search distance is 1 + MARGIN + 2
/// SLACK = 2 voxels. With a smaller `NEAR`, it would list adjacent elements of an undeformed surface.
pub const NEAR: u16 = 2;

id! {
    /// Number of a contact sphere among the spheres of all bodies.
    pub SphereId
}

impl SphereId {
    /// Value that stands for no sphere.
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
    /// Radius: half the width of a voxel [m].
    pub radius: f32,
    /// Whether the sphere's piece sleeps.
    pub asleep: bool,
    /// Bit mask of the bare faces of the voxel. On each axis, bit 2 · axis is the face on the low side, and
    /// bit 2 · axis + 1 the face on the high side.
    exposed_faces: u8,
    /// Voxel of the element.
    voxel: [i16; 3],
    /// Bit mask of the voxels around the sphere's voxel that share a node with that voxel. Bit x + 3 y + 9 z
    /// stands for the voxel at the offset (x − 1, y − 1, z − 1).
    connected_voxels: u32,
    /// Corner nodes of the element; in 2D only the first four are used.
    pub nodes: [NodeId; 8],
}

/// Returns the mean over a sphere's corner nodes of a quantity that `rows` holds for each node.
#[inline(always)]
pub fn mean<D: Dim, I: Id>(rows: &IndexVec<I, Row>, nodes: &[I; 8]) -> Row {
    let mut sum = rows[nodes[0]];
    for &node in &nodes[1..D::CORNERS] {
        sum += rows[node];
    }
    sum * (1.0 / D::CORNERS as f32)
}

impl ContactSphere {
    /// Returns the contact sphere of an element; `None` if the element is not at the surface.
    pub fn of<D: Dim>(slot: BodySlot, body: &SoftBody<D>, id: ElementId) -> Option<Self> {
        let exposed_faces = body.exposed_faces(id)?;
        if exposed_faces == 0 {
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
            exposed_faces,
            voxel: element.cell.at.map(|k| k as i16),
            connected_voxels: body.connected_voxels(id),
            nodes,
        })
    }

    /// Returns the body and element of the sphere. They identify the sphere, also after its number has
    /// changed.
    pub fn key(&self) -> (BodySlot, ElementId) {
        (self.body, self.element)
    }

    /// Returns the voxel of the element.
    pub fn voxel(&self) -> Point {
        self.voxel.map(i32::from)
    }

    /// Returns the voxel of the sphere, and which voxels around that voxel share a node with it.
    pub fn site(&self) -> Site {
        Site {
            body: self.body,
            voxel: self.voxel,
            connected_voxels: self.connected_voxels,
        }
    }

    /// Returns the mean over the sphere's corner nodes of a quantity that `rows` holds for each node.
    #[inline]
    pub fn mean<D: Dim>(&self, rows: &IndexVec<NodeId, Row>) -> Row {
        mean::<D, _>(rows, &self.nodes)
    }

    /// Returns the velocity of the sphere [m/s]: the mean velocity of its corner nodes.
    #[inline]
    pub fn velocity<D: Dim>(&self, bodies: &SoftBodies<D>) -> Row {
        self.mean::<D>(bodies.at(self.body).velocities())
    }

    /// Returns whether the voxel of the sphere is a crumb: a piece of its own.
    pub fn is_crumb<D: Dim>(&self) -> bool {
        self.exposed_faces.count_ones() as usize == 2 * D::N
    }

    /// Returns whether the sphere has an outward direction: whether on some axis exactly one face of its
    /// voxel is bare.
    pub fn leads_out(&self) -> bool {
        (self.exposed_faces ^ self.exposed_faces >> 1) & 0b1_0101 != 0
    }

    /// Returns the sum of the vectors from the centre of the element to its bare faces [m], which points out
    /// of the body. It is 0 if every bare face has a bare face opposite, as in a crumb or a sheet.
    pub fn outward<D: Dim>(&self, position: &IndexVec<NodeId, Row>) -> Row {
        let mut sum = Row::ZERO;
        for corner in 0..D::CORNERS {
            let is_bare =
                |axis: usize, side: usize| f32::from(self.exposed_faces >> (2 * axis + side) & 1);
            // Each bare face adds the vector from the centre of the element to the centre of that face. This
            // vector is half the vector from the opposite face to the bare one.
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

    /// Returns the inverse effective mass of the sphere [1/kg], for an impulse spread evenly over its corner
    /// nodes.
    #[inline]
    pub fn inverse_mass<D: Dim>(&self, bodies: &SoftBodies<D>) -> f32 {
        let all = bodies.at(self.body).inverse_masses();
        let nodes = self.nodes[..D::CORNERS].iter();
        let sum: f32 = nodes.map(|&node| all[node]).sum();
        sum / (D::CORNERS * D::CORNERS) as f32
    }
}

/// Voxel of a sphere, and its connections to the voxels around it.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Site {
    pub body: BodySlot,
    pub voxel: [i16; 3],
    /// Copy of [`ContactSphere::connected_voxels`].
    pub connected_voxels: u32,
}

impl Site {
    /// Returns whether elastic forces keep the spheres of two voxels a and b apart, so that no contact is
    /// required. If a and b are adjacent, this is true if they share a node. If they are two voxels apart, it
    /// is true if both share a node with the same voxel u between them.
    ///
    /// ```text
    ///   a─u─b   held      a┃b   not held: a and b are on       a   b   not held: there is
    ///                     u┃u   opposite crack faces           u   u   no voxel between a and b
    ///                     u─u                                  u─u─u
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
        self.connected_voxels & other.connected_voxels.rotate_left(turn) & common != 0
    }
}

/// Table for [`Site::is_held_to`]: a mask and a rotation for each offset of the second voxel from the first,
/// up to two voxels per axis. The entry of the offset (x, y, z) has the index (x + 2) + 5 (y + 2) + 25 (z +
/// 2). The mask selects, among the 27 voxels around the first voxel, those that touch both voxels. If the two
/// voxels are adjacent, the mask selects only the second voxel, because [`Site::connected_voxels`] includes a
/// sphere's own voxel. The rotation aligns the bits of the second sphere's `connected_voxels` with those of
/// the first.
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

/// Bit of a sphere's own voxel in a mask of the 27 voxels around the sphere.
const MIDDLE: i32 = 13;
