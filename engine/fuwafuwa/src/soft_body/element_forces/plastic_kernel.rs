//! Plastic flow of a batch, all lanes at once: the formulas of [`crate::soft_body::plasticity`] in single
//! precision.

use super::force_kernel::{BatchView, Moduli, Scratch, stress_of};
use super::rotation_extraction::{Matrix, turn};
use crate::foundation::dim::Dim;
use crate::math::lanes::{Eight, Lanes, at_least, if_positive, load, splat};
use crate::soft_body::element_law::MIN_VOLUME_RATIO;
use crate::soft_body::plasticity::{MAX_FLOW, MIN_FLOW_VOLUME_RATIO, Plasticity};
use fearless_simd::prelude::*;

/// Plastic flow limits of a material in single precision.
#[derive(Copy, Clone, Debug)]
pub struct PlasticFlowLimits {
    most_deviator: f32,
    most_flown: f32,
}

impl PlasticFlowLimits {
    pub fn of<D: Dim>(plasticity: Plasticity) -> Self {
        Self {
            most_deviator: plasticity.max_deviator::<D>() as f32,
            most_flown: plasticity.max_plastic_norm_squared::<D>() as f32,
        }
    }
}

/// Second loop for plastic elements: computes the stress like that of elastic elements, then applies plastic
/// flow. The loop is split into several functions that are not inlined, because a single function took
/// minutes to compile with scalar lanes.
#[inline(never)]
pub fn plastic_stress<D: Dim, S: Simd>(
    simd: S,
    material: (&Moduli, &PlasticFlowLimits),
    view: &mut BatchView,
    plastic_inverse: &mut [[Eight; 3]; 3],
    scratch: &mut Scratch,
) {
    simd.vectorize(
        #[inline(always)]
        || flow_on::<D, S>(simd, material, view, plastic_inverse, scratch),
    );
}

#[inline(always)]
fn flow_on<D: Dim, S: Simd>(
    simd: S,
    (moduli, flow): (&Moduli, &PlasticFlowLimits),
    view: &mut BatchView,
    plastic_inverse: &mut [[Eight; 3]; 3],
    scratch: &mut Scratch,
) {
    let zero = splat(simd, 0.0);
    let (mut f, mut g) = ([[zero; 3]; 3], [[zero; 3]; 3]);
    for i in 0..D::N {
        for j in 0..D::N {
            f[i][j] = load(simd, &scratch.f[i][j]);
            g[i][j] = load(simd, &plastic_inverse[i][j]);
        }
    }
    let elastic = product::<D, S>(zero, &f, &g);
    let rotation = turn::<D, S>(simd, &elastic, view.rotation);
    let own = stress_of::<D, S>(simd, moduli, &elastic, &rotation, view.inverted);
    let soft = plastic_stiffness_factor::<D, S>(simd, &g);
    for i in 0..D::N {
        for j in 0..D::N {
            let mut sum = zero;
            for k in 0..D::N {
                sum += own[i][k] * g[j][k];
            }
            (soft * sum).store_array(&mut scratch.stress[i][j]);
        }
    }
    let next = plastic_flow_outlined::<D, S>(simd, (moduli, flow), &elastic, &rotation, &g);
    for i in 0..D::N {
        for j in 0..D::N {
            next[i][j].store_array(&mut plastic_inverse[i][j]);
        }
    }
}

#[inline(never)]
fn plastic_flow_outlined<D: Dim, S: Simd>(
    simd: S,
    material: (&Moduli, &PlasticFlowLimits),
    elastic: &Matrix<S>,
    rotation: &Matrix<S>,
    g: &Matrix<S>,
) -> Matrix<S> {
    simd.vectorize(
        #[inline(always)]
        || plastic_flow::<D, S>(simd, material, elastic, rotation, g),
    )
}

