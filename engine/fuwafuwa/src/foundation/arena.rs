//! Generational arenas and their handles. An item keeps its slot while other items are removed, and a handle
//! to a removed item is detected as stale.

use crate::error::Error;
use crate::foundation::hash::{HashState, hash_state};
use crate::foundation::ids::{Id, IndexVec, id};
use std::collections::BTreeSet;
use std::fmt;

/// Generational handle into an [`Arena`]: the index of a slot, and its generation, the number of items that
/// were removed from the slot before.
pub trait Handle: Copy + Ord + fmt::Debug + sealed::Sealed {
    /// Name of the item type, for error texts.
    const KIND: &'static str;

    #[doc(hidden)]
    type Slot: Id;

    #[doc(hidden)]
    fn new(slot: Self::Slot, generation: u32) -> Self;

    #[doc(hidden)]
    fn parts(self) -> (Self::Slot, u32);
}

mod sealed {
    /// Supertrait that prevents other modules from implementing [`Handle`](super::Handle).
    pub trait Sealed {}
}

macro_rules! handle {
    ($(#[$doc:meta])* $name:ident, $kind:literal, $slot:ident) => {
        $(#[$doc])*
        #[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        pub struct $name {
            slot: $slot,
            generation: u32,
        }

        impl $name {
            /// Index of the slot in the arena.
            #[allow(dead_code)] // unused for joints, knives and grips
            pub(crate) fn slot(self) -> $slot {
                self.slot
            }
        }

        hash_state! { struct $name { slot, generation } }

        impl sealed::Sealed for $name {}

        impl Handle for $name {
            const KIND: &'static str = $kind;
            type Slot = $slot;

            fn new(slot: $slot, generation: u32) -> Self {
                Self { slot, generation }
            }

            fn parts(self) -> ($slot, u32) {
                (self.slot, self.generation)
            }
        }
    };
}

id! {
    /// Slot of a soft body in a world; reused after the soft body is removed.
    #[doc(hidden)]
    pub BodySlot
}
id! {
    /// Slot of a rigid body in a world; reused after the rigid body is removed.
    #[doc(hidden)]
    pub RigidSlot
}

id! {
    /// Slot of a joint in a world; reused after the joint is removed.
    #[doc(hidden)]
    pub JointSlot
}

id! {
    /// Slot of a knife in a world; reused after the knife is removed.
    #[doc(hidden)]
    pub KnifeSlot
}

id! {
    /// Slot of a grip in a world; reused after the grip is removed.
    #[doc(hidden)]
    pub GripSlot
}

impl BodySlot {
    /// Slot of a body that is in no world.
    pub(crate) const NONE: Self = Self(u32::MAX);
}

handle! {
    /// Handle of a soft body in a [`World`](crate::World). Adding or removing other bodies does not change
    /// it.
    SoftBodyHandle, "soft body", BodySlot
}
handle! {
    /// Handle of a rigid body in a [`World`](crate::World). Adding or removing other rigid bodies does not
    /// change it.
    RigidBodyHandle, "rigid body", RigidSlot
}

handle! {
    /// Handle of a joint in a [`World`](crate::World). Adding or removing other joints does not change it.
    JointHandle, "joint", JointSlot
}

handle! {
    /// Handle of a knife in a [`World`](crate::World). Adding or removing other knives does not change it.
    KnifeHandle, "knife", KnifeSlot
}

handle! {
    /// Handle of a grip in a [`World`](crate::World). Adding or removing other grips does not change it.
    GripHandle, "grip", GripSlot
}

/// Generational arena: items by handle, iterated in the order of their slots.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        from = "StoredArena<K, T>",
        bound = "T: serde::Serialize + for<'a> serde::Deserialize<'a>"
    )
)]
pub struct Arena<K: Handle, T> {
    slots: IndexVec<K::Slot, Slot<T>>,
    /// Number of mutable accesses, see [`Arena::revision`].
    #[cfg_attr(feature = "serde", serde(skip))]
    revision: u64,
    /// Indices of the free slots. Not stored in files: loading recomputes them from `slots`, so that a loaded
    /// arena assigns the same slots as the original.
    #[cfg_attr(feature = "serde", serde(skip))]
    free: BTreeSet<usize>,
}

/// Form of an [`Arena`] in files.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(bound = "T: for<'b> serde::Deserialize<'b>")]
struct StoredArena<K: Handle, T> {
    slots: IndexVec<K::Slot, Slot<T>>,
}

#[cfg(feature = "serde")]
impl<K: Handle, T> From<StoredArena<K, T>> for Arena<K, T> {
    fn from(StoredArena { slots }: StoredArena<K, T>) -> Self {
        let free = slots.iter().enumerate();
        let free = free.filter(|(_, slot)| slot.item.is_none());
        let free = free.map(|(index, _)| index).collect();
        Self {
            slots,
            revision: 0,
            free,
        }
    }
}

