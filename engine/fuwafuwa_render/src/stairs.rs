//! Smoothing of voxel staircases at rest, shared by 2D outlines and 3D surfaces.

use std::ops::{Add, Mul, Sub};

/// Returns points with their staircase smoothed: (3 S − 3 S² + S³) applied to them, where S is a blur. Unlike
/// S alone, this does not shrink features much larger than the blur width [Taubin 1995].
pub fn smoothed<V>(places: &[V], blurred: impl Fn(&[V]) -> Vec<V>) -> Vec<V>
where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<f32, Output = V>,
{
    let once = blurred(places);
    let twice = blurred(&once);
    let thrice = blurred(&twice);
    let sum = |k: usize| (once[k] - twice[k]) * 3.0 + thrice[k];
    (0..places.len()).map(sum).collect()
}
