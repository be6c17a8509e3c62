//! Plasticity of an element in double precision: the reference for `plastic_kernel`.
//!
//! The deformation gradient is the product F = Fₑ Fₚ of an elastic and a plastic part [Bargteil 2007]. The
//! state is the plastic inverse G = Fₚ⁻¹, with determinant 1, because plastic flow preserves volume. Let Pₑ
//! be the stress of the elastic law, R the rotation of Fₑ, S = sym RᵀFₑ the stretch, and D the deviator of S.
//! Let y be the norm of D at which the material yields, f the largest flow per evaluation, and n the number
//! of dimensions. Then the stress P and the flow are
//!
//! ```text
//! Fₑ = F G       P = s Pₑ(Fₑ) Gᵀ        s = 1 / λ_max(GᵀG)
//! |D| > y:       G ← G Q / (det G Q)^(1/n),   Q = 1 − min(|D| − y, f) D/|D|
//! ```
//!
//! Q commutes with S. The flow therefore reduces the elastic strain by exactly min(|D| − y, f) and leaves R
//! unchanged, so that no decomposition is needed. This is the return mapping of von Mises' law to first
//! order. P Fᵀ is symmetric like Pₑ Fₑᵀ, so angular momentum is conserved. The additive strain of [Mueller
//! 2004] does not conserve it if the plastic and the elastic strain of an element have different directions.
//!
//! The factor s prevents flattened elements from becoming too stiff for the substep. Without the factor, a
//! sheet pressed to half its thickness would be four times as stiff across the sheet, relative to its rest
//! shape. Beyond the plastic limit of the material, an element is purely elastic.

use crate::foundation::dim::Dim;
use crate::soft_body::element_law::{
    ElasticLaw, Elasticity, IDENTITY, MIN_VOLUME_RATIO, Matrix, deformation_of, forces_of_stress,
    rotation_of, stress,
};
use crate::topology::element_class::ElementClass;
use glam::DVec3;

/// Largest plastic strain per evaluation; the limit prevents jumps in the shape of violently torn elements.
/// The flow is computed to first order, with an error of half the squared plastic strain, here 2 %.
pub(crate) const MAX_FLOW: f64 = 0.2;
/// Volume ratio below which an element does not flow; a quarter of [`MIN_VOLUME_RATIO`]. The strain of such
/// an element is not meaningful.
pub(crate) const MIN_FLOW_VOLUME_RATIO: f64 = 0.1;

/// Yield strain and plastic limit of a material.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Plasticity {
    /// Yield strain: the largest strain that is fully recovered; 0.05 for clay.
    pub yield_strain: f64,
    /// Plastic limit: the largest factor by which a width can shrink permanently; usually 2.
    pub limit: f64,
}

impl Plasticity {
    /// Norm of the strain deviator at which the material yields: ε √(n / (n − 1)), which is the norm for a
    /// volume-preserving stretch by the yield strain ε in n dimensions.
    pub(crate) fn max_deviator<D: Dim>(self) -> f64 {
        let axes = D::N as f64;
        self.yield_strain * (axes / (axes - 1.0)).sqrt()
    }

    /// Largest squared norm of the plastic inverse G: its value after compression to the plastic limit along
    /// one axis, with equal expansion along the other axes.
    pub(crate) fn max_plastic_norm_squared<D: Dim>(self) -> f64 {
        let squared = self.limit * self.limit;
        // In 2D one other axis expands, in 3D two.
        match D::N {
            2 => squared + 1.0 / squared,
            _ => squared + 2.0 / self.limit,
        }
    }
}

/// Returns the elastic part F G of a deformation gradient F with the plastic inverse G = `plastic_inverse`.
pub fn elastic_part(deformation: &Matrix, plastic_inverse: &Matrix) -> Matrix {
    product(deformation, plastic_inverse)
}

/// Returns the first Piola–Kirchhoff stress [Pa] of a deformation gradient with a plastic inverse.
pub fn stress_after<D: Dim>(
    elastic: ElasticLaw,
    deformation: &Matrix,
    plastic_inverse: &Matrix,
) -> Matrix {
    let own = stress(elastic, &elastic_part(deformation, plastic_inverse));
    let soft = plastic_stiffness_factor::<D>(plastic_inverse);
    let mut total = [DVec3::ZERO; 3];
    for i in 0..3 {
        for j in 0..3 {
            total[i][j] = soft * own[i].dot(plastic_inverse[j]);
        }
    }
    total
}

