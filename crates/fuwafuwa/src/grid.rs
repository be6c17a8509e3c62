//! Which voxels are solid, and of which material: the shape that a body starts from.

use crate::dim::{Dim, Point, points_in};
use std::fmt;
use std::marker::PhantomData;
use std::ops::RangeInclusive;

/// Most voxels on one axis of a grid.
pub const MAX_EXTENT: usize = 1024;
/// Most voxels in the box of a grid, solid or not.
pub const MAX_VOXELS: usize = 1 << 26;
/// Edge lengths that a voxel can have [m]: with others, volumes and places leave single precision.
pub const VOXEL_SIZES: RangeInclusive<f32> = 1e-6..=1e3;

/// Why a body or a grid could not be made.
#[derive(Debug, Clone, PartialEq)]
pub enum BuildError {
    /// No voxel is solid.
    Empty,
    /// The grid is larger than [`MAX_EXTENT`] or [`MAX_VOXELS`].
    TooLarge {
        /// Voxels asked for on each axis.
        size: [usize; 3],
    },
    /// The number of voxel values is not the product of the size.
    WrongLength {
        /// Values that the size asks for.
        expected: usize,
        /// Values that were given.
        found: usize,
    },
    /// A grid of the plane has more than one layer.
    NotFlat {
        /// Layers asked for.
        layers: usize,
    },
    /// The edge length of a voxel [m] is not one of [`VOXEL_SIZES`].
    BadVoxelSize(f32),
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "the shape is empty: no voxel is solid"),
            Self::TooLarge { size } => write!(
                f,
                "the grid of {} x {} x {} voxels is too large: at most {MAX_EXTENT} on an axis and {MAX_VOXELS} in all",
                size[0], size[1], size[2]
            ),
            Self::WrongLength { expected, found } => {
                write!(f, "the grid needs {expected} voxel values, got {found}")
            }
            Self::BadVoxelSize(size) => write!(
                f,
                "the voxel size {size} m is not between {} and {} m",
                VOXEL_SIZES.start(),
                VOXEL_SIZES.end()
            ),
            Self::NotFlat { layers } => {
                write!(
                    f,
                    "a grid of the plane has one layer of voxels, not {layers}"
                )
            }
        }
    }
}

impl std::error::Error for BuildError {}

/// A box of voxels, each empty (0) or of a material (1 to 255).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct VoxelGrid<D: Dim> {
    size: Point,
    voxel_size: f32,
    materials: Vec<u8>,
    dim: PhantomData<D>,
}

impl<D: Dim> VoxelGrid<D> {
    /// A grid of `size` voxels of edge length `voxel_size` [m], each given by `material` (0 = empty).
    ///
    /// # Errors
    /// [`BuildError`] when the grid is too large, not flat in 2D or empty, or the voxel size is not one
    /// of [`VOXEL_SIZES`].
    pub fn from_fn(
        size: [usize; 3],
        voxel_size: f32,
        mut material: impl FnMut(Point) -> u8,
    ) -> Result<Self, BuildError> {
        let size = Self::checked_size(size)?;
        let high = [size[0] - 1, size[1] - 1, size[2] - 1];
        let materials = points_in([0; 3], high).map(&mut material).collect();
        Self::checked(size, voxel_size, materials)
    }

    /// A grid from voxel values in memory, the first axis running fastest.
    ///
    /// # Errors
    /// As [`VoxelGrid::from_fn`], and when the number of values does not fit the size.
    pub fn from_materials(
        size: [usize; 3],
        voxel_size: f32,
        materials: Vec<u8>,
    ) -> Result<Self, BuildError> {
        let size = Self::checked_size(size)?;
        let expected = size.iter().map(|&extent| extent as usize).product();
        if materials.len() != expected {
            return Err(BuildError::WrongLength {
                expected,
                found: materials.len(),
            });
        }
        Self::checked(size, voxel_size, materials)
    }

    /// The disc (2D) or ball (3D) that fills a grid of `n` voxels across `diameter` metres.
    ///
    /// A voxel is solid when its centre lies within the radius less half a voxel, so that the
    /// outermost layer stays inside the box.
    ///
    /// # Errors
    /// As [`VoxelGrid::from_fn`]; `n` below 3 leaves nothing solid.
    pub fn ball(n: usize, diameter: f32) -> Result<Self, BuildError> {
        let centre = n as f32 * 0.5;
        let radius = centre - 0.5;
        Self::from_fn(Self::cube_size(n), diameter / n as f32, |at| {
            let squared: f32 = at[..D::N]
                .iter()
                .map(|&k| (k as f32 + 0.5 - centre) * (k as f32 + 0.5 - centre))
                .sum();
            u8::from(squared < radius * radius)
        })
    }

