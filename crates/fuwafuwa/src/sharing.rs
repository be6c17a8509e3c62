//! For every lattice point, how the voxels around it are grouped: the truth about what is connected.
//!
//! Voxels of one group share a node at that point; releasing a node splits its group. Two voxels
//! with a common face are *closed* where they share a node at every point of that face. After a
//! release, the voxels at a point stay together only through closed faces, so that cracks which
//! meet join up and no hinge of a single node remains ([`Sharing::normalise`]).
//!
//! ```text
//!   a │ b        the crack came from below and ended at p: c and d are no longer closed, but
//!   ──p──        all four still share p, through c-a, a-b and b-d
//!   c ┃ d
//! ```

use crate::dim::{Dim, Point, neighbourhood, points_in, voxel_around};
use crate::grid::VoxelGrid;
use std::marker::PhantomData;

/// The label of a side of a lattice point where there is no voxel.
const EMPTY: u32 = 15;

/// A partition of the voxels around one lattice point; a group is named by its lowest octant.
///
/// Four bits an octant, 15 where there is no voxel.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Groups(u32);

impl Groups {
    /// No voxel at all.
    pub const NONE: Self = Self(u32::MAX);

    /// All octants of `solid` in one group.
    #[inline]
    pub fn joined(solid: u8) -> Self {
        let mut groups = Self::NONE;
        if solid != 0 {
            let name = solid.trailing_zeros();
            for octant in (0..8).filter(|octant| solid >> octant & 1 == 1) {
                groups.put(octant, name);
            }
        }
        groups
    }

    /// Every octant of `solid` in a group of its own.
    fn apart(solid: u8) -> Self {
        let mut groups = Self::NONE;
        for octant in (0..8).filter(|octant| solid >> octant & 1 == 1) {
            groups.put(octant, octant as u32);
        }
        groups
    }

    /// The octants that hold a voxel.
    #[inline]
    pub fn solid(self) -> u8 {
        (0..8).fold(0, |mask, octant| {
            mask | u8::from(self.name(octant) != EMPTY) << octant
        })
    }

    /// The octants that share a node with `octant`: 0 when there is no voxel.
    #[inline]
    pub fn group_of(self, octant: usize) -> u8 {
        let name = self.name(octant);
        if name == EMPTY {
            return 0;
        }
        (0..8).fold(0, |mask, other| {
            mask | u8::from(self.name(other) == name) << other
        })
    }

    /// Whether two octants hold voxels that share a node.
    #[inline]
    pub fn shares(self, a: usize, b: usize) -> bool {
        self.name(a) != EMPTY && self.name(a) == self.name(b)
    }

    /// The groups, each as a mask of octants, in ascending order of their lowest octant.
    pub fn iter(self) -> impl Iterator<Item = u8> {
        (0..8)
            .filter(move |&octant| self.name(octant) == octant as u32)
            .map(move |octant| self.group_of(octant))
    }

    /// Splits every group that has octants both inside and outside `side`; false when there is none.
    pub fn release(&mut self, side: u8) -> bool {
        let split = self.split(side);
        std::mem::replace(self, split) != split
    }

    fn split(self, side: u8) -> Self {
        let mut groups = Self::NONE;
        for octant in (0..8).filter(|&octant| self.name(octant) != EMPTY) {
            let mask = if side >> octant & 1 == 1 { side } else { !side };
            let name = (self.group_of(octant) & mask).trailing_zeros();
            groups.put(octant, name);
        }
        groups
    }

    fn join(&mut self, a: usize, b: usize) {
        let (low, high) = (
            self.name(a).min(self.name(b)),
            self.name(a).max(self.name(b)),
        );
        for octant in 0..8 {
            if self.name(octant) == high {
                self.put(octant, low);
            }
        }
    }

    #[inline]
    fn name(self, octant: usize) -> u32 {
        self.0 >> (4 * octant) & 15
    }

    #[inline]
    fn put(&mut self, octant: usize, name: u32) {
        self.0 = self.0 & !(15 << (4 * octant)) | name << (4 * octant);
    }
}

/// The grouping at every lattice point of a voxel grid.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Sharing<D: Dim> {
    /// Lattice points on each axis: one more than there are voxels (1 on the third axis in 2D).
    size: Point,
    groups: Vec<Groups>,
    dim: PhantomData<D>,
}

