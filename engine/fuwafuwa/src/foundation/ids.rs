//! Typed ids of the nodes, elements and pieces of a body.
//!
//! An id is an index into tables, and does not identify the body. Ids of nodes and elements are reused after
//! their node or element is removed; ids of pieces are never reused.

use crate::foundation::hash::{HashState, hash_state};
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut, Index, IndexMut};

/// Typed id: an index into tables, with a type for each kind of object.
pub trait Id: Copy {
    /// Creates the id for an index of a table.
    fn of(index: usize) -> Self;

    /// Index in a table.
    fn index(self) -> usize;
}

macro_rules! id {
    ($(#[$what:meta])* $vis:vis $name:ident) => {
        $(#[$what])*
        #[derive(Copy, Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(transparent))]
        $vis struct $name(pub u32);

        impl $name {
            /// Index in a table.
            #[inline(always)]
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl $crate::foundation::ids::Id for $name {
            #[inline(always)]
            fn of(index: usize) -> Self {
                Self(index as u32)
            }

            #[inline(always)]
            fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl $crate::foundation::hash::HashState for $name {
            #[inline(always)]
            fn hash_state(&self, hash: &mut $crate::foundation::hash::Hash) {
                let Self(index) = self;
                index.hash_state(hash);
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

pub(crate) use id;

id! {
    /// Id of a node of a soft body.
    pub NodeId
}
id! {
    /// Id of an element of a soft body.
    pub ElementId
}
id! {
    /// Id of a piece of a soft body.
    pub PieceId
}

/// Vector indexed by ids of one kind.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct IndexVec<I, T> {
    list: Vec<T>,
    #[cfg_attr(feature = "serde", serde(skip))]
    ids: PhantomData<I>,
}

hash_state! { [I, T: HashState] struct IndexVec<I, T> { list } skip { ids } }

impl<I: Id, T> IndexVec<I, T> {
    /// Returns all entries with their ids, ascending.
    pub fn entries(&self) -> impl DoubleEndedIterator<Item = (I, &T)> + Clone {
        let entries = self.list.iter().enumerate();
        entries.map(|(index, entry)| (I::of(index), entry))
    }

    /// Returns all entries mutably, with their ids, ascending.
    pub(crate) fn entries_mut(&mut self) -> impl Iterator<Item = (I, &mut T)> {
        let entries = self.list.iter_mut().enumerate();
        entries.map(|(index, entry)| (I::of(index), entry))
    }

    /// Returns the ids of all entries, ascending.
    pub fn ids(&self) -> impl Iterator<Item = I> + use<I, T> {
        (0..self.list.len()).map(I::of)
    }

    /// Returns the id of the next entry to be pushed.
    pub fn next_id(&self) -> I {
        I::of(self.list.len())
    }
}

impl<I, T> From<Vec<T>> for IndexVec<I, T> {
    fn from(list: Vec<T>) -> Self {
        Self {
            list,
            ids: PhantomData,
        }
    }
}

impl<I, T> FromIterator<T> for IndexVec<I, T> {
    fn from_iter<A: IntoIterator<Item = T>>(all: A) -> Self {
        Vec::from_iter(all).into()
    }
}

impl<I, T> Default for IndexVec<I, T> {
    fn default() -> Self {
        Self::from(Vec::new())
    }
}

impl<I: Id, T> Index<I> for IndexVec<I, T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, id: I) -> &T {
        &self.list[id.index()]
    }
}

impl<I: Id, T> IndexMut<I> for IndexVec<I, T> {
    #[inline(always)]
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.list[id.index()]
    }
}

impl<'a, I, T> IntoIterator for &'a IndexVec<I, T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.iter()
    }
}

impl<'a, I, T> IntoIterator for &'a mut IndexVec<I, T> {
    type Item = &'a mut T;
    type IntoIter = std::slice::IterMut<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.iter_mut()
    }
}

impl<I, T> Deref for IndexVec<I, T> {
    type Target = Vec<T>;

    #[inline(always)]
    fn deref(&self) -> &Vec<T> {
        &self.list
    }
}

impl<I, T> DerefMut for IndexVec<I, T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.list
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn index_vec_is_indexed_by_ids() {
        let mut table: IndexVec<NodeId, char> = vec!['a', 'b'].into();
        assert_eq!(table.next_id(), NodeId(2));
        table.push('c');
        table[NodeId(0)] = 'd';
        let entries: Vec<_> = table.entries().map(|(id, &entry)| (id.0, entry)).collect();
        assert_eq!(entries, [(0, 'd'), (1, 'b'), (2, 'c')]);
        assert_eq!(
            table.ids().map(|id| id.to_string()).collect::<Vec<_>>(),
            ["0", "1", "2"]
        );
    }
}
