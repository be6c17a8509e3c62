//! Coordinates on the paper.

use fuwafuwa::DimVector;

/// A point on the paper [px], y downwards.
pub type PaperPoint = [f32; 2];

/// Map from the plane, y upwards, to the paper.
#[derive(Copy, Clone, Debug)]
pub struct PaperTransform {
    /// Position of the origin on the paper.
    pub origin: PaperPoint,
    /// Scale: pixels per unit.
    pub unit: f32,
}

impl PaperTransform {
    /// Returns the point on the paper; a third coordinate is ignored.
    pub fn spot(self, at: impl DimVector) -> PaperPoint {
        let [x, y] = self.origin;
        [x + at[0] * self.unit, y - at[1] * self.unit]
    }
}
