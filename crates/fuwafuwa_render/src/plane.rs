//! What small vectors of the plane have beside the arithmetic of `fuwafuwa::vector`.

use fuwafuwa::vector::{length, minus, plus, scaled};

/// A vector or a place in the plane [m].
pub type Flat = [f32; 2];

pub fn flat([x, y, _]: [f32; 3]) -> Flat {
    [x, y]
}

pub fn mixed(a: Flat, b: Flat, share: f32) -> Flat {
    plus(a, scaled(minus(b, a), share))
}

/// Twice the area between two vectors, positive when the second is to the left of the first.
pub fn cross(a: Flat, b: Flat) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}

/// The same direction with length 1; nothing where there is no direction.
pub fn unit(a: Flat) -> Flat {
    scaled(a, 1.0 / length(a).max(1e-12))
}
