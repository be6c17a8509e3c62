//! Cuts: along a segment in 2D, along a parallelogram in 3D.
//!
//! A blade separates two neighbouring voxels if the line between their present centres crosses the blade. The
//! nodes that the voxels share are then released, as in a tear.

use crate::foundation::dim::{Dim, Dim2, Dim3, DimVector, Point, voxel_around};
use crate::foundation::ids::PieceId;
use crate::soft_body::SoftBody;
use crate::topology::cell_hierarchy::Grading;
use crate::topology::changes::Changes;
use crate::topology::connectivity::faces_around;
use glam::{Vec2, Vec3};
use std::collections::BTreeSet;
use std::marker::PhantomData;

/// Area that is cut at once: a segment in 2D, a parallelogram in 3D.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Blade<D: Dim> {
    /// Corner of the area [m]; in 2D the beginning of the segment, with the third coordinate −0.5.
    corner: Vec3,
    /// Edge of the area, as a vector from `corner` [m]; in 2D the segment.
    across: Vec3,
    /// Second edge of the area, as a vector from `corner` [m]; in 2D the unit vector of the third axis.
    along: Vec3,
    dim: PhantomData<D>,
}

impl Blade<Dim2> {
    /// Returns a blade that cuts from one point [m] to another.
    pub fn segment(from: Vec2, to: Vec2) -> Self {
        Self {
            corner: from.extend(-0.5),
            across: (to - from).extend(0.0),
            along: Vec3::Z,
            dim: PhantomData,
        }
    }
}

impl Blade<Dim3> {
    /// Returns a parallelogram with a corner [m] and the two edge vectors [m] that begin there.
    pub fn parallelogram(corner: Vec3, first: Vec3, second: Vec3) -> Self {
        Self {
            corner,
            across: first,
            along: second,
            dim: PhantomData,
        }
    }
}

impl<D: Dim> Blade<D> {
    /// Returns the area that an edge [m] sweeps when it moves by a vector [m]. In 2D only the midpoint of the edge is
    /// used.
    pub fn swept(edge: [D::Vector; 2], by: D::Vector) -> Self {
        let [from, to] = edge.map(|end| end.to_vec3());
        let (corner, along) = match D::N {
            2 => (0.5 * (from + to) - 0.5 * Vec3::Z, Vec3::Z),
            _ => (from, to - from),
        };
        Self {
            corner,
            across: by.to_vec3(),
            along,
            dim: PhantomData,
        }
    }

    /// Returns whether the line segment between two points [m] crosses the blade.
    fn crosses(&self, a: Vec3, b: Vec3) -> bool {
        let normal = self.across.cross(self.along);
        let (over, under) = (normal.dot(a - self.corner), normal.dot(b - self.corner));
        if (over > 0.0) == (under > 0.0) {
            return false;
        }
        let meeting = a + (b - a) * (over / (over - under));
        let reach = meeting - self.corner;
        let squared = normal.dot(normal);
        let first = reach.cross(self.along).dot(normal);
        let second = self.across.cross(reach).dot(normal);
        (0.0..=squared).contains(&first) && (0.0..=squared).contains(&second)
    }
}

/// Result of a cut.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CutReport<D: Dim> {
    /// Positions of the nodes that were split [m].
    pub split_nodes: Vec<D::Vector>,
    /// Numbers of the detached pieces.
    pub detached: Vec<PieceId>,
}

impl<D: Dim> SoftBody<D> {
    /// Cuts the body along a blade. Does nothing to a body with `Grading::Coarse`.
    #[inline(never)]
    pub fn cut(&mut self, blade: &Blade<D>) -> CutReport<D> {
        if self.grading() == Grading::Coarse {
            return CutReport::default();
        }
        let (released, changes) = self.open(&self.faces_across(blade));
        CutReport {
            split_nodes: released.into_iter().map(D::Vector::from_vec3).collect(),
            detached: changes.detached,
        }
    }

    /// Opens faces between voxels, each given by the voxel on its low side and its axis, and releases the
    /// nodes there. Returns the positions of the released nodes [m], and the changes of the body's topology.
    pub(crate) fn open(&mut self, opened: &BTreeSet<(Point, usize)>) -> (Vec<Vec3>, Changes) {
        let mut points: BTreeSet<Point> = BTreeSet::new();
        for &(voxel, axis) in opened {
            for corner in 0..D::CORNERS / 2 {
                points.insert(corner_of_face::<D>(voxel, axis, corner));
            }
        }
        let mut releases = Vec::new();
        for &at in &points {
            releases.extend(self.sides(at, opened).into_iter().map(|side| (at, side)));
        }
        let positions = releases.iter().filter_map(|&(at, _)| self.position_of(at));
        let released = positions.collect();
        (released, self.tear(&releases))
    }

