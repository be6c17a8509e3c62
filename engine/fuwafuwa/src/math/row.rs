//! Vectors padded to four numbers.

use glam::Vec3;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Index, IndexMut, Mul, MulAssign, Neg, Sub, SubAssign};
use std::slice::SliceIndex;

/// Vector of three coordinates, padded to four so that it loads with one aligned instruction. In 2D the third
/// coordinate is 0.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
#[repr(transparent)]
pub struct Row([f32; 4]);

impl Row {
    /// All components 0.
    pub const ZERO: Self = Self([0.0; 4]);

    /// Creates a row from its four components.
    #[inline(always)]
    pub const fn from_array(components: [f32; 4]) -> Self {
        Self(components)
    }

    /// Returns the four components.
    #[inline(always)]
    pub const fn to_array(self) -> [f32; 4] {
        self.0
    }

    /// Borrows the four components.
    #[inline(always)]
    pub const fn as_array(&self) -> &[f32; 4] {
        &self.0
    }

    /// Drops the fourth component.
    #[inline(always)]
    pub const fn xyz(self) -> Vec3 {
        let [x, y, z, _] = self.0;
        Vec3::new(x, y, z)
    }

    /// Returns the dot product over all four components.
    #[inline(always)]
    pub fn dot(self, other: Self) -> f32 {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        a * e + b * f + c * g + d * h
    }

    /// Returns the length over all four components.
    #[inline(always)]
    pub fn length(self) -> f32 {
        self.dot(self).sqrt()
    }

    /// Returns whether all four components are finite.
    #[inline(always)]
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|component| component.is_finite())
    }
}

/// Pads a vector with a fourth component 0.
impl From<Vec3> for Row {
    #[inline(always)]
    fn from(vector: Vec3) -> Self {
        Self([vector.x, vector.y, vector.z, 0.0])
    }
}

impl<I: SliceIndex<[f32]>> Index<I> for Row {
    type Output = I::Output;

    #[inline(always)]
    fn index(&self, index: I) -> &I::Output {
        &self.0[index]
    }
}

impl<I: SliceIndex<[f32]>> IndexMut<I> for Row {
    #[inline(always)]
    fn index_mut(&mut self, index: I) -> &mut I::Output {
        &mut self.0[index]
    }
}

impl Add for Row {
    type Output = Self;

    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl Sum for Row {
    #[inline(always)]
    fn sum<I: Iterator<Item = Self>>(rows: I) -> Self {
        rows.fold(Self::ZERO, Self::add)
    }
}

impl Sub for Row {
    type Output = Self;

    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        self -= other;
        self
    }
}

impl Mul<f32> for Row {
    type Output = Self;

    #[inline(always)]
    fn mul(mut self, factor: f32) -> Self {
        self *= factor;
        self
    }
}

impl Neg for Row {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|component| -component))
    }
}

impl AddAssign for Row {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        for axis in 0..4 {
            self.0[axis] += other.0[axis];
        }
    }
}

impl SubAssign for Row {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        for axis in 0..4 {
            self.0[axis] -= other.0[axis];
        }
    }
}

impl MulAssign<f32> for Row {
    #[inline(always)]
    fn mul_assign(&mut self, factor: f32) {
        for axis in 0..4 {
            self.0[axis] *= factor;
        }
    }
}