/// Slot of an [`Arena`]: its present item, and its generation, which is the number of items removed from the
/// slot so far.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Slot<T> {
    generation: u32,
    item: Option<T>,
}

hash_state! { [K: Handle, T: HashState] struct Arena<K, T> { slots } skip { revision, free } }
hash_state! { [T: HashState] struct Slot<T> { generation, item } }

impl<K: Handle, T> Default for Arena<K, T> {
    fn default() -> Self {
        Self {
            slots: IndexVec::default(),
            revision: 0,
            free: BTreeSet::new(),
        }
    }
}

impl<K: Handle, T> Arena<K, T> {
    /// Returns the item of a handle.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn get(&self, id: K) -> Result<&T, Error> {
        let (own, generation) = id.parts();
        let slot = self.slots.get(own.index());
        let slot = slot.filter(|slot| slot.generation == generation);
        slot.and_then(|slot| slot.item.as_ref())
            .ok_or_else(|| stale::<K>(own))
    }

    /// Returns the item of a handle, mutably; see [`Arena::get`].
    pub(crate) fn get_mut(&mut self, id: K) -> Result<&mut T, Error> {
        let (own, generation) = id.parts();
        let slot = self.slots.get_mut(own.index());
        let slot = slot.filter(|slot| slot.generation == generation);
        let item = slot.and_then(|slot| slot.item.as_mut());
        let item = item.ok_or_else(|| stale::<K>(own))?;
        self.revision += 1;
        Ok(item)
    }

    /// Iterates over the items in the order of their slots.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &T> + Clone {
        self.slots.iter().filter_map(|slot| slot.item.as_ref())
    }

    /// Iterates over handles and items in the order of their slots.
    pub fn entries(&self) -> impl DoubleEndedIterator<Item = (K, &T)> + Clone {
        self.by_slot().map(|(slot, item)| (self.id(slot), item))
    }

    /// Iterates over the handles in the order of their slots.
    pub fn ids(&self) -> impl Iterator<Item = K> {
        self.by_slot().map(|(slot, _)| self.id(slot))
    }

    /// Returns the item in the lowest occupied slot.
    pub fn first(&self) -> Option<&T> {
        self.iter().next()
    }

    /// Returns the number of items in slots below that of the handle `id`, or `None` if the handle is stale.
    pub fn rank(&self, id: K) -> Option<usize> {
        self.ids().position(|other| other == id)
    }

    /// Returns the number of items.
    pub fn len(&self) -> usize {
        self.iter().count()
    }

    /// Returns whether the arena has no items.
    pub fn is_empty(&self) -> bool {
        self.first().is_none()
    }

    /// Inserts an item into the lowest free slot.
    pub(crate) fn insert(&mut self, item: T) -> K {
        self.revision += 1;
        let item = Some(item);
        let own = match self.free.pop_first() {
            Some(index) => {
                let own = K::Slot::of(index);
                self.slots[own].item = item;
                own
            }
            None => {
                let own = self.slots.next_id();
                let generation = 0;
                self.slots.push(Slot { generation, item });
                own
            }
        };
        self.id(own)
    }

    /// Removes an item; all other items keep their slots.
    pub(crate) fn remove(&mut self, id: K) -> Result<T, Error> {
        let (own, _) = id.parts();
        self.get(id)?;
        self.revision += 1;
        let slot = &mut self.slots[own];
        slot.generation = slot.generation.wrapping_add(1);
        self.free.insert(own.index());
        slot.item.take().ok_or_else(|| stale::<K>(own))
    }

    /// Returns a number that increases with each mutable access to the arena or to an item. If two calls
    /// return the same number, no item has changed in between.
    pub(crate) fn revision(&self) -> u64 {
        self.revision
    }

    /// Returns the number of slots, free ones included.
    pub(crate) fn slot_count(&self) -> usize {
        self.slots.len()
    }

    /// Iterates over all slots; free ones give `None`.
    pub(crate) fn slots(&self) -> impl Iterator<Item = Option<&T>> {
        self.slots.iter().map(|slot| slot.item.as_ref())
    }

    /// Iterates over occupied slots and their items.
    pub(crate) fn by_slot(&self) -> impl DoubleEndedIterator<Item = (K::Slot, &T)> + Clone {
        let slots = self.slots.entries();
        slots.filter_map(|(own, slot)| Some((own, slot.item.as_ref()?)))
    }

    /// Iterates over occupied slots and their items, mutably.
    pub(crate) fn by_slot_mut(&mut self) -> impl Iterator<Item = (K::Slot, &mut T)> {
        self.revision += 1;
        let slots = self.slots.entries_mut();
        slots.filter_map(|(own, slot)| Some((own, slot.item.as_mut()?)))
    }

    /// Iterates over handles and items, mutably.
    pub(crate) fn entries_mut(&mut self) -> impl Iterator<Item = (K, &mut T)> {
        self.revision += 1;
        let slots = self.slots.entries_mut();
        slots.filter_map(|(own, slot)| {
            let id = K::new(own, slot.generation);
            Some((id, slot.item.as_mut()?))
        })
    }

    /// Iterates over the items, mutably.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.revision += 1;
        self.slots.iter_mut().filter_map(|slot| slot.item.as_mut())
    }

    /// Returns the item in a slot, or `None` if the slot is free.
    pub(crate) fn find(&self, slot: K::Slot) -> Option<&T> {
        self.slots.get(slot.index())?.item.as_ref()
    }

    /// Returns the item in an occupied slot.
    #[inline(always)]
    pub(crate) fn at(&self, slot: K::Slot) -> &T {
        let item = self.slots[slot].item.as_ref();
        item.expect("internal slot lists contain occupied slots only")
    }

    /// Returns the item in an occupied slot, mutably.
    #[inline(always)]
    pub(crate) fn at_mut(&mut self, slot: K::Slot) -> &mut T {
        self.revision += 1;
        let item = self.slots[slot].item.as_mut();
        item.expect("internal slot lists contain occupied slots only")
    }

    /// Returns the handle of the item in a slot.
    pub(crate) fn id(&self, slot: K::Slot) -> K {
        K::new(slot, self.slots[slot].generation)
    }
}

