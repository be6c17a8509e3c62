//! Connectivity: the grouping of the voxels around every lattice point.
//!
//! Voxels of one group share a node at the lattice point; a release splits a group, and so the node. A face
//! between two voxels is *closed* if the voxels share a node at every corner of that face. After a release,
//! voxels stay in one group only if closed faces connect them. Therefore cracks that meet join up, and no two
//! parts of a body are connected by a single node ([`Connectivity::normalise`]).
//!
//! ```text
//!   a │ b        the crack came from below and ended at p: c and d are no longer closed, but
//!   ──p──        all four still share p, through c-a, a-b and b-d
//!   c ┃ d
//! ```

mod voxel_removal;
use crate::foundation::dim::{Dim, FAR, Point, add, neighbourhood, points_in, voxel_around};
use crate::foundation::hash::{Hash, HashState, hash_state};
use crate::foundation::id_lists::ascending;
use crate::foundation::ids::id;
use crate::topology::grid::VoxelGrid;
use std::marker::PhantomData;
/// Group name that marks an octant without a voxel in [`Groups`].
const EMPTY: u32 = 15;

/// Partition of the voxels around one lattice point into groups. The voxels of a group share a node.
///
/// Each octant has four bits for the name of its group. The name is the number of the lowest octant in the
/// group, or 15 if the octant has no voxel.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Groups(u32);

impl HashState for Groups {
    #[inline]
    fn hash_state(&self, hash: &mut Hash) {
        let Self(mask) = self;
        mask.hash_state(hash);
    }
}

impl Groups {
    /// Groups of a lattice point without voxels.
    pub const NONE: Self = Self(u32::MAX);

    /// Returns groups in which all octants of the mask `solid` form a single group.
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

    /// Returns groups in which each octant of the mask `solid` forms a group of its own.
    fn apart(solid: u8) -> Self {
        let mut groups = Self::NONE;
        for octant in (0..8).filter(|octant| solid >> octant & 1 == 1) {
            groups.put(octant, octant as u32);
        }
        groups
    }

    /// Returns the mask of the octants with a voxel.
    #[inline]
    pub fn solid(self) -> u8 {
        !self.named(EMPTY)
    }

    /// Returns the mask of the octants in the group of `octant`, itself included; 0 if `octant` has no voxel.
    #[inline]
    pub fn group_of(self, octant: usize) -> u8 {
        match self.name(octant) {
            EMPTY => 0,
            name => self.named(name),
        }
    }

    /// Returns whether both octants have voxels, and these voxels share a node.
    #[inline]
    pub fn shares(self, a: usize, b: usize) -> bool {
        self.name(a) != EMPTY && self.name(a) == self.name(b)
    }

    /// Returns the groups as masks of octants, ascending by their lowest octant.
    pub fn iter(self) -> impl Iterator<Item = u8> {
        (0..8)
            .filter(move |&octant| self.name(octant) == octant as u32)
            .map(move |octant| self.group_of(octant))
    }

    /// Splits each group that has octants both inside and outside the mask `side`. Returns false if there is
    /// no such group.
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

    /// Returns the mask of the octants whose group has the name `name`.
    #[inline]
    fn named(self, name: u32) -> u8 {
        // XOR makes the four bits of an octant 0 if its group has this name. The following steps combine the
        // four bits of each octant into one bit, and collect these bits in the lowest byte.
        let mut other = self.0 ^ (name * 0x1111_1111);
        other |= other >> 2;
        other |= other >> 1;
        let mut fits = !other & 0x1111_1111;
        fits = (fits | fits >> 3) & 0x0303_0303;
        fits = (fits | fits >> 6) & 0x000f_000f;
        (fits | fits >> 12) as u8
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

id! {
    /// Index of a lattice point in memory order.
    PointId
}

/// Groups of the voxels at every lattice point of a grid.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Connectivity<D: Dim> {
    /// Number of lattice points on each axis: the number of voxels + 1, or 1 on the third axis in 2D.
    size: Point,
    groups: Vec<Groups>,
    dim: PhantomData<D>,
}

hash_state! { [D: Dim] struct Connectivity<D> { size, groups } skip { dim } }

impl<D: Dim> Connectivity<D> {
    /// Returns the connectivity of the uncut body: voxels at a lattice point form one group if closed faces
    /// around the point connect them.
    #[inline(never)]
    pub fn new(grid: &VoxelGrid<D>) -> Self {
        let mut size = grid.size();
        size.iter_mut().take(D::N).for_each(|extent| *extent += 1);
        let high = [size[0] - 1, size[1] - 1, size[2] - 1];
        let groups = points_in([0; 3], high)
            .map(|at| {
                let solid = (0..D::CORNERS).fold(0u8, |mask, octant| {
                    mask | u8::from(grid.is_present(voxel_around::<D>(at, octant))) << octant
                });
                Groups::joined(solid)
            })
            .collect();
        let dim = PhantomData;
        let mut connectivity = Self { size, groups, dim };
        // Only points with an empty octant can need regrouping at first. If the groups at such a point
        // change, `normalise` continues with the neighbouring points.
        let is_partial = |&at: &Point| connectivity.groups(at) != Groups::joined(D::ALL_CORNERS);
        let partial = connectivity.points().filter(is_partial).collect();
        connectivity.normalise(partial);
        connectivity
    }

