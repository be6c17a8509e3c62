//! Forces of one element in double precision: the reference for the vectorised implementation.
//!
//! Two laws are available. [`Law::Endo2004`] is the law of the paper. It rotates the rest shape so that the
//! moments of the forces balance [Endo 2004, Eq. 1], and pulls each node towards its position in the rotated
//! shape, in proportion to the distance. This law is simple and robust, but fails the patch test as soon as
//! an element has mid nodes. [`Law::CorotationalVem`], the default, is a corotational virtual element [Beirao
//! da Veiga 2013]:
//!
//! ```text
//! F = (1/V) Σ x_i b_iᵀ      R = its rotation      J = det F
//! P = 2μ (F − R) + λ (tr RᵀF − d) R − k_J max(0, J_min − J) cof F
//! h_i = x_i − c − F r_i     S = Σ w_i h_i r_iᵀ     (c, r_i about the volume centroid)
//! f_i = −P b_i − k (w_i h_i − S b_i / V)           k = α β Y s^(d−2),  w_i = 2^d V_i / s^d
//! ```
//!
//! Node i has the position x_i, the rest offset r_i from the volume centroid, the gradient b_i and the volume
//! V_i. The element has the centroid c, the volume V and the width s; d is the number of dimensions. Y, μ and
//! λ are Young's modulus and Lamé's parameters. J_min is [`MIN_VOLUME_RATIO`], and k_J equals Y.
//!
//! The constant α, [`Dim::HOURGLASS`], makes a plain element bend with the right stiffness. The factor β,
//! [`ElementClass::hourglass`], does the same for the other element classes. In 2D the law is plane strain
//! with 1 m of depth: the same formulas with F₃₃ = R₃₃ = 1.
//!
//! This P is that of [`StressLaw::Corotational`]. [`crate::soft_body::hyperelasticity`] has the P of the other stress
//! laws, and the growth of their hourglass stiffness k under tension.

use crate::error::{Error, require};
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::material::Material;
use crate::soft_body::hyperelasticity::{self, StressLaw};
use crate::topology::element_class::ElementClass;
use glam::DVec3;

/// Law of the elastic forces of an element, with the criterion by which cracks start and grow.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Law {
    /// Shape-matching law of [Endo 2004, §3.1], unchanged. The nodal tension alone decides where a crack starts or
    /// grows, as in the paper, so that the load and the direction of a crack depend on the voxels.
    Endo2004,
    /// Corotational virtual element law; exact for every uniform strain, on any graded mesh. A crack grows by its
    /// energy release rate.
    #[default]
    CorotationalVem,
}

hash_state! { enum Law { Endo2004, CorotationalVem } }

/// Elastic constants of a material.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Elasticity {
    /// Young's modulus Y [Pa]; about 5000 for a game body. A world lowers it if its substep would otherwise
    /// be unstable: see [`SoftBody::stiffness_scale`](crate::SoftBody::stiffness_scale).
    pub young: f64,
    /// Poisson's ratio ν, 0 to 0.49: lateral expansion under compression. Rubber and gels preserve their volume:
    /// 0.49. A higher ratio requires shorter substeps: 0.45 twice and 0.49 four times as many as 0.3.
    pub poisson: f64,
}

hash_state! { struct Elasticity { young, poisson } }

/// Elastic constants of a material with its stress law.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ElasticLaw {
    /// Elastic constants.
    pub elasticity: Elasticity,
    /// Relation between stress and large strain.
    pub stress_law: StressLaw,
}

impl From<Elasticity> for ElasticLaw {
    /// Corotational law with the constants.
    fn from(elasticity: Elasticity) -> Self {
        let stress_law = StressLaw::Corotational;
        Self {
            elasticity,
            stress_law,
        }
    }
}

impl From<&Material> for ElasticLaw {
    fn from(material: &Material) -> Self {
        Self {
            elasticity: material.elasticity,
            stress_law: material.stress_law,
        }
    }
}

/// Volume ratio det F below which an element of any material resists further compression. A higher ratio
/// would stiffen soft contacts. With a lower ratio, strong contacts would invert elements before the
/// resistance sets in.
pub const MIN_VOLUME_RATIO: f64 = 0.4;

