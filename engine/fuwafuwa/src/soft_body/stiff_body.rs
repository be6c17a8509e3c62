//! Soft bodies that require more substeps than the world allows: scaling of their stiffness or mass.

use super::SoftBody;
use super::damping::{PieceMotion, motions};
use super::element_forces::Row;
use super::element_law::{IDENTITY, Matrix};
use super::hyperelasticity::relative_stiffness;
use crate::foundation::dim::Dim;
use crate::foundation::hash::{Hash, HashState};
use crate::foundation::ids::{ElementId, IndexVec, NodeId, PieceId};
use crate::topology::mesh::Element;
use crate::world::{StiffBodies, WorldConfig};
use glam::DVec3;

/// Longest stable substep, as a fraction of the stability limit of the breathing mode of a free voxel. Decides in 3D
/// above a Poisson's ratio of 0.45, where the breathing mode is the fastest one at the Courant number [`COURANT`].
const BREATHING: f64 = 0.975;

/// Time for which the positions of nodes are predicted to find out how stiff a hyperelastic body becomes [s].
const LOOKAHEAD: f64 = 1.0 / 120.0;

/// Largest stiffening of a body. Beyond it, the positions are not meaningful.
const MAX_STIFFENING: f64 = 1e4;

/// Step between two values of the stiffening: the fourth root of 2. With finer steps, the mass scale would change in
/// almost every tick.
const STIFFENING_STEP: f64 = 1.189_207_115_002_721;

/// Stiffness of the stiffest hyperelastic element against a pressure wave relative to that at rest, rounded up; 1 for
/// other materials.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stiffening(f64);

impl Default for Stiffening {
    fn default() -> Self {
        Self(1.0)
    }
}

impl HashState for Stiffening {
    /// Bodies that are not stiffer than at rest have the hash of earlier versions.
    fn hash_state(&self, hash: &mut Hash) {
        if self.0 != 1.0 {
            self.0.hash_state(hash);
        }
    }
}

impl Stiffening {
    /// Rounds up a stiffness relative to that at rest.
    fn at_least(stiffness: f64) -> Self {
        let mut rounded = 1.0;
        while rounded < stiffness.min(MAX_STIFFENING) {
            rounded *= STIFFENING_STEP;
        }
        Self(rounded)
    }

    /// Factor on the frequencies of the body.
    pub fn speed(self) -> f64 {
        self.0.sqrt()
    }

    /// Returns whether the value read from a snapshot is valid.
    #[cfg(feature = "serde")]
    pub fn is_valid(self) -> bool {
        (1.0..=MAX_STIFFENING * STIFFENING_STEP).contains(&self.0)
    }
}

/// Courant number of a substep: the fastest pressure wave travels at most this fraction of a voxel per
/// substep.
///
/// The fastest mode of a body at rest is the oscillation of a single free voxel. Let the voxel have the width
/// s, the angular frequency Ω and the wave speed c. The oscillation is stable up to a Courant number of 2c /
/// Ωs: 0.73 in 3D and 0.84 in 2D, at a Poisson's ratio of 0.3. Squashed elements oscillate faster. At 0.6, a
/// ball stays stable even if it is squashed to 40 % of its height and hit at its wave speed.
const COURANT: f64 = 0.6;

impl<D: Dim> SoftBody<D> {
    /// Longest stable substep [s]: 0.6 h √s / c, with the voxel size h [m], the speed c [m/s] of the fastest
    /// pressure wave at the present stiffness, and the mass scale s. See [`SoftBody::stiffness_scale`] and
    /// [`SoftBody::mass_scale`]. In 3D it is up to 5 % shorter above a Poisson's ratio of 0.45. For hyperelastic
    /// materials, c is that of the most deformed element at the beginning of the last tick.
    pub fn longest_substep(&self) -> f64 {
        let scale = self.topology.stiffness_scale / self.topology.mass_scale;
        self.unscaled_substep() / (scale.sqrt() * self.state.stiffening.speed())
    }

