//! Growth of the hourglass stiffness of hyperelastic elements under tension, all lanes at once: the formulas of
//! [`crate::soft_body::hyperelasticity`] in single precision, with the symbols of [`super::force_kernel`].

use super::force_kernel::{
    ClassData, Scratch, class_data_len, class_data_per_node, cofactor, symmetric,
};
use super::rotation_extraction::Matrix;
use crate::foundation::dim::Dim;
use crate::math::lanes::{Lanes, at_least, load, splat};
use fearless_simd::prelude::*;

/// Returns the growth s of the hourglass stiffness, and the matrix s'(J) (k/2V) Σ w |h|² h^(d−1) cof F, which adds to
/// h^(d−1) P. `spring` is k for elements with `count` nodes and the half width `half`; `rate` is c (λ + μ) / Y.
#[inline(always)]
pub fn tension_terms<D: Dim, S: Simd>(
    simd: S,
    rate: f32,
    class_data: &impl ClassData,
    (count, half, spring): (usize, Lanes<S>, Lanes<S>),
    scratch: &Scratch,
) -> (Lanes<S>, Matrix<S>) {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    let a_node = class_data_per_node::<D>();
    // Σ w |h|² = Σ w |x − c|² − h F : (2 G − h F W)
    let mut swings = zero;
    for node in 0..count {
        let w = class_data.get(simd, a_node * node + 2 * D::N);
        let mut squared = zero;
        for i in 0..D::N {
            let apart = load(simd, &scratch.x[node][i]) - load(simd, &scratch.centre[i]);
            squared += apart * apart;
        }
        swings += w * squared;
    }
    let mut f = [[zero; 3]; 3];
    for i in 0..D::N {
        for j in 0..D::N {
            f[i][j] = load(simd, &scratch.f[i][j]);
        }
    }
    for i in 0..D::N {
        for j in 0..D::N {
            let mut bent = zero;
            for k in 0..D::N {
                bent += f[i][k] * class_data.get(simd, a_node * count + symmetric::<D>(k, j));
            }
            let moment = load(simd, &scratch.moment[i][j]);
            swings -= half * f[i][j] * (moment + moment - half * bent);
        }
    }
    let rate = splat(simd, rate);
    let tension = rate * load(simd, &scratch.swelling);
    let growth = (one + tension * tension).sqrt();
    let inverse_volume = class_data.get(simd, class_data_len::<D>(count) - 2);
    let energy = splat(simd, 0.5) * spring * at_least(swings, zero);
    let scale = rate * tension / growth * energy * inverse_volume / half;
    let mut pull = cofactor::<D, S>(zero, &f);
    for row in &mut pull {
        for entry in row {
            *entry *= scale;
        }
    }
    (growth, pull)
}
