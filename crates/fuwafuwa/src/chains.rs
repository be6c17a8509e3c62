//! Short lists of ids, one for each place of a table: which elements a cell has, which nodes a point.
//!
//! A place keeps the first id of its list and every id the next one, so that a list costs no
//! memory of its own and is found without a search.

use crate::ids::Id;
use std::marker::PhantomData;

const END: u32 = u32::MAX;

/// A list of ids for every place; an id is in one list at most.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Chains<I> {
    /// The first id of each place.
    first: Vec<u32>,
    /// The id after each id.
    next: Vec<u32>,
    ids: PhantomData<I>,
}

impl<I: Id> Chains<I> {
    /// Empty lists for `places` places.
    pub fn new(places: usize) -> Self {
        Self {
            first: vec![END; places],
            next: Vec::new(),
            ids: PhantomData,
        }
    }

    /// The ids of a place, in the order in which they came.
    #[inline]
    pub fn at(&self, place: usize) -> impl Iterator<Item = I> + '_ {
        let mut id = self.first[place];
        std::iter::from_fn(move || {
            let found = (id != END).then_some(id)?;
            id = self.next[found as usize];
            Some(I::of(found as usize))
        })
    }

    /// Puts an id, which is in no list, at the end of the list of a place.
    pub fn append(&mut self, place: usize, id: I) {
        let end = self.next.len().max(id.index() + 1);
        self.next.resize(end, END);
        self.next[id.index()] = END;
        *self.link(place, END) = id.index() as u32;
    }

    /// Takes an id out of the list of a place.
    ///
    /// # Panics
    /// If it is not there.
    pub fn remove(&mut self, place: usize, id: I) {
        let after = self.next[id.index()];
        *self.link(place, id.index() as u32) = after;
    }

    /// Whether chains that were read from a file have so many places, and ids below a number, each in one
    /// list at most: then every list ends.
    #[cfg(feature = "serde")]
    pub fn is_sound(&self, places: usize, ids: usize) -> bool {
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

    /// Where the list of a place names `id`.
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

/// Ids below a bound in ascending order, each once. What is touched by a release has most of its ids
/// several times, and close together: a bit for every id there could be is cheaper than sorting them, as long as only
/// those between the lowest and the highest are looked through.
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
    use crate::ids::NodeId;

    #[test]
    #[cfg(feature = "serde")]
    fn a_list_that_never_ends_is_seen() {
        let mut chains = Chains::new(2);
        for id in 0..3 {
            chains.append(1, NodeId(id));
        }
        assert!(chains.is_sound(2, 3) && !chains.is_sound(3, 3) && !chains.is_sound(2, 2));
        chains.next[2] = 0;
        assert!(!chains.is_sound(2, 3));
        chains.next[2] = 7;
        assert!(!chains.is_sound(2, 3));
    }

    #[test]
    fn ids_keep_their_order_and_come_back() {
        let mut chains = Chains::new(2);
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
    fn ids_ascend_and_come_once() {
        let ids = [129, 3, 63, 64, 3, 0, 129, 128].map(NodeId);
        let expected = [0, 3, 63, 64, 128, 129].map(NodeId);
        assert_eq!(ascending(ids.into_iter(), 130), expected);
        assert!(ascending::<NodeId>([].into_iter(), 0).is_empty());
    }
}