#[cold]
fn stale<K: Handle>(slot: K::Slot) -> Error {
    Error::InvalidHandle {
        kind: K::KIND,
        slot: slot.index() as u32,
    }
}

impl<'a, K: Handle, T> IntoIterator for &'a Arena<K, T> {
    type Item = &'a T;
    type IntoIter = Box<dyn Iterator<Item = &'a T> + 'a>;

    fn into_iter(self) -> Self::IntoIter {
        Box::new(self.iter())
    }
}

impl<K: Handle, T> std::ops::Index<K> for Arena<K, T> {
    type Output = T;

    /// Returns the item of a handle.
    ///
    /// # Panics
    /// If the handle is stale. [`Arena::get`] returns an error instead.
    fn index(&self, id: K) -> &T {
        self.get(id).unwrap_or_else(|error| panic!("{error}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn removal_keeps_other_slots_and_makes_the_handle_stale() {
        let mut names = Arena::<SoftBodyHandle, &str>::default();
        let [ball, ring, heart] = ["ball", "ring", "heart"].map(|name| names.insert(name));
        assert_eq!(names.remove(ring), Ok("ring"));
        assert_eq!(names[heart], "heart");
        let cube = names.insert("cube");
        assert_eq!(
            names.iter().copied().collect::<Vec<_>>(),
            ["ball", "cube", "heart"]
        );
        assert_ne!(cube, ring);
        let error = names.get(ring).unwrap_err();
        assert_eq!(
            error.to_string(),
            "stale soft body handle: slot 1 was removed or reused, or belongs to another world"
        );
        assert_eq!(names.remove(ring), Err(error));
        let all: Vec<SoftBodyHandle> = names.entries().map(|(id, _)| id).collect();
        assert_eq!(all, [ball, cube, heart]);
    }

    /// Inserts and removes items at random, and compares the arena with a plain list in which insertion scans
    /// for the first free slot. `again` transforms the arena after each operation, for example by storing and
    /// loading it.
    fn check_slots(again: impl Fn(Arena<SoftBodyHandle, u32>) -> Arena<SoftBodyHandle, u32>) {
        let mut arena = Arena::<SoftBodyHandle, u32>::default();
        let mut model = Vec::<Option<u32>>::new();
        let mut seed = 1u32;
        for number in 0..2000 {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let (action, choice) = (seed >> 24 & 3, seed as usize >> 8 & 0xffff);
            // Alternates between phases of 250 operations in which the arena mostly grows or mostly shrinks.
            if (action == 0) == (number / 250 % 2 == 0) && !arena.is_empty() {
                let id = arena.ids().nth(choice % arena.len()).expect("an item");
                assert_eq!(arena.remove(id).ok(), model[id.slot().index()].take());
            } else {
                let free = model.iter().position(Option::is_none);
                let expected = free.unwrap_or(model.len());
                model.resize(model.len().max(expected + 1), None);
                model[expected] = Some(number);
                assert_eq!(arena.insert(number).slot().index(), expected);
            }
            arena = again(arena);
        }
        assert!(arena.slots().eq(model.iter().map(Option::as_ref)));
    }

    #[test]
    fn insert_uses_lowest_free_slot() {
        check_slots(|arena| arena);
    }

    #[test]
    #[cfg(feature = "serde")]
    fn insert_uses_same_slots_after_loading() {
        check_slots(|arena| {
            let bytes = postcard::to_stdvec(&arena).expect("storable");
            postcard::from_bytes(&bytes).expect("loadable")
        });
    }
}