    /// The square (2D) or cube (3D) of `n` voxels across `width` metres.
    ///
    /// # Errors
    /// As [`VoxelGrid::from_fn`].
    pub fn cube(n: usize, width: f32) -> Result<Self, BuildError> {
        Self::from_fn(Self::cube_size(n), width / n as f32, |_| 1)
    }

    /// Voxels on each axis; 1 on the third axis in 2D.
    pub fn size(&self) -> Point {
        self.size
    }

    /// Edge length of a voxel [m].
    pub fn voxel_size(&self) -> f32 {
        self.voxel_size
    }

    /// Number of solid voxels.
    pub fn solid_count(&self) -> usize {
        self.materials.iter().filter(|&&m| m != 0).count()
    }

    /// The material of a voxel: 0 when it is empty or outside the grid.
    #[inline]
    pub fn material(&self, voxel: Point) -> u8 {
        let inside = (0..3).all(|axis| voxel[axis] >= 0 && voxel[axis] < self.size[axis]);
        if inside {
            self.materials[self.index(voxel)]
        } else {
            0
        }
    }

    /// Whether a voxel is solid; voxels outside the grid are not.
    #[inline]
    pub fn is_solid(&self, voxel: Point) -> bool {
        self.material(voxel) != 0
    }

    /// All voxels of the box, solid or not.
    pub fn voxels(&self) -> impl Iterator<Item = Point> + use<D> {
        let size = self.size;
        points_in([0; 3], [size[0] - 1, size[1] - 1, size[2] - 1])
    }

    /// The place of a voxel inside the box in memory order.
    #[inline]
    pub fn index(&self, voxel: Point) -> usize {
        ((voxel[2] * self.size[1] + voxel[1]) * self.size[0] + voxel[0]) as usize
    }

    fn cube_size(n: usize) -> [usize; 3] {
        [n, n, if D::N == 3 { n } else { 1 }]
    }

    fn checked_size(size: [usize; 3]) -> Result<Point, BuildError> {
        if size.contains(&0) {
            return Err(BuildError::Empty);
        }
        if D::N == 2 && size[2] != 1 {
            return Err(BuildError::NotFlat { layers: size[2] });
        }
        let fits = size.iter().all(|&extent| extent <= MAX_EXTENT);
        if !fits || size.iter().product::<usize>() > MAX_VOXELS {
            return Err(BuildError::TooLarge { size });
        }
        Ok(size.map(|extent| extent as i32))
    }

    fn checked(size: Point, voxel_size: f32, materials: Vec<u8>) -> Result<Self, BuildError> {
        if !VOXEL_SIZES.contains(&voxel_size) {
            return Err(BuildError::BadVoxelSize(voxel_size));
        }
        if materials.iter().all(|&m| m == 0) {
            return Err(BuildError::Empty);
        }
        Ok(Self {
            size,
            voxel_size,
            materials,
            dim: PhantomData,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{Dim2, Dim3};

    #[test]
    fn bad_grids_are_refused_with_their_reason() {
        assert_eq!(VoxelGrid::<Dim2>::ball(0, 1.0), Err(BuildError::Empty));
        assert_eq!(VoxelGrid::<Dim3>::ball(1, 1.0), Err(BuildError::Empty));
        let size = [2000, 1, 1];
        let long = VoxelGrid::<Dim3>::from_fn(size, 1.0, |_| 1);
        assert_eq!(long, Err(BuildError::TooLarge { size }));
        let short = VoxelGrid::<Dim2>::from_materials([2, 2, 1], 1.0, vec![1; 3]);
        let (expected, found) = (4, 3);
        assert_eq!(short, Err(BuildError::WrongLength { expected, found }));
        for width in [f32::NAN, f32::INFINITY, 0.0, -1.0, 1e-9, 1e9] {
            let odd = VoxelGrid::<Dim2>::cube(2, width);
            assert!(matches!(odd, Err(BuildError::BadVoxelSize(_))), "{width}");
        }
        let deep = VoxelGrid::<Dim2>::from_fn([4, 4, 2], 1.0, |_| 1);
        assert_eq!(deep, Err(BuildError::NotFlat { layers: 2 }));
    }

    #[test]
    fn a_ball_keeps_the_count_of_its_voxels() {
        // Counts of the prototypes: 15,408 voxels at n = 32 in 3D.
        assert_eq!(
            VoxelGrid::<Dim3>::ball(32, 1.0).unwrap().solid_count(),
            15_408
        );
    }
}
