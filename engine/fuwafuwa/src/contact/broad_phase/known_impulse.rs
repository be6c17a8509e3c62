//! Impulses between two sides of a contact.

#[cfg(feature = "serde")]
use crate::foundation::dim::Dim;
use crate::soft_body::element_forces::Row;

/// Impulses of a contact, in the last substep and over the tick [N s].
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Impulse {
    /// Normal impulse.
    pub pressed: f32,
    /// Friction impulse.
    pub dragged: Row,
    /// Sum of the normal impulses since the start of the tick.
    pub total: f32,
    /// Highest approach speed since the start of the tick [m/s].
    pub speed: f32,
}

#[cfg(feature = "serde")]
impl Impulse {
    /// Clears the components beyond the dimension.
    pub fn flatten<D: Dim>(&mut self) {
        let aside = self.dragged[D::N..].iter_mut();
        aside
            .filter(|along| **along != 0.0)
            .for_each(|along| *along = 0.0);
    }
}
