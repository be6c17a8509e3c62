//! Materials from publications, with the source of each number.
//!
//! ```
//! use fuwafuwa::library::{self, Quantity};
//!
//! let ecoflex = library::find("ecoflex-00-30").ok_or("unknown")?;
//! let shear = ecoflex.value(Quantity::ShearModulus).ok_or("missing")?;
//! println!("{} Pa, from {}", shear.value[0], shear.source);
//! assert_eq!(shear.strain, Some([0.06, 2.99]));
//! let material = ecoflex.material();
//! assert!((material.elasticity.shear_modulus() - shear.value[0]).abs() < 1.0);
//! assert!(ecoflex.is_missing(Quantity::FractureEnergy));
//! # Ok::<(), &'static str>(())
//! ```

mod table;
mod tension;

use crate::fracture::strength::{RateToughening, StrengthCriterion};
use crate::material::Material;
use crate::soft_body::element_law::Elasticity;
use crate::soft_body::hyperelasticity::StressLaw;
use crate::soft_body::rayleigh::Damping;

pub use table::MATERIALS;
pub use tension::TensileBreak;

/// Density of a material whose density is missing [kg/m³]: that of water.
pub const USUAL_DENSITY: f32 = 1000.0;
/// Poisson's ratio that is used if the published ratio is missing or larger: the largest that the engine supports.
/// Rubber, gels and soft tissue preserve their volume.
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
    /// Lowest and highest engineering strain of the curve to which a modulus or the constants of a law were fitted.
    /// Beyond them, the law extrapolates.
    pub strain: Option<[f64; 2]>,
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
    /// Tensile strength [Pa]: nominal stress at break, which is the force per original area.
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

/// Returns the names that resemble an unknown one: those with the same first three letters, and those that contain it. If
/// there is none, returns all names.
pub fn similar_names(unknown: &str) -> Vec<&'static str> {
    let unknown = unknown.to_lowercase();
    let start: String = unknown.chars().take(3).collect();
    let names = || MATERIALS.iter().map(|material| material.name);
    let is_similar =
        |name: &&str| !start.is_empty() && (name.starts_with(&start) || name.contains(&unknown));
    let similar: Vec<_> = names().filter(is_similar).collect();
    match similar.is_empty() {
        true => names().collect(),
        false => similar,
    }
}