#[inline(always)]
fn plastic_flow<D: Dim, S: Simd>(
    simd: S,
    (moduli, flow): (&Moduli, &PlasticFlowLimits),
    elastic: &Matrix<S>,
    rotation: &Matrix<S>,
    g: &Matrix<S>,
) -> Matrix<S> {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    let half = splat(simd, 0.5);
    let mut stretch = [[zero; 3]; 3];
    let mut mean = zero;
    for i in 0..D::N {
        for j in 0..D::N {
            let mut both = zero;
            for k in 0..D::N {
                both += rotation[k][i] * elastic[k][j] + rotation[k][j] * elastic[k][i];
            }
            stretch[i][j] = half * both;
        }
        mean += stretch[i][i];
    }
    mean *= splat(simd, 1.0 / D::N as f32);
    let (mut deviator, mut size) = (stretch, zero);
    for i in 0..D::N {
        deviator[i][i] -= mean;
        for j in 0..D::N {
            size += deviator[i][j] * deviator[i][j];
        }
    }
    let size = size.sqrt();
    let excess = size - splat(simd, flow.most_deviator);
    let most = splat(simd, MAX_FLOW as f32);
    let bounded = most - at_least(most - at_least(excess, zero), zero);
    let share = bounded / at_least(size, splat(simd, 1e-6));
    let mut step = [[zero; 3]; 3];
    for i in 0..D::N {
        for j in 0..D::N {
            let own = if i == j { one } else { zero };
            step[i][j] = own - share * deviator[i][j];
        }
    }
    let mut next = product::<D, S>(zero, g, &step);
    let scale = inverse_root::<D, S>(simd, determinant::<D, S>(&next));
    for i in 0..D::N {
        for j in 0..D::N {
            next[i][j] *= scale;
        }
    }
    let mut eased = product::<D, S>(zero, &stretch, &step);
    for i in 0..D::N {
        for j in 0..D::N {
            eased[i][j] *= scale;
        }
    }
    // Flow back towards the original shape raises the stiffness factor of an element, and may thereby raise
    // its elastic energy. Flow that would raise the energy is rejected, so the energies before and after are
    // compared.
    let whole = determinant::<D, S>(elastic);
    let before =
        plastic_stiffness_factor::<D, S>(simd, g) * density::<D, S>(simd, moduli, &stretch, whole);
    let after = plastic_stiffness_factor::<D, S>(simd, &next)
        * density::<D, S>(simd, moduli, &eased, whole);
    // An element flows only if four quantities are positive: the distance to the plastic limit, the decrease
    // of the energy, the excess over the minimum volume ratio, and the excess over the yield strain. Beyond
    // the plastic limit, the decrease of plastic strain takes the place of the distance. A comparison with
    // NaN is false, so NaN prevents flow.
    let (now, then) = (squared::<D, S>(zero, g), squared::<D, S>(zero, &next));
    let room = splat(simd, flow.most_flown) - then;
    let room = if_positive(room, room, now - then);
    let volume = whole - splat(simd, MIN_FLOW_VOLUME_RATIO as f32);
    let may = if_positive(room, if_positive(before - after, volume, zero), zero);
    let may = if_positive(excess, may, zero);
    let mut kept = *g;
    for i in 0..D::N {
        for j in 0..D::N {
            kept[i][j] = if_positive(may, next[i][j], g[i][j]);
        }
    }
    kept
}

/// Elastic energy density [J/m³] of elements with the symmetric stretch matrix `stretch` and the volume ratio
/// `volume`.
#[inline(always)]
fn density<D: Dim, S: Simd>(
    simd: S,
    moduli: &Moduli,
    stretch: &Matrix<S>,
    volume: Lanes<S>,
) -> Lanes<S> {
    let (zero, half) = (splat(simd, 0.0), splat(simd, 0.5));
    let (mut strain, mut trace) = (*stretch, zero);
    for i in 0..D::N {
        strain[i][i] -= splat(simd, 1.0);
        trace += strain[i][i];
    }
    let below = at_least(splat(simd, MIN_VOLUME_RATIO as f32) - volume, zero);
    half * (splat(simd, moduli.twice_shear) * squared::<D, S>(zero, &strain)
        + splat(simd, moduli.lame) * trace * trace
        + splat(simd, moduli.young) * below * below)
}

/// Returns the stiffness factor 1 / λ_max(GᵀG) of elements with plastic inverse G. The largest eigenvalue
/// λ_max is estimated from the trace and the norm of GᵀG.
#[inline(always)]
pub(super) fn plastic_stiffness_factor<D: Dim, S: Simd>(simd: S, g: &Matrix<S>) -> Lanes<S> {
    let zero = splat(simd, 0.0);
    let (mut trace, mut norm) = (zero, zero);
    for i in 0..D::N {
        for j in 0..D::N {
            let mut sum = zero;
            for k in 0..D::N {
                sum += g[k][i] * g[k][j];
            }
            norm += sum * sum;
            if i == j {
                trace += sum;
            }
        }
    }
    let axes = D::N as f32;
    let mean = trace / splat(simd, axes);
    let spread = at_least(norm - trace * mean, zero);
    let share = splat(simd, (axes - 1.0) / axes);
    splat(simd, 1.0) / (mean + (share * spread).sqrt())
}

/// Returns the inverse square root (2D) or inverse cube root (3D) of a number near 1.
#[inline(always)]
fn inverse_root<D: Dim, S: Simd>(simd: S, of: Lanes<S>) -> Lanes<S> {
    let one = splat(simd, 1.0);
    if D::N == 2 {
        return one / of.sqrt();
    }
    // Newton's iteration for the inverse cube root, from 1. Three rounds are enough for numbers from 0.8 to
    // 1.2.
    let (four, third) = (splat(simd, 4.0), splat(simd, 1.0 / 3.0));
    let mut root = one;
    for _ in 0..3 {
        root = root * (four - of * root * root * root) * third;
    }
    root
}

#[inline(always)]
pub(super) fn product<D: Dim, S: Simd>(zero: Lanes<S>, a: &Matrix<S>, b: &Matrix<S>) -> Matrix<S> {
    let mut product = [[zero; 3]; 3];
    for i in 0..D::N {
        for j in 0..D::N {
            for k in 0..D::N {
                product[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    product
}

#[inline(always)]
fn determinant<D: Dim, S: Simd>(m: &Matrix<S>) -> Lanes<S> {
    // In 2D the third axis is not deformed, so the determinant of the 2 × 2 part is that of the whole matrix.
    if D::N == 2 {
        return m[0][0] * m[1][1] - m[0][1] * m[1][0];
    }
    m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
}

#[inline(always)]
fn squared<D: Dim, S: Simd>(zero: Lanes<S>, m: &Matrix<S>) -> Lanes<S> {
    let mut sum = zero;
    for i in 0..D::N {
        for j in 0..D::N {
            sum += m[i][j] * m[i][j];
        }
    }
    sum
}