impl Elasticity {
    /// Creates elastic constants: Young's modulus `young` [Pa], and Poisson's ratio `poisson` from 0 to 0.49.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if a constant is out of range or not a number.
    pub fn new(young: f64, poisson: f64) -> Result<Self, Error> {
        let is_valid = young.is_finite() && young > 0.0;
        require(is_valid, "young", "positive and finite [Pa]", young)?;
        let is_valid = (0.0..=0.49).contains(&poisson);
        require(is_valid, "poisson", "0 to 0.49", poisson)?;
        Ok(Self { young, poisson })
    }

    /// Shear modulus μ [Pa].
    pub fn shear_modulus(self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Lamé's first parameter λ [Pa].
    pub fn lame(self) -> f64 {
        self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))
    }
}

/// 3 × 3 matrix by rows; in 2D the third row and column are those of the identity.
pub type Matrix = [DVec3; 3];

pub(crate) const IDENTITY: Matrix = DVec3::AXES;

/// Returns the elastic force [N] that an element exerts on each of its nodes. The element is `size` [m] wide;
/// `positions` are those of its nodes [m].
///
/// # Panics
/// If the number of positions is not the number of nodes of the element class.
#[inline(never)]
pub fn forces<D: Dim>(
    law: Law,
    elastic: ElasticLaw,
    element_class: &ElementClass<D>,
    size: f64,
    positions: &[DVec3],
) -> Vec<DVec3> {
    assert_eq!(
        positions.len(),
        element_class.slots.len(),
        "the number of positions must match the nodes of the element class"
    );
    match law {
        Law::Endo2004 => endo(elastic.elasticity, element_class, size, positions),
        Law::CorotationalVem => patch_exact(elastic, element_class, size, positions),
    }
}

/// Returns the nodal forces [N] of [`Law::Endo2004`]: a stiffness times the vector from each node to its goal
/// position.
fn endo<D: Dim>(
    elasticity: Elasticity,
    element_class: &ElementClass<D>,
    size: f64,
    positions: &[DVec3],
) -> Vec<DVec3> {
    let (stiffness, apart) = shape_matching_offsets(elasticity, element_class, size, positions);
    apart.into_iter().map(|d| d * stiffness).collect()
}

/// Returns the stiffness Y V d / Σ|R0_i|² [N/m], and the vector M R0_i − r_i [m] from each node i to its goal
/// position. R0_i and r_i are the offsets of the node from the mean of all nodes, at rest and now; M is the
/// best-fit rotation. Y is Young's modulus, V the volume and d the number of dimensions.
pub(crate) fn shape_matching_offsets<D: Dim>(
    elasticity: Elasticity,
    element_class: &ElementClass<D>,
    size: f64,
    positions: &[DVec3],
) -> (f64, Vec<DVec3>) {
    let half = 0.5 * size;
    let rest: Vec<DVec3> = element_class.offsets.iter().map(|&r| r * half).collect();
    let count = positions.len() as f64;
    let mean = |all: &[DVec3]| all.iter().map(|&x| x * (1.0 / count)).sum::<DVec3>();
    let (rest_mean, now_mean) = (mean(&rest), mean(positions));
    let rest: Vec<DVec3> = rest.iter().map(|&r| r - rest_mean).collect();
    let now: Vec<DVec3> = positions.iter().map(|&x| x - now_mean).collect();
    let mut moment = [DVec3::ZERO; 3];
    let mut spread = 0.0;
    for (r, x) in rest.iter().zip(&now) {
        add_outer(&mut moment, *x, *r);
        spread += r.dot(*r);
    }
    // In 2D, the third diagonal entry would be 0. A positive entry makes the best-fit rotation a rotation
    // about the third axis.
    (D::N..3).for_each(|axis| moment[axis][axis] = spread);
    let rotation = rotation_of(&moment);
    let stiffness = elasticity.young * volume_of(element_class, half) * D::N as f64 / spread;
    let apart = |(r, x): (&DVec3, &DVec3)| apply(&rotation, *r) - *x;
    (stiffness, rest.iter().zip(&now).map(apart).collect())
}

