//! Viscoelasticity in double precision: the reference for `viscous_kernel`.
//!
//! Each term of the Prony series is a spring in series with a dashpot, parallel to the elastic material. With the
//! Biot strain E of the elastic deformation in the frame of the element, the strain A of the dashpot, the rotation R
//! and the ratio g of the term, the term adds the stress
//!
//! ```text
//! P += R (S + W)        S = 2μ g dev(E − A)        dA/dt = (E − A) / τ
//! ```
//!
//! dev takes away a third of the trace, so that only shear relaxes. W is the antisymmetric matrix with which (S + W) U is
//! symmetric, where U = I + E. It makes P the gradient of the stored energy μ g |dev(E − A)|². Without it, an element in which
//! A and U have different axes would exert a torque on itself. The strain of the dashpot is integrated by the implicit Euler
//! method.

use crate::error::{Error, require};
use crate::foundation::hash::hash_state;
use crate::soft_body::element_law::{Elasticity, IDENTITY, Matrix, rotation_of};
use glam::DVec3;

/// Term of a Prony series: viscoelastic relaxation of the shear stress with one relaxation time.
///
/// With the terms i of a material, the shear modulus falls from μ (1 + Σ gᵢ) for fast motion to μ at rest, where μ is
/// that of the [`Elasticity`]: μ(t) = μ (1 + Σ gᵢ exp(−t/τᵢ)). Data sheets often give ratios hᵢ to the modulus of fast
/// motion instead; then gᵢ = hᵢ / (1 − Σ hᵢ), and the elasticity is (1 − Σ hᵢ) times that of fast motion.
///
/// The volume responds elastically. The relaxing stress is linear in the strain, also under a hyperelastic
/// [`StressLaw`](crate::StressLaw). A body that creeps no faster than the rest speeds of its world falls asleep and
/// stops, unless [`WorldConfig::sleep`](crate::WorldConfig::sleep) is false.
///
/// ```
/// use fuwafuwa::{Material, PronyTerm};
///
/// let dough = Material { prony: [PronyTerm::new(2.0, 0.5), PronyTerm::NONE], ..Material::default() };
/// assert!((dough.relaxation(0.0) - 3.0).abs() < 1e-6);
/// assert!((dough.relaxation(100.0) - 1.0).abs() < 1e-6);
/// ```
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PronyTerm {
    /// Ratio g of the relaxing shear modulus to the shear modulus at rest, 0 (no relaxation) to 100. A higher
    /// ratio requires shorter substeps.
    pub ratio: f32,
    /// Relaxation time τ [s], 0.001 to 1000.
    pub time: f32,
}

hash_state! { struct PronyTerm { ratio, time } }

impl PronyTerm {
    /// No relaxation.
    pub const NONE: Self = Self {
        ratio: 0.0,
        time: 1.0,
    };

    /// Creates a term from its ratio and its relaxation time [s].
    pub const fn new(ratio: f32, time: f32) -> Self {
        Self { ratio, time }
    }

    /// Checks both fields.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names the field that is out of range.
    pub(crate) fn check(self) -> Result<(), Error> {
        let is_valid = (0.0..=100.0).contains(&self.ratio);
        require(is_valid, "prony.ratio", "0 to 100", self.ratio)?;
        let is_valid = (1e-3..=1e3).contains(&self.time);
        require(is_valid, "prony.time", "0.001 to 1000 s", self.time)
    }

    /// Returns the share of the strain by which the dashpot follows in `duration` [s].
    pub(crate) fn share(self, duration: f64) -> f64 {
        duration / (f64::from(self.time) + duration)
    }
}

/// Strains of the dashpots of an element: for each term the components xx, yy, zz, xy, yz and zx of A.
pub type ViscousStrains = [[f64; 6]; 2];