    /// Longest stable substep at rest, without any scale [s].
    fn unscaled_substep(&self) -> f64 {
        let properties = &self.cache.properties;
        let size = f64::from(self.topology.grid.voxel_size());
        let wave = COURANT * size / properties.fastest_wave;
        wave.min(BREATHING * 2.0 * size / properties.fastest_breathing)
    }

    /// Measures how much stiffer hyperelastic elements are than at rest, and scales the body for the substeps of a
    /// world accordingly.
    pub(crate) fn follow_stiffening(&mut self, config: &WorldConfig<D>) {
        if !self.cache.properties.is_hyperelastic {
            return;
        }
        let stiffening = Stiffening::at_least(self.stiffening());
        if stiffening != self.state.stiffening {
            self.state.stiffening = stiffening;
            let before = self.topology.mass_scale;
            self.scale_for(config);
            let grown = self.topology.mass_scale / before;
            if grown > 1.0 {
                self.slow_deformation((1.0 / grown.sqrt()) as f32);
            }
        }
    }

    /// Multiplies all velocities other than the affine motion of each piece by `factor`. Only they have the scaled mass; the
    /// mass of affine motion hardly changes with the scale, see [`piece_response`](super::piece_response). At unchanged
    /// velocities, a growing mass scale would add kinetic energy.
    fn slow_deformation(&mut self, factor: f32) {
        let motions = motions(self);
        let wide = |row: Row| row.xyz().as_dvec3();
        let mut moments: IndexVec<PieceId, [DVec3; 3]> =
            vec![[DVec3::ZERO; 3]; motions.len()].into();
        for &id in &self.cache.awake {
            let piece = self.topology.pieces.of_node(id);
            let offset = wide(self.state.position[id]) - motions[piece].centre;
            let impulse = wide(self.state.velocity[id]) * f64::from(self.state.mass[id]);
            for axis in 0..D::N {
                moments[piece][axis] += impulse * offset[axis];
            }
        }
        let rigid: IndexVec<PieceId, _> = motions.iter().map(PieceMotion::rigid).collect();
        let gradients = motions.iter().zip(moments.iter()).map(|(motion, moments)| {
            // All motion of a piece with fixed nodes has the scaled mass, so only its rigid motion is kept.
            if motion.nodes == 0 || motion.has_fixed_nodes() {
                return None;
            }
            let inverse = motion.inverse_spread::<D>();
            Some([0, 1, 2].map(|axis: usize| {
                let parts = [0, 1, 2].map(|k: usize| moments[k] * inverse[k][axis]);
                parts[0] + parts[1] + parts[2]
            }))
        });
        let gradients: IndexVec<PieceId, Option<[DVec3; 3]>> = gradients.collect();
        for index in 0..self.cache.awake.len() {
            let id = self.cache.awake[index];
            if self.state.inverse_mass[id] == 0.0 {
                continue;
            }
            let piece = self.topology.pieces.of_node(id);
            let at = self.state.position[id];
            let affine = match &gradients[piece] {
                None => rigid[piece].at(at),
                Some(columns) => {
                    let offset = wide(at) - motions[piece].centre;
                    let whole = rigid[piece].velocity().linear.as_dvec3();
                    (0..D::N).fold(whole, |sum, axis| sum + columns[axis] * offset[axis])
                }
            };
            let affine = Row::from(affine.as_vec3());
            let own = self.state.velocity[id] - affine;
            self.state.velocity[id] = affine + own * factor;
        }
    }

    /// Stiffness of the stiffest awake hyperelastic element against a pressure wave relative to that at rest, now or
    /// at the predicted positions.
    fn stiffening(&self) -> f64 {
        let elements = self.topology.mesh.elements();
        let awake = elements.filter(|&(id, _)| {
            let pieces = &self.topology.pieces;
            !pieces.list[pieces.of_element(id)].asleep
        });
        let of = |(_, element): (ElementId, &Element)| {
            let material = self.material(element);
            let Some(factors) = material.stress_law.factors() else {
                return 1.0;
            };
            let now = self.gradient_of(element, &self.state.position);
            let rate = self.gradient_of(element, &self.state.velocity);
            let soon = [0, 1, 2].map(|row: usize| now[row] + rate[row] * LOOKAHEAD);
            let stiffness = |mut deformation: Matrix| {
                (D::N..3).for_each(|axis| deformation[axis] = IDENTITY[axis]);
                relative_stiffness(material.elasticity, factors, &deformation)
            };
            stiffness(now).max(stiffness(soon))
        };
        awake.map(of).fold(1.0, f64::max)
    }