fn patch_exact<D: Dim>(
    elastic: ElasticLaw,
    element_class: &ElementClass<D>,
    size: f64,
    positions: &[DVec3],
) -> Vec<DVec3> {
    let (deformation, centre) = deformation_of(element_class, size, positions);
    let elasticity = elastic.elasticity;
    let mut stress = stress(elastic, &deformation);
    let [growth, slope] = hourglass_growth(elastic, element_class, &deformation);
    if slope != 0.0 {
        let (stiffness, hourglass) = hourglass(
            elasticity,
            element_class,
            size,
            positions,
            &deformation,
            centre,
        );
        let energy = slope * hourglass_energy(element_class, stiffness, &hourglass);
        let tension = energy / volume_of(element_class, 0.5 * size);
        for (row, cofactor) in stress.iter_mut().zip(cofactor(&deformation)) {
            *row += cofactor * tension;
        }
    }
    forces_of_stress(elasticity, &stress, growth, element_class, size, positions)
}

/// Returns the factor of the hourglass stiffness of an element under tension, and its derivative by det F.
pub(crate) fn hourglass_growth<D: Dim>(
    elastic: ElasticLaw,
    element_class: &ElementClass<D>,
    deformation: &Matrix,
) -> [f64; 2] {
    match elastic.stress_law {
        StressLaw::Corotational => [1.0, 0.0],
        _ if element_class.is_plain() => [1.0, 0.0],
        _ => hyperelasticity::hourglass_growth::<D>(elastic.elasticity, deformation),
    }
}

/// Returns the energy [J] of the hourglass modes, from the values that [`hourglass`] returns.
pub(crate) fn hourglass_energy<D: Dim>(
    element_class: &ElementClass<D>,
    stiffness: f64,
    hourglass: &[DVec3],
) -> f64 {
    let weights = element_class.volumes.iter().zip(hourglass);
    let swings = weights.map(|(&weight, &h)| h.dot(h) / weight);
    0.5 * stiffness * swings.sum::<f64>()
}

/// Returns the nodal forces [N] of a stress [Pa], plus the forces that resist the hourglass modes. `growth` is the factor
/// of the hourglass stiffness.
pub(crate) fn forces_of_stress<D: Dim>(
    elasticity: Elasticity,
    stress: &Matrix,
    growth: f64,
    element_class: &ElementClass<D>,
    size: f64,
    positions: &[DVec3],
) -> Vec<DVec3> {
    let volume = volume_of(element_class, 0.5 * size);
    let gradient = |k: usize| gradient_of(element_class, size, k);
    let (deformation, centre) = deformation_of(element_class, size, positions);
    let (stiffness, hourglass) = hourglass(
        elasticity,
        element_class,
        size,
        positions,
        &deformation,
        centre,
    );
    let mut skew = [DVec3::ZERO; 3];
    for (k, &h) in hourglass.iter().enumerate() {
        add_outer(&mut skew, h, element_class.offsets[k] * (0.5 * size));
    }
    (0..positions.len())
        .map(|k| {
            let b = gradient(k);
            let correction = hourglass[k] + apply(&skew, b) * (-1.0 / volume);
            -apply(stress, b) - correction * (growth * stiffness)
        })
        .collect()
}

/// Returns the gradient b of a node. The sum of x bᵀ over the nodes at positions x is V F, with the volume V
/// and the deformation gradient F of the element.
fn gradient_of<D: Dim>(element_class: &ElementClass<D>, size: f64, node: usize) -> DVec3 {
    let half = 0.5 * size;
    element_class.gradients[node] * (volume_scale::<D>(half) / half)
}

/// Returns the deformation gradient, and the volume centroid [m] in the present shape.
pub(crate) fn deformation_of<D: Dim>(
    element_class: &ElementClass<D>,
    size: f64,
    positions: &[DVec3],
) -> (Matrix, DVec3) {
    let volume = volume_of(element_class, 0.5 * size);
    let mut deformation = [DVec3::ZERO; 3];
    let mut centre = DVec3::ZERO;
    for (k, &x) in positions.iter().enumerate() {
        let gradient = gradient_of(element_class, size, k);
        add_outer(&mut deformation, x * (1.0 / volume), gradient);
        centre += x * (element_class.volumes[k] / element_class.volume);
    }
    deformation[D::N..].copy_from_slice(&IDENTITY[D::N..]);
    (deformation, centre)
}

/// Returns the stiffness k of the hourglass modes, and the product w h of each node: volume weight times
/// deviation [m] from the affine motion of the element.
pub(crate) fn hourglass<D: Dim>(
    elasticity: Elasticity,
    element_class: &ElementClass<D>,
    size: f64,
    positions: &[DVec3],
    deformation: &Matrix,
    centre: DVec3,
) -> (f64, Vec<DVec3>) {
    let offset = |k: usize| element_class.offsets[k] * (0.5 * size);
    let motion = (0..positions.len()).map(|k| {
        let affine = centre + apply(deformation, offset(k));
        (positions[k] - affine) * element_class.volumes[k]
    });
    let modulus = D::HOURGLASS * element_class.hourglass * elasticity.young;
    let stiffness = (2..D::N).fold(modulus, |stiffness, _| stiffness * size);
    (stiffness, motion.collect())
}