impl<D: Dim> Sharing<D> {
    /// The uncut body: voxels at a point are together when closed faces around it join them.
    pub fn new(grid: &VoxelGrid<D>) -> Self {
        let mut size = grid.size();
        size.iter_mut().take(D::N).for_each(|extent| *extent += 1);
        let high = [size[0] - 1, size[1] - 1, size[2] - 1];
        let groups = points_in([0; 3], high)
            .map(|at| {
                let solid = (0..D::CORNERS).fold(0u8, |mask, octant| {
                    mask | u8::from(grid.is_solid(voxel_around::<D>(at, octant))) << octant
                });
                Groups::joined(solid)
            })
            .collect();
        let dim = PhantomData;
        let mut sharing = Self { size, groups, dim };
        // Faces around a full point are closed until a neighbour changes.
        let is_partial = |&at: &Point| sharing.groups(at) != Groups::joined(D::ALL_CORNERS);
        let partial = sharing.points().filter(is_partial).collect();
        sharing.normalise(partial);
        sharing
    }

    /// Number of lattice points on each axis.
    pub fn size(&self) -> Point {
        self.size
    }

    /// All lattice points.
    pub fn points(&self) -> impl Iterator<Item = Point> + use<D> {
        points_in([0; 3], self.size.map(|extent| extent - 1))
    }

    /// Number of lattice points.
    pub fn point_count(&self) -> usize {
        self.groups.len()
    }

    /// Whether a point belongs to the lattice.
    #[inline]
    pub fn contains(&self, at: Point) -> bool {
        (0..3).all(|axis| at[axis] >= 0 && at[axis] < self.size[axis])
    }

    /// The place of a lattice point in memory order.
    #[inline]
    pub fn index(&self, at: Point) -> usize {
        ((at[2] * self.size[1] + at[1]) * self.size[0] + at[0]) as usize
    }

    /// The grouping at a point: nothing outside the lattice.
    #[inline]
    pub fn groups(&self, at: Point) -> Groups {
        if self.contains(at) {
            self.groups[self.index(at)]
        } else {
            Groups::NONE
        }
    }

    /// Whether the face between `octant` and its neighbour across `axis`, seen from the lattice
    /// point `at`, is closed: both voxels exist and share a node at all of its corners.
    pub fn is_closed(&self, at: Point, octant: usize, axis: usize) -> bool {
        let others: [usize; 2] = match (D::N, axis) {
            (2, axis) => [1 - axis, usize::MAX],
            (_, 0) => [1, 2],
            (_, 1) => [0, 2],
            _ => [0, 1],
        };
        (0..D::CORNERS / 2).all(|corner| {
            let (mut point, mut seen) = (at, octant);
            for (bit, &other) in others.iter().enumerate().take(D::N - 1) {
                if corner >> bit & 1 == 1 {
                    point[other] += (octant >> other & 1) as i32 * 2 - 1;
                    seen ^= 1 << other;
                }
            }
            self.groups(point).shares(seen, seen ^ 1 << axis)
        })
    }

    /// Whether a crack can start or go on at a point: some side is empty, it has more than one
    /// group, or one of the faces around it is open.
    pub fn is_open(&self, at: Point) -> bool {
        let groups = self.groups(at);
        if groups == Groups::NONE {
            return false;
        }
        let full = Groups::joined(D::ALL_CORNERS);
        // Where everything around is together no face is open: true of most points of a body.
        let is_near_a_gap = || neighbourhood::<D>(at, 1).any(|near| self.groups(near) != full);
        let is_open = |(octant, axis)| !self.is_closed(at, octant, axis);
        groups != full || is_near_a_gap() && faces_around::<D>().any(is_open)
    }

    /// Splits the groups at `at` into what lies in the octants of `side` and what does not.
    /// Returns whether anything changed; [`Sharing::normalise`] must follow.
    pub fn release(&mut self, at: Point, side: u8) -> bool {
        if !self.contains(at) {
            return false;
        }
        let index = self.index(at);
        self.groups[index].release(side)
    }

