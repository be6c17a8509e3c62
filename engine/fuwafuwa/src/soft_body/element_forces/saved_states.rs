//! State of the elements in a snapshot: rotation, last forces and internal state of each element.

use super::internal_state::InternalState;
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
    /// Internal states other than [`InternalState::NONE`], by ascending element id.
    pub internal_states: Vec<(ElementId, InternalState)>,
    /// For each element, whether its volume was negative in the last evaluation.
    pub inverted: Vec<bool>,
}