    /// Returns the number of lattice points on each axis.
    pub fn size(&self) -> Point {
        self.size
    }

    /// Returns all lattice points.
    pub fn points(&self) -> impl Iterator<Item = Point> + use<D> {
        points_in([0; 3], self.size.map(|extent| extent - 1))
    }

    /// Returns the number of lattice points.
    pub fn point_count(&self) -> usize {
        self.groups.len()
    }

    /// Returns whether a point lies in the lattice of this grid.
    #[inline]
    pub fn contains(&self, at: Point) -> bool {
        (0..3).all(|axis| at[axis] >= 0 && at[axis] < self.size[axis])
    }

    /// Returns the index of a lattice point in memory order.
    #[inline]
    pub fn index(&self, at: Point) -> usize {
        ((at[2] * self.size[1] + at[1]) * self.size[0] + at[0]) as usize
    }

    /// Returns the groups at a lattice point; [`Groups::NONE`] outside the lattice.
    #[inline]
    pub fn groups(&self, at: Point) -> Groups {
        if self.contains(at) {
            self.groups[self.index(at)]
        } else {
            Groups::NONE
        }
    }

    /// Returns the mask of those voxels in the 3 × 3 (× 3) block around a solid voxel that share a node with
    /// the voxel. The voxel itself is included. Bit x + 3 y + 9 z stands for the voxel at the offset (x − 1,
    /// y − 1, z − 1).
    pub fn connected_voxels(&self, voxel: Point) -> u32 {
        let mut bound = 0;
        for octant in 0..D::CORNERS {
            // Lattice point that has the voxel in its octant `octant`.
            let mut at = voxel;
            (0..D::N).for_each(|axis| at[axis] += 1 - (octant >> axis & 1) as i32);
            let group = self.groups(at).group_of(octant);
            for other in (0..D::CORNERS).filter(|other| group >> other & 1 == 1) {
                let near = voxel_around::<D>(at, other);
                let [x, y, z] = [0, 1, 2].map(|axis: usize| near[axis] - voxel[axis] + 1);
                bound |= 1 << (x + 3 * y + 9 * z);
            }
        }
        bound
    }

    /// Returns the groups at a lattice point and at its neighbouring lattice points.
    pub fn around(&self, at: Point) -> PointNeighbourhood<D> {
        let mut groups = [Groups::NONE; 27];
        let is_inner = (0..D::N).all(|axis| at[axis] > 0 && at[axis] + 1 < self.size[axis]);
        if is_inner {
            // Lattice points along the first axis are adjacent in memory, so three are copied at once.
            let below = D::depth(3) as i32 / 2;
            for (row, three) in groups[..D::SLOTS].chunks_exact_mut(3).enumerate() {
                let (y, z) = (row as i32 % 3 - 1, row as i32 / 3 - below);
                let first = self.index(add(at, [-1, y, z]));
                three.copy_from_slice(&self.groups[first..first + 3]);
            }
        } else {
            for (groups, near) in groups.iter_mut().zip(neighbourhood::<D>(at, 1)) {
                *groups = self.groups(near);
            }
        }
        PointNeighbourhood {
            groups,
            dim: PhantomData,
        }
    }

    /// Returns the given lattice points and their neighbouring lattice points, each once, in memory order.
    pub fn all_around(&self, points: &[Point]) -> Vec<Point> {
        let near = { points.iter() }.flat_map(|&point| neighbourhood::<D>(point, 1));
        self.each_once(near.filter(|&near| self.contains(near)))
    }

    /// Sorts lattice points in memory order and removes duplicates.
    pub fn each_once(&self, points: impl Iterator<Item = Point>) -> Vec<Point> {
        let ids = points.map(|at| PointId(self.index(at) as u32));
        let ids = ascending(ids, self.point_count()).into_iter();
        ids.map(|id| self.point(id)).collect()
    }

    fn point(&self, id: PointId) -> Point {
        let ([x, y, _], place) = (self.size, id.index() as i32);
        [place % x, place / x % y, place / x / y]
    }

