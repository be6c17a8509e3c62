//! What a snapshot has of the blocks: how each element has turned and what it pulled at last.

use super::plastic::Dent;
use crate::ids::ElementId;
use crate::law::Law;
use serde::{Deserialize, Serialize};

/// What is state in the blocks, element by element, by ascending ids.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Saved {
    pub law: Law,
    /// Of each element its rotation, then the forces on its nodes [N], in their order.
    pub numbers: Vec<f32>,
    /// What was kneaded into those that were, ascending.
    pub undone: Vec<(ElementId, Dent)>,
    /// Whether each was inside out.
    pub inverted: Vec<bool>,
}
