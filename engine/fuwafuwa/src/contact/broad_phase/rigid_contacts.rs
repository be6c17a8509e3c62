//! Contact points between two rigid bodies, at least one of which is dynamic. A point is recognised in the
//! next substep by the key of the touching corner or edge crossing.

use super::known_impulse::Impulse;
use crate::foundation::arena::RigidSlot;
#[cfg(feature = "serde")]
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
#[cfg(feature = "serde")]
use crate::rigid_body::RigidBodies;
use glam::Vec3;

/// Contact point between two rigid bodies.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigidContactPoint {
    /// Slots of the dynamic body and of the body that it touches.
    pub both: [RigidSlot; 2],
    /// Key of the touching corner or edge crossing: identifies the point in the next substep.
    pub key: u32,
    /// Impulses of the point.
    pub impulse: Impulse,
}

hash_state! { struct RigidContactPoint { both, key, impulse } }

/// Contact point that had a normal impulse in one substep, kept for the events of the tick.
#[derive(Copy, Clone, Debug)]
pub struct PressedContact {
    /// Slots of the dynamic body and of the body that it touches.
    pub both: [RigidSlot; 2],
    /// Normal impulse [N s].
    pub impulse: f32,
    /// Normal and friction impulse on the first body, without the part that only resolved overlaps [N s].
    pub sum: Vec3,
    /// Approach speed [m/s].
    pub speed: f32,
    /// Position [m].
    pub at: Vec3,
    /// Unit normal from the second body to the first.
    pub normal: Vec3,
}

/// All contact points between rigid bodies.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigidContactPoints {
    /// Points, ascending by bodies and key.
    pub list: Vec<RigidContactPoint>,
    /// Contact points with a normal impulse in the past substeps of this tick, for its contact events.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub pressed: Vec<PressedContact>,
}

hash_state! { struct RigidContactPoints { list } skip { pressed } }

impl RigidContactPoint {
    fn order(&self) -> ([RigidSlot; 2], u32) {
        (self.both, self.key)
    }
}

impl RigidContactPoints {
    /// Starts a tick: clears the contacts of the last tick.
    pub fn start_tick(&mut self) {
        self.pressed.clear();
    }

    /// Returns the impulses of a contact point in the last substep; 0 if the point is new.
    pub fn known(&self, both: [RigidSlot; 2], key: u32) -> Impulse {
        let found = self
            .list
            .binary_search_by_key(&(both, key), RigidContactPoint::order);
        found.map_or_else(|_| Impulse::default(), |place| self.list[place].impulse)
    }

    /// Replaces the points by those of this substep.
    pub fn renew(&mut self, touches: impl Iterator<Item = RigidContactPoint>) {
        self.list.clear();
        self.list.extend(touches);
        self.list.sort_by_key(RigidContactPoint::order);
    }

    /// Removes all contact points of a rigid body.
    pub fn remove(&mut self, slot: RigidSlot) {
        self.list.retain(|touch| !touch.both.contains(&slot));
        self.pressed.retain(|pressed| !pressed.both.contains(&slot));
    }

    /// Discards contact points of bodies that do not exist. Sorts the remaining points and removes
    /// duplicates.
    #[cfg(feature = "serde")]
    pub fn keep_known<D: Dim>(&mut self, rigids: &RigidBodies) {
        let is_known =
            |touch: &RigidContactPoint| touch.both.iter().all(|&slot| rigids.find(slot).is_some());
        self.list.retain(is_known);
        self.list.sort_by_key(RigidContactPoint::order);
        self.list.dedup_by_key(|touch| touch.order());
        self.list
            .iter_mut()
            .for_each(|touch| touch.impulse.flatten::<D>());
    }
}