/// Returns the Biot strain of an elastic deformation gradient, and its rotation.
fn biot_strain(elastic: &Matrix) -> (Matrix, Matrix) {
    let rotation = rotation_of(elastic);
    let column = |m: &Matrix, k: usize| DVec3::new(m[0][k], m[1][k], m[2][k]);
    let mut strain = [DVec3::ZERO; 3];
    for i in 0..3 {
        for j in 0..3 {
            let one = column(&rotation, i).dot(column(elastic, j));
            let other = column(&rotation, j).dot(column(elastic, i));
            strain[i][j] = 0.5 * (one + other) - IDENTITY[i][j];
        }
    }
    (strain, rotation)
}

/// Returns E − A of a term.
fn relaxing(strain: &Matrix, dashpot: &[f64; 6]) -> Matrix {
    let [xx, yy, zz, xy, yz, zx] = *dashpot;
    let dashpot = [
        DVec3::new(xx, xy, zx),
        DVec3::new(xy, yy, yz),
        DVec3::new(zx, yz, zz),
    ];
    [0, 1, 2].map(|i: usize| strain[i] - dashpot[i])
}

/// Returns the viscous part of the first Piola–Kirchhoff stress [Pa], and its stored energy per volume [J/m³].
pub(crate) fn viscous_stress(
    elasticity: Elasticity,
    terms: &[PronyTerm; 2],
    elastic: &Matrix,
    dashpots: &ViscousStrains,
) -> (Matrix, f64) {
    let (strain, rotation) = biot_strain(elastic);
    let (mut inner, mut energy) = ([DVec3::ZERO; 3], 0.0);
    for (term, dashpot) in terms.iter().zip(dashpots) {
        let mut rest = relaxing(&strain, dashpot);
        let mean = (rest[0].x + rest[1].y + rest[2].z) / 3.0;
        (0..3).for_each(|k| rest[k][k] -= mean);
        let stiffness = 2.0 * elasticity.shear_modulus() * f64::from(term.ratio);
        for (inner, rest) in inner.iter_mut().zip(rest) {
            *inner += rest * stiffness;
            energy += 0.5 * stiffness * rest.length_squared();
        }
    }
    let turning = turning_stress(&strain, &inner);
    (0..3).for_each(|i| inner[i] += turning[i]);
    let stress = rotation.map(|row| inner[0] * row.x + inner[1] * row.y + inner[2] * row.z);
    (stress, energy)
}

/// Returns the antisymmetric matrix W with which (S + W)(I + E) is symmetric, for a strain E and a symmetric stress S. In the
/// principal axes of E, with the stretches u, W₂₃ = S₂₃ (u₂ − u₃) / (u₂ + u₃): it is no larger than S unless the element is
/// inverted. W of an inverted element is limited to about the size of S.
fn turning_stress(strain: &Matrix, stress: &Matrix) -> Matrix {
    let stretch = [0, 1, 2].map(|i: usize| strain[i] + IDENTITY[i]);
    let dot = |a: &Matrix, i: usize, b: &Matrix, j: usize| a[i].dot(b[j]);
    // (U S − S U)ᵢⱼ = uᵢ · sⱼ − sᵢ · uⱼ, because both are symmetric. Its axial vector is (tr U − U) that of W.
    let moment = |i: usize, j: usize| dot(&stretch, i, stress, j) - dot(stress, i, &stretch, j);
    let moment = DVec3::new(moment(2, 1), moment(0, 2), moment(1, 0));
    let trace = stretch[0].x + stretch[1].y + stretch[2].z;
    let rows = [0, 1, 2].map(|i: usize| IDENTITY[i] * trace - stretch[i]);
    let adjugate = [
        rows[1].cross(rows[2]),
        rows[2].cross(rows[0]),
        rows[0].cross(rows[1]),
    ];
    let determinant = rows[0].dot(adjugate[0]);
    let axis = DVec3::from(adjugate.map(|row| row.dot(moment))) / determinant.max(1e-9);
    let most = (0.5 * stress.iter().map(|row| row.length_squared()).sum::<f64>()).sqrt();
    let axis = axis.clamp_length_max(most);
    [
        DVec3::new(0.0, -axis.z, axis.y),
        DVec3::new(axis.z, 0.0, -axis.x),
        DVec3::new(-axis.y, axis.x, 0.0),
    ]
}
