//! Rayleigh damping of the materials of a body, and the stability limit of its stiffness term.

use super::SoftBody;
use crate::error::{Error, require};
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::foundation::ids::NodeId;
use crate::material::Material;
use std::f32::consts::TAU;

/// Fraction of the largest stable stiffness damping that a substep uses; see [`max_stiffness_damping`]. 0.7
/// leaves about the margin that the Courant number of a substep leaves in 3D for the squared substep: (0.6 /
/// 0.73)² = 0.68.
const STABLE_SHARE: f64 = 0.7;

/// Smallest stiffness damping of a body with a mass scale [substeps]. Without it, the vibrations of single voxels
/// grow while a scaled body without stiffness damping rests on another one: a ball 1 cm wide in 12 voxels, with a
/// mass scale of 18, began to hop after 2 s.
const MIN_SCALED_DAMPING: f32 = 0.1;

/// Rayleigh damping of a material: C = α M + β K, with the damping matrix C, the mass matrix M and the
/// stiffness matrix K [Bathe 1996, §9.3.3].
///
/// A vibration of angular frequency ω [rad/s] has the damping ratio ζ = α / 2ω + β ω / 2, at every shape and
/// resolution: 0 rings on, 1 is critically damped. Each voxel has the damping of its own material.
///
/// Both terms keep the linear and angular momentum of a free piece:
///
/// - The mass term acts on the motion of each piece relative to its rigid motion, so it damps neither flight
///   nor rotation. In a piece with fixed nodes, it acts relative to the rigid motion of the fixed nodes.
/// - The stiffness term acts on the rate of the strain.
///
/// ```
/// use fuwafuwa::{Damping, Material};
///
/// let material = Material { damping: Damping::at(0.2, 5.0), ..Material::default() };
/// assert!((material.damping.ratio(5.0) - 0.2).abs() < 1e-6);
/// // Mass damping alone: half the ratio at double the frequency.
/// assert!((material.damping.ratio(10.0) - 0.1).abs() < 1e-6);
/// let damping = Damping::between(0.05, 5.0, 20.0);
/// assert!((damping.ratio(5.0) - 0.05).abs() < 1e-6);
/// assert!((damping.ratio(20.0) - 0.05).abs() < 1e-6);
/// assert!(damping.ratio(10.0) < 0.05);
/// ```
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Damping {
    /// Mass damping α [1/s], 0 or more; default 4. Damps slow vibrations most: the amplitude of a vibration
    /// falls by the factor e in the time 2/α, whatever its frequency. It has no stability limit.
    pub mass: f32,
    /// Stiffness damping β [s], 0 or more; default 0.0002. Damps fast vibrations most: those faster than 2/β
    /// [rad/s] do not oscillate.
    ///
    /// The substep limits its value to about a tenth of the time in which a pressure wave crosses a voxel, or
    /// to more if the substep is shorter than the material requires; see
    /// [`World::acting_damping`](crate::World::acting_damping). In a body with a
    /// [mass scale](crate::SoftBody::mass_scale), at least a tenth of a substep acts.
    pub stiffness: f32,
}

hash_state! { struct Damping { mass, stiffness } }

impl Default for Damping {
    /// Damping ratio of about 0.08 at 4 Hz, the frequency of the slowest vibration of a disc or ball 1 m
    /// across of the default material.
    ///
    /// The stiffness damping is about the largest that 16 substeps of 1/960 s allow the default material in
    /// voxels of 1/64 m in 3D (0.00029 s), and the substeps that it requires in voxels of 1/128 m in 2D
    /// (0.00021 s).
    fn default() -> Self {
        Self {
            mass: 4.0,
            stiffness: 2e-4,
        }
    }
}

impl Damping {
    /// No damping: vibrations ring on.
    pub const NONE: Self = Self {
        mass: 0.0,
        stiffness: 0.0,
    };

    /// Returns mass damping with a damping ratio of `ratio` at `frequency` [Hz]. The ratio at other
    /// frequencies is inversely proportional to the frequency.
    pub fn at(ratio: f32, frequency: f32) -> Self {
        Self {
            mass: 2.0 * ratio * TAU * frequency,
            stiffness: 0.0,
        }
    }

    /// Returns mass and stiffness damping with a damping ratio of `ratio` at the frequencies `low` and `high`
    /// [Hz]. The ratio is lower between them and higher outside.
    pub fn between(ratio: f32, low: f32, high: f32) -> Self {
        let (low, high) = (TAU * low, TAU * high);
        let stiffness = 2.0 * ratio / (low + high);
        Self {
            mass: stiffness * low * high,
            stiffness,
        }
    }

    /// Damping ratio of a vibration of `frequency` [Hz].
    pub fn ratio(self, frequency: f32) -> f32 {
        let angular = TAU * frequency;
        0.5 * (self.mass / angular + self.stiffness * angular)
    }

    /// Returns the damping with the same damping ratio for vibrations that are `slowdown` times slower.
    fn slowed(self, slowdown: f32) -> Self {
        Self {
            mass: self.mass / slowdown,
            stiffness: self.stiffness * slowdown,
        }
    }

    /// Checks both fields.
    pub(crate) fn check(self) -> Result<(), Error> {
        let fields = [
            ("mass_damping", self.mass),
            ("stiffness_damping", self.stiffness),
        ];
        for (field, given) in fields {
            let is_valid = (0.0..=f32::MAX).contains(&given);
            require(is_valid, field, "0 or more, and finite", given)?;
        }
        Ok(())
    }
}

