//! Constants of a material for the kernel, in single precision.

use super::force_kernel::Moduli;
use super::plastic_kernel::PlasticFlowLimits;
use crate::foundation::dim::Dim;
use crate::material::Material;
use crate::soft_body::element_law::{Elasticity, Law};
use crate::soft_body::hyperelasticity::tension_rate;
use crate::soft_body::viscosity::PronyTerm;

/// Constants of a material. Under [`Law::Endo2004`], only the moduli are used.
#[derive(Copy, Clone, Debug)]
pub struct MaterialConstants {
    pub moduli: Moduli,
    /// Limits of plastic flow; `None` if the material is elastic.
    pub flow: Option<PlasticFlowLimits>,
    /// Constants of a hyperelastic law; `None` under the corotational law.
    pub hyperelastic: Option<HyperelasticConstants>,
    /// Prony series; `None` if no term has a ratio above 0.
    pub prony: Option<[PronyTerm; 2]>,
}

/// Constants of [`crate::soft_body::hyperelasticity`].
#[derive(Copy, Clone, Debug)]
pub struct HyperelasticConstants {
    /// μ [Pa].
    pub shear: f32,
    /// λ + μ [Pa].
    pub bulk: f32,
    /// 2 a and 3 b.
    pub stiffening: [f32; 2],
    /// x_max
    pub max: f32,
    /// c (λ + μ) / Y, for the growth of the hourglass stiffness.
    pub tension_rate: f32,
}

impl MaterialConstants {
    /// Returns the constants of materials, with Young's modulus multiplied by `stiffness_scale`.
    pub fn of_all<D: Dim>(law: Law, materials: &[Material], stiffness_scale: f64) -> Vec<Self> {
        let of = |material: &Material| Self::of::<D>(law, material, stiffness_scale);
        materials.iter().map(of).collect()
    }

    fn of<D: Dim>(law: Law, material: &Material, stiffness_scale: f64) -> Self {
        let elasticity = Elasticity {
            young: material.elasticity.young * stiffness_scale,
            ..material.elasticity
        };
        let moduli = Moduli::of::<D>(elasticity);
        if law == Law::Endo2004 {
            return Self {
                moduli,
                flow: None,
                hyperelastic: None,
                prony: None,
            };
        }
        let shear = elasticity.shear_modulus();
        let factors = material.stress_law.factors();
        let hyperelastic = factors.map(|factors| HyperelasticConstants {
            shear: shear as f32,
            bulk: (elasticity.lame() + shear) as f32,
            stiffening: [(2.0 * factors.a) as f32, (3.0 * factors.b) as f32],
            max: factors.max.min(f64::from(f32::MAX)) as f32,
            tension_rate: tension_rate::<D>(elasticity) as f32,
        });
        Self {
            moduli,
            flow: material.plasticity().map(PlasticFlowLimits::of::<D>),
            hyperelastic,
            prony: material.is_viscous().then_some(material.prony),
        }
    }

    /// Returns whether the material is elastic and corotational.
    pub fn is_usual(&self) -> bool {
        !self.has_internal_state() && self.hyperelastic.is_none()
    }

    /// Returns whether the elements of the material have an internal state.
    pub fn has_internal_state(&self) -> bool {
        self.flow.is_some() || self.prony.is_some()
    }
}
