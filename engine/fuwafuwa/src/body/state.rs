//! What changes in a body from substep to substep, and what the next one goes on from.

use super::cooldowns::Cooldowns;
use crate::dim::Dim;
use crate::ids::{NodeId, Table};
use crate::layers::Layers;
use crate::solve::{Blocks, Row};

/// How many times as strongly as on others gravity may pull on a body. A choice: with it a body falls by
/// 1 m within three ticks.
pub const MOST_GRAVITY: f32 = 100.0;

/// What changes in a body from substep to substep, and what the next one goes on from.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct State<D: Dim> {
    /// Position [m], velocity [m/s] and mass [kg] of each node.
    pub position: Table<NodeId, Row>,
    pub velocity: Table<NodeId, Row>,
    pub mass: Table<NodeId, f32>,
    /// One over the mass [1/kg]; 0 while a node is held or sleeps.
    pub inverse_mass: Table<NodeId, f32>,
    pub held: Table<NodeId, bool>,
    /// How far each node has given way to what is more than it bears; at 1 it comes off.
    pub damage: Table<NodeId, f32>,
    /// Where it tore a short while ago.
    pub cooldowns: Cooldowns,
    /// Positions a moment ahead, where damped forces are evaluated.
    pub ahead: Table<NodeId, Row>,
    /// How many times as strongly as on others gravity pulls on it.
    pub gravity_scale: f32,
    /// Who touches it.
    pub layers: Layers,
    /// What whoever put it into a world wants to know of it.
    pub user_data: u64,
    /// Whether nodes were placed from outside since forces were last computed.
    pub placed: bool,
    /// How each element has turned, and the forces of the last substep: where an element has come to turns
    /// step by step, and the next crack goes where the last forces pulled. Snapshots have no more of them.
    pub blocks: Blocks<D>,
}

impl<D: Dim> State<D> {
    /// Of a body without nodes.
    pub fn new(blocks: Blocks<D>) -> Self {
        Self {
            position: Table::default(),
            velocity: Table::default(),
            mass: Table::default(),
            inverse_mass: Table::default(),
            held: Table::default(),
            damage: Table::default(),
            cooldowns: Cooldowns::default(),
            ahead: Table::default(),
            gravity_scale: 1.0,
            layers: Layers::default(),
            user_data: 0,
            placed: false,
            blocks,
        }
    }

    /// Makes room for as many nodes.
    pub fn make_room(&mut self, nodes: usize) {
        self.position.resize(nodes, [0.0; 4]);
        self.velocity.resize(nodes, [0.0; 4]);
        self.mass.resize(nodes, 0.0);
        self.inverse_mass.resize(nodes, 0.0);
        self.held.resize(nodes, false);
        self.damage.resize(nodes, 0.0);
        self.ahead.resize(nodes, [0.0; 4]);
    }
}
