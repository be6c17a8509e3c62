//! Rotation part of deformation gradients, all lanes at once.

use crate::foundation::dim::Dim;
use crate::math::lanes::{Eight, Lanes, if_positive, load, splat};
use fearless_simd::prelude::*;

pub type Matrix<S> = [[Lanes<S>; 3]; 3];

/// Updates `rotation` to the rotation part of the deformation gradient `f`, and returns it as a matrix; see
/// [`crate::soft_body::element_law::rotation_of`]. Exact in 2D. In 3D, two iterations from the previous
/// rotation.
#[inline(always)]
pub fn turn<D: Dim, S: Simd>(simd: S, f: &Matrix<S>, rotation: &mut [Eight; 4]) -> Matrix<S> {
    if D::N == 2 {
        return turn_in_plane(simd, f, rotation);
    }
    let mut q = [splat(simd, 0.0); 4];
    for part in 0..4 {
        q[part] = load(simd, &rotation[part]);
    }
    // Two iterations: a single one would lag behind a body that spins while it is squashed.
    q = turn_in_space(simd, f, turn_in_space(simd, f, q));
    for part in 0..4 {
        q[part].store_array(&mut rotation[part]);
    }
    matrix_of(simd, q)
}

/// Returns the rotation part of a 2D deformation gradient F exactly: (cos, sin) ∝ (F₀₀ + F₁₁, F₁₀ − F₀₁).
/// Keeps the previous rotation if both components on the right are almost 0.
#[inline(always)]
fn turn_in_plane<S: Simd>(simd: S, f: &Matrix<S>, rotation: &mut [Eight; 4]) -> Matrix<S> {
    let zero = splat(simd, 0.0);
    let (a, b) = (f[0][0] + f[1][1], f[1][0] - f[0][1]);
    let squared = a * a + b * b;
    let inverse = splat(simd, 1.0) / squared.sqrt();
    let is_clear = squared - splat(simd, 1e-24);
    let cosine = if_positive(is_clear, a * inverse, load(simd, &rotation[0]));
    let sine = if_positive(is_clear, b * inverse, load(simd, &rotation[1]));
    cosine.store_array(&mut rotation[0]);
    sine.store_array(&mut rotation[1]);
    [[cosine, zero - sine, zero], [sine, cosine, zero], [zero; 3]]
}

/// Returns the rotation, as a quaternion, after one iteration from `q` towards the rotation part of the 3D
/// deformation gradient `f`.
#[inline(always)]
fn turn_in_space<S: Simd>(simd: S, f: &Matrix<S>, q: [Lanes<S>; 4]) -> [Lanes<S>; 4] {
    let zero = splat(simd, 0.0);
    let half = splat(simd, 0.5);
    let r = matrix_of(simd, q);
    let mut s = [[zero; 3]; 3];
    let mut norm = zero;
    for i in 0..3 {
        for j in 0..3 {
            s[i][j] = f[i][0] * r[j][0] + f[i][1] * r[j][1] + f[i][2] * r[j][2];
            norm += f[i][j] * f[i][j];
        }
    }
    let t = (splat(simd, 3.0) * norm).sqrt() + splat(simd, 1e-6);
    // Rounds values to multiples of about 1e-12, the resolution of `f32` near 1e-5. Otherwise elements at
    // rest would compute with subnormal numbers, which are slow.
    let rounder = splat(simd, 1e-5);
    let settled = |value: Lanes<S>| (value + rounder) - rounder;
    let axial = [
        settled(s[2][1] - s[1][2]),
        settled(s[0][2] - s[2][0]),
        settled(s[1][0] - s[0][1]),
    ];
    let (a, d, g) = (t - s[0][0], t - s[1][1], t - s[2][2]);
    let b = zero - half * (s[0][1] + s[1][0]);
    let c = zero - half * (s[0][2] + s[2][0]);
    let e = zero - half * (s[1][2] + s[2][1]);
    let (c00, c01, c02) = (d * g - e * e, c * e - b * g, b * e - c * d);
    let (c11, c12, c22) = (a * g - c * c, b * c - a * e, a * d - b * b);
    let k = half / (a * c00 + b * c01 + c * c02);
    let w = [
        k * (c00 * axial[0] + c01 * axial[1] + c02 * axial[2]),
        k * (c01 * axial[0] + c11 * axial[1] + c12 * axial[2]),
        k * (c02 * axial[0] + c12 * axial[1] + c22 * axial[2]),
    ];
    let [x, y, z, o] = q;
    let next = [
        x + w[0] * o + w[1] * z - w[2] * y,
        y + w[1] * o + w[2] * x - w[0] * z,
        z + w[2] * o + w[0] * y - w[1] * x,
        o - w[0] * x - w[1] * y - w[2] * z,
    ];
    let squared = next[0] * next[0] + next[1] * next[1] + next[2] * next[2] + next[3] * next[3];
    let scale = splat(simd, 1.0) / squared.sqrt();
    [
        next[0] * scale,
        next[1] * scale,
        next[2] * scale,
        next[3] * scale,
    ]
}

/// Returns the matrix of a stored rotation.
#[inline(always)]
pub fn rotation_matrix<D: Dim, S: Simd>(simd: S, rotation: &[Eight; 4]) -> Matrix<S> {
    let mut parts = [splat(simd, 0.0); 4];
    for part in 0..4 {
        parts[part] = load(simd, &rotation[part]);
    }
    if D::N == 2 {
        let (zero, [cosine, sine, ..]) = (splat(simd, 0.0), parts);
        return [[cosine, zero - sine, zero], [sine, cosine, zero], [zero; 3]];
    }
    matrix_of(simd, parts)
}

/// Returns the rotation matrix of a unit quaternion (x, y, z, w).
#[inline(always)]
pub fn matrix_of<S: Simd>(simd: S, q: [Lanes<S>; 4]) -> Matrix<S> {
    let [x, y, z, w] = q;
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let one = splat(simd, 1.0);
    [
        [one - (y * y2 + z * z2), x * y2 - w * z2, x * z2 + w * y2],
        [x * y2 + w * z2, one - (x * x2 + z * z2), y * z2 - w * x2],
        [x * z2 - w * y2, y * z2 + w * x2, one - (x * x2 + y * y2)],
    ]
}
