//! Linked lists of ids, one per table index: for example the elements of each cell, or the nodes at each
//! lattice point.
//!
//! A list is stored as its first id and, for each id, the id after it. So lists need no allocation of their
//! own, and the list of an index is found without a search.

use crate::foundation::hash::hash_state;
use crate::foundation::ids::Id;
use std::marker::PhantomData;

const END: u32 = u32::MAX;

/// One list of ids per index; every id is in at most one list.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct IdLists<I> {
    /// First id of each list; `END` for an empty list.
    first: Vec<u32>,
    /// For each id, the id after it in its list; `END` for the last one.
    next: Vec<u32>,
    ids: PhantomData<I>,
}

hash_state! { [I] struct IdLists<I> { first, next } skip { ids } }

impl<I: Id> IdLists<I> {
    /// Creates `places` empty lists, for the indices below `places`.
    pub fn new(places: usize) -> Self {
        Self {
            first: vec![END; places],
            next: Vec::new(),
            ids: PhantomData,
        }
    }

    /// Returns the ids of a list, in the order of insertion.
    #[inline]
    pub fn at(&self, place: usize) -> impl Iterator<Item = I> + '_ {
        let mut id = self.first[place];
        std::iter::from_fn(move || {
            let found = (id != END).then_some(id)?;
            id = self.next[found as usize];
            Some(I::of(found as usize))
        })
    }

    /// Appends an id to a list; the id must not be in any list.
    pub fn append(&mut self, place: usize, id: I) {
        let end = self.next.len().max(id.index() + 1);
        self.next.resize(end, END);
        self.next[id.index()] = END;
        *self.link(place, END) = id.index() as u32;
    }

    /// Removes an id from a list.
    ///
    /// # Panics
    /// If the id is not in the list.
    pub fn remove(&mut self, place: usize, id: I) {
        let after = self.next[id.index()];
        *self.link(place, id.index() as u32) = after;
    }

    /// Returns whether lists read from a file are valid: there are `places` lists, every id is below `ids`,
    /// and no id occurs twice. Lists without repeated ids cannot be cyclic, so iteration ends.
    #[cfg(feature = "serde")]
    pub fn is_valid(&self, places: usize, ids: usize) -> bool {
        let mut seen = vec![false; ids.min(self.next.len())];
        let mut ends = |&first: &u32| {
            let mut id = first;
            while id != END {
                match seen.get_mut(id as usize) {
                    Some(seen) if !*seen => *seen = true,
                    _ => return false,
                }
                id = self.next[id as usize];
            }
            true
        };
        self.first.len() == places && self.first.iter().all(&mut ends)
    }

    /// Returns the entry of `first` or `next` that equals `id`, in the list at index `place`.
    fn link(&mut self, place: usize, id: u32) -> &mut u32 {
        let (mut before, mut here) = (END, self.first[place]);
        while here != id {
            (before, here) = (here, self.next[here as usize]);
        }
        if before == END {
            &mut self.first[place]
        } else {
            &mut self.next[before as usize]
        }
    }
}

/// Returns ids below `bound` in ascending order, without duplicates. Uses a bit set over all ids, and scans
/// only the range between the lowest and the highest id. After a release this is faster than sorting, because
/// most ids occur several times and lie close together.
pub fn ascending<I: Id>(ids: impl Iterator<Item = I>, bound: usize) -> Vec<I> {
    let mut words = vec![0u64; bound.div_ceil(64)];
    let (mut first, mut end, mut count) = (words.len(), 0, 0);
    for id in ids {
        let (place, bit) = (id.index() / 64, 1 << (id.index() % 64));
        count += usize::from(words[place] & bit == 0);
        words[place] |= bit;
        (first, end) = (first.min(place), end.max(place + 1));
    }
    let mut found = Vec::with_capacity(count);
    for place in first..end {
        let mut left = words[place];
        while left != 0 {
            found.push(I::of(64 * place + left.trailing_zeros() as usize));
            left &= left - 1;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::ids::NodeId;

    #[test]
    #[cfg(feature = "serde")]
    fn is_valid_detects_endless_list() {
        let mut chains = IdLists::new(2);
        for id in 0..3 {
            chains.append(1, NodeId(id));
        }
        assert!(chains.is_valid(2, 3) && !chains.is_valid(3, 3) && !chains.is_valid(2, 2));
        chains.next[2] = 0;
        assert!(!chains.is_valid(2, 3));
        chains.next[2] = 7;
        assert!(!chains.is_valid(2, 3));
    }

    #[test]
    fn lists_preserve_order_after_remove_and_append() {
        let mut chains = IdLists::new(2);
        for id in [4, 0, 2].map(NodeId) {
            chains.append(1, id);
        }
        chains.append(0, NodeId(1));
        chains.remove(1, NodeId(0));
        assert_eq!(chains.at(1).collect::<Vec<_>>(), [4, 2].map(NodeId));
        chains.append(0, NodeId(0));
        chains.remove(1, NodeId(4));
        assert_eq!(chains.at(0).collect::<Vec<_>>(), [1, 0].map(NodeId));
        assert_eq!(chains.at(1).collect::<Vec<_>>(), [NodeId(2)]);
    }

    #[test]
    fn ascending_sorts_and_removes_duplicates() {
        let ids = [129, 3, 63, 64, 3, 0, 129, 128].map(NodeId);
        let expected = [0, 3, 63, 64, 128, 129].map(NodeId);
        assert_eq!(ascending(ids.into_iter(), 130), expected);
        assert!(ascending::<NodeId>([].into_iter(), 0).is_empty());
    }
}
