//! Collision layers.

use crate::foundation::hash::hash_state;

/// Collision layers of a body, as two bit masks: the layers that the body belongs to, and the layers that it
/// collides with. Two bodies collide if each belongs to a layer that the other one collides with. The same
/// test decides whether two pieces of one soft body collide.
///
/// ```
/// use fuwafuwa::Layers;
///
/// let ghost = Layers { memberships: 0b10, filters: 0b01 };
/// assert!(ghost.meet(Layers::default()) && !ghost.meet(ghost));
/// ```
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Layers {
    /// Bit mask of the layers that the body belongs to; by default only the first layer.
    pub memberships: u32,
    /// Bit mask of the layers that the body collides with; by default all layers.
    pub filters: u32,
}

hash_state! { struct Layers { memberships, filters } }

impl Default for Layers {
    fn default() -> Self {
        Self {
            memberships: 1,
            filters: u32::MAX,
        }
    }
}

impl Layers {
    /// Returns whether bodies with these layers collide.
    #[inline(always)]
    pub fn meet(self, other: Self) -> bool {
        self.memberships & other.filters != 0 && other.memberships & self.filters != 0
    }
}