    /// Returns whether a crack can start or continue at a lattice point: an octant around the point is empty,
    /// the point has more than one group, or a face around the point is not closed.
    pub fn is_open(&self, at: Point) -> bool {
        self.around(at).is_open()
    }

    /// Splits each group at the lattice point `at` into its octants inside and outside the mask `side`.
    /// Returns whether a group was split. The caller must then call [`Connectivity::normalise`].
    pub fn release(&mut self, at: Point, side: u8) -> bool {
        if !self.contains(at) {
            return false;
        }
        let index = self.index(at);
        self.groups[index].release(side)
    }

    /// Returns whether connectivity read from a file is valid: it groups exactly the voxels of `grid`, and
    /// the voxels of each group are connected by closed faces.
    #[cfg(feature = "serde")]
    pub(crate) fn is_valid(&self, grid: &VoxelGrid<D>) -> bool {
        let whole = Self::new(grid);
        let is_grouping = |(&own, whole): (&Groups, &Groups)| {
            let groups = own.iter().map(|group| (group, group.trailing_zeros()));
            let named = groups.fold(Groups::NONE, |mut named, (group, name)| {
                let octants = (0..8).filter(|octant| group >> octant & 1 == 1);
                octants.for_each(|octant| named.put(octant, name));
                named
            });
            // Exactly the octants with a voxel must have groups, and each group must lie in one group of the
            // uncut body.
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

    /// Splits the groups at each lattice point of `work` into parts that closed faces connect. If this
    /// changes a point, continues with its neighbouring points. Returns the changed points, each once, in
    /// memory order.
    #[inline(never)]
    pub fn normalise(&mut self, mut work: Vec<Point>) -> Vec<Point> {
        let mut changed = Vec::new();
        while let Some(at) = work.pop() {
            let around = self.around(at);
            let groups = around.joined_by_faces();
            if groups != around.middle() {
                let index = self.index(at);
                self.groups[index] = groups;
                changed.push(at);
                work.extend(neighbourhood::<D>(at, 1));
            }
        }
        self.each_once(changed.into_iter())
    }
}

/// Groups at a lattice point and at its neighbouring lattice points. They determine which of the voxels
/// around the point exist, and which of the faces between these voxels are closed.
#[derive(Copy, Clone, Debug)]
pub struct PointNeighbourhood<D: Dim> {
    /// Groups at the 9 or 27 lattice points, the first axis fastest; the central point is in the middle.
    groups: [Groups; 27],
    dim: PhantomData<D>,
}

impl<D: Dim> PointNeighbourhood<D> {
    /// Difference between the indices in `groups` of lattice points that are neighbours along each axis.
    const STEPS: [usize; 3] = [1, 3, 9];

    /// Returns the groups at the central lattice point.
    pub fn middle(&self) -> Groups {
        self.groups[D::SLOTS / 2]
    }

    /// Returns whether the face between the voxel in `octant` of the central lattice point and the next voxel
    /// across `axis` is closed: both voxels exist and share a node at all corners of the face.
    #[inline]
    pub fn is_closed(&self, octant: usize, axis: usize) -> bool {
        self.is_closed_from(D::SLOTS / 2, octant, axis)
    }

    /// Returns whether the voxel in `octant` of the central lattice point has a closed face on the side along
    /// `axis` that faces away from the point.
    #[inline]
    pub fn is_far_face_closed(&self, octant: usize, axis: usize) -> bool {
        let from = Self::towards(D::SLOTS / 2, octant, axis);
        self.is_closed_from(from, octant ^ 1 << axis, axis)
    }

    /// Returns, for each axis, the mask of the octants on the low side of a closed face that is perpendicular
    /// to the axis and meets the central lattice point.
    pub fn closed_faces(&self) -> [u8; 3] {
        let mut closed = [0; 3];
        for axis in 0..D::N {
            for octant in 0..D::CORNERS {
                if octant >> axis & 1 == 0 {
                    closed[axis] |= u8::from(self.is_closed(octant, axis)) << octant;
                }
            }
        }
        closed
    }

    /// Returns whether a crack can start or continue at the central lattice point: see
    /// [`Connectivity::is_open`].
    pub fn is_open(&self) -> bool {
        let groups = self.middle();
        if groups != Groups::joined(D::ALL_CORNERS) {
            return groups != Groups::NONE;
        }
        // Most points of a body pass the fast test `is_whole`: without empty octants and cracks nearby, all
        // faces are closed.
        let is_open = |(faces, far): (u8, u8)| faces != D::ALL_CORNERS & !far;
        !self.is_whole()
            && self
                .closed_faces()
                .into_iter()
                .zip(FAR)
                .take(D::N)
                .any(is_open)
    }

    /// Returns the groups at the central lattice point, split into parts that closed faces connect.
    fn joined_by_faces(&self) -> Groups {
        let mut groups = Groups::apart(self.middle().solid());
        if groups == self.middle() || self.is_whole() {
            return self.middle();
        }
        let closed = self.closed_faces();
        for (octant, axis) in faces_around::<D>() {
            if closed[axis] >> octant & 1 == 1 {
                groups.join(octant, octant ^ 1 << axis);
            }
        }
        groups
    }

    /// Returns whether all eight (in 2D four) octants form one group at the central lattice point and at each
    /// of its neighbours.
    fn is_whole(&self) -> bool {
        let full = Groups::joined(D::ALL_CORNERS);
        self.groups[..D::SLOTS].iter().all(|&groups| groups == full)
    }

    /// Implements [`PointNeighbourhood::is_closed`] for the octant `octant` of the lattice point at index
    /// `place` of `groups`. All corners of the face must have an entry in `groups`.
    #[inline]
    fn is_closed_from(&self, place: usize, octant: usize, axis: usize) -> bool {
        (0..D::CORNERS / 2).all(|corner| {
            let (mut place, mut seen) = (place, octant);
            for bit in 0..D::N - 1 {
                let other = bit + usize::from(bit >= axis);
                if corner >> bit & 1 == 1 {
                    place = Self::towards(place, octant, other);
                    seen ^= 1 << other;
                }
            }
            self.groups[place].shares(seen, seen ^ 1 << axis)
        })
    }

    /// Returns the index in `groups` of the lattice point after the one at index `place`, along `axis` and on
    /// the side where `octant` lies.
    #[inline]
    fn towards(place: usize, octant: usize, axis: usize) -> usize {
        if octant >> axis & 1 == 1 {
            place + Self::STEPS[axis]
        } else {
            place - Self::STEPS[axis]
        }
    }
}

/// Returns the faces that meet at a lattice point. Each face is given by the octant on its low side and by
/// the axis to which it is perpendicular.
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
    use crate::foundation::dim::{Dim2, Dim3};

    #[test]
    fn connectivity_separates_voxels_that_meet_only_at_corner() {
        let diagonal = |at: Point| u8::from(at[0] == at[1]);
        let grid = VoxelGrid::<Dim2>::from_fn([2, 2, 1], 1.0, diagonal).unwrap();
        let connectivity = Connectivity::new(&grid);
        assert_eq!(
            connectivity.groups([1, 1, 0]).iter().collect::<Vec<_>>(),
            [1, 8]
        );
    }

    #[test]
    fn normalise_removes_hinge_when_crack_reaches_far_side() {
        // Releases the lattice points of the middle column of a 4 × 2 grid one after the other. After the
        // second release, `normalise` also splits the last point of the column.
        let grid = VoxelGrid::<Dim2>::from_fn([4, 2, 1], 1.0, |_| 1).unwrap();
        let mut connectivity = Connectivity::new(&grid);
        assert!(connectivity.release([2, 0, 0], 0b1010));
        connectivity.normalise(vec![[2, 0, 0]]);
        assert_eq!(
            connectivity.groups([2, 1, 0]),
            Groups::joined(15),
            "the crack ends at its tip"
        );
        assert!(connectivity.release([2, 1, 0], 0b1010));
        let changed = connectivity.normalise(neighbourhood::<Dim2>([2, 1, 0], 1).collect());
        assert_eq!(changed, [[2, 2, 0]], "`normalise` splits the last node");
        assert_eq!(connectivity.groups([2, 2, 0]).iter().count(), 2);
    }

    #[test]
    fn is_open_includes_far_corners_of_open_face() {
        let grid = VoxelGrid::<Dim3>::cube(6, 1.0).unwrap();
        let mut connectivity = Connectivity::new(&grid);
        assert!(!connectivity.is_open([3, 3, 3]));
        connectivity.release([3, 3, 3], 0b1010_1010);
        connectivity.normalise(neighbourhood::<Dim3>([3, 3, 3], 1).collect());
        assert_eq!(connectivity.groups([3, 3, 3]).iter().count(), 2);
        // The release opens the four faces across x around the released point. The other corners of these
        // faces form the front of the crack, so they are open points, too.
        assert!(connectivity.is_open([3, 4, 4]) && connectivity.is_open([3, 2, 3]));
        assert_eq!(
            connectivity.groups([3, 4, 4]),
            Groups::joined(255),
            "one group at the front of the crack"
        );
        assert!(!connectivity.is_open([4, 3, 3]));
    }
}
