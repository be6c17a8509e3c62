//! Impulses between two sides of a contact.

use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::soft_body::element_forces::Row;

/// Impulses of a contact in the last substep [N s], and sums over the tick. The hash of the state omits the
/// sums, because each tick begins by clearing them.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Impulse {
    /// Normal impulse in the last substep [N s].
    pub normal_impulse: f32,
    /// Friction impulse in the last substep [N s].
    pub friction_impulse: Row,
    /// Sum of the normal impulses since the start of the tick [N s].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub total: f32,
    /// Highest approach speed since the start of the tick [m/s].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub speed: f32,
}

hash_state! { struct Impulse { normal_impulse, friction_impulse } skip { total, speed } }

impl Impulse {
    /// Returns whether the contact had an impulse in the last substep.
    pub fn is_known(&self) -> bool {
        self.normal_impulse != 0.0 || self.friction_impulse != Row::ZERO
    }
}

impl Impulse {
    /// Clears the unused components of the friction impulse: the fourth one, and in 2D also the third.
    pub fn flatten<D: Dim>(&mut self) {
        let aside = self.friction_impulse[D::N..].iter_mut();
        aside
            .filter(|along| **along != 0.0)
            .for_each(|along| *along = 0.0);
    }
}
