//! Stress of a batch whose material is hyperelastic, plastic or viscoelastic, all lanes at once: the formulas of
//! [`crate::soft_body::hyperelasticity`] in single precision, and the choice between the laws.

use super::force_kernel::{BatchView, Scratch, cofactor, stress};
use super::internal_state::InternalLanes;
use super::material_constants::{HyperelasticConstants, MaterialConstants};
use super::plastic_kernel::plastic_stress;
use super::rotation_extraction::turn;
use super::viscous_kernel::add_viscous_stress;
use crate::foundation::dim::Dim;
use crate::math::lanes::{at_least, if_positive, load, positive, splat};
use crate::soft_body::element_law::Law;
use crate::soft_body::hyperelasticity::{CRUSH_FACTOR, CRUSH_THRESHOLD};
use fearless_simd::prelude::*;

/// Second loop for unusual materials: updates the rotation and the internal state, and computes the stress.
#[inline(always)]
pub fn unusual_stress<D: Dim, S: Simd>(
    simd: S,
    (material, duration): (&MaterialConstants, f32),
    view: &mut BatchView,
    internal: Option<&mut InternalLanes>,
    scratch: &mut Scratch,
) {
    let moduli = &material.moduli;
    let Some(internal) = internal else {
        match &material.hyperelastic {
            Some(constants) => hyperelastic_stress::<D, S>(simd, constants, view, scratch),
            None => stress::<D, S>(simd, Law::CorotationalVem, moduli, view, scratch),
        }
        return;
    };
    // Dashpots follow the elastic strain before the flow of this substep.
    let plastic_inverse = internal.plastic_inverse;
    match (&material.flow, &material.hyperelastic) {
        (Some(flow), _) => {
            let inner = &mut internal.plastic_inverse;
            plastic_stress::<D, S>(simd, (moduli, flow), view, inner, scratch);
        }
        (None, Some(constants)) => hyperelastic_stress::<D, S>(simd, constants, view, scratch),
        (None, None) => stress::<D, S>(simd, Law::CorotationalVem, moduli, view, scratch),
    }
    if let Some(terms) = &material.prony {
        let plastic_inverse = material.flow.is_some().then_some(&plastic_inverse);
        let constants = (moduli, terms, duration);
        let dashpots = &mut internal.dashpots;
        add_viscous_stress::<D, S>(simd, constants, view, plastic_inverse, dashpots, scratch);
    }
}

/// Second loop for hyperelastic materials. Not inlined, because scalar lanes would take long to compile.
#[inline(never)]
fn hyperelastic_stress<D: Dim, S: Simd>(
    simd: S,
    constants: &HyperelasticConstants,
    view: &mut BatchView,
    scratch: &mut Scratch,
) {
    simd.vectorize(
        #[inline(always)]
        || hyperelastic_lanes::<D, S>(simd, constants, view, scratch),
    );
}

#[inline(always)]
fn hyperelastic_lanes<D: Dim, S: Simd>(
    simd: S,
    constants: &HyperelasticConstants,
    view: &mut BatchView,
    scratch: &mut Scratch,
) {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    let mut f = [[zero; 3]; 3];
    // |F|² − 3, of which the third axis adds nothing in 2D.
    let mut squares = splat(simd, -(D::N as f32));
    for i in 0..D::N {
        for j in 0..D::N {
            f[i][j] = load(simd, &scratch.f[i][j]);
            squares += f[i][j] * f[i][j];
        }
    }
    // The stress does not use the rotation, but fracture does.
    turn::<D, S>(simd, &f, view.rotation);
    let cofactor = cofactor::<D, S>(zero, &f);
    let mut swelling = splat(simd, -1.0);
    for j in 0..D::N {
        swelling += f[0][j] * cofactor[0][j];
    }
    *view.inverted = positive(zero - one - swelling);
    at_least(swelling, zero).store_array(&mut scratch.swelling);
    let max = splat(simd, constants.max);
    let stretched = at_least(squares - (swelling + swelling), zero);
    let stretched = if_positive(max - stretched, stretched, max);
    let [second, third] = constants.stiffening;
    let growth = splat(simd, second) + splat(simd, third) * stretched;
    let distortion = splat(simd, constants.shear) * (one + growth * stretched);
    let pressure = splat(simd, constants.bulk) * swelling;
    let area = pressure - distortion;
    let [least, factor] = [CRUSH_THRESHOLD, CRUSH_FACTOR].map(|k| k as f32);
    let crushed = squares * splat(simd, -1.0 / least) + splat(simd, 1.0 - 3.0 / least);
    let crushed = at_least(crushed, zero);
    let length = distortion - splat(simd, constants.shear * factor) * (crushed * crushed);
    for i in 0..D::N {
        for j in 0..D::N {
            let stress = length * f[i][j] + area * cofactor[i][j];
            stress.store_array(&mut scratch.stress[i][j]);
        }
    }
}
