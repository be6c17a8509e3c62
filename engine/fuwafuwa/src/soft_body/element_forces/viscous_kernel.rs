//! Viscoelastic stress of a batch, all lanes at once: the formulas of [`crate::soft_body::viscosity`] in single
//! precision.

use super::force_kernel::{BatchView, Moduli, Scratch};
use super::plastic_kernel::{plastic_stiffness_factor, product};
use super::rotation_extraction::rotation_matrix;
use crate::foundation::dim::Dim;
use crate::math::lanes::{Eight, Lanes, at_least, load, splat};
use crate::soft_body::viscosity::PronyTerm;
use fearless_simd::prelude::*;

/// Least divisor. Only inverted elements have smaller ones.
const TINY: f32 = 1e-9;

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
    add_turning_stress::<D, S>(simd, &strain, &mut inner);
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

/// Adds the antisymmetric matrix W with which (S + W)(I + E) is symmetric to the stress S.
#[inline(always)]
fn add_turning_stress<D: Dim, S: Simd>(
    simd: S,
    strain: &[[Lanes<S>; 3]; 3],
    stress: &mut [[Lanes<S>; 3]; 3],
) {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    let mut stretch = *strain;
    let (mut trace, mut square) = (zero, zero);
    for i in 0..D::N {
        stretch[i][i] += one;
        trace += stretch[i][i];
        for j in 0..D::N {
            square += stress[i][j] * stress[i][j];
        }
    }
    // Component of U S − S U.
    let moment = |i: usize, j: usize| {
        let mut sum = zero;
        for k in 0..D::N {
            sum += stretch[i][k] * stress[k][j] - stress[i][k] * stretch[k][j];
        }
        sum
    };
    let axis = match D::N {
        2 => [
            zero,
            zero,
            moment(1, 0) / at_least(trace, splat(simd, TINY)),
        ],
        _ => {
            let moment = [moment(2, 1), moment(0, 2), moment(1, 0)];
            let mut matrix = stretch.map(|row| row.map(|k| zero - k));
            (0..3).for_each(|k| matrix[k][k] += trace);
            let cofactor = |i: usize, j: usize| {
                let [a, b] = [(i + 1) % 3, (i + 2) % 3];
                let [c, d] = [(j + 1) % 3, (j + 2) % 3];
                matrix[a][c] * matrix[b][d] - matrix[a][d] * matrix[b][c]
            };
            let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| cofactor(i, j)));
            let dot =
                |a: &[Lanes<S>; 3], b: &[Lanes<S>; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let determinant = at_least(dot(&matrix[0], &rows[0]), splat(simd, TINY));
            [0, 1, 2].map(|i| dot(&rows[i], &moment) / determinant)
        }
    };
    let length = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
    let most = splat(simd, 0.5) * square;
    // At most 1; a length of zero gives zero.
    let share = most / at_least(length, most + splat(simd, f32::MIN_POSITIVE));
    let [x, y, z] = axis.map(|component| component * share.sqrt());
    let turning = [
        [zero, zero - z, y],
        [z, zero, zero - x],
        [zero - y, x, zero],
    ];
    for i in 0..D::N {
        for j in 0..D::N {
            stress[i][j] += turning[i][j];
        }
    }
}
