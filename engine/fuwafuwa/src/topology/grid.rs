//! Voxel grids: the shape of a body before any crack, as solid voxels with materials.

use crate::error::Error;
use crate::foundation::dim::{Dim, Point, points_in};
use crate::foundation::hash::hash_state;
use crate::topology::skin;
use glam::Vec3;
use std::marker::PhantomData;
use std::ops::RangeInclusive;

mod shapes;

/// Largest number of voxels on one axis. At this distance from the origin, single precision still resolves
/// 1/10000 of a voxel.
pub const MAX_EXTENT: usize = 1024;
/// Largest number of voxels in the box of a grid, solid or not. The materials of this many voxels take 64
/// MiB, and a 32-bit id can number the eight corners of each voxel.
pub const MAX_VOXELS: usize = 1 << 26;
/// Valid edge lengths of a voxel [m]. With other lengths, volumes and positions leave the range of single
/// precision.
pub const VOXEL_SIZES: RangeInclusive<f32> = 1e-6..=1e3;

/// Box of voxels, each empty (0) or of a material (1 to 255).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct VoxelGrid<D: Dim> {
    size: Point,
    voxel_size: f32,
    materials: Vec<u8>,
    /// For each voxel, whether it was removed with its piece. An empty list means that no voxel was removed.
    removed: Vec<bool>,
    /// Offset of the smooth surface from each surface point, outwards [1/64 voxel], see [`skin::measured`].
    /// Empty if only the voxels are known.
    surface: Vec<i8>,
    dim: PhantomData<D>,
}

hash_state! { [D: Dim] struct VoxelGrid<D> { size, voxel_size, materials, removed, surface } skip { dim } }

impl<D: Dim> VoxelGrid<D> {
    /// Creates a grid of `size` voxels with edge length `voxel_size` [m]; `material` returns the material
    /// number of each voxel (0 = empty).
    ///
    /// # Errors
    /// [`Error::EmptyGrid`] if no voxel is solid. [`Error::InvalidParameter`] if the grid is too large, or not flat
    /// in 2D, or if the voxel size is outside [`VOXEL_SIZES`].
    pub fn from_fn(
        size: [usize; 3],
        voxel_size: f32,
        mut material: impl FnMut(Point) -> u8,
    ) -> Result<Self, Error> {
        let size = Self::checked_size(size)?;
        let high = [size[0] - 1, size[1] - 1, size[2] - 1];
        let materials = points_in([0; 3], high).map(&mut material).collect();
        Self::checked(size, voxel_size, materials)
    }

    /// Creates a grid from the material number of each voxel (0 = empty), in memory order, the first axis
    /// fastest.
    ///
    /// # Errors
    /// See [`VoxelGrid::from_fn`]. Also [`Error::InvalidParameter`] if the length of `materials` does not
    /// match the size.
    pub fn from_materials(
        size: [usize; 3],
        voxel_size: f32,
        materials: Vec<u8>,
    ) -> Result<Self, Error> {
        let size = Self::checked_size(size)?;
        let expected: usize = size.iter().map(|&extent| extent as usize).product();
        if materials.len() != expected {
            let expected = format!("{expected} voxel values, the product of the size");
            let given = format_args!("{} voxel values", materials.len());
            return Err(Error::parameter("materials", expected, given));
        }
        Self::checked(size, voxel_size, materials)
    }

    /// Creates a grid like [`VoxelGrid::from_fn`], but calls `material` with the centre of each voxel [m],
    /// measured from the low corner of the grid; the third coordinate is 0 in 2D. This turns signed distances
    /// into voxels:
    ///
    /// ```
    /// use fuwafuwa::{Dim3, Shape, Vec3, VoxelGrid};
    ///
    /// let ball = |radius| Shape::<Dim3>::ball(radius).translated(Vec3::splat(0.5));
    /// let (shell, core) = (ball(0.45), ball(0.2));
    /// let grid = VoxelGrid::<Dim3>::from_centres([32; 3], 1.0 / 32.0, |at| {
    ///     match (shell.distance(at).0 < 0.0, core.distance(at).0 < 0.0) {
    ///         (_, true) => 2,
    ///         (true, false) => 1,
    ///         (false, false) => 0,
    ///     }
    /// })?;
    /// assert_eq!(grid.material([16; 3]), 2);
    /// # Ok::<(), fuwafuwa::Error>(())
    /// ```
    ///
    /// # Errors
    /// See [`VoxelGrid::from_fn`].
    pub fn from_centres(
        size: [usize; 3],
        voxel_size: f32,
        mut material: impl FnMut(Vec3) -> u8,
    ) -> Result<Self, Error> {
        Self::from_fn(size, voxel_size, |voxel| {
            material(Self::centre(voxel, voxel_size))
        })
    }

