//! Materials from publications, with the source of each number.
//!
//! ```
//! use fuwafuwa::library::{self, Quantity};
//!
//! let ecoflex = library::find("ecoflex-00-30").ok_or("unknown")?;
//! let shear = ecoflex.value(Quantity::ShearModulus).ok_or("missing")?;
//! println!("{} Pa, from {}", shear.value[0], shear.source);
//! let material = ecoflex.material();
//! assert!((material.elasticity.shear_modulus() - shear.value[0]).abs() < 1.0);
//! assert!(ecoflex.is_missing(Quantity::FractureEnergy));
//! # Ok::<(), &'static str>(())
//! ```

mod table;

use crate::fracture::strength::{RateToughening, StrengthCriterion};
use crate::material::Material;
use crate::soft_body::element_law::Elasticity;
use crate::soft_body::hyperelasticity::StressLaw;
use crate::soft_body::rayleigh::Damping;

pub use table::MATERIALS;

/// Density of a material whose density is missing [kg/m³]: that of water.
pub const USUAL_DENSITY: f32 = 1000.0;
/// Poisson's ratio of a material whose ratio is missing or above: the largest that the engine supports. Rubber, gels
/// and soft tissue preserve their volume.
pub const USUAL_POISSON: f64 = 0.49;

/// Material of the library.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct LibraryMaterial {
    /// Name, for example `ecoflex-00-30`.
    pub name: &'static str,
    /// Kind and maker of the material.
    pub about: &'static str,
    /// Published numbers. A number that no source gives is missing.
    pub values: &'static [LibraryValue],
}

/// Published number of a material.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct LibraryValue {
    /// Quantity and its unit.
    pub quantity: Quantity,
    /// Value; the second number is used by [`Quantity::Yeoh`] and [`Quantity::RateToughening`], and 0 otherwise.
    pub value: [f64; 2],
    /// Lowest and highest published value, or the value less and plus the standard deviation.
    pub spread: Option<[f64; 2]>,
    /// Temperature [°C].
    pub temperature: Option<f64>,
    /// Strain rate [1/s].
    pub rate: Option<f64>,
    /// Publication.
    pub source: &'static str,
}

/// Quantity of a published number.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Density [kg/m³].
    Density,
    /// Young's modulus at small strain [Pa].
    Young,
    /// Shear modulus at small strain [Pa].
    ShearModulus,
    /// Poisson's ratio.
    Poisson,
    /// C₂ / C₁ and C₃ / C₁ of [`StressLaw::Yeoh`].
    Yeoh,
    /// Tensile strength [Pa]: force per original area.
    Strength,
    /// Hydrostatic strength [Pa], see [`StrengthCriterion::DruckerPrager`].
    HydrostaticStrength,
    /// Fracture energy [J/m²].
    FractureEnergy,
    /// Speed [m/s] and exponent of [`RateToughening`].
    RateToughening,
    /// Engineering strain at break.
    StrainAtBreak,
}

impl Quantity {
    /// All quantities.
    pub const ALL: [Self; 10] = [
        Self::Density,
        Self::Young,
        Self::ShearModulus,
        Self::Poisson,
        Self::Yeoh,
        Self::Strength,
        Self::HydrostaticStrength,
        Self::FractureEnergy,
        Self::RateToughening,
        Self::StrainAtBreak,
    ];

    /// Key of the quantity in `materials.toml`.
    pub fn key(self) -> &'static str {
        match self {
            Self::Density => "density",
            Self::Young => "young",
            Self::ShearModulus => "shear_modulus",
            Self::Poisson => "poisson",
            Self::Yeoh => "yeoh",
            Self::Strength => "strength",
            Self::HydrostaticStrength => "hydrostatic_strength",
            Self::FractureEnergy => "fracture_energy",
            Self::RateToughening => "rate_toughening",
            Self::StrainAtBreak => "strain_at_break",
        }
    }

    /// Unit of the quantity; empty for a ratio.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Density => "kg/m³",
            Self::Young | Self::ShearModulus | Self::Strength | Self::HydrostaticStrength => "Pa",
            Self::FractureEnergy => "J/m²",
            Self::RateToughening => "m/s and exponent",
            Self::Poisson | Self::Yeoh | Self::StrainAtBreak => "",
        }
    }
}

