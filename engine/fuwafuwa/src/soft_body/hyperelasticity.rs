//! Stress laws of materials in double precision: the reference for `stress_kernel`.
//!
//! With the deformation gradient F, its rotation R, J = det F, and Lamé's parameters μ and λ, the energy density
//! W and the first Piola–Kirchhoff stress P of the hyperelastic laws are
//!
//! ```text
//! x = |F|² − 3 − 2 (J − 1)      y = min(max(x, 0), x_max)      g = 1 + 2 a y + 3 b y²
//! W = μ/2 (x + a y² + b y³ + (g − 1) (x − y)) + (λ + μ)/2 (J − 1)² + μ β I₀/6 q³      q = max(1 − |F|² / I₀, 0)
//! P = μ g (F − cof F) + (λ + μ) (J − 1) cof F − μ β q² F
//! ```
//!
//! At constant volume, x = |F|² − 3, and W is the law of [Yeoh 1993] with C₁ = μ/2, C₂ = a C₁ and C₃ = b C₁, or
//! the neo-Hookean law if a = b = 0. The term −2 (J − 1) takes the place of the usual −2 ln J, which is infinite
//! at J = 0 [Smith 2018]. If b is negative, g grows up to x_max = −a / 3b and stays constant beyond; otherwise x_max is
//! infinite. P is therefore finite for every F, and restores inverted elements. Small strains follow
//! Hooke's law with μ and λ.
//!
//! The terms in q, with I₀ = 1.27 and β = 1.05, act where the mean stretch is below √(I₀/3) = 0.65 in 3D, and below
//! 0.37 in 2D. Without them, F = 0
//! would be a local minimum of the energy: an element of a low Poisson's ratio that is crushed to half of its width would
//! collapse to a point and stay there.
//!
//! F is the mean over an element. If an element has mid nodes or lacks children, det F is not the ratio of its
//! volumes once its nodes leave the affine motion. Under the tension t = (λ + μ) (J − 1), the difference would release
//! energy, and graded elements would fold at a t of about 3μ. Their hourglass stiffness k therefore grows with t:
//!
//! ```text
//! E = V W + s k/2 Σ w |h|²      s = √(1 + (c max(t, 0) / Y)²)      P_total = P + s'(J) (k/2V) Σ w |h|² cof F
//! ```
//!
//! The constant c is in [`tension_rate`]. The last term keeps the forces the gradient of the energy E. In plain elements, s = 1: in 2D, their det F is the
//! ratio of areas.

use crate::error::{Error, require};
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::soft_body::element_law::{Elasticity, Matrix, cofactor};

/// Relation between stress and large strain of a material. Small strains follow Hooke's law with the
/// [`Elasticity`] of the material under every stress law.
///
/// An element of a hyperelastic material becomes stiffer where it is stretched. The world takes shorter substeps
/// while a body is stiffer than at rest, see [`SoftBody::longest_substep`](crate::SoftBody::longest_substep).
///
/// Graded elements of a hyperelastic material become stiffer against bending under a tension in all directions. They are
/// stable up to a tension of about 6 times the shear modulus; rubber tears inside at less. With [`Grading::Uniform`](crate::Grading), the error of
/// such bodies is smaller.
///
/// Ignored under [`Law::Endo2004`](crate::Law::Endo2004).
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum StressLaw {
    /// Stress in proportion to the strain in the rotated frame of the element: fast, and right for strains up to
    /// about a tenth.
    #[default]
    Corotational,
    /// Compressible neo-Hookean law: rubber and gels up to a stretch of about 1.5.
    NeoHookean,
    /// Law of [Yeoh 1993]: rubber that stiffens at large stretches. The energy density is C₁ (I − 3) + C₂ (I − 3)² +
    /// C₃ (I − 3)³, with the first invariant I and C₁ = μ/2, where μ is the shear modulus.
    Yeoh {
        /// C₂ / C₁; usually −0.01 to 0.1. It may be negative if its square is below 3 C₃ / C₁.
        second: f64,
        /// C₃ / C₁; usually −0.001 to 0.01. It may be negative if C₂ is positive. The stiffness then grows up to the
        /// invariant 3 − C₂ / 3 C₃ and stays constant beyond.
        third: f64,
    },
}

hash_state! { enum StressLaw { Corotational, NeoHookean, Yeoh { second, third } } }

