//! Tables over the places of a box: what stands where, found in a few steps.

use crate::dim::Point;

const NONE: u32 = u32::MAX;

/// The places of a box in memory order.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Places {
    size: Point,
    first: usize,
}

impl Places {
    /// The places of a box of the given size, numbered from `first`.
    pub fn new(size: Point, first: usize) -> Self {
        Self { size, first }
    }

    /// The number of a place; `None` outside the box.
    #[inline]
    pub fn number(&self, at: Point) -> Option<usize> {
        let inside = (0..3).all(|axis| at[axis] >= 0 && at[axis] < self.size[axis]);
        inside
            .then(|| self.first + ((at[2] * self.size[1] + at[1]) * self.size[0] + at[0]) as usize)
    }

    /// One more than the last number.
    pub fn end(&self) -> usize {
        self.first
            + self
                .size
                .iter()
                .map(|&extent| extent as usize)
                .product::<usize>()
    }
}

/// A short list of ids for each place; an id is in one list at most.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Chains {
    /// By place.
    first: Vec<u32>,
    /// By id.
    next: Vec<u32>,
}

impl Chains {
    /// Empty lists.
    pub fn new(places: usize) -> Self {
        Self {
            first: vec![NONE; places],
            next: Vec::new(),
        }
    }

    /// Puts an id into the list of a place.
    pub fn insert(&mut self, place: usize, id: u32) {
        if self.next.len() <= id as usize {
            self.next.resize(id as usize + 1, NONE);
        }
        self.next[id as usize] = self.first[place];
        self.first[place] = id;
    }

    /// Takes an id out of the list of a place, if it is there.
    pub fn remove(&mut self, place: usize, id: u32) {
        let after = self.next[id as usize];
        if self.first[place] == id {
            self.first[place] = after;
            return;
        }
        let before = self
            .at(place)
            .find(|&before| self.next[before as usize] == id);
        if let Some(before) = before {
            self.next[before as usize] = after;
        }
    }

    /// The ids of a place.
    #[inline]
    pub fn at(&self, place: usize) -> impl Iterator<Item = u32> + '_ {
        let known = |id: u32| (id != NONE).then_some(id);
        std::iter::successors(known(self.first[place]), move |&id| {
            known(self.next[id as usize])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_hold_what_was_put_in_and_not_taken_out() {
        let mut chains = Chains::new(2);
        for (place, id) in [(0, 7), (1, 3), (0, 4), (0, 0)] {
            chains.insert(place, id);
        }
        chains.remove(0, 4);
        chains.remove(1, 3);
        chains.remove(1, 0);
        assert_eq!(chains.at(0).collect::<Vec<_>>(), [0, 7]);
        assert_eq!(chains.at(1).count(), 0);
    }
}