    /// Creates a grid from a signed distance: a voxel is of material 1 if `distance` is negative at its centre.
    /// The distance [m] is positive outside, and its argument is a position [m] measured from the low corner of
    /// the grid; the third coordinate is 0 in 2D.
    ///
    /// The grid keeps the surface, at distance 0, to 1/64 voxel. Rigid shapes and queries then see this surface and
    /// not a smoothed staircase of voxels, which may be wrong by half a voxel. A surface more than a voxel
    /// from a corner of a voxel (a thin wall) is not reached. [`VoxelGrid::with_materials`] sets other materials.
    ///
    /// ```
    /// use fuwafuwa::{Dim2, Vec3, VoxelGrid};
    ///
    /// let centre = Vec3::new(0.5, 0.5, 0.0);
    /// let disc = |at: Vec3| at.distance(centre) - 0.4;
    /// let grid = VoxelGrid::<Dim2>::from_distance([16, 16, 1], 1.0 / 16.0, disc)?;
    /// assert!(grid.has_surface());
    /// # Ok::<(), fuwafuwa::Error>(())
    /// ```
    ///
    /// # Errors
    /// See [`VoxelGrid::from_fn`].
    pub fn from_distance(
        size: [usize; 3],
        voxel_size: f32,
        distance: impl Fn(Vec3) -> f32,
    ) -> Result<Self, Error> {
        let grid = Self::from_centres(size, voxel_size, |at| u8::from(distance(at) < 0.0))?;
        Ok(grid.with_distance(|at| distance(at * voxel_size) / voxel_size))
    }

    /// Returns the grid with the surface at which a signed distance [voxels] of a position [voxels] is 0.
    fn with_distance(mut self, distance: impl Fn(Vec3) -> f32) -> Self {
        self.surface = skin::measured(&self, distance);
        self
    }

    /// Returns the grid with other material numbers; `material` gets each voxel and its present number. The
    /// grid keeps its [surface](VoxelGrid::has_surface) if the same voxels are solid, and forgets it otherwise.
    /// Removed voxels stay removed only if they stay solid.
    ///
    /// # Errors
    /// [`Error::EmptyGrid`] if no voxel is solid.
    pub fn with_materials(
        mut self,
        mut material: impl FnMut(Point, u8) -> u8,
    ) -> Result<Self, Error> {
        let voxels: Vec<Point> = self.voxels().collect();
        let mut is_same_shape = true;
        for (index, &voxel) in voxels.iter().enumerate() {
            let known = self.materials[index];
            let new = material(voxel, known);
            is_same_shape &= (new == 0) == (known == 0);
            self.materials[index] = new;
            if new == 0 && !self.removed.is_empty() {
                self.removed[index] = false;
            }
        }
        if !is_same_shape {
            self.surface.clear();
        }
        if self.materials.iter().all(|&number| number == 0) {
            return Err(Error::EmptyGrid);
        }
        Ok(self)
    }

    /// Returns whether the grid knows its smooth surface: see [`VoxelGrid::from_distance`]. The constructors of
    /// balls and rings know it too. Other grids have the smoothed surface of their voxels.
    pub fn has_surface(&self) -> bool {
        !self.surface.is_empty()
    }

    /// Returns the offsets of the smooth surface from the surface points [1/64 voxel]: the lattice points
    /// between solid and empty voxels, the first axis fastest. `None` if the grid does not know its surface.
    pub fn surface_offsets(&self) -> Option<&[i8]> {
        self.has_surface().then_some(&self.surface)
    }

    /// Returns the grid with the offsets of [`VoxelGrid::surface_offsets`].
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the number of offsets is not that of the surface points, or if one is longer than a
    /// voxel, which is 64.
    pub fn with_surface_offsets(mut self, offsets: Vec<i8>) -> Result<Self, Error> {
        let count = skin::surface_points(&self).len();
        if offsets.len() != count {
            let expected = format!("{count} offsets, one for each surface point");
            return Err(Error::parameter("surface", expected, offsets.len()));
        }
        if !skin::are_offsets(&offsets) {
            let found = offsets.iter().map(|steps| steps.unsigned_abs()).max();
            let expected = "offsets from -64 to 64, which is one voxel";
            return Err(Error::parameter("surface", expected, found.unwrap_or(0)));
        }
        self.surface = offsets;
        Ok(self)
    }

