//! Pool of reusable slots.

use std::ops::{Index, IndexMut};

/// Values in slots with stable indices. The slot released last is reused first.
#[derive(Clone, Debug)]
pub struct Pool<T> {
    /// All slots, in use or free.
    pub all: Vec<T>,
    free: Vec<u32>,
}

impl<T> Default for Pool<T> {
    fn default() -> Self {
        Self {
            all: Vec::new(),
            free: Vec::new(),
        }
    }
}

impl<T> Pool<T> {
    /// Stores a value and returns its slot.
    pub fn insert(&mut self, thing: T) -> u32 {
        match self.free.pop() {
            Some(place) => {
                self.all[place as usize] = thing;
                place
            }
            None => {
                self.all.push(thing);
                self.all.len() as u32 - 1
            }
        }
    }

    /// Releases a slot and stores `nothing` in it until the slot is reused.
    pub fn remove(&mut self, place: u32, nothing: T) {
        self.all[place as usize] = nothing;
        self.free.push(place);
    }
}

impl<T> Index<u32> for Pool<T> {
    type Output = T;

    fn index(&self, place: u32) -> &T {
        &self.all[place as usize]
    }
}

impl<T> IndexMut<u32> for Pool<T> {
    fn index_mut(&mut self, place: u32) -> &mut T {
        &mut self.all[place as usize]
    }
}