impl StressLaw {
    /// Returns the factors of a hyperelastic law; `None` for the corotational law.
    pub(crate) fn factors(self) -> Option<Factors> {
        let (a, b) = match self {
            Self::Corotational => return None,
            Self::NeoHookean => (0.0, 0.0),
            Self::Yeoh { second, third } => (second, third),
        };
        let max = if b < 0.0 {
            -a / (3.0 * b)
        } else {
            f64::INFINITY
        };
        Some(Factors { a, b, max })
    }

    /// Checks that the factor g of the stress is positive. The stress may still fall over a range of stretches, if
    /// `second` is negative.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names the constant that is out of range.
    pub(crate) fn check(self) -> Result<(), Error> {
        let Self::Yeoh { second, third } = self else {
            return Ok(());
        };
        let is_valid = (-1e6..=1e6).contains(&third);
        require(is_valid, "stress_law.third", "-1e6 to 1e6", third)?;
        // g is positive for all strains.
        let is_valid = match second < 0.0 {
            true => second * second < 3.0 * third,
            false => second <= 1e6 && (second > 0.0 || third >= 0.0),
        };
        let expected =
            "0 to 1e6, or negative with a square below 3 × third; positive if third is negative";
        require(is_valid, "stress_law.second", expected, second)
    }
}

/// I₀: |F|² below which an element resists further compression.
pub(crate) const CRUSH_THRESHOLD: f64 = 1.27;
/// Factor β of this resistance. Above 1, even an element that is a point is pushed apart.
pub(crate) const CRUSH_FACTOR: f64 = 1.05;

/// Factors of a hyperelastic law.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Factors {
    /// C₂ / C₁
    pub a: f64,
    /// C₃ / C₁
    pub b: f64,
    /// x_max
    pub max: f64,
}

impl Factors {
    /// g
    fn growth(self, y: f64) -> f64 {
        1.0 + 2.0 * self.a * y + 3.0 * self.b * y * y
    }
}

/// Invariants of a deformation gradient.
struct Invariants {
    cofactor: Matrix,
    /// J = det F.
    volume: f64,
    /// |F|² and |cof F|².
    squares: [f64; 2],
}

impl Invariants {
    fn of(deformation: &Matrix) -> Self {
        let cofactor = cofactor(deformation);
        let square = |m: &Matrix| m.iter().map(|row| row.length_squared()).sum();
        Self {
            volume: deformation[0].dot(cofactor[0]),
            squares: [square(deformation), square(&cofactor)],
            cofactor,
        }
    }

    /// y
    fn stretched(&self, factors: Factors) -> f64 {
        self.distortion().clamp(0.0, factors.max)
    }

    /// x
    fn distortion(&self) -> f64 {
        self.squares[0] - 3.0 - 2.0 * (self.volume - 1.0)
    }

    /// q
    fn crushed(&self) -> f64 {
        (1.0 - self.squares[0] / CRUSH_THRESHOLD).max(0.0)
    }
}

/// Returns the first Piola–Kirchhoff stress [Pa] of a hyperelastic law.
pub(crate) fn stress(elasticity: Elasticity, factors: Factors, deformation: &Matrix) -> Matrix {
    let shear = elasticity.shear_modulus();
    let all = Invariants::of(deformation);
    let distortion = shear * factors.growth(all.stretched(factors));
    let pressure = (elasticity.lame() + shear) * (all.volume - 1.0);
    let q = all.crushed();
    let crushed = shear * CRUSH_FACTOR * q * q;
    [0, 1, 2].map(|i: usize| {
        let grown = (deformation[i] - all.cofactor[i]) * distortion;
        grown + all.cofactor[i] * pressure - deformation[i] * crushed
    })
}

/// Returns the energy density [J/m³] of a hyperelastic law.
pub(crate) fn energy(elasticity: Elasticity, factors: Factors, deformation: &Matrix) -> f64 {
    let shear = elasticity.shear_modulus();
    let all = Invariants::of(deformation);
    let (x, y) = (all.distortion(), all.stretched(factors));
    let beyond = (factors.growth(y) - 1.0) * (x - y).max(0.0);
    let swelling = all.volume - 1.0;
    let q = all.crushed();
    let crushed = CRUSH_THRESHOLD * CRUSH_FACTOR / 3.0 * q * q * q;
    0.5 * shear * (x + y * y * (factors.a + factors.b * y) + beyond + crushed)
        + 0.5 * (elasticity.lame() + shear) * swelling * swelling
}

