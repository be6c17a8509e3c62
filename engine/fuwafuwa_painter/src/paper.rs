//! Coordinates on the paper of a picture.

use fuwafuwa::DimVector;

/// Point on the paper [px]; x points to the right, y down.
pub type PaperPoint = [f32; 2];

/// Map from world coordinates, with y upwards, to paper coordinates, with y downwards.
#[derive(Copy, Clone, Debug)]
pub struct PaperTransform {
    /// Paper coordinates of the world's origin.
    pub origin: PaperPoint,
    /// Pixels per world unit.
    pub unit: f32,
}

impl PaperTransform {
    /// Converts a point of the world to paper coordinates; a third coordinate is ignored.
    pub fn spot(self, at: impl DimVector) -> PaperPoint {
        let [x, y] = self.origin;
        [x + at[0] * self.unit, y - at[1] * self.unit]
    }
}
