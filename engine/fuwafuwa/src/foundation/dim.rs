//! Everything that differs between two and three dimensions.
//!
//! Inside the engine, most code is written once for 2D and 3D: a [`Point`] of the lattice and a [`Vec3`]
//! always have three coordinates, and the third one is 0 in 2D. A dimension adds the number of axes
//! ([`Dim::N`]), the constants that follow from it, and the vectors of the public interface
//! ([`Dim::Vector`]).

use crate::foundation::hash::HashState;
use crate::math::row::Row;
use glam::{Vec2, Vec3};
use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, MulAssign, Neg, Sub, SubAssign};

/// Lattice point, voxel or cell, in lattice units. In 2D the third coordinate is 0.
pub type Point = [i32; 3];

/// Number of space dimensions as a type: [`Dim2`] or [`Dim3`].
pub trait Dim:
    sealed::Sealed + Copy + Clone + Debug + Default + PartialEq + Eq + Send + Sync + 'static
{
    /// Position, direction, velocity or force: [`Vec2`] in 2D, [`Vec3`] in 3D.
    type Vector: DimVector;
    /// Angular velocity or torque: [`f32`] in 2D (positive is counterclockwise), [`Vec3`] in 3D.
    type Angular: DimAngular;
    /// Number of axes: 2 or 3.
    const N: usize;
    /// Number of corners of a cell, children of a cell, and voxels around a lattice point: 2^N.
    const CORNERS: usize = 1 << Self::N;
    /// Number of slots of the 3 × 3 (× 3) lattice of an element: 3^N.
    const SLOTS: usize = 3usize.pow(Self::N as u32);
    /// Mask with a bit for every corner.
    const ALL_CORNERS: u8 = ((1u16 << Self::CORNERS) - 1) as u8;
    /// Stiffness of the hourglass modes of a cell with all its children, relative to Young's modulus: 1/3 in
    /// 2D, 1/6 in 3D. With these values, a beam one element thick has the bending stiffness of beam theory.
    const HOURGLASS: f64;

    /// Returns the number of voxels along the third axis of a grid: 1 in 2D, `voxels` in 3D.
    fn depth(voxels: usize) -> usize {
        match Self::N {
            2 => 1,
            _ => voxels,
        }
    }
}

/// Two dimensions.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Dim2;

/// Three dimensions.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Dim3;

/// Holds `Sealed`, a supertrait of [`Dim`]. Other crates cannot name it, so they cannot implement [`Dim`].
mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Dim2 {}
    impl Sealed for super::Dim3 {}
    impl Sealed for glam::Vec2 {}
    impl Sealed for glam::Vec3 {}
    impl Sealed for f32 {}

    /// Trait of all serialisable types with the feature `serde`, and of all types without the feature.
    #[cfg(feature = "serde")]
    pub trait Stored: serde::Serialize + serde::de::DeserializeOwned {}
    #[cfg(feature = "serde")]
    impl<T: serde::Serialize + serde::de::DeserializeOwned> Stored for T {}
    #[cfg(not(feature = "serde"))]
    pub trait Stored {}
    #[cfg(not(feature = "serde"))]
    impl<T> Stored for T {}
}

/// Vector of a dimension, for code that works in 2D and in 3D: [`Vec2`] or [`Vec3`].
pub trait DimVector:
    sealed::Sealed
    + sealed::Stored
    + HashState
    + Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<f32, Output = Self>
    + Div<f32, Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign<f32>
    + Index<usize, Output = f32>
    + IndexMut<usize>
    + Sum
{
    /// Number of coordinates.
    const N: usize;
    /// Zero vector.
    const ZERO: Self;
    /// Unit vector of the first axis.
    const X: Self;
    /// Unit vector of the second axis, by default upwards.
    const Y: Self;

    /// Returns the vector with three coordinates; in 2D the third one is 0.
    fn to_vec3(self) -> Vec3;

    /// Returns the vector with the coordinates of the dimension; in 2D the third one is dropped.
    fn from_vec3(vector: Vec3) -> Self;

    /// Returns a vector with all coordinates equal.
    fn splat(number: f32) -> Self;

    /// Dot product.
    fn dot(self, other: Self) -> f32;

    /// Length.
    fn length(self) -> f32;

    /// Returns whether all coordinates are finite.
    fn is_finite(self) -> bool;
}

/// Implements [`DimVector`] by the methods of a `glam` vector.
macro_rules! dim_vector {
    ($vector:ident, $count:expr, $to:expr, $from:expr) => {
        impl DimVector for $vector {
            const N: usize = $count;
            const ZERO: Self = Self::ZERO;
            const X: Self = Self::X;
            const Y: Self = Self::Y;

            #[inline(always)]
            fn to_vec3(self) -> Vec3 {
                $to(self)
            }

            #[inline(always)]
            fn from_vec3(vector: Vec3) -> Self {
                $from(vector)
            }

            #[inline(always)]
            fn splat(number: f32) -> Self {
                Self::splat(number)
            }

            #[inline(always)]
            fn dot(self, other: Self) -> f32 {
                $vector::dot(self, other)
            }

            #[inline(always)]
            fn length(self) -> f32 {
                $vector::length(self)
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                $vector::is_finite(self)
            }
        }
    };
}

dim_vector!(
    Vec2,
    2,
    |vector: Vec2| vector.extend(0.0),
    |vector: Vec3| { vector.truncate() }
);
dim_vector!(Vec3, 3, |vector: Vec3| vector, |vector: Vec3| vector);

