//! Vector arithmetic in single and double precision.

use std::ops::{Add, Mul, Sub};

/// Vector or position in space; the third coordinate is 0 in 2D.
pub type Vector = [f32; 3];

/// Scalar type of vectors.
pub trait Number:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
}

impl Number for f32 {}
impl Number for f64 {}

/// a + b
#[inline(always)]
pub fn plus<T: Number, const K: usize>(mut a: [T; K], b: [T; K]) -> [T; K] {
    for axis in 0..K {
        a[axis] = a[axis] + b[axis];
    }
    a
}

/// a − b
#[inline(always)]
pub fn minus<T: Number, const K: usize>(mut a: [T; K], b: [T; K]) -> [T; K] {
    for axis in 0..K {
        a[axis] = a[axis] - b[axis];
    }
    a
}

/// a k
#[inline(always)]
pub fn scaled<T: Number, const K: usize>(mut a: [T; K], k: T) -> [T; K] {
    for axis in 0..K {
        a[axis] = a[axis] * k;
    }
    a
}

/// a · b
#[inline(always)]
pub fn dot<T: Number, const K: usize>(a: [T; K], b: [T; K]) -> T {
    let mut sum = a[0] * b[0];
    for axis in 1..K {
        sum = sum + a[axis] * b[axis];
    }
    sum
}

/// a × b
#[inline(always)]
pub fn cross<T: Number>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Pads a vector with a fourth component 0.
#[inline(always)]
pub fn as_row([x, y, z]: [f32; 3]) -> [f32; 4] {
    [x, y, z, 0.0]
}

/// Drops the fourth component.
#[inline(always)]
pub fn three([x, y, z, _]: [f32; 4]) -> [f32; 3] {
    [x, y, z]
}

/// Whether every component is finite.
#[inline(always)]
pub fn is_finite<const K: usize>(a: [f32; K]) -> bool {
    a.iter().all(|k| k.is_finite())
}

/// |a|
#[inline(always)]
pub fn length<const K: usize>(a: [f32; K]) -> f32 {
    dot(a, a).sqrt()
}

/// Returns two unit vectors that are perpendicular to the unit vector `way` and to each other.
pub fn across(way: Vector) -> [Vector; 2] {
    let least = (0..3).fold(0, |least, k| match way[k].abs() < way[least].abs() {
        true => k,
        false => least,
    });
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let first = cross(way, other);
    let first = scaled(first, 1.0 / length(first));
    [first, cross(way, first)]
}
