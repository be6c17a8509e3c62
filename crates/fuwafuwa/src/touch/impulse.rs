//! What passes between two that touch.

use crate::solve::Row;

/// The impulses of a contact [N s]: from one substep to the next, and over a tick.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Impulse {
    /// Along the normal.
    pub pressed: f32,
    /// Across it.
    pub dragged: Row,
    /// Along the normal, since the start of the tick.
    pub total: f32,
}
