//! Things that come and go: each keeps its place while others leave, and its handle is of no use once it has left.

use std::fmt;
use std::marker::PhantomData;

/// What a thing in an [`Arena`] is known by: a place, and how many stood there before.
pub trait Handle: Copy + Ord + fmt::Debug + sealed::Sealed {
    /// What it is a handle of.
    const KIND: &'static str;

    #[doc(hidden)]
    fn new(place: u32, generation: u32) -> Self;

    #[doc(hidden)]
    fn parts(self) -> (u32, u32);
}

mod sealed {
    /// Only worlds give out handles.
    pub trait Sealed {}
}

macro_rules! handle {
    ($(#[$doc:meta])* $name:ident, $kind:literal) => {
        $(#[$doc])*
        #[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        pub struct $name {
            place: u32,
            generation: u32,
        }

        impl $name {
            /// Where it stands or stood among the others.
            pub(crate) fn place(self) -> u32 {
                self.place
            }
        }

        impl sealed::Sealed for $name {}

        impl Handle for $name {
            const KIND: &'static str = $kind;

            fn new(place: u32, generation: u32) -> Self {
                Self { place, generation }
            }

            fn parts(self) -> (u32, u32) {
                (self.place, self.generation)
            }
        }
    };
}

handle! {
    /// What a body in a world is known by, whoever comes or goes beside it.
    BodyId, "body"
}
handle! {
    /// What something rigid in a world is known by, whoever comes or goes beside it.
    RigidId, "rigid thing"
}

/// A handle was used of something that is not there: it was taken out, or never was in this world. A handle of another
/// world is not always noticed: it may be good for something here too.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Gone {
    /// What it was the handle of.
    pub kind: &'static str,
    /// At which place it stood.
    pub place: u32,
}

impl fmt::Display for Gone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, place } = self;
        write!(
            f,
            "there is no such {kind} in this world: who had place {place} was taken out"
        )
    }
}

impl std::error::Error for Gone {}

/// Things that come and go, by their handles and in the order of their places.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound = "T: serde::Serialize + for<'a> serde::Deserialize<'a>")
)]
pub struct Arena<K, T> {
    slots: Vec<Slot<T>>,
    kind: PhantomData<K>,
}

/// A place: how many have left it, and who is there.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Slot<T> {
    generation: u32,
    thing: Option<T>,
}

impl<K, T> Default for Arena<K, T> {
    fn default() -> Self {
        Self {
            slots: Vec::new(),
            kind: PhantomData,
        }
    }
}

impl<K: Handle, T> Arena<K, T> {
    /// Who has a handle.
    ///
    /// # Errors
    /// [`Gone`] when nobody has it any more.
    pub fn get(&self, id: K) -> Result<&T, Gone> {
        let (place, generation) = id.parts();
        let slot = self.slots.get(place as usize);
        let slot = slot.filter(|slot| slot.generation == generation);
        slot.and_then(|slot| slot.thing.as_ref())
            .ok_or(gone::<K>(place))
    }

    /// As [`Arena::get`], to be changed.
    pub(crate) fn get_mut(&mut self, id: K) -> Result<&mut T, Gone> {
        let (place, generation) = id.parts();
        let slot = self.slots.get_mut(place as usize);
        let slot = slot.filter(|slot| slot.generation == generation);
        slot.and_then(|slot| slot.thing.as_mut())
            .ok_or(gone::<K>(place))
    }

    /// All of them, in the order of their places.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &T> + Clone {
        self.slots.iter().filter_map(|slot| slot.thing.as_ref())
    }

    /// All of them with their handles, in the order of their places.
    pub fn entries(&self) -> impl DoubleEndedIterator<Item = (K, &T)> + Clone {
        self.placed().map(|(place, thing)| (self.id(place), thing))
    }

    /// Their handles, in the order of their places.
    pub fn ids(&self) -> impl Iterator<Item = K> {
        self.placed().map(|(place, _)| self.id(place))
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

    /// Puts one into the first free place.
    pub(crate) fn insert(&mut self, thing: T) -> K {
        let free = self.slots.iter().position(|slot| slot.thing.is_none());
        let place = free.unwrap_or(self.slots.len());
        if free.is_none() {
            self.slots.push(Slot {
                generation: 0,
                thing: None,
            });
        }
        self.slots[place].thing = Some(thing);
        self.id(place as u32)
    }

    /// Takes one out; the others stay where they are.
    pub(crate) fn remove(&mut self, id: K) -> Result<T, Gone> {
        let (place, _) = id.parts();
        self.get(id)?;
        let slot = &mut self.slots[place as usize];
        slot.generation = slot.generation.wrapping_add(1);
        slot.thing.take().ok_or(gone::<K>(place))
    }

    /// How many places there are, free or not.
    pub(crate) fn place_count(&self) -> usize {
        self.slots.len()
    }

    /// Who is at each place, if anybody.
    pub(crate) fn places(&self) -> impl Iterator<Item = Option<&T>> {
        self.slots.iter().map(|slot| slot.thing.as_ref())
    }

    /// All of them with their places.
    pub(crate) fn placed(&self) -> impl DoubleEndedIterator<Item = (u32, &T)> + Clone {
        let slots = self.slots.iter().enumerate();
        slots.filter_map(|(place, slot)| Some((place as u32, slot.thing.as_ref()?)))
    }

    /// As [`Arena::placed`], to be changed.
    pub(crate) fn placed_mut(&mut self) -> impl Iterator<Item = (u32, &mut T)> {
        let slots = self.slots.iter_mut().enumerate();
        slots.filter_map(|(place, slot)| Some((place as u32, slot.thing.as_mut()?)))
    }

    /// As [`Arena::entries`], to be changed.
    pub(crate) fn entries_mut(&mut self) -> impl Iterator<Item = (K, &mut T)> {
        let slots = self.slots.iter_mut().zip(0..);
        slots.filter_map(|(slot, place)| {
            let id = K::new(place, slot.generation);
            Some((id, slot.thing.as_mut()?))
        })
    }

    /// As [`Arena::iter`], to be changed.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.slots.iter_mut().filter_map(|slot| slot.thing.as_mut())
    }

    /// Who is at a place, if anybody.
    pub(crate) fn find(&self, place: u32) -> Option<&T> {
        self.slots.get(place as usize)?.thing.as_ref()
    }

    /// Who is at a place that is known not to be free.
    #[inline(always)]
    pub(crate) fn at(&self, place: u32) -> &T {
        let thing = self.slots[place as usize].thing.as_ref();
        thing.expect("lists of the world name places that are not free")
    }

    /// As [`Arena::at`], to be changed.
    #[inline(always)]
    pub(crate) fn at_mut(&mut self, place: u32) -> &mut T {
        let thing = self.slots[place as usize].thing.as_mut();
        thing.expect("lists of the world name places that are not free")
    }

    /// The handle of who is at a place.
    pub(crate) fn id(&self, place: u32) -> K {
        K::new(place, self.slots[place as usize].generation)
    }
}

fn gone<K: Handle>(place: u32) -> Gone {
    let kind = K::KIND;
    Gone { kind, place }
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
            "there is no such body in this world: who had place 1 was taken out"
        );
        assert_eq!(names.remove(ring), Err(gone));
        let all: Vec<BodyId> = names.entries().map(|(id, _)| id).collect();
        assert_eq!(all, [ball, cube, heart]);
    }
}
