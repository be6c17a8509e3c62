//! Soft bodies that require more substeps than the world allows: scaling of their stiffness or mass.

use super::SoftBody;
use super::body_properties::elasticities;
use crate::foundation::dim::Dim;
use crate::foundation::ids::NodeId;
use crate::world::{StiffBodies, WorldConfig};

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
    /// [`SoftBody::mass_scale`].
    pub fn longest_substep(&self) -> f64 {
        let scale = self.topology.stiffness_scale / self.topology.mass_scale;
        let fastest = self.cache.properties.fastest_wave * scale.sqrt();
        COURANT * f64::from(self.topology.grid.voxel_size()) / fastest
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
        let size = f64::from(self.topology.grid.voxel_size());
        let duration = config.shortest_substep();
        let ratio = COURANT * size / self.cache.properties.fastest_wave / duration;
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
        let elasticities = elasticities(&topology.materials, stiffness_scale);
        self.state.batches.set_elasticities(&elasticities);
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
