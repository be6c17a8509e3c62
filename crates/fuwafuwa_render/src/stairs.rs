//! How stairs of voxels go, before a body moves: the same for the lines of the plane and the surfaces of space.

use fuwafuwa::vector::{length, minus, plus, scaled};

/// Places without their stairs: 3 S − 3 S² + S³ of them, S being a blur. What is much longer than the blur reaches does not
/// shrink, as it would with S alone [Taubin 1995].
pub fn smoothed<const K: usize>(
    places: &[[f32; K]],
    blurred: impl Fn(&[[f32; K]]) -> Vec<[f32; K]>,
) -> Vec<[f32; K]> {
    let once = blurred(places);
    let twice = blurred(&once);
    let thrice = blurred(&twice);
    let sum = |k: usize| plus(scaled(minus(once[k], twice[k]), 3.0), thrice[k]);
    (0..places.len()).map(sum).collect()
}

/// An offset that is at most so long.
pub fn limited<const K: usize>(offset: [f32; K], farthest: f32) -> [f32; K] {
    match length(offset) {
        length if length > farthest => scaled(offset, farthest / length),
        _ => offset,
    }
}
