//! State of the elements in a snapshot: rotation, last forces and plastic inverse of each element.

use super::plastic_kernel::PlasticInverse;
use crate::foundation::ids::ElementId;
use crate::soft_body::element_law::Law;
use serde::{Deserialize, Serialize};

/// State of all elements of a body in a snapshot, by ascending element id.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SavedElementStates {
    pub law: Law,
    /// For each element, the rotation (cosine and sine in 2D, a quaternion in 3D), then the forces on its
    /// nodes [N], in the order of the nodes.
    pub numbers: Vec<f32>,
    /// Plastic inverses that differ from the identity, by ascending element id.
    pub plastic_inverses: Vec<(ElementId, PlasticInverse)>,
    /// For each element, whether its volume was negative in the last evaluation.
    pub inverted: Vec<bool>,
}