    /// Separates all voxels, so that only pieces of one voxel remain. Returns the detached pieces.
    #[inline(never)]
    pub fn crumble(&mut self) -> Vec<PieceId> {
        let octants = |at: Point| (0..D::CORNERS).map(move |octant| (at, 1 << octant));
        let everything: Vec<(Point, u8)> = self.connectivity().points().flat_map(octants).collect();
        self.release(&everything)
    }

    /// Returns the closed or open faces between voxels that a blade crosses, each given by the voxel on its
    /// low side and its axis.
    fn faces_across(&self, blade: &Blade<D>) -> BTreeSet<(Point, usize)> {
        let mut middles = vec![None; self.grid().voxels().count()];
        for (_, element) in self.mesh().elements() {
            let carry = self.affine_map(element);
            for voxel in self.mesh().voxels(element) {
                let middle = carry(voxel.map(|k| k as f32 + 0.5).into());
                middles[self.grid().index(voxel)] = Some(middle);
            }
        }
        let mut crossed = BTreeSet::new();
        for voxel in self.grid().voxels() {
            let Some(here) = middles[self.grid().index(voxel)] else {
                continue;
            };
            for axis in 0..D::N {
                let mut next = voxel;
                next[axis] += 1;
                if !self.grid().is_present(next) {
                    continue;
                }
                let there =
                    middles[self.grid().index(next)].expect("every remaining voxel has an owner");
                if blade.crosses(here, there) {
                    crossed.insert((voxel, axis));
                }
            }
        }
        crossed
    }

    /// Returns the present position of a lattice point [m], interpolated in one of the elements around the
    /// point.
    fn position_of(&self, at: Point) -> Option<Vec3> {
        let voxels = (0..D::CORNERS).map(|octant| voxel_around::<D>(at, octant));
        let owner = { voxels }.find_map(|voxel| self.mesh().owner(voxel))?;
        Some(self.affine_map(self.mesh().element(owner)?)(
            at.map(|k| k as f32).into(),
        ))
    }

    /// Returns the releases at a lattice point that open the faces `opened` there. Each release is a mask of
    /// octants that is separated from the other octants. The result is empty if the faces are open already.
    fn sides(&self, at: Point, opened: &BTreeSet<(Point, usize)>) -> Vec<u8> {
        let around = self.connectivity().around(at);
        let mut groups = around.middle();
        let solid = groups.solid();
        let mut sides: Vec<u8> = (0..D::CORNERS)
            .filter(|octant| solid >> octant & 1 == 1)
            .map(|octant| 1 << octant)
            .collect();
        for (octant, axis) in faces_around::<D>() {
            let face = (voxel_around::<D>(at, octant), axis);
            if opened.contains(&face) || !around.is_closed(octant, axis) {
                continue;
            }
            let (a, b) = (1u8 << octant, 1u8 << (octant ^ 1 << axis));
            let (joined, others): (Vec<u8>, Vec<u8>) =
                sides.into_iter().partition(|side| side & (a | b) != 0);
            sides = others;
            sides.push(joined.into_iter().fold(0, |all, side| all | side));
        }
        sides.sort_unstable();
        sides.retain(|&side| groups.release(side));
        sides
    }
}

/// Returns the lattice point at corner number `corner`, from 0, of the face on the high side of a voxel along
/// `axis`.
fn corner_of_face<D: Dim>(voxel: Point, axis: usize, corner: usize) -> Point {
    let mut at = voxel;
    at[axis] += 1;
    for (bit, other) in (0..D::N).filter(|&other| other != axis).enumerate() {
        at[other] += (corner >> bit & 1) as i32;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Dim2, Dim3};

    #[test]
    fn swept_edge_is_a_segment_in_2d_and_a_parallelogram_in_3d() {
        let (from, by) = (Vec2::new(0.25, -0.5), Vec2::new(0.5, 0.125));
        let ends = [from - Vec2::Y, from + Vec2::Y];
        let swept = Blade::<Dim2>::swept(ends, by);
        assert_eq!(swept, Blade::segment(from, from + by));

        let (low, high) = (Vec3::new(0.1, -0.4, 0.2), Vec3::new(0.1, 0.4, 0.3));
        let by = Vec3::new(0.7, 0.0, -0.2);
        let swept = Blade::<Dim3>::swept([low, high], by);
        assert!(swept.crosses(Vec3::new(0.4, 0.0, -1.0), Vec3::new(0.4, 0.0, 1.0)));
        assert!(!swept.crosses(Vec3::new(0.9, 0.0, -1.0), Vec3::new(0.9, 0.0, 1.0)));
        assert!(!swept.crosses(Vec3::new(0.4, 0.6, -1.0), Vec3::new(0.4, 0.6, 1.0)));
        let other = Blade::parallelogram(low, high - low, by);
        for k in 0..20 {
            let at = Vec3::new(0.05 * k as f32, 0.07 * (k as f32 - 10.0), 0.0);
            let [a, b] = [at - Vec3::Z, at + Vec3::Z];
            assert_eq!(swept.crosses(a, b), other.crosses(a, b), "{at}");
        }
    }
}