    /// Returns the grid with all lengths multiplied by `factor` and with the same voxels. Removed voxels stay
    /// removed.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the new voxel size is outside [`VOXEL_SIZES`].
    pub fn scaled(mut self, factor: f32) -> Result<Self, Error> {
        self.voxel_size = checked_voxel_size(self.voxel_size * factor)?;
        Ok(self)
    }

    /// Returns the centre of a voxel [m], measured from the low corner of a grid with this voxel size; the
    /// third coordinate is 0 in 2D.
    pub fn centre(voxel: Point, voxel_size: f32) -> Vec3 {
        let mut centre = Vec3::ZERO;
        for axis in 0..D::N {
            centre[axis] = (voxel[axis] as f32 + 0.5) * voxel_size;
        }
        centre
    }

    /// Returns the number of voxels on each axis; 1 on the third axis in 2D.
    pub fn size(&self) -> Point {
        self.size
    }

    /// Returns the edge length of a voxel [m].
    pub fn voxel_size(&self) -> f32 {
        self.voxel_size
    }

    /// Returns the number of solid voxels, with those that were removed.
    #[inline(never)]
    pub fn solid_count(&self) -> usize {
        self.materials.iter().filter(|&&m| m != 0).count()
    }

    /// Returns the material number of a voxel: 0 if the voxel is empty or outside the grid.
    #[inline]
    pub fn material(&self, voxel: Point) -> u8 {
        let inside = (0..3).all(|axis| voxel[axis] >= 0 && voxel[axis] < self.size[axis]);
        if inside {
            self.materials[self.index(voxel)]
        } else {
            0
        }
    }

    /// Returns whether a voxel is solid; false outside the grid.
    #[inline]
    pub fn is_solid(&self, voxel: Point) -> bool {
        self.material(voxel) != 0
    }

    /// Returns whether a voxel is solid and was not removed with its [piece](crate::World::remove_piece).
    /// [`VoxelGrid::is_solid`] stays true for removed voxels.
    #[inline]
    pub fn is_present(&self, voxel: Point) -> bool {
        self.is_solid(voxel) && (self.removed.is_empty() || !self.removed[self.index(voxel)])
    }

    /// Returns the number of solid voxels without those that were removed.
    #[inline(never)]
    pub fn remaining_count(&self) -> usize {
        let gone = self.removed.iter().filter(|&&gone| gone).count();
        self.solid_count() - gone
    }

    /// Marks solid voxels as removed.
    pub(crate) fn remove_voxels(&mut self, voxels: &[Point]) {
        self.removed.resize(self.materials.len(), false);
        for &voxel in voxels {
            let index = self.index(voxel);
            self.removed[index] = true;
        }
    }

    /// Returns all voxels of the box, solid or not.
    pub fn voxels(&self) -> impl Iterator<Item = Point> + use<D> {
        let size = self.size;
        points_in([0; 3], [size[0] - 1, size[1] - 1, size[2] - 1])
    }

    /// Returns the index of a voxel inside the box, in memory order.
    #[inline]
    pub fn index(&self, voxel: Point) -> usize {
        ((voxel[2] * self.size[1] + voxel[1]) * self.size[0] + voxel[0]) as usize
    }

    /// Returns whether a grid read from a file has a valid size and voxel size, and a valid list of removed
    /// voxels.
    #[cfg(feature = "serde")]
    pub(crate) fn is_valid(&self) -> bool {
        let size = self.size.map(|extent| usize::try_from(extent).unwrap_or(0));
        let is_box = Self::from_materials(size, self.voxel_size, self.materials.clone()).is_ok();
        let are_solid = |(&gone, &material): (&bool, &u8)| !gone || material != 0;
        let gone = &self.removed;
        let is_known = gone.is_empty() || gone.len() == self.materials.len();
        let has_points = || {
            let is_complete = || self.surface.len() == skin::surface_points(self).len();
            self.surface.is_empty() || skin::are_offsets(&self.surface) && is_complete()
        };
        is_box && is_known && has_points() && gone.iter().zip(&self.materials).all(are_solid)
    }

