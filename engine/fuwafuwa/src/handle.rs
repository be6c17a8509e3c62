//! Things that come and go: each keeps its slot while others leave, and its handle is of no use once it has left.

use crate::ids::{Id, Table, id};
use std::fmt;

/// What a thing in an [`Arena`] is known by: a slot, and how many stood there before.
pub trait Handle: Copy + Ord + fmt::Debug + sealed::Sealed {
    /// What it is a handle of.
    const KIND: &'static str;

    #[doc(hidden)]
    type Slot: Id;

    #[doc(hidden)]
    fn new(slot: Self::Slot, generation: u32) -> Self;

    #[doc(hidden)]
    fn parts(self) -> (Self::Slot, u32);
}

mod sealed {
    /// Only worlds give out handles.
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
            /// Where it stands or stood among the others.
            #[allow(dead_code)] // no list names joints or knives by their slots
            pub(crate) fn slot(self) -> $slot {
                self.slot
            }
        }

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
    /// Where a body stands in a world; given out again once it has left.
    #[doc(hidden)]
    pub BodySlot
}
id! {
    /// Where something rigid stands in a world; given out again once it has left.
    #[doc(hidden)]
    pub RigidSlot
}

id! {
    /// Where a joint stands in a world; given out again once it has left.
    #[doc(hidden)]
    pub JointSlot
}

id! {
    /// Where a knife stands in a world; given out again once it has left.
    #[doc(hidden)]
    pub KnifeSlot
}

impl BodySlot {
    /// That of a body in no world.
    pub(crate) const NONE: Self = Self(u32::MAX);
}

handle! {
    /// What a body in a world is known by, whoever comes or goes beside it.
    BodyId, "body", BodySlot
}
handle! {
    /// What something rigid in a world is known by, whoever comes or goes beside it.
    RigidId, "rigid thing", RigidSlot
}

handle! {
    /// What a joint in a world is known by, whoever comes or goes beside it.
    JointId, "joint", JointSlot
}

handle! {
    /// What a knife in a world is known by, whoever comes or goes beside it.
    KnifeId, "knife", KnifeSlot
}

/// A handle was used of something that is not there: it was taken out, or never was in this world. A handle of another
/// world is not always noticed: it may be good for something here too.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Gone {
    /// What it was the handle of.
    pub kind: &'static str,
    /// In which slot it stood.
    pub slot: u32,
}

impl fmt::Display for Gone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, slot } = self;
        write!(
            f,
            "there is no such {kind} in this world: who had slot {slot} was taken out"
        )
    }
}

impl std::error::Error for Gone {}

/// Things that come and go, by their handles and in the order of their slots.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound = "T: serde::Serialize + for<'a> serde::Deserialize<'a>")
)]
pub struct Arena<K: Handle, T> {
    slots: Table<K::Slot, Slot<T>>,
}

/// How many have left it, and who is there.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Slot<T> {
    generation: u32,
    thing: Option<T>,
}

impl<K: Handle, T> Default for Arena<K, T> {
    fn default() -> Self {
        let slots = Table::default();
        Self { slots }
    }
}

impl<K: Handle, T> Arena<K, T> {
    /// Who has a handle.
    ///
    /// # Errors
    /// [`Gone`] when nobody has it any more.
    pub fn get(&self, id: K) -> Result<&T, Gone> {
        let (own, generation) = id.parts();
        let slot = self.slots.get(own.index());
        let slot = slot.filter(|slot| slot.generation == generation);
        slot.and_then(|slot| slot.thing.as_ref())
            .ok_or(gone::<K>(own))
    }

    /// As [`Arena::get`], to be changed.
    pub(crate) fn get_mut(&mut self, id: K) -> Result<&mut T, Gone> {
        let (own, generation) = id.parts();
        let slot = self.slots.get_mut(own.index());
        let slot = slot.filter(|slot| slot.generation == generation);
        slot.and_then(|slot| slot.thing.as_mut())
            .ok_or(gone::<K>(own))
    }