/// Returns the first Piola–Kirchhoff stress [Pa] of a deformation gradient.
pub(crate) fn stress(elastic: ElasticLaw, deformation: &Matrix) -> Matrix {
    let elasticity = elastic.elasticity;
    if let Some(factors) = elastic.stress_law.factors() {
        return hyperelasticity::stress(elasticity, factors, deformation);
    }
    let rotation = rotation_of(deformation);
    let stretch: f64 = (0..3).map(|i| rotation[i].dot(deformation[i])).sum();
    let pressure = elasticity.lame() * (stretch - 3.0);
    let cofactor = cofactor(deformation);
    let squash = deformation[0].dot(cofactor[0]);
    let barrier = elasticity.young * (MIN_VOLUME_RATIO - squash).max(0.0);
    let mut stress = [DVec3::ZERO; 3];
    for i in 0..3 {
        for j in 0..3 {
            stress[i][j] = 2.0 * elasticity.shear_modulus() * (deformation[i][j] - rotation[i][j])
                + pressure * rotation[i][j]
                - barrier * cofactor[i][j];
        }
    }
    stress
}

/// Returns the rotation R that balances the moments of a deformation gradient F [Endo 2004, Eq. 1].
///
/// Each iteration turns R by the rotation vector ω from (√3‖F‖·I − S) ω = axial(F Rᵀ), where S is the
/// symmetric part of F Rᵀ. Unlike in a plain Newton step, the matrix is positive definite for every F. Unlike
/// the usual division by |tr S| [Mueller 2016], the step does not lag behind a spinning body. The iteration
/// ends if the turn is below rounding.
///
/// Moments also balance if R differs from the best rotation by half a turn about some axis, but tr RᵀF is
/// then not maximal. In that case the iteration restarts three times, from half a turn about each axis. At
/// least one of these starts is within 120° of the best rotation.
pub fn rotation_of(deformation: &Matrix) -> Matrix {
    from_quaternion(rotation_quaternion(deformation))
}

/// Returns the rotation of a deformation gradient as a quaternion, but only if the rotation `near` differs
/// from it by about a quarter turn or more. The iterations of the force kernel do not reliably correct such a
/// difference.
pub fn rotation_if_far_from(near: &Matrix, deformation: &Matrix) -> Option<[f64; 4]> {
    if is_greatest(near, deformation) {
        return None;
    }
    let turned = rotation_quaternion(deformation);
    let gain = trace(&from_quaternion(turned), deformation) - trace(near, deformation);
    // In an unstrained element, a rotation that is wrong by the angle a lowers tr RᵀF by 2 − 2 cos a, and ‖F‖
    // = √3. There, the threshold ‖F‖ corresponds to a = 82°.
    (gain > norm(deformation)).then_some(turned)
}

fn rotation_quaternion(deformation: &Matrix) -> [f64; 4] {
    let mut turned = turn_from([0.0, 0.0, 0.0, 1.0], deformation);
    let trace_of = |turned| trace(&from_quaternion(turned), deformation);
    if is_greatest(&from_quaternion(turned), deformation) {
        return turned;
    }
    // In 2D, only half a turn about the third axis needs to be tried.
    let [first, second, third] = deformation;
    let is_flat = [first.z, second.z] == [0.0; 2] && *third == IDENTITY[2];
    for axis in if is_flat { 2..3 } else { 0..3 } {
        let mut start = [0.0; 4];
        start[axis] = 1.0;
        let other = turn_from(start, deformation);
        if trace_of(other) > trace_of(turned) + 1e-9 * norm(deformation) {
            turned = other;
        }
    }
    turned
}

