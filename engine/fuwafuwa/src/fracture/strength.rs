//! Strength under stress in several directions, and toughness that grows with the speed of a crack.

use crate::error::{Error, require};
use crate::foundation::hash::hash_state;

/// Criterion by which a multiaxial stress starts a crack.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum StrengthCriterion {
    /// The greatest principal stress decides. Cracks start at surfaces only.
    #[default]
    GreatestTension,
    /// Criterion of Drucker and Prager [Kumar 2020]: √J₂ + γ I₁ = k, with the first invariant I₁ of the stress and the
    /// second invariant J₂ of its deviator. The constants γ and k follow from the tensile strength, the stress at which a
    /// bar under tension fails, and the hydrostatic strength. Cracks also start inside a body, in a plane perpendicular
    /// to the greatest tension.
    DruckerPrager {
        /// Hydrostatic strength [Pa]: the tension in all directions that the material withstands; above a third of
        /// the tensile strength.
        hydrostatic: f32,
    },
}

hash_state! { enum StrengthCriterion { GreatestTension, DruckerPrager { hydrostatic } } }

impl StrengthCriterion {
    /// Checks the hydrostatic strength against the tensile strength [Pa].
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the hydrostatic strength is out of range.
    pub(crate) fn check(self, strength: f32) -> Result<(), Error> {
        let Self::DruckerPrager { hydrostatic } = self else {
            return Ok(());
        };
        let is_valid =
            hydrostatic.is_finite() && strength.is_finite() && hydrostatic > strength / 3.0;
        let expected = "finite and above a third of a finite strength [Pa]";
        require(is_valid, "hydrostatic_strength", expected, hydrostatic)
    }

    /// Returns γ, relative to the factor of √J₂, of a material with a tensile strength [Pa]; `None` if the greatest
    /// tension decides.
    pub(crate) fn pressure_factor(self, strength: f32) -> Option<f32> {
        match self {
            Self::GreatestTension => None,
            // Tension σ: √J₂ = σ/√3, I₁ = σ. Hydrostatic tension σₕ: √J₂ = 0, I₁ = 3 σₕ.
            Self::DruckerPrager { hydrostatic } => {
                Some(strength / (3f32.sqrt() * (3.0 * hydrostatic - strength)))
            }
        }
    }
}

/// Growth of the fracture energy G with the speed v of a crack or of a cutting edge: G max(1, v / v₀)^m.
///
/// Below the speed v₀, the energy is that of [`Material::fracture_energy`](crate::Material::fracture_energy). A crack
/// grows no faster than at the speed at which the fracture energy equals the energy release rate.
///
/// ```
/// use fuwafuwa::{Material, RateToughening};
///
/// // Gelatine with 10 % of solids: 1.1 J/m² up to 10 mm/min, then with the root of the speed (Forte and others 2015).
/// let gelatine = Material {
///     rate_toughening: RateToughening { speed: 0.01 / 60.0, exponent: 0.5 },
///     ..Material::default()
/// };
/// let ratio = gelatine.fracture_energy_at(1.0 / 60.0) / gelatine.fracture_energy();
/// assert!((ratio - 10.0).abs() < 1e-3);
/// ```
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RateToughening {
    /// Speed v₀ up to which the fracture energy is constant [m/s]; above 0.
    pub speed: f32,
    /// Exponent m, 0 (no growth) to 2; usually 0.1 to 0.5.
    pub exponent: f32,
}

hash_state! { struct RateToughening { speed, exponent } }

impl RateToughening {
    /// Fracture energy that does not depend on the speed.
    pub const NONE: Self = Self {
        speed: 1.0,
        exponent: 0.0,
    };

    /// Checks both fields.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names the field that is out of range.
    pub(crate) fn check(self) -> Result<(), Error> {
        let is_valid = (1e-9..=1e6).contains(&self.speed);
        require(
            is_valid,
            "rate_toughening.speed",
            "1e-9 to 1e6 m/s",
            self.speed,
        )?;
        let is_valid = (0.0..=2.0).contains(&self.exponent);
        require(
            is_valid,
            "rate_toughening.exponent",
            "0 to 2",
            self.exponent,
        )
    }

    /// Returns the factor on the fracture energy at a speed [m/s].
    pub(crate) fn factor(self, speed: f32) -> f32 {
        match self.exponent > 0.0 && speed > self.speed {
            true => libm::powf(speed / self.speed, self.exponent),
            false => 1.0,
        }
    }

    /// Returns the speed of a crack [m/s] at which the fracture energy is `factor` times that at rest; infinite without
    /// toughening.
    pub(crate) fn speed_at(self, factor: f32) -> f32 {
        match self.exponent > 0.0 {
            true => self.speed * libm::powf(factor.max(1.0), 1.0 / self.exponent),
            false => f32::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drucker_prager_has_published_strengths_of_polyurethane_and_glass() {
        // Tensile, hydrostatic, biaxial and shear strength [MPa]; Kamarei and others 2026 (arXiv 2507.00266).
        for [tensile, hydrostatic, biaxial, shear] in
            [[0.3f32, 1.0, 0.27, 0.19], [40.0, 27.8, 27.0, 44.4]]
        {
            let criterion = StrengthCriterion::DruckerPrager { hydrostatic };
            let factor = criterion.pressure_factor(tensile).unwrap();
            let limit = tensile * (1.0 / 3f32.sqrt() + factor);
            assert!((3.0 * factor * hydrostatic / limit - 1.0).abs() < 1e-5);
            // Equal tension σ in two directions: √J₂ = σ/√3, I₁ = 2 σ. Shear τ: √J₂ = τ, I₁ = 0.
            let two = limit / (1.0 / 3f32.sqrt() + 2.0 * factor);
            assert!((two / biaxial - 1.0).abs() < 0.02, "{two}");
            assert!((limit / shear - 1.0).abs() < 0.02, "{limit}");
        }
    }

    #[test]
    fn speed_at_inverts_factor() {
        let toughening = RateToughening {
            speed: 0.1,
            exponent: 0.5,
        };
        for factor in [1.5f32, 3.0, 20.0] {
            let speed = toughening.speed_at(factor);
            assert!((toughening.factor(speed) / factor - 1.0).abs() < 1e-4);
        }
        assert_eq!(RateToughening::NONE.speed_at(2.0), f32::INFINITY);
        assert_eq!(toughening.factor(0.05), 1.0);
    }
}