    /// All of them, in the order of their slots.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &T> + Clone {
        self.slots.iter().filter_map(|slot| slot.thing.as_ref())
    }

    /// All of them with their handles, in the order of their slots.
    pub fn entries(&self) -> impl DoubleEndedIterator<Item = (K, &T)> + Clone {
        self.by_slot().map(|(slot, thing)| (self.id(slot), thing))
    }

    /// Their handles, in the order of their slots.
    pub fn ids(&self) -> impl Iterator<Item = K> {
        self.by_slot().map(|(slot, _)| self.id(slot))
    }

    /// The first of them.
    pub fn first(&self) -> Option<&T> {
        self.iter().next()
    }

    /// How many of them stand before one; nothing when it is gone.
    pub fn rank(&self, id: K) -> Option<usize> {
        self.ids().position(|other| other == id)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.iter().count()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.first().is_none()
    }

    /// Puts one into the first free slot.
    pub(crate) fn insert(&mut self, thing: T) -> K {
        let free = self.slots.iter().position(|slot| slot.thing.is_none());
        let own = free.map_or(self.slots.next_id(), K::Slot::of);
        if free.is_none() {
            self.slots.push(Slot {
                generation: 0,
                thing: None,
            });
        }
        self.slots[own].thing = Some(thing);
        self.id(own)
    }

    /// Takes one out; the others stay where they are.
    pub(crate) fn remove(&mut self, id: K) -> Result<T, Gone> {
        let (own, _) = id.parts();
        self.get(id)?;
        let slot = &mut self.slots[own];
        slot.generation = slot.generation.wrapping_add(1);
        slot.thing.take().ok_or(gone::<K>(own))
    }

    /// How many slots there are, free or not.
    pub(crate) fn slot_count(&self) -> usize {
        self.slots.len()
    }

    /// Who is in each slot, if anybody.
    pub(crate) fn slots(&self) -> impl Iterator<Item = Option<&T>> {
        self.slots.iter().map(|slot| slot.thing.as_ref())
    }

    /// All of them with their slots.
    pub(crate) fn by_slot(&self) -> impl DoubleEndedIterator<Item = (K::Slot, &T)> + Clone {
        let slots = self.slots.entries();
        slots.filter_map(|(own, slot)| Some((own, slot.thing.as_ref()?)))
    }

    /// As [`Arena::by_slot`], to be changed.
    pub(crate) fn by_slot_mut(&mut self) -> impl Iterator<Item = (K::Slot, &mut T)> {
        let slots = self.slots.entries_mut();
        slots.filter_map(|(own, slot)| Some((own, slot.thing.as_mut()?)))
    }

    /// As [`Arena::entries`], to be changed.
    pub(crate) fn entries_mut(&mut self) -> impl Iterator<Item = (K, &mut T)> {
        let slots = self.slots.entries_mut();
        slots.filter_map(|(own, slot)| {
            let id = K::new(own, slot.generation);
            Some((id, slot.thing.as_mut()?))
        })
    }

    /// As [`Arena::iter`], to be changed.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.slots.iter_mut().filter_map(|slot| slot.thing.as_mut())
    }

    /// Who is in a slot, if anybody.
    pub(crate) fn find(&self, slot: K::Slot) -> Option<&T> {
        self.slots.get(slot.index())?.thing.as_ref()
    }

    /// Who is in a slot that is known not to be free.
    #[inline(always)]
    pub(crate) fn at(&self, slot: K::Slot) -> &T {
        let thing = self.slots[slot].thing.as_ref();
        thing.expect("lists of the world name slots that are not free")
    }

    /// As [`Arena::at`], to be changed.
    #[inline(always)]
    pub(crate) fn at_mut(&mut self, slot: K::Slot) -> &mut T {
        let thing = self.slots[slot].thing.as_mut();
        thing.expect("lists of the world name slots that are not free")
    }

    /// The handle of who is in a slot.
    pub(crate) fn id(&self, slot: K::Slot) -> K {
        K::new(slot, self.slots[slot].generation)
    }
}

fn gone<K: Handle>(slot: K::Slot) -> Gone {
    Gone {
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

    /// Who has a handle.
    ///
    /// # Panics
    /// When nobody has it any more; [`Arena::get`] tells.
    fn index(&self, id: K) -> &T {
        self.get(id).unwrap_or_else(|gone| panic!("{gone}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_leaves_moves_nobody_and_is_not_mistaken_for_who_comes_next() {
        let mut names = Arena::<BodyId, &str>::default();
        let [ball, ring, heart] = ["ball", "ring", "heart"].map(|name| names.insert(name));
        assert_eq!(names.remove(ring), Ok("ring"));
        assert_eq!(names[heart], "heart");
        let cube = names.insert("cube");
        assert_eq!(
            names.iter().copied().collect::<Vec<_>>(),
            ["ball", "cube", "heart"]
        );
        assert_ne!(cube, ring);
        let gone = names.get(ring).unwrap_err();
        assert_eq!(
            gone.to_string(),
            "there is no such body in this world: who had slot 1 was taken out"
        );
        assert_eq!(names.remove(ring), Err(gone));
        let all: Vec<BodyId> = names.entries().map(|(id, _)| id).collect();
        assert_eq!(all, [ball, cube, heart]);
    }
}