/// Returns the largest stiffness damping [s] that acts in a substep of `duration` [s].
///
/// The fastest vibration, of angular frequency Ω = `fastest` [rad/s], is that of a single voxel. With the
/// stiffness damping β and a substep of h, it is stable if Ω²h (h + 2β) < 4, that is, β < (4/Ω² − h²) / 2h.
/// Voxels in a body vibrate more slowly. The result is [`STABLE_SHARE`] times this bound.
fn max_stiffness_damping(fastest: f64, duration: f64) -> f64 {
    let room = 4.0 / (fastest * fastest) - duration * duration;
    STABLE_SHARE * room.max(0.0) / (2.0 * duration)
}

impl<D: Dim> SoftBody<D> {
    /// Returns the damping of each material, by material number − 1, that acts in substeps of `duration` [s].
    pub(crate) fn acting_damping(&self, duration: f32) -> impl Iterator<Item = Damping> + '_ {
        let slowdown = self.slowdown();
        let least = if slowdown > 1.0 {
            MIN_SCALED_DAMPING * duration
        } else {
            0.0
        };
        let scale = self.topology.stiffness_scale.sqrt() / slowdown * self.state.stiffening.speed();
        let size = f64::from(self.topology.grid.voxel_size());
        let acting = move |material: &Material| {
            let fastest = material.breathing_speed(D::N) * scale / size;
            let max = max_stiffness_damping(fastest, f64::from(duration)) as f32;
            let wanted = material.damping.slowed(slowdown as f32);
            Damping {
                stiffness: wanted.stiffness.max(least).min(max),
                ..wanted
            }
        };
        self.topology.materials.iter().map(acting)
    }

    /// Returns whether a material in use has less stiffness damping than specified in substeps of `duration`
    /// [s].
    pub(crate) fn is_damping_limited(&self, duration: f32) -> bool {
        let used = self.cache.properties.used.iter();
        let mut materials = self.topology.materials.iter().zip(used);
        let slowdown = self.slowdown() as f32;
        let mut acting = self.acting_damping(duration);
        materials.any(|(material, used)| {
            let acting = acting.next().expect("every material has a damping");
            *used && acting.stiffness < material.damping.slowed(slowdown).stiffness
        })
    }

    /// Returns the time [s] by which the positions are extrapolated at which the forces of each material are
    /// evaluated, by material number − 1: its acting stiffness damping in substeps of `duration` [s].
    /// Materials that are not in use have the longest of these times. Also returns the longest time.
    pub(crate) fn leads(&self, duration: f32) -> (Vec<f32>, f32) {
        let used = &self.cache.properties.used;
        let acting = self.acting_damping(duration);
        // Adding 0 turns −0 into 0.
        let mut leads: Vec<f32> = acting.map(|damping| damping.stiffness + 0.0).collect();
        let in_use = leads.iter().zip(used).filter(|(_, used)| **used);
        let longest = in_use.fold(0.0, |longest: f32, (&lead, _)| longest.max(lead));
        for (lead, used) in leads.iter_mut().zip(used) {
            if !used {
                *lead = longest;
            }
        }
        (leads, longest)
    }

    /// Factor by which the mass scale makes vibrations slower. The damping acts with the same damping ratio.
    pub(super) fn slowdown(&self) -> f64 {
        self.topology.mass_scale.sqrt()
    }

    /// Acting mass damping of the body [1/s]; `None` if it differs between the materials in use.
    pub(crate) fn mass_damping(&self) -> Option<f32> {
        let specified = self.cache.properties.mass_damping;
        specified.map(|damping| damping / self.slowdown() as f32)
    }

    /// Updates the mass damping of nodes, if it differs between the materials in use. The mass damping of a
    /// node is the mean over the elements that carry its mass.
    pub(crate) fn update_mass_damping(&mut self, nodes: &[NodeId]) {
        if self.mass_damping().is_some() {
            return;
        }
        let capacity = self.topology.mesh.node_capacity();
        self.cache.mass_damping.edit().resize(capacity, 0.0);
        for &id in nodes {
            let rate = |material: &Material| {
                f64::from(material.density) * f64::from(material.damping.mass)
            };
            let damped = self.sum_over_carriers(id, &rate);
            self.cache.mass_damping.edit()[id] = (damped / f64::from(self.state.mass[id])) as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_vibrations_have_the_ratio_of_rayleigh_s_rule() {
        // Bathe 1996, example 9.9: ratios 0.02 and 0.10 at 2 and 3 rad/s need α = −0.336 and β = 0.104. With
        // the same ratio at both, α = 2 ζ ω₁ ω₂ / (ω₁ + ω₂) and β = 2 ζ / (ω₁ + ω₂).
        let damping = Damping::between(0.1, 2.0 / TAU, 3.0 / TAU);
        assert!((damping.mass - 0.24).abs() < 1e-6, "{damping:?}");
        assert!((damping.stiffness - 0.04).abs() < 1e-6, "{damping:?}");
    }

    #[test]
    fn stiffness_damping_at_its_limit_leaves_the_stated_margin() {
        let (fastest, duration) = (700.0, 1.0 / 960.0);
        let damping = max_stiffness_damping(fastest, duration);
        let stability = fastest * fastest * duration * (duration + 2.0 * damping / STABLE_SHARE);
        assert!((stability - 4.0).abs() < 1e-9, "{stability}");
        assert_eq!(max_stiffness_damping(3000.0, duration), 0.0);
    }
}