    /// Whether one that was read from a file groups the voxels of a grid, by closed faces alone.
    #[cfg(feature = "serde")]
    pub(crate) fn is_sound(&self, grid: &VoxelGrid<D>) -> bool {
        let whole = Self::new(grid);
        let is_grouping = |(&own, whole): (&Groups, &Groups)| {
            let groups = own.iter().map(|group| (group, group.trailing_zeros()));
            let named = groups.fold(Groups::NONE, |mut named, (group, name)| {
                let octants = (0..8).filter(|octant| group >> octant & 1 == 1);
                octants.for_each(|octant| named.put(octant, name));
                named
            });
            // What is no voxel has no group, and no group is larger than before anything was released.
            let is_part = |group: u8| {
                let of = whole.group_of(group.trailing_zeros() as usize);
                group & !of == 0
            };
            named == own && own.solid() == whole.solid() && own.iter().all(is_part)
        };
        self.size == whole.size
            && self.groups.len() == whole.groups.len()
            && self.groups.iter().zip(&whole.groups).all(is_grouping)
            && self.clone().normalise(self.points().collect()).is_empty()
    }

    /// Regroups the voxels at each point of `work`, and wherever that spreads, by closed faces
    /// alone. Returns the points that changed, in ascending order without repeats.
    pub fn normalise(&mut self, mut work: Vec<Point>) -> Vec<Point> {
        let mut changed = Vec::new();
        while let Some(at) = work.pop() {
            let old = self.groups(at);
            if old == Groups::NONE {
                continue;
            }
            let mut groups = Groups::apart(old.solid());
            for (octant, axis) in faces_around::<D>() {
                if self.is_closed(at, octant, axis) {
                    groups.join(octant, octant ^ 1 << axis);
                }
            }
            if groups != old {
                let index = self.index(at);
                self.groups[index] = groups;
                changed.push(at);
                work.extend(neighbourhood::<D>(at, 1));
            }
        }
        changed.sort_unstable_by_key(|&at| self.index(at));
        changed.dedup();
        changed
    }
}

/// The faces that meet in a lattice point, each as its low octant and its axis.
pub fn faces_around<D: Dim>() -> impl Iterator<Item = (usize, usize)> {
    (0..D::N).flat_map(|axis| {
        (0..D::CORNERS)
            .filter(move |octant| octant >> axis & 1 == 0)
            .map(move |octant| (octant, axis))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{Dim2, Dim3};

    #[test]
    fn voxels_that_meet_in_a_corner_only_do_not_share_it() {
        let diagonal = |at: Point| u8::from(at[0] == at[1]);
        let grid = VoxelGrid::<Dim2>::from_fn([2, 2, 1], 1.0, diagonal).unwrap();
        let sharing = Sharing::new(&grid);
        assert_eq!(sharing.groups([1, 1, 0]).iter().collect::<Vec<_>>(), [1, 8]);
    }

    #[test]
    fn a_crack_that_reaches_the_far_side_leaves_no_hinge() {
        // Release the middle column of a 4 x 2 block point by point: the last release parts it.
        let grid = VoxelGrid::<Dim2>::from_fn([4, 2, 1], 1.0, |_| 1).unwrap();
        let mut sharing = Sharing::new(&grid);
        assert!(sharing.release([2, 0, 0], 0b1010));
        sharing.normalise(vec![[2, 0, 0]]);
        assert_eq!(
            sharing.groups([2, 1, 0]),
            Groups::joined(15),
            "the crack ends at its tip"
        );
        assert!(sharing.release([2, 1, 0], 0b1010));
        let changed = sharing.normalise(neighbourhood::<Dim2>([2, 1, 0], 1).collect());
        assert_eq!(changed, [[2, 2, 0]], "the last node follows by itself");
        assert_eq!(sharing.groups([2, 2, 0]).iter().count(), 2);
    }

    #[test]
    fn an_open_face_makes_its_far_corners_open() {
        let grid = VoxelGrid::<Dim3>::cube(6, 1.0).unwrap();
        let mut sharing = Sharing::new(&grid);
        assert!(!sharing.is_open([3, 3, 3]));
        sharing.release([3, 3, 3], 0b1010_1010);
        sharing.normalise(neighbourhood::<Dim3>([3, 3, 3], 1).collect());
        assert_eq!(sharing.groups([3, 3, 3]).iter().count(), 2);
        // The four faces across x are open, so the points in that plane are the crack's front.
        assert!(sharing.is_open([3, 4, 4]) && sharing.is_open([3, 2, 3]));
        assert_eq!(
            sharing.groups([3, 4, 4]),
            Groups::joined(255),
            "still together there"
        );
        assert!(!sharing.is_open([4, 3, 3]));
    }
}
