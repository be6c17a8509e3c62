//! What passes between two that touch.

#[cfg(feature = "serde")]
use crate::dim::Dim;
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
    /// How fast the two approached each other at the most since then [m/s].
    pub speed: f32,
}

#[cfg(feature = "serde")]
impl Impulse {
    /// Takes out what leads out of the plane.
    pub fn flatten<D: Dim>(&mut self) {
        let aside = self.dragged[D::N..].iter_mut();
        aside
            .filter(|along| **along != 0.0)
            .for_each(|along| *along = 0.0);
    }
}
