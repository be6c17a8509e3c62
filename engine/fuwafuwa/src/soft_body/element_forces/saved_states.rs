//! State of the elements in a snapshot: rotation and last forces of each element.

use super::plastic_kernel::PlasticInverse;
use crate::foundation::ids::ElementId;
use crate::soft_body::element_law::Law;
use serde::{Deserialize, Serialize};

/// State of the elements, by ascending id.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SavedElementStates {
    pub law: Law,
    /// For each element its rotation, then the forces on its nodes [N], in the order of the nodes.
    pub numbers: Vec<f32>,
    /// Plastic inverses other than the identity, by ascending id.
    pub undone: Vec<(ElementId, PlasticInverse)>,
    /// Whether each element was inverted in the last evaluation.
    pub inverted: Vec<bool>,
}