/// Returns the elastic force [N] that an element with a plastic inverse exerts on each of its
/// nodes. The element is `size` [m] wide; `positions` are those of its nodes [m].
///
/// # Panics
/// If the number of positions is not the number of nodes of the element class.
#[inline(never)]
pub fn forces_after<D: Dim>(
    elasticity: Elasticity,
    plastic_inverse: &Matrix,
    element_class: &ElementClass<D>,
    size: f64,
    positions: &[DVec3],
) -> Vec<DVec3> {
    assert_eq!(
        positions.len(),
        element_class.slots.len(),
        "the number of positions must match the nodes of the element class"
    );
    let (deformation, _) = deformation_of(element_class, size, positions);
    let stress = stress_after::<D>(elasticity.into(), &deformation, plastic_inverse);
    forces_of_stress(elasticity, &stress, 1.0, element_class, size, positions)
}

/// Returns the plastic inverse after plastic flow. It differs from the `plastic_inverse` before the flow
/// only if the elastic strain exceeds the yield strain.
pub fn flow<D: Dim>(
    plasticity: Plasticity,
    elasticity: Elasticity,
    deformation: &Matrix,
    plastic_inverse: &Matrix,
) -> Matrix {
    let elastic = elastic_part(deformation, plastic_inverse);
    if determinant(&elastic) <= MIN_FLOW_VOLUME_RATIO {
        return *plastic_inverse;
    }
    let rotation = rotation_of(&elastic);
    let column = |m: &Matrix, k: usize| DVec3::new(m[0][k], m[1][k], m[2][k]);
    let whole = determinant(&elastic);
    let mut stretch = IDENTITY;
    for i in 0..D::N {
        for j in 0..D::N {
            let one = column(&rotation, i).dot(column(&elastic, j));
            let other = column(&rotation, j).dot(column(&elastic, i));
            stretch[i][j] = 0.5 * (one + other);
        }
    }
    let mut deviator = stretch;
    (D::N..3).for_each(|k| deviator[k][k] = 0.0);
    let mean = (0..D::N).map(|k| deviator[k][k]).sum::<f64>() / D::N as f64;
    (0..D::N).for_each(|k| deviator[k][k] -= mean);
    let size = squared(&deviator).sqrt();
    let excess = size - plasticity.max_deviator::<D>();
    if excess <= 0.0 {
        return *plastic_inverse;
    }
    let share = excess.min(MAX_FLOW) / size;
    let mut step = [DVec3::ZERO; 3];
    for i in 0..3 {
        for j in 0..3 {
            step[i][j] = f64::from(u8::from(i == j)) - share * deviator[i][j];
        }
    }
    let next = product(plastic_inverse, &step);
    let volume = determinant(&next);
    // Rescales the plastic inverse to determinant 1; in 2D by two axes only, because the third axis is not
    // deformed.
    let scale = 1.0
        / if D::N == 2 {
            volume.sqrt()
        } else {
            libm::cbrt(volume)
        };
    let mut next = next;
    for i in 0..D::N {
        for j in 0..D::N {
            next[i][j] *= scale;
        }
    }
    let inner = |m: &Matrix| squared(m) - (3 - D::N) as f64;
    // Flow back towards the original shape raises the stiffness factor of an element, and may thereby raise
    // its elastic energy. Flow that would raise the energy is rejected, so the energies before and after are
    // compared.
    let eased = product(&stretch, &step);
    let eased = [0, 1, 2].map(|i: usize| {
        DVec3::from([0, 1, 2].map(|j: usize| {
            if i < D::N && j < D::N {
                scale * eased[i][j]
            } else {
                IDENTITY[i][j]
            }
        }))
    });
    let before =
        plastic_stiffness_factor::<D>(plastic_inverse) * density(elasticity, &stretch, whole);
    let after = plastic_stiffness_factor::<D>(&next) * density(elasticity, &eased, whole);
    if after >= before {
        return *plastic_inverse;
    }
    let may_be = inner(&next) < plasticity.max_plastic_norm_squared::<D>()
        || inner(&next) < inner(plastic_inverse);
    if may_be { next } else { *plastic_inverse }
}

/// Elastic energy density [J/m³] of an element with the symmetric stretch matrix `stretch` and the volume
/// ratio `volume`.
fn density(elasticity: Elasticity, stretch: &Matrix, volume: f64) -> f64 {
    let mut strain = *stretch;
    (0..3).for_each(|k| strain[k][k] -= 1.0);
    let spread = strain[0][0] + strain[1][1] + strain[2][2];
    let below = (MIN_VOLUME_RATIO - volume).max(0.0);
    elasticity.shear_modulus() * squared(&strain)
        + 0.5 * elasticity.lame() * spread * spread
        + 0.5 * elasticity.young * below * below
}