    /// Returns the gradient of a vector field, given at the nodes, in an element.
    fn gradient_of(&self, element: &Element, field: &IndexVec<NodeId, Row>) -> Matrix {
        let class = self.topology.mesh.element_class(element);
        let half =
            0.5 * f64::from(self.topology.grid.voxel_size()) * f64::from(element.cell.width());
        let mut gradient = [DVec3::ZERO; 3];
        for (&node, &slope) in element.nodes.iter().zip(&class.gradients) {
            let value = field[node].xyz().as_dvec3() / (class.volume * half);
            for (row, part) in gradient.iter_mut().zip(value.to_array()) {
                *row += slope * part;
            }
        }
        gradient
    }

    /// Factor by which Young's modulus was lowered to keep the substep stable; 1 = unchanged. It acts under
    /// [`StiffBodies::Softened`](crate::StiffBodies::Softened).
    pub fn stiffness_scale(&self) -> f64 {
        self.topology.stiffness_scale
    }

    /// Factor s by which the inertia of deformation was raised to keep the substep stable; 1 = unchanged. It acts
    /// under [`StiffBodies::MassScaled`](crate::StiffBodies::MassScaled). Vibrations are √s times slower and have
    /// the same damping ratio; only uniform stretching is less slow, with a lower ratio of mass damping and a
    /// higher one of stiffness damping. Masses, momentum and [kinetic energy](SoftBody::kinetic_energy) are those
    /// of the true mass.
    pub fn mass_scale(&self) -> f64 {
        self.topology.mass_scale
    }

    /// Notes that the scale of the body is new to its world, if the body has one.
    pub(crate) fn announce_scale(&mut self) {
        let topology = &self.topology;
        self.state.scale_changed |= (topology.stiffness_scale, topology.mass_scale) != (1.0, 1.0);
    }

    /// Scales the stiffness or the mass of the body by the smallest factor at which the shortest substep of a
    /// world is stable.
    pub(crate) fn scale_for(&mut self, config: &WorldConfig<D>) {
        let duration = config.shortest_substep() * self.state.stiffening.speed();
        let ratio = self.unscaled_substep() / duration;
        let scale = (ratio * ratio).min(1.0);
        let (stiffness_scale, mass_scale) = match config.stiff_bodies {
            StiffBodies::Softened => (scale, 1.0),
            StiffBodies::MassScaled | StiffBodies::Exact => (1.0, 1.0 / scale),
        };
        let topology = &mut self.topology;
        if (stiffness_scale, mass_scale) == (topology.stiffness_scale, topology.mass_scale) {
            return;
        }
        (topology.stiffness_scale, topology.mass_scale) = (stiffness_scale, mass_scale);
        self.state.scale_changed = true;
        let materials = &topology.materials;
        self.state.batches.set_materials(materials, stiffness_scale);
        let nodes: Vec<NodeId> = self.topology.mesh.nodes().map(|(id, _)| id).collect();
        for id in nodes {
            self.state.inverse_mass[id] = self.inverse_mass_of(id);
        }
    }

    /// Returns whether the scale has changed since the last call.
    pub(crate) fn take_scale_changed(&mut self) -> bool {
        std::mem::take(&mut self.state.scale_changed)
    }

    /// Speed of the fastest pressure wave [m/s] at the full stiffness of the materials and the present mass
    /// scale.
    pub(crate) fn fastest_wave(&self) -> f64 {
        self.cache.properties.fastest_wave / self.topology.mass_scale.sqrt()
    }
}