    fn checked_size(size: [usize; 3]) -> Result<Point, Error> {
        if size.contains(&0) {
            return Err(Error::EmptyGrid);
        }
        if size[2] != D::depth(size[2]) {
            let expected = "1 voxel on the third axis in 2D";
            return Err(Error::parameter("size", expected, size));
        }
        let fits = size.iter().all(|&extent| extent <= MAX_EXTENT);
        if !fits || size.iter().product::<usize>() > MAX_VOXELS {
            let expected =
                format!("at most {MAX_EXTENT} voxels on an axis and {MAX_VOXELS} in all");
            return Err(Error::parameter("size", expected, size));
        }
        Ok(size.map(|extent| extent as i32))
    }

    #[inline(never)]
    fn checked(size: Point, voxel_size: f32, materials: Vec<u8>) -> Result<Self, Error> {
        let voxel_size = checked_voxel_size(voxel_size)?;
        if materials.iter().all(|&m| m == 0) {
            return Err(Error::EmptyGrid);
        }
        Ok(Self {
            size,
            voxel_size,
            materials,
            removed: Vec::new(),
            surface: Vec::new(),
            dim: PhantomData,
        })
    }
}

/// Returns a voxel size [m], or an error if it is outside [`VOXEL_SIZES`].
fn checked_voxel_size(voxel_size: f32) -> Result<f32, Error> {
    if VOXEL_SIZES.contains(&voxel_size) {
        return Ok(voxel_size);
    }
    let (low, high) = (VOXEL_SIZES.start(), VOXEL_SIZES.end());
    let expected = format!("{low} to {high} m");
    Err(Error::parameter("voxel_size", expected, voxel_size))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;
    use crate::foundation::dim::{Dim2, Dim3};

    #[test]
    fn from_fn_reports_reason_for_invalid_grid() {
        assert_eq!(VoxelGrid::<Dim2>::ball(0, 1.0), Err(Error::EmptyGrid));
        let text = |grid: Result<VoxelGrid<Dim2>, Error>| grid.unwrap_err().to_string();
        let long = VoxelGrid::<Dim3>::from_fn([2000, 1, 1], 1.0, |_| 1);
        assert_eq!(
            long.unwrap_err().to_string(),
            "size must be at most 1024 voxels on an axis and 67108864 in all, given [2000, 1, 1]"
        );
        assert_eq!(
            text(VoxelGrid::from_materials([2, 2, 1], 1.0, vec![1; 3])),
            "materials must be 4 voxel values, the product of the size, given 3 voxel values"
        );
        for width in [f32::NAN, f32::INFINITY, 0.0, -1.0, 1e-9, 1e9] {
            let odd = text(VoxelGrid::cube(2, width));
            let given = width / 2.0;
            assert_eq!(
                odd,
                format!("voxel_size must be 0.000001 to 1000 m, given {given:?}")
            );
        }
        assert_eq!(
            text(VoxelGrid::from_fn([4, 4, 2], 1.0, |_| 1)),
            "size must be 1 voxel on the third axis in 2D, given [4, 4, 2]"
        );
    }

    #[test]
    fn ball_contains_voxels_at_smallest_sizes() {
        for (n, [disc, ball]) in [(1, [1, 1]), (2, [4, 8]), (3, [1, 1]), (4, [4, 8])] {
            let disc_of_n = VoxelGrid::<Dim2>::ball(n, 1.0).unwrap();
            assert_eq!(disc_of_n.solid_count(), disc, "{n}");
            let ball_of_n = VoxelGrid::<Dim3>::ball(n, 1.0).unwrap();
            assert_eq!(ball_of_n.solid_count(), ball, "{n}");
        }
    }

    #[test]
    fn from_centres_fills_voxels_with_centre_inside() {
        use crate::rigid_body::solid::Solid;
        let (centre, radius) = (Vec3::splat(0.5), 0.3);
        let inside = |at: Vec3| u8::from(Solid::Ball { centre, radius }.distance(at).0 < 0.0);
        let grid = VoxelGrid::<Dim3>::from_centres([5; 3], 0.2, inside).unwrap();
        assert_eq!(grid.solid_count(), 19, "a cube of 3 without its 8 corners");
        let centre = VoxelGrid::<Dim2>::centre([1, 2, 0], 2.0);
        assert_eq!(centre, Vec3::new(3.0, 5.0, 0.0));
    }
}