impl LibraryMaterial {
    /// Returns a published number.
    pub fn value(&self, quantity: Quantity) -> Option<&'static LibraryValue> {
        self.values.iter().find(|value| value.quantity == quantity)
    }

    /// Returns whether no source gives a quantity. One modulus determines the other.
    pub fn is_missing(&self, quantity: Quantity) -> bool {
        match quantity {
            Quantity::Young | Quantity::ShearModulus => {
                self.value(Quantity::Young).is_none()
                    && self.value(Quantity::ShearModulus).is_none()
            }
            _ => self.value(quantity).is_none(),
        }
    }

    /// Returns the engineering strains of the curve to which the stress law was fitted; `None` if the law has no fit.
    /// Beyond them, the law extrapolates and can be far from the material: a fit to strains below 3 says little on a
    /// strain at break of 10.
    pub fn fitted_strain(&self) -> Option<[f64; 2]> {
        let fit = self
            .value(Quantity::Yeoh)
            .or_else(|| self.value(Quantity::ShearModulus));
        fit.and_then(|value| value.strain)
    }

    /// Returns the state in which a bar of [`material`](Self::material) breaks under tension; `None` if the strength
    /// is missing.
    ///
    /// Its nominal stress is the published [`Quantity::Strength`]. Its strain follows from the stress law and differs
    /// from the published [`Quantity::StrainAtBreak`] where the law extrapolates.
    pub fn tensile_break(&self) -> Option<TensileBreak> {
        let nominal = self.value(Quantity::Strength)?.value[0];
        Some(TensileBreak::at(
            self.elasticity(),
            self.stress_law(),
            nominal,
        ))
    }

    /// Returns the elastic constants for a simulation.
    ///
    /// A published shear modulus keeps its value. Otherwise, a published Young's modulus keeps its value.
    fn elasticity(&self) -> Elasticity {
        let number = |quantity| self.value(quantity).map(|value| value.value[0]);
        let poisson = number(Quantity::Poisson).map_or(USUAL_POISSON, |one| one.min(USUAL_POISSON));
        let young = match (number(Quantity::ShearModulus), number(Quantity::Young)) {
            (Some(shear), _) => 2.0 * (1.0 + poisson) * shear,
            (None, Some(young)) => young,
            (None, None) => Material::default().elasticity.young,
        };
        Elasticity { young, poisson }
    }

    /// Returns the stress law for a simulation.
    fn stress_law(&self) -> StressLaw {
        match self.value(Quantity::Yeoh).map(|value| value.value) {
            Some([second, third]) => StressLaw::Yeoh { second, third },
            None => StressLaw::NeoHookean,
        }
    }

    /// Returns a material for a simulation, without damping and without scatter of the strength.
    ///
    /// A missing density is [`USUAL_DENSITY`]. A Poisson's ratio that is missing or too high for the engine is
    /// [`USUAL_POISSON`]. The published modulus keeps its value, the shear modulus if both are published; without a
    /// modulus, Young's modulus is that of [`Material::default`]. Without constants of Yeoh, the material is neo-Hookean.
    ///
    /// The strength is the true (Cauchy) stress at which the force per original area reaches the published strength, see
    /// [`tensile_break`](Self::tensile_break). A missing strength or fracture energy is infinite: without a strength, no
    /// crack starts, and without a fracture energy, no crack grows.
    pub fn material(&self) -> Material {
        let number = |quantity| self.value(quantity).map(|value| value.value[0]);
        let pair = |quantity| self.value(quantity).map(|value| value.value);
        let elasticity = self.elasticity();
        let Elasticity { young, poisson } = elasticity;
        let infinite = f64::from(f32::INFINITY);
        let energy = number(Quantity::FractureEnergy).unwrap_or(infinite);
        let hydrostatic = number(Quantity::HydrostaticStrength);
        let toughening = pair(Quantity::RateToughening);
        Material {
            elasticity,
            stress_law: self.stress_law(),
            density: number(Quantity::Density).map_or(USUAL_DENSITY, |density| density as f32),
            damping: Damping::NONE,
            strength: { self.tensile_break() }
                .map_or(f32::INFINITY, |state| state.true_stress as f32),
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
                assert_eq!(material.elasticity.young, young.value[0], "{}", record.name);
            }
            assert!(!record.is_missing(Quantity::Young), "{}", record.name);
            for value in record.values {
                if let Some([low, high]) = value.spread {
                    let is_inside = low <= value.value[0] && value.value[0] <= high;
                    assert!(is_inside, "{}: {value:?}", record.name);
                }
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

    #[test]
    fn modulus_is_missing_only_without_both_moduli() {
        let mut record = *find("gelatine-5").unwrap();
        assert!(!record.is_missing(Quantity::ShearModulus));
        record.values = find("liver").unwrap().values;
        assert!(!record.is_missing(Quantity::Young));
        record.values = &[];
        assert!(record.is_missing(Quantity::Young) && record.is_missing(Quantity::ShearModulus));
        let young = record.material().elasticity.young;
        assert_eq!(young, Material::default().elasticity.young);
    }

    #[test]
    fn strength_is_the_true_stress_at_the_published_nominal_stress() {
        // Stretch at break, from a separate program: bisection of μ g (s − J / s²) with J = 1 + μ g (1 − 1/s) / (λ + μ).
        for (name, stretch, true_stress) in [
            ("ecoflex-00-10", 8.9888, 6.1517e6),
            ("ecoflex-00-30", 11.985, 1.4645e7),
            ("dragon-skin-10", 15.623, 4.7648e7),
            ("natural-rubber", 7.7320, 4.6724e7),
            ("polyurethane", 1.2350, 3.6910e5),
        ] {
            let record = find(name).unwrap();
            let state = record.tensile_break().unwrap();
            assert!(
                (state.stretch / stretch - 1.0).abs() < 1e-3,
                "{name}: {state:?}"
            );
            let strength = f64::from(record.material().strength);
            assert!(
                (strength / true_stress - 1.0).abs() < 2e-3,
                "{name}: {strength}"
            );
            let nominal = record.value(Quantity::Strength).unwrap().value[0];
            // At constant volume, the cross section would shrink by the stretch.
            let ratio = strength / (nominal * state.stretch);
            assert!((0.8..1.0).contains(&ratio), "{name}: {ratio}");
        }
        let liver = find("liver").unwrap();
        assert_eq!(liver.tensile_break(), None);
        assert_eq!(liver.material().strength, f32::INFINITY);
    }

    #[test]
    fn similar_names_resemble_the_unknown_name() {
        assert_eq!(similar_names("rubber"), ["natural-rubber"]);
        assert_eq!(
            similar_names("Gelatine"),
            ["gelatine-5", "gelatine-10", "gelatine-15", "gelatine-20"]
        );
        assert_eq!(similar_names("cheese").len(), MATERIALS.len());
        assert_eq!(similar_names("").len(), MATERIALS.len());
    }
}
