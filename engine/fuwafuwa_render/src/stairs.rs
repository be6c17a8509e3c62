//! How stairs of voxels go, before a body moves: the same for the lines of the plane and the surfaces of space.

use std::ops::{Add, Mul, Sub};

/// Places without their stairs: 3 S − 3 S² + S³ of them, S being a blur. What is much longer than the blur reaches does not
/// shrink, as it would with S alone [Taubin 1995].
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