/// Angular velocity or torque of a dimension: [`f32`] or [`Vec3`].
pub trait DimAngular:
    sealed::Sealed
    + sealed::Stored
    + HashState
    + Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<f32, Output = Self>
    + Neg<Output = Self>
{
    /// Returns the components about all three axes. In 2D the number becomes the third component, and the
    /// other two are 0.
    fn to_vec3(self) -> Vec3;

    /// Returns the vector in 3D, and its third component in 2D.
    fn from_vec3(vector: Vec3) -> Self;
}

impl DimAngular for f32 {
    fn to_vec3(self) -> Vec3 {
        Vec3::new(0.0, 0.0, self)
    }

    fn from_vec3(vector: Vec3) -> Self {
        vector.z
    }
}

impl DimAngular for Vec3 {
    fn to_vec3(self) -> Vec3 {
        self
    }

    fn from_vec3(vector: Vec3) -> Self {
        vector
    }
}

impl Dim for Dim2 {
    type Vector = Vec2;
    type Angular = f32;
    const N: usize = 2;
    const HOURGLASS: f64 = 1.0 / 3.0;
}

impl Dim for Dim3 {
    type Vector = Vec3;
    type Angular = Vec3;
    const N: usize = 3;
    const HOURGLASS: f64 = 1.0 / 6.0;
}

/// Returns corner `index` of the unit cell: bit k of the index is the coordinate on axis k.
///
/// ```text
///   2 ─── 3
///   │     │      the same numbers name the children of a cell, and the voxels
///   0 ─── 1      around a lattice point (bit set = on the far side of the point)
/// ```
#[inline]
pub fn corner(index: usize) -> Point {
    [
        (index & 1) as i32,
        (index >> 1 & 1) as i32,
        (index >> 2 & 1) as i32,
    ]
}

/// For each axis, mask of the corners with coordinate 1 on that axis, see [`corner`].
pub const FAR: [u8; 3] = [0b1010_1010, 0b1100_1100, 0b1111_0000];

/// Returns the voxel, or the low corner of the block, on the other side of face 2 · axis + side (0 = low, 1 = high).
pub fn beyond(mut block: Point, face: usize) -> Point {
    block[face / 2] += 2 * (face % 2) as i32 - 1;
    block
}

/// Coordinate-wise sum.
#[inline]
pub fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Multiplies each coordinate by `k`.
#[inline]
pub fn scale(a: Point, k: i32) -> Point {
    [a[0] * k, a[1] * k, a[2] * k]
}

/// Dot product over the components of the dimension. In 2D the third components are ignored.
#[inline(always)]
pub(crate) fn inner<D: Dim>(a: Row, b: Row) -> f32 {
    let mut sum = a[0] * b[0];
    for axis in 1..D::N {
        sum += a[axis] * b[axis];
    }
    sum
}

/// Returns an angular velocity or torque without the components that do not exist in the dimension: in 2D
/// only the third component remains.
pub(crate) fn turning<D: Dim>(mut about: Vec3) -> Vec3 {
    if D::N == 2 {
        (about.x, about.y) = (0.0, 0.0);
    }
    about
}

/// Returns the voxel in octant `octant` around the lattice point `at`. Bit k of `octant` is 1 if the voxel is
/// on the high side of the point along axis k.
#[inline]
pub fn voxel_around<D: Dim>(at: Point, octant: usize) -> Point {
    let mut voxel = at;
    for axis in 0..D::N {
        voxel[axis] += (octant >> axis & 1) as i32 - 1;
    }
    voxel
}

/// Returns all points of the box `low..=high`; the first coordinate varies fastest.
pub fn points_in(low: Point, high: Point) -> impl Iterator<Item = Point> {
    let mut next = (0..3).all(|axis| low[axis] <= high[axis]).then_some(low);
    std::iter::from_fn(move || {
        let mut at = next?;
        let found = at;
        next = (0..3).find_map(|axis| {
            let more = at[axis] < high[axis];
            at[axis] = if more { at[axis] + 1 } else { low[axis] };
            more.then_some(at)
        });
        Some(found)
    })
}

/// Returns all points up to `reach` lattice steps away from `at` on every axis of `D`, including `at`.
pub fn neighbourhood<D: Dim>(at: Point, reach: i32) -> impl Iterator<Item = Point> {
    let (mut low, mut high) = (at, at);
    for axis in 0..D::N {
        low[axis] -= reach;
        high[axis] += reach;
    }
    points_in(low, high)
}

/// Returns the corners of face number 2 · axis + side of a cell, counterclockwise as seen from outside; see
/// [`corner`] for their numbers. In 2D a face has two corners, and the last two entries are unused. As seen
/// from the first corner, looking to the second, the cell lies to the left.
pub fn face_corners<D: Dim>(face: usize) -> [usize; 4] {
    let (axis, side) = (face / 2, face % 2);
    let ring: &[usize] = match D::N {
        2 => &[0, 1],
        _ => &[0, 1, 3, 2],
    };
    // The two axes other than `axis`. In 3D they are ordered so that `ring` runs counterclockwise around the
    // direction of `axis`.
    let others = match D::N {
        2 => [1 - axis, 2],
        _ => [(axis + 1) % 3, (axis + 2) % 3],
    };
    let forwards = match D::N {
        2 => (side == 1) == (axis == 0),
        _ => side == 1,
    };
    let mut corners = [0; 4];
    for (place, &step) in ring.iter().enumerate() {
        let place = if forwards {
            place
        } else {
            ring.len() - 1 - place
        };
        corners[place] = side << axis | (step & 1) << others[0] | (step >> 1) << others[1];
    }
    corners
}
