//! State of a body that changes from substep to substep.

use super::cooldowns::Cooldowns;
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::foundation::ids::{IndexVec, NodeId};
use crate::fracture::tip_deviations::TipDeviations;
use crate::rigid_body::layers::Layers;
use crate::soft_body::element_forces::{ElementBatches, Row};
use crate::soft_body::stiff_body::Stiffening;

/// Largest absolute value of a body's gravity scale. At this scale, a body under the gravity of the earth
/// falls by 1 m within three ticks of 1/60 s.
pub const MAX_GRAVITY_SCALE: f32 = 100.0;

/// State of a body that changes from substep to substep.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct State<D: Dim> {
    /// Position of each node [m].
    pub position: IndexVec<NodeId, Row>,
    /// Velocity of each node [m/s].
    pub velocity: IndexVec<NodeId, Row>,
    /// Mass of each node [kg].
    pub mass: IndexVec<NodeId, f32>,
    /// Inverse mass of each node [1/kg]; 0 while the node is fixed or sleeps.
    pub inverse_mass: IndexVec<NodeId, f32>,
    /// Whether each node is fixed.
    pub fixed: IndexVec<NodeId, bool>,
    /// Damage of each node, from 0 (intact) to 1, at which the node is split.
    pub damage: IndexVec<NodeId, f32>,
    /// Lattice points at which nodes were released recently, with the time until nodes around them can fail
    /// again.
    pub cooldowns: Cooldowns,
    /// Deviation of each crack tip from its ideal path.
    pub tip_deviations: TipDeviations,
    /// Position of each node [m], extrapolated by the largest stiffness damping of the materials. The elastic
    /// forces of that material are evaluated at these positions.
    pub ahead: IndexVec<NodeId, Row>,
    /// Factor on the gravity of the world, default 1.
    pub gravity_scale: f32,
    /// Collision layers, which decide with which objects the body collides.
    pub layers: Layers,
    /// Number for use by the program; the engine ignores it.
    pub user_data: u64,
    /// Whether the caller has moved nodes since forces were last computed, so that element rotations must be
    /// recomputed.
    pub placed: bool,
    /// Whether the stiffness scale or the mass scale has changed since the last tick.
    pub scale_changed: bool,
    /// Stiffening of hyperelastic elements at the beginning of the last tick.
    pub stiffening: Stiffening,
    /// Batches of elements. Snapshots contain only the rotation and the internal state of each element and
    /// the forces of the last substep. Each substep continues from the last rotations, and the last forces
    /// decide where the next crack runs.
    pub batches: ElementBatches<D>,
}

hash_state! {
    [D: Dim] struct State<D> {
        position, velocity, mass, inverse_mass, fixed, damage, cooldowns, tip_deviations, ahead,
        gravity_scale, layers, user_data, placed, scale_changed, stiffening, batches,
    }
}

impl<D: Dim> State<D> {
    /// Creates the state of a body without nodes.
    pub fn new(batches: ElementBatches<D>) -> Self {
        Self {
            position: IndexVec::default(),
            velocity: IndexVec::default(),
            mass: IndexVec::default(),
            inverse_mass: IndexVec::default(),
            fixed: IndexVec::default(),
            damage: IndexVec::default(),
            cooldowns: Cooldowns::default(),
            tip_deviations: TipDeviations::default(),
            ahead: IndexVec::default(),
            gravity_scale: 1.0,
            layers: Layers::default(),
            user_data: 0,
            placed: false,
            scale_changed: false,
            stiffening: Stiffening::default(),
            batches,
        }
    }

    /// Resizes the list of each quantity to `nodes` nodes; new entries are 0.
    pub fn make_room(&mut self, nodes: usize) {
        self.position.resize(nodes, Row::ZERO);
        self.velocity.resize(nodes, Row::ZERO);
        self.mass.resize(nodes, 0.0);
        self.inverse_mass.resize(nodes, 0.0);
        self.fixed.resize(nodes, false);
        self.damage.resize(nodes, 0.0);
        self.ahead.resize(nodes, Row::ZERO);
    }
}