/// Returns the derivative of c t / Y by J, for the growth s of the hourglass stiffness.
///
/// With this constant c, graded bodies with holes in random places withstand a tension of 6μ in all directions. With a c
/// of 12.6 in 3D or 6.4 in 2D, usual element classes would withstand any tension, but stretched elements would be stiffer
/// against bending.
pub(crate) fn tension_rate<D: Dim>(elasticity: Elasticity) -> f64 {
    let c = match D::N {
        2 => 3.5,
        _ => 5.0,
    };
    c * (elasticity.lame() + elasticity.shear_modulus()) / elasticity.young
}

/// Returns the growth s of the hourglass stiffness of a graded element, and its derivative by J.
pub(crate) fn hourglass_growth<D: Dim>(elasticity: Elasticity, deformation: &Matrix) -> [f64; 2] {
    let rate = tension_rate::<D>(elasticity);
    let tension = rate * (Invariants::of(deformation).volume - 1.0).max(0.0);
    let growth = (1.0 + tension * tension).sqrt();
    [growth, rate * tension / growth]
}

/// Returns an upper estimate of the stiffness of a deformed element against a pressure wave, λ + 2μ at rest,
/// divided by λ + 2μ; at least 1.
///
/// A wave with the normal n at rest and the direction of motion m has the stiffness
/// μ g + 2 μ g' (m · (F − cof F) n)² + (λ + μ) (m · cof F n)² + 4 μ β q (m · F n)² / I₀, and the second derivative of J adds at
/// most (λ + μ) |J − 1|. The estimate takes the largest value of each term.
pub(crate) fn relative_stiffness(
    elasticity: Elasticity,
    factors: Factors,
    deformation: &Matrix,
) -> f64 {
    let (shear, lame) = (elasticity.shear_modulus(), elasticity.lame());
    let all = Invariants::of(deformation);
    let Factors { a, b, max } = factors;
    let y = all.stretched(factors);
    let slope = if all.distortion() < max {
        2.0 * a + 6.0 * b * y
    } else {
        0.0
    };
    let [lengths, areas] = all.squares;
    let apart = (lengths + areas - 6.0 * all.volume).max(0.0);
    let crushed = 4.0 * CRUSH_FACTOR * all.crushed() / CRUSH_THRESHOLD * lengths;
    let distortion = factors.growth(y) + 2.0 * slope.max(0.0) * apart + crushed;
    // Largest eigenvalue of a symmetric matrix, here of the square of cof F, from its trace and its norm.
    let spread = (areas * areas - 3.0 * lengths * all.volume * all.volume).max(0.0);
    let largest = (areas + 2.0 * spread.sqrt()) / 3.0;
    let swelling = (lame + shear) * (all.volume - 1.0).abs();
    let stiffness = shear * distortion.max(1.0) + (lame + shear) * largest + swelling;
    (stiffness / (lame + 2.0 * shear)).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soft_body::element_law::IDENTITY;
    use glam::DVec3;

    const LAWS: [StressLaw; 4] = [
        StressLaw::NeoHookean,
        StressLaw::Yeoh {
            second: 0.02,
            third: 0.001,
        },
        StressLaw::Yeoh {
            second: -0.008,
            third: 0.00025,
        },
        StressLaw::Yeoh {
            second: 0.04,
            third: -0.01,
        },
    ];

    /// Returns a pseudo-random number between −1 and 1.
    fn random(seed: &mut u32) -> f64 {
        *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(*seed >> 8) / f64::from(1 << 23) - 1.0
    }

    /// Returns random deformation gradients, some of them inverted.
    fn deformations() -> impl Iterator<Item = Matrix> {
        let mut seed = 7;
        (0..60).map(move |round| {
            let size = 0.1 + 0.03 * f64::from(round);
            IDENTITY.map(|row| row + DVec3::from([0; 3].map(|_| size * random(&mut seed))))
        })
    }

    #[test]
    fn stress_is_gradient_of_energy() {
        for factors in LAWS.map(|law| law.factors().unwrap()) {
            for poisson in [0.0, 0.3, 0.49] {
                let elasticity = Elasticity::new(1000.0, poisson).unwrap();
                for deformation in deformations() {
                    let stress = stress(elasticity, factors, &deformation);
                    let size = stress.iter().map(|row| row.length()).sum::<f64>() + 1000.0;
                    for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                        let at = |by: f64| {
                            let mut moved = deformation;
                            moved[i][j] += by;
                            energy(elasticity, factors, &moved)
                        };
                        let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
                        assert!((slope - stress[i][j]).abs() < 1e-5 * size, "{slope}");
                    }
                }
            }
        }
    }

    #[test]
    fn small_strain_follows_hooke() {
        for factors in LAWS.map(|law| law.factors().unwrap()) {
            let elasticity = Elasticity::new(1000.0, 0.3).unwrap();
            let (shear, lame) = (elasticity.shear_modulus(), elasticity.lame());
            let strain = [[2.0, 1.0, 0.0], [1.0, -1.0, 0.5], [0.0, 0.5, 0.3]];
            let strain = strain.map(|row| DVec3::from(row) * 1e-6);
            let deformation = [0, 1, 2].map(|k: usize| IDENTITY[k] + strain[k]);
            let spread = strain[0].x + strain[1].y + strain[2].z;
            let stress = stress(elasticity, factors, &deformation);
            for (i, row) in stress.into_iter().enumerate() {
                let expected = strain[i] * (2.0 * shear) + IDENTITY[i] * (lame * spread);
                assert!((row - expected).length() < 1e-8 * shear, "{row} {expected}");
            }
        }
    }

    /// Nominal stress in uniaxial tension: the width across follows from zero stress there.
    fn uniaxial(elasticity: Elasticity, factors: Factors, stretch: f64) -> f64 {
        let (mut low, mut high) = (0.1, 4.0);
        for _ in 0..100 {
            let width: f64 = 0.5 * (low + high);
            let deformation = [DVec3::X * stretch, DVec3::Y * width, DVec3::Z * width];
            match stress(elasticity, factors, &deformation)[1].y < 0.0 {
                true => low = width,
                false => high = width,
            }
        }
        let deformation = [DVec3::X * stretch, DVec3::Y * low, DVec3::Z * low];
        stress(elasticity, factors, &deformation)[0].x
    }

    #[test]
    fn uniaxial_stress_approaches_incompressible_law() {
        let elasticity = Elasticity::new(3000.0, 0.49).unwrap();
        let shear = elasticity.shear_modulus();
        for law in LAWS {
            let factors = law.factors().unwrap();
            for stretch in [0.7, 1.1, 1.5, 2.0, 3.0] {
                let x: f64 = stretch * stretch + 2.0 / stretch - 3.0;
                let growth = factors.growth(x.min(factors.max));
                let exact = shear * growth * (stretch - 1.0 / (stretch * stretch));
                let ratio = uniaxial(elasticity, factors, stretch) / exact;
                assert!((ratio - 1.0).abs() < 0.03, "{law:?} {stretch} {ratio}");
            }
        }
    }

    #[test]
    fn relative_stiffness_exceeds_that_of_all_waves() {
        for factors in LAWS.map(|law| law.factors().unwrap()) {
            for poisson in [0.0, 0.3, 0.49] {
                let elasticity = Elasticity::new(1000.0, poisson).unwrap();
                let rest = elasticity.lame() + 2.0 * elasticity.shear_modulus();
                let mut seed = 3;
                for deformation in deformations() {
                    let bound = relative_stiffness(elasticity, factors, &deformation);
                    for _ in 0..20 {
                        let mut unit =
                            || DVec3::from([0; 3].map(|_| random(&mut seed))).normalize();
                        let (normal, motion) = (unit(), unit());
                        let at = |by: f64| {
                            let moved = [0, 1, 2]
                                .map(|k: usize| deformation[k] + normal * (motion[k] * by));
                            energy(elasticity, factors, &moved)
                        };
                        let stiffness = (at(1e-4) - 2.0 * at(0.0) + at(-1e-4)) / 1e-8;
                        assert!(stiffness < 1.001 * bound * rest + 1.0, "{stiffness}");
                    }
                }
                assert_eq!(relative_stiffness(elasticity, factors, &IDENTITY), 1.0);
            }
        }
    }

    #[test]
    fn laws_whose_stiffness_would_vanish_are_refused() {
        for (second, third, is_valid) in [
            (0.1, 0.0, true),
            (-0.1, 0.0, false),
            (-0.1, 0.001, false),
            (-0.1, 0.01, true),
            (0.1, -0.01, true),
            (0.0, -0.01, false),
            (0.0, 0.0, true),
            (f64::NAN, 0.0, false),
            (0.0, f64::INFINITY, false),
        ] {
            let law = StressLaw::Yeoh { second, third };
            assert_eq!(law.check().is_ok(), is_valid, "{law:?}");
        }
    }
}
