//! What passes between rigid things where one of both is free: kept from one substep to the next, by the corners and edges
//! that touch.

use super::impulse::Impulse;
#[cfg(feature = "serde")]
use crate::dim::Dim;
use crate::handle::RigidSlot;
#[cfg(feature = "serde")]
use crate::rigid::Rigids;
use crate::shape::Vector;

/// A point at which two rigid things touch.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigidTouch {
    /// The one that is free, and the other.
    pub both: [RigidSlot; 2],
    /// Which corner or edge it is.
    pub key: u32,
    /// What passed between them.
    pub impulse: Impulse,
}

/// What passed at a point in one substep.
#[derive(Copy, Clone, Debug)]
pub struct Passed {
    /// The one that is free, and the other.
    pub both: [RigidSlot; 2],
    /// Along the normal [N s].
    pub impulse: f32,
    /// How fast they approached each other [m/s].
    pub speed: f32,
    /// Where [m].
    pub at: Vector,
    /// Which way the first gets away from the other.
    pub normal: Vector,
}

/// All of those points, in ascending order.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigidTouches {
    /// By both, and by key.
    pub list: Vec<RigidTouch>,
    /// What passed in this tick.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub passed: Vec<Passed>,
}

impl RigidTouch {
    fn order(&self) -> ([RigidSlot; 2], u32) {
        (self.both, self.key)
    }
}

impl RigidTouches {
    /// What passed in the last tick is settled.
    pub fn start_tick(&mut self) {
        self.passed.clear();
    }

    /// What passed at a point so far.
    pub fn known(&self, both: [RigidSlot; 2], key: u32) -> Impulse {
        let found = self
            .list
            .binary_search_by_key(&(both, key), RigidTouch::order);
        found.map_or_else(|_| Impulse::default(), |place| self.list[place].impulse)
    }

    /// What passes in this substep takes the place of it.
    pub fn renew(&mut self, touches: impl Iterator<Item = RigidTouch>) {
        self.list.clear();
        self.list.extend(touches);
        self.list.sort_by_key(RigidTouch::order);
    }

    /// Something rigid was taken out.
    pub fn remove(&mut self, slot: RigidSlot) {
        self.list.retain(|touch| !touch.both.contains(&slot));
        self.passed.retain(|passed| !passed.both.contains(&slot));
    }

    /// Forgets what is of nothing that is there; leaves each point once, in order.
    #[cfg(feature = "serde")]
    pub fn keep_known<D: Dim>(&mut self, rigids: &Rigids) {
        let is_known =
            |touch: &RigidTouch| touch.both.iter().all(|&slot| rigids.find(slot).is_some());
        self.list.retain(is_known);
        self.list.sort_by_key(RigidTouch::order);
        self.list.dedup_by_key(|touch| touch.order());
        self.list
            .iter_mut()
            .for_each(|touch| touch.impulse.flatten::<D>());
    }
}