/// Returns the material with a name.
pub fn find(name: &str) -> Option<&'static LibraryMaterial> {
    MATERIALS.iter().find(|material| material.name == name)
}

impl LibraryMaterial {
    /// Returns a published number.
    pub fn value(&self, quantity: Quantity) -> Option<&'static LibraryValue> {
        self.values.iter().find(|value| value.quantity == quantity)
    }

    /// Returns whether no source gives a quantity. One modulus suffices for both.
    pub fn is_missing(&self, quantity: Quantity) -> bool {
        match quantity {
            Quantity::Young | Quantity::ShearModulus => false,
            _ => self.value(quantity).is_none(),
        }
    }

    /// Returns a material for a simulation, without damping and without scatter of the strength.
    ///
    /// A missing density is [`USUAL_DENSITY`]. A Poisson's ratio that is missing or too high for the engine is
    /// [`USUAL_POISSON`]; the shear modulus keeps its value. A missing strength or fracture energy is infinite: the
    /// material does not tear. Without constants of Yeoh, the material is neo-Hookean.
    pub fn material(&self) -> Material {
        let number = |quantity| self.value(quantity).map(|value| value.value[0]);
        let pair = |quantity| self.value(quantity).map(|value| value.value);
        let published = number(Quantity::Poisson).unwrap_or(0.5);
        let poisson = published.min(USUAL_POISSON);
        let young = number(Quantity::Young).unwrap_or(0.0);
        let shear = number(Quantity::ShearModulus).unwrap_or(young / (2.0 * (1.0 + published)));
        let young = 2.0 * (1.0 + poisson) * shear;
        let infinite = f64::from(f32::INFINITY);
        let energy = number(Quantity::FractureEnergy).unwrap_or(infinite);
        let hydrostatic = number(Quantity::HydrostaticStrength);
        let toughening = pair(Quantity::RateToughening);
        Material {
            elasticity: Elasticity { young, poisson },
            stress_law: match pair(Quantity::Yeoh) {
                Some([second, third]) => StressLaw::Yeoh { second, third },
                None => StressLaw::NeoHookean,
            },
            density: number(Quantity::Density).map_or(USUAL_DENSITY, |density| density as f32),
            damping: Damping::NONE,
            strength: number(Quantity::Strength).unwrap_or(infinite) as f32,
            strength_criterion: match hydrostatic {
                Some(hydrostatic) => StrengthCriterion::DruckerPrager {
                    hydrostatic: hydrostatic as f32,
                },
                None => StrengthCriterion::GreatestTension,
            },
            strength_scatter: 0.0,
            toughness: (energy * young / (1.0 - poisson * poisson)).sqrt() as f32,
            rate_toughening: match toughening {
                Some([speed, exponent]) => RateToughening {
                    speed: speed as f32,
                    exponent: exponent as f32,
                },
                None => RateToughening::NONE,
            },
            ..Material::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn materials_are_valid_and_have_their_published_moduli() {
        for record in MATERIALS {
            let material = record.material();
            material
                .check()
                .unwrap_or_else(|error| panic!("{}: {error}", record.name));
            assert!(!record.values.is_empty() && !record.about.is_empty());
            if let Some(shear) = record.value(Quantity::ShearModulus) {
                let ratio = material.elasticity.shear_modulus() / shear.value[0];
                assert!((ratio - 1.0).abs() < 1e-9, "{}", record.name);
            }
            if let Some(young) = record.value(Quantity::Young) {
                // Young's modulus was measured at the true Poisson's ratio of 0.5.
                let ratio = 3.0 * material.elasticity.shear_modulus() / young.value[0];
                assert!((ratio - 1.0).abs() < 1e-9, "{}", record.name);
            }
            if let Some(energy) = record.value(Quantity::FractureEnergy) {
                let ratio = f64::from(material.fracture_energy()) / energy.value[0];
                assert!((ratio - 1.0).abs() < 1e-3, "{}", record.name);
            }
        }
        let names: Vec<&str> = MATERIALS.iter().map(|record| record.name).collect();
        let unique: std::collections::BTreeSet<&str> = names.iter().copied().collect();
        assert_eq!(unique.len(), names.len());
        assert!(find("ecoflex-00-30").is_some() && find("cheese").is_none());
    }
}
