//! Rest positions of world-space points in a body.

use crate::foundation::dim::{Dim, Point, voxel_around};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::NodeId;
use crate::soft_body::SoftBody;
use crate::topology::mesh::Element;
use glam::Vec3;

/// Maximum number of elements that [`MaterialPoint::find`] visits.
const STEPS: usize = 6;
/// Distance outside of an element's cell up to which a point counts as inside [voxels]. Neighbouring elements
/// deform differently, so without this tolerance a point between two cells could be outside of both.
const CELL_TOLERANCE: f32 = 0.25;

/// Point that moves with the material of a body.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MaterialPoint {
    /// Voxel that contains the point in the undeformed body.
    pub voxel: Point,
    /// Rest position [voxels].
    pub at: Vec3,
}

hash_state! { struct MaterialPoint { voxel, at } }

impl MaterialPoint {
    /// Finds the material point at a world-space position [m]. Begins in the voxel `from` and walks from
    /// element to element. Returns `None` if the position is not in the body, or more than `STEPS` elements
    /// away from the start.
    pub fn find<D: Dim>(body: &SoftBody<D>, at: Vec3, from: Point) -> Option<Self> {
        let mesh = body.mesh();
        let mut voxel = from;
        for step in 0..STEPS {
            let owner = mesh.owner(voxel)?;
            let element = mesh.element(owner)?;
            let rest = body.at_rest(element, at)?;
            let next = voxel_of::<D>(rest)?;
            if mesh.owner(next) == Some(owner) {
                return Some(Self {
                    voxel: next,
                    at: rest,
                });
            }
            if !body.grid().is_solid(next) {
                return None;
            }
            if step + 1 == STEPS && distance::<D>(element, rest) <= CELL_TOLERANCE {
                return Some(Self { voxel, at: rest });
            }
            voxel = next;
        }
        None
    }

    /// Returns the rest position of a world-space position [m], extrapolated with the deformation of the
    /// element that contains this material point.
    pub fn extend<D: Dim>(&self, body: &SoftBody<D>, at: Vec3) -> Option<Vec3> {
        body.at_rest(body.mesh().element_at(self.voxel)?, at)
    }

    /// Returns the velocity of the body at this point [m/s].
    pub fn velocity<D: Dim>(&self, body: &SoftBody<D>) -> Option<Vec3> {
        let element = body.mesh().element_at(self.voxel)?;
        Some(body.velocity_of(&body.weights(element, self.at)))
    }

    /// Maps world-space directions to rest coordinates: undoes the rotation and strain of the element at this
    /// point. A direction of length 1 has length 1 [voxels] after this if the element is unstrained.
    pub fn rest_directions<D: Dim, const COUNT: usize>(
        &self,
        body: &SoftBody<D>,
        ways: [Vec3; COUNT],
    ) -> Option<[Vec3; COUNT]> {
        let (_, undo) = body.inverse_deformation(body.mesh().element_at(self.voxel)?)?;
        Some(ways.map(undo))
    }

    /// Returns whether this material point is within half a voxel of a world-space position [m].
    pub fn is_near<D: Dim>(&self, body: &SoftBody<D>, at: Vec3) -> bool {
        let element = body.mesh().element_at(self.voxel);
        let half = 0.5 * body.grid().voxel_size();
        element.is_some_and(|element| (body.affine_map(element)(self.at) - at).length() <= half)
    }

    /// Returns whether the material in front of an edge is uncut: whether the next face that the edge would
    /// open is still closed. `along` and `toward` are the direction of the edge and the cutting direction, in
    /// rest coordinates [voxels].
    pub fn is_uncut_ahead<D: Dim>(&self, body: &SoftBody<D>, along: Vec3, toward: Vec3) -> bool {
        let ahead = self.at + toward * 0.5;
        let Some(voxel) = voxel_of::<D>(ahead).filter(|&at| body.grid().is_solid(at)) else {
            return false;
        };
        let normal = along.cross(toward);
        let steepest = |a: &usize, b: &usize| normal[*a].abs().total_cmp(&normal[*b].abs());
        let axis = (0..D::N).max_by(steepest).unwrap_or(0);
        // Signed distance from the centre of the voxel to the plane that the edge sweeps, times the length of
        // `normal`. Divided by `normal[axis]`, it is the distance along the axis [voxels].
        let apart: f32 = (0..D::N)
            .map(|k| normal[k] * (ahead[k] - voxel[k] as f32 - 0.5))
            .sum();
        let crossing = (apart / normal[axis]).clamp(-2.0, 2.0);
        let mut before = voxel;
        before[axis] += crossing.floor() as i32;
        is_closed(body, before, axis)
    }
}

/// Returns whether the face on the high side of a voxel along an axis is closed.
fn is_closed<D: Dim>(body: &SoftBody<D>, voxel: Point, axis: usize) -> bool {
    let mut corner = voxel;
    corner[axis] += 1;
    // Seen from this corner, the voxel is on the low side along `axis` and on the high side along all other
    // axes.
    let octant = (0..D::N)
        .filter(|&other| other != axis)
        .fold(0, |octant, other| octant | 1 << other);
    debug_assert_eq!(voxel_around::<D>(corner, octant), voxel);
    body.connectivity().around(corner).is_closed(octant, axis)
}

/// Returns the voxel that contains a rest position; `None` beyond 1e6 voxels or if a coordinate is NaN.
fn voxel_of<D: Dim>(at: Vec3) -> Option<Point> {
    let mut voxel = [0; 3];
    for axis in 0..D::N {
        if at[axis].abs() > 1e6 || at[axis].is_nan() {
            return None;
        }
        voxel[axis] = at[axis].floor() as i32;
    }
    Some(voxel)
}

/// Returns whether an element may contain a world-space point [m]: whether the point is in the box around the
/// element's nodes, enlarged by a margin.
pub fn may_contain<D: Dim>(body: &SoftBody<D>, element: &Element, at: Vec3) -> bool {
    let margin = CELL_TOLERANCE * body.grid().voxel_size() * element.cell.width() as f32;
    (0..D::N).all(|axis| {
        let apart = |&node: &NodeId| body.positions()[node][axis] - at[axis];
        let apart = element.nodes.iter().map(apart);
        let (low, high) = apart.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), k| {
            (low.min(k), high.max(k))
        });
        low <= margin && high >= -margin
    })
}

/// Returns the largest distance along an axis of a rest position from the cell of an element [voxels]; 0
/// inside the cell.
fn distance<D: Dim>(element: &Element, at: Vec3) -> f32 {
    let (low, width) = (element.cell.first_voxel(), element.cell.width() as f32);
    let out = |axis: usize| {
        let along = at[axis] - low[axis] as f32;
        (-along).max(along - width)
    };
    (0..D::N).map(out).fold(0.0, f32::max)
}
