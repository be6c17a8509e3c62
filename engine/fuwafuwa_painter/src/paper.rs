//! Places on the paper.

/// A place on the paper [px], y downwards.
pub type Spot = [f32; 2];

/// Where places of the plane, y upwards, fall on the paper.
#[derive(Copy, Clone, Debug)]
pub struct Frame {
    /// Where the origin falls.
    pub origin: Spot,
    /// Pixels a unit.
    pub unit: f32,
}

impl Frame {
    /// The spot of a place; its third coordinate does not count.
    pub fn spot(self, at: [f32; 3]) -> Spot {
        let [x, y] = self.origin;
        [x + at[0] * self.unit, y - at[1] * self.unit]
    }
}
