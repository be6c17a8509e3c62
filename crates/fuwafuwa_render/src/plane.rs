//! Small vectors of the plane.

/// A vector or a place in the plane [m].
pub type Flat = [f32; 2];

pub fn flat([x, y, _]: [f32; 3]) -> Flat {
    [x, y]
}

pub fn plus(a: Flat, b: Flat) -> Flat {
    [a[0] + b[0], a[1] + b[1]]
}

pub fn minus(a: Flat, b: Flat) -> Flat {
    [a[0] - b[0], a[1] - b[1]]
}

pub fn scaled(a: Flat, k: f32) -> Flat {
    [a[0] * k, a[1] * k]
}

pub fn mixed(a: Flat, b: Flat, share: f32) -> Flat {
    [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share]
}

pub fn dot(a: Flat, b: Flat) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

/// Twice the area between two vectors, positive when the second is to the left of the first.
pub fn cross(a: Flat, b: Flat) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}

/// The same direction with length 1; nothing where there is no direction.
pub fn unit(a: Flat) -> Flat {
    scaled(a, 1.0 / dot(a, a).sqrt().max(1e-12))
}