/// Runs the iteration of [`rotation_of`] from the quaternion `turned`.
fn turn_from(mut turned: [f64; 4], deformation: &Matrix) -> [f64; 4] {
    let scale = 3f64.sqrt() * norm(deformation);
    for _ in 0..100 {
        let rotation = from_quaternion(turned);
        let mut product = [DVec3::ZERO; 3];
        for i in 0..3 {
            for j in 0..3 {
                product[i][j] = deformation[i].dot(rotation[j]);
            }
        }
        let axial = DVec3::new(
            product[2][1] - product[1][2],
            product[0][2] - product[2][0],
            product[1][0] - product[0][1],
        );
        let mut system = [DVec3::ZERO; 3];
        for i in 0..3 {
            for j in 0..3 {
                system[i][j] = -0.5 * (product[i][j] + product[j][i]);
            }
            system[i][i] += scale + 1e-12;
        }
        let adjugate = cofactor(&system);
        let determinant = system[0].dot(adjugate[0]);
        let turn = apply(&adjugate, axial) * (1.0 / determinant);
        turned = turn_quaternion(turned, turn);
        if turn.dot(turn) < 1e-30 {
            break;
        }
    }
    turned
}

/// Returns whether the rotation R is surely the best fit to the deformation gradient F: tr RᵀF exceeds ‖F‖,
/// which no eigenvalue of F Rᵀ exceeds.
fn is_greatest(rotation: &Matrix, deformation: &Matrix) -> bool {
    trace(rotation, deformation) > norm(deformation)
}

/// Returns tr Rᵀ F.
fn trace(rotation: &Matrix, deformation: &Matrix) -> f64 {
    (0..3).map(|i| rotation[i].dot(deformation[i])).sum()
}

fn norm(m: &Matrix) -> f64 {
    m.iter().map(|&row| row.dot(row)).sum::<f64>().sqrt()
}

fn from_quaternion([x, y, z, w]: [f64; 4]) -> Matrix {
    [
        DVec3::new(
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
        ),
        DVec3::new(
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
        ),
        DVec3::new(
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ),
    ]
}

/// Turns the rotation q by the small rotation vector ω [rad] in world axes: q ← normalise((ω/2, 1) q).
fn turn_quaternion([x, y, z, w]: [f64; 4], turn: DVec3) -> [f64; 4] {
    let [a, b, c] = (turn * 0.5).to_array();
    let next = [
        x + a * w + b * z - c * y,
        y + b * w + c * x - a * z,
        z + c * w + a * y - b * x,
        w - a * x - b * y - c * z,
    ];
    let length = next.iter().map(|k| k * k).sum::<f64>().sqrt();
    next.map(|k| k / length)
}

pub(crate) fn cofactor(m: &Matrix) -> Matrix {
    [m[1].cross(m[2]), m[2].cross(m[0]), m[0].cross(m[1])]
}

fn volume_scale<D: Dim>(half: f64) -> f64 {
    (0..D::N).fold(1.0, |scale, _| scale * half)
}

pub(crate) fn volume_of<D: Dim>(element_class: &ElementClass<D>, half: f64) -> f64 {
    element_class.volume * volume_scale::<D>(half)
}

fn apply(m: &Matrix, v: DVec3) -> DVec3 {
    DVec3::new(m[0].dot(v), m[1].dot(v), m[2].dot(v))
}

fn add_outer(m: &mut Matrix, a: DVec3, b: DVec3) {
    for (row, component) in m.iter_mut().zip(a.to_array()) {
        *row += b * component;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Regression test: the iteration did not leave a start that differed from the best rotation by half a
    /// turn, and the body tore itself apart.
    #[test]
    fn rotation_of_finds_half_turn_about_any_axis() {
        let axes = [
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.6, 0.8, 0.0],
            [0.6, 0.0, -0.8],
            [2.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0],
        ];
        let stretch = [[1.1, 0.1, 0.0], [0.1, 0.9, 0.05], [0.0, 0.05, 1.2]].map(DVec3::from);
        for [x, y, z] in axes {
            for w in [0.0, 1e-9, 1e-3, 0.3] {
                let length = f64::sqrt(1.0 + w * w);
                let turned = from_quaternion([x, y, z, w].map(|k| k / length));
                // The deformation gradient is the product of the rotation and the stretch, by rows.
                let deformation = turned.map(|row| {
                    let rows = (0..3).map(|k| stretch[k] * row[k]);
                    rows.sum()
                });
                let found = rotation_of(&deformation);
                for (found, expected) in found.into_iter().zip(turned) {
                    let off = (found - expected).abs().max_element();
                    assert!(off < 1e-9, "{found} for {expected}");
                }
            }
        }
    }
}
