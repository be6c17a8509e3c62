//! Collision layers.

use crate::foundation::hash::hash_state;

/// Collision layers of a body: the layers of which it is a member, and the layers that it collides with, bit
/// by bit. Two bodies collide if each is a member of a layer that the other one collides with. The pieces of
/// a body use its layers, also among each other.
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
    /// Layers of which the body is a member; only the first by default.
    pub memberships: u32,
    /// Layers that the body collides with; all by default.
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
    /// Whether bodies with these layers collide.
    #[inline(always)]
    pub fn meet(self, other: Self) -> bool {
        self.memberships & other.filters != 0 && other.memberships & self.filters != 0
    }
}
