//! Who touches whom: layers that things are in, and layers that they meet.

/// The layers that something is in, and those whose things it touches: bit by bit. Two touch when each is in a layer that the
/// other meets. Pieces of one body are of its layers, too.
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
    /// Those that it is in; the first alone unless it is said.
    pub memberships: u32,
    /// Those that it meets; all unless it is said.
    pub filters: u32,
}

impl Default for Layers {
    fn default() -> Self {
        Self {
            memberships: 1,
            filters: u32::MAX,
        }
    }
}

impl Layers {
    /// Whether things of both touch each other.
    #[inline(always)]
    pub fn meet(self, other: Self) -> bool {
        self.memberships & other.filters != 0 && other.memberships & self.filters != 0
    }
}