/// Stiffness factor 1 / λ_max(GᵀG) of an element with plastic inverse G. The largest eigenvalue λ_max is
/// estimated from the trace and the norm of GᵀG; exact in 2D and for elements flattened along one axis.
pub fn plastic_stiffness_factor<D: Dim>(plastic_inverse: &Matrix) -> f64 {
    let axes = D::N as f64;
    let mut squares = [DVec3::ZERO; 3];
    for i in 0..D::N {
        for j in 0..D::N {
            squares[i][j] = (0..D::N)
                .map(|k| plastic_inverse[k][i] * plastic_inverse[k][j])
                .sum();
        }
    }
    let trace = (0..D::N).map(|k| squares[k][k]).sum::<f64>();
    let spread = (squared(&squares) - trace * trace / axes).max(0.0);
    1.0 / (trace / axes + ((axes - 1.0) / axes * spread).sqrt())
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let mut product = [DVec3::ZERO; 3];
    for i in 0..3 {
        for j in 0..3 {
            product[i][j] = (0..3).map(|k| a[i][k] * b[k][j]).sum();
        }
    }
    product
}

fn determinant(m: &Matrix) -> f64 {
    m[0].dot(m[1].cross(m[2]))
}

fn squared(m: &Matrix) -> f64 {
    m.iter().map(|&row| row.dot(row)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};

    const CLAY: Plasticity = Plasticity {
        yield_strain: 0.05,
        limit: 2.0,
    };

    fn soft() -> Elasticity {
        Elasticity::new(5000.0, 0.3).unwrap()
    }

    fn check_flow<D: Dim>() {
        // Deformation gradient of a stretch by the factor `by` along the first axis, with preserved volume.
        let drawn = |by: f64| {
            let mut f = IDENTITY;
            f[0][0] = by;
            let across = if D::N == 2 { 1.0 / by } else { 1.0 / by.sqrt() };
            (1..D::N).for_each(|k| f[k][k] = across);
            f
        };
        assert_eq!(flow::<D>(CLAY, soft(), &drawn(1.04), &IDENTITY), IDENTITY);
        let mut plastic_inverse = IDENTITY;
        for _ in 0..40 {
            plastic_inverse = flow::<D>(CLAY, soft(), &drawn(1.3), &plastic_inverse);
            assert!((determinant(&plastic_inverse) - 1.0).abs() < 1e-12);
        }
        // After the flow, the elastic strain that remains is the yield strain; the excess has become plastic.
        let left = elastic_part(&drawn(1.3), &plastic_inverse)[0][0];
        assert!((left - 1.05).abs() < 2e-3, "{left}");
        assert!(plastic_stiffness_factor::<D>(&plastic_inverse) <= 1.0);
        // An element is compressed to 0.3 of its width, but flows only to half its width, the plastic limit.
        // Stretching back then restores the original shape up to the yield strain.
        let mut flat = IDENTITY;
        for step in 0..400 {
            let by = 1.0 - 0.7 * f64::from(step.min(300)) / 300.0;
            flat = flow::<D>(CLAY, soft(), &drawn(by), &flat);
        }
        let pressed = 1.0 / flat[0][0];
        assert!((pressed - 0.5).abs() < 0.02, "{pressed}");
        assert!((plastic_stiffness_factor::<D>(&flat) - 0.25).abs() < 0.03);
        // Deforms in many small steps. Flow is correct only to first order, so one large step would flow too
        // far.
        for step in 0..400 {
            let by = 0.3 + 0.7 * f64::from(step.min(300)) / 300.0;
            flat = flow::<D>(CLAY, soft(), &drawn(by), &flat);
        }
        assert!((1.0 / flat[0][0] - 0.95).abs() < 0.01, "{flat:?}");
    }

    #[test]
    fn flow_reaches_yield_strain_and_preserves_volume() {
        check_flow::<Dim2>();
        check_flow::<Dim3>();
    }

    /// Regression test: an earlier law with additive plastic strain exerted a torque if the plastic strain
    /// was not along the load.
    #[test]
    fn stress_after_flow_preserves_angular_momentum() {
        let mut plastic_inverse = IDENTITY;
        let sheared = [[1.0, 0.5, 0.0], [0.1, 1.0, 0.2], [0.0, 0.0, 1.0]].map(DVec3::from);
        (0..20)
            .for_each(|_| plastic_inverse = flow::<Dim3>(CLAY, soft(), &sheared, &plastic_inverse));
        let elasticity = Elasticity::new(5000.0, 0.3).unwrap();
        let other = [[0.9, -0.2, 0.3], [0.1, 1.2, 0.0], [-0.2, 0.1, 1.1]].map(DVec3::from);
        let stress = stress_after::<Dim3>(elasticity.into(), &other, &plastic_inverse);
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let spin = stress[i].dot(other[j]) - stress[j].dot(other[i]);
            assert!(spin.abs() < 1e-7 * elasticity.young, "{spin}");
        }
    }
}
