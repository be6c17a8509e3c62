//! Viscoelastic stress of a batch, all lanes at once: the formulas of [`crate::soft_body::viscosity`] in single
//! precision.

use super::force_kernel::{BatchView, Moduli, Scratch};
use super::plastic_kernel::{plastic_stiffness_factor, product};
use super::rotation_extraction::rotation_matrix;
use crate::foundation::dim::Dim;
use crate::math::lanes::{Eight, load, splat};
use crate::soft_body::viscosity::PronyTerm;
use fearless_simd::prelude::*;

/// Component of a symmetric matrix in the order xx, yy, zz, xy, yz, zx.
const fn component(i: usize, j: usize) -> usize {
    match (i, j) {
        (0, 1) | (1, 0) => 3,
        (1, 2) | (2, 1) => 4,
        (0, 2) | (2, 0) => 5,
        _ => i,
    }
}

/// Advances the strains of the dashpots by a substep, and adds the viscous stress to the stress of the second loop,
/// which has updated the rotations. Not inlined, because scalar lanes would take long to compile.
#[inline(never)]
pub fn add_viscous_stress<D: Dim, S: Simd>(
    simd: S,
    constants: (&Moduli, &[PronyTerm; 2], f32),
    view: &BatchView,
    plastic_inverse: Option<&[[Eight; 3]; 3]>,
    dashpots: &mut [[Eight; 6]; 2],
    scratch: &mut Scratch,
) {
    simd.vectorize(
        #[inline(always)]
        || add_in_lanes::<D, S>(simd, constants, view, plastic_inverse, dashpots, scratch),
    );
}

#[inline(always)]
fn add_in_lanes<D: Dim, S: Simd>(
    simd: S,
    (moduli, terms, duration): (&Moduli, &[PronyTerm; 2], f32),
    view: &BatchView,
    plastic_inverse: Option<&[[Eight; 3]; 3]>,
    dashpots: &mut [[Eight; 6]; 2],
    scratch: &mut Scratch,
) {
    let (zero, half) = (splat(simd, 0.0), splat(simd, 0.5));
    let (mut f, mut g) = ([[zero; 3]; 3], [[zero; 3]; 3]);
    for i in 0..D::N {
        for j in 0..D::N {
            f[i][j] = load(simd, &scratch.f[i][j]);
            g[i][j] = plastic_inverse.map_or(zero, |inverse| load(simd, &inverse[i][j]));
        }
    }
    if plastic_inverse.is_some() {
        f = product::<D, S>(zero, &f, &g);
    }
    let rotation = rotation_matrix::<D, S>(simd, view.rotation);
    let mut strain = [[zero; 3]; 3];
    for i in 0..D::N {
        for j in 0..D::N {
            let mut both = zero;
            for k in 0..D::N {
                both += rotation[k][i] * f[k][j] + rotation[k][j] * f[k][i];
            }
            strain[i][j] = half * both;
        }
        strain[i][i] -= splat(simd, 1.0);
    }
    let mut inner = [[zero; 3]; 3];
    for (term, dashpots) in terms.iter().zip(dashpots) {
        let share = splat(simd, term.share(f64::from(duration)) as f32);
        let stiffness = splat(simd, moduli.twice_shear * term.ratio);
        let (mut rest, mut mean) = ([[zero; 3]; 3], zero);
        for i in 0..D::N {
            for j in i..D::N {
                let dashpot = &mut dashpots[component(i, j)];
                let before = load(simd, dashpot);
                let after = before + share * (strain[i][j] - before);
                after.store_array(dashpot);
                rest[i][j] = strain[i][j] - after;
                rest[j][i] = rest[i][j];
            }
            mean += rest[i][i];
        }
        mean *= splat(simd, 1.0 / 3.0);
        for i in 0..D::N {
            rest[i][i] -= mean;
            for j in 0..D::N {
                inner[i][j] += stiffness * rest[i][j];
            }
        }
    }
    let mut stress = product::<D, S>(zero, &rotation, &inner);
    if plastic_inverse.is_some() {
        let soft = plastic_stiffness_factor::<D, S>(simd, &g);
        let mut transposed = g;
        for i in 0..D::N {
            for j in 0..D::N {
                transposed[i][j] = soft * g[j][i];
            }
        }
        stress = product::<D, S>(zero, &stress, &transposed);
    }
    for i in 0..D::N {
        for j in 0..D::N {
            let own = load(simd, &scratch.stress[i][j]);
            (own + stress[i][j]).store_array(&mut scratch.stress[i][j]);
        }
    }
}
