//! Where in a body a place is: in which voxel, and where it was at rest.

use crate::body::Body;
use crate::dim::{Dim, Point, voxel_around};
use crate::ids::NodeId;
use crate::mesh::Element;
use crate::shape::Vector;
use crate::vector::{cross, length, minus};

/// From a voxel to the one that has a place leads a way of so many elements at most. A choice: from 2 to 12 all is cut as well.
const STEPS: usize = 6;
/// So far out of both of two elements [voxels] a place is still in one of them: neighbours differ by their bending.
/// A choice: from 0 to 0.5 all is cut as well.
const LITTLE: f32 = 0.25;

/// A place in a body.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Spot {
    /// The voxel that it is in.
    pub voxel: Point,
    /// Where it was at rest [voxels].
    pub at: Vector,
}

impl Spot {
    /// Where a place [m] is, looked for from a voxel on. Nothing when it is not in the body, or far from there.
    pub fn find<D: Dim>(body: &Body<D>, at: Vector, from: Point) -> Option<Self> {
        let mesh = &body.truth.mesh;
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
            if !body.truth.grid.is_solid(next) {
                return None;
            }
            if step + 1 == STEPS && distance::<D>(element, rest) <= LITTLE {
                return Some(Self { voxel, at: rest });
            }
            voxel = next;
        }
        None
    }

    /// Where a place [m] would be if all moved as here.
    pub fn extend<D: Dim>(&self, body: &Body<D>, at: Vector) -> Option<Vector> {
        body.at_rest(body.truth.mesh.element_at(self.voxel)?, at)
    }

    /// How fast the body moves there [m/s].
    pub fn velocity<D: Dim>(&self, body: &Body<D>) -> Option<Vector> {
        let element = body.truth.mesh.element_at(self.voxel)?;
        Some(body.velocity_of(&body.weights(element, self.at)))
    }

    /// Where directions of the world point in the body at rest, for the width of a voxel [voxels].
    pub fn directions<D: Dim, const COUNT: usize>(
        &self,
        body: &Body<D>,
        ways: [Vector; COUNT],
    ) -> Option<[Vector; COUNT]> {
        let (_, undo) = body.undo(body.truth.mesh.element_at(self.voxel)?)?;
        Some(ways.map(undo))
    }

    /// Whether it is within half a voxel of a place [m].
    pub fn is_near<D: Dim>(&self, body: &Body<D>, at: Vector) -> bool {
        let element = body.truth.mesh.element_at(self.voxel);
        let half = 0.5 * body.truth.grid.voxel_size();
        element.is_some_and(|element| length(minus(body.carry(element)(self.at), at)) <= half)
    }

    /// Whether the material is whole where an edge goes on that lies and cuts along these [voxels]: the face that it opens
    /// next is closed.
    pub fn is_whole_ahead<D: Dim>(&self, body: &Body<D>, along: Vector, toward: Vector) -> bool {
        let ahead = [0, 1, 2].map(|k: usize| self.at[k] + 0.5 * toward[k]);
        let Some(voxel) = voxel_of::<D>(ahead).filter(|&at| body.truth.grid.is_solid(at)) else {
            return false;
        };
        let normal = cross(along, toward);
        let steepest = |a: &usize, b: &usize| normal[*a].abs().total_cmp(&normal[*b].abs());
        let axis = (0..D::N).max_by(steepest).unwrap_or(0);
        // Where the swath crosses the line along the axis through the middle of the voxel, seen from there.
        let apart: f32 = (0..D::N)
            .map(|k| normal[k] * (ahead[k] - voxel[k] as f32 - 0.5))
            .sum();
        let crossing = (apart / normal[axis]).clamp(-2.0, 2.0);
        let mut before = voxel;
        before[axis] += crossing.floor() as i32;
        is_closed(body, before, axis)
    }
}

/// Whether the face after a voxel across an axis holds it and its neighbour together.
fn is_closed<D: Dim>(body: &Body<D>, voxel: Point, axis: usize) -> bool {
    let mut corner = voxel;
    corner[axis] += 1;
    // Seen from its low corner the voxel is in the octant that is low along the axis alone.
    let octant = (0..D::N)
        .filter(|&other| other != axis)
        .fold(0, |octant, other| octant | 1 << other);
    debug_assert_eq!(voxel_around::<D>(corner, octant), voxel);
    body.truth.sharing.around(corner).is_closed(octant, axis)
}

/// The voxel that has a place, however far from a body it is.
fn voxel_of<D: Dim>(at: Vector) -> Option<Point> {
    let mut voxel = [0; 3];
    for axis in 0..D::N {
        if at[axis].abs() > 1e6 || at[axis].is_nan() {
            return None;
        }
        voxel[axis] = at[axis].floor() as i32;
    }
    Some(voxel)
}

/// Whether an element may have a place [m] in it: whether it is in the box around its nodes, or little out of it.
pub fn may_have<D: Dim>(body: &Body<D>, element: &Element, at: Vector) -> bool {
    let margin = LITTLE * body.truth.grid.voxel_size() * element.cell.width() as f32;
    (0..D::N).all(|axis| {
        let apart = |&node: &NodeId| body.state.position[node][axis] - at[axis];
        let apart = element.nodes.iter().map(apart);
        let (low, high) = apart.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), k| {
            (low.min(k), high.max(k))
        });
        low <= margin && high >= -margin
    })
}

/// How far a place is out of the cell of an element [voxels].
fn distance<D: Dim>(element: &Element, at: Vector) -> f32 {
    let (low, width) = (element.cell.first_voxel(), element.cell.width() as f32);
    let out = |axis: usize| {
        let along = at[axis] - low[axis] as f32;
        (-along).max(along - width)
    };
    (0..D::N).map(out).fold(0.0, f32::max)
}
