//! Hashes and checksums, and the hash of the simulation state.

use crate::math::row::Row;
use glam::{DVec3, Vec2, Vec3};
use std::collections::BTreeMap;

/// Incremental hash [FNV-1a] of bytes or of 64-bit words. FNV-1a is defined for bytes; words are faster and
/// equally sensitive to changes.
#[derive(Copy, Clone, Debug)]
pub struct Hash(u64);

impl Hash {
    /// Hash of no data.
    pub const NONE: Self = Self(0xcbf2_9ce4_8422_2325);

    /// Hash of bytes.
    pub const fn of(bytes: &[u8]) -> u64 {
        let mut hash = Self::NONE;
        let mut place = 0;
        while place < bytes.len() {
            hash.add(bytes[place] as u64);
            place += 1;
        }
        hash.number()
    }

    /// Adds one byte or one 64-bit word.
    #[inline]
    pub const fn add(&mut self, number: u64) {
        self.0 = (self.0 ^ number).wrapping_mul(0x0100_0000_01b3);
    }

    /// Returns the hash value.
    pub const fn number(self) -> u64 {
        self.0
    }
}

/// State of an object that the hash of a world covers: exactly the fields that snapshots contain.
pub trait HashState {
    /// Adds the state to a hash.
    fn hash_state(&self, hash: &mut Hash);
}

/// Implements [`HashState`] for a struct or an enum from the list of its fields or variants. A missing field
/// or variant is a compile error. Fields under `skip` are not hashed: they follow from the other fields or
/// are rebuilt in each tick, so snapshots do not contain them.
macro_rules! hash_state {
    (
        $([$($generics:tt)*])? struct $type:ty { $($field:ident),* $(,)? }
        $(skip { $($cache:ident),* $(,)? })?
    ) => {
        impl $(<$($generics)*>)? $crate::foundation::hash::HashState for $type {
            #[inline]
            fn hash_state(&self, hash: &mut $crate::foundation::hash::Hash) {
                let Self { $($field,)* $($($cache: _,)*)? } = self;
                $($crate::foundation::hash::HashState::hash_state($field, hash);)*
            }
        }
    };
    (
        $([$($generics:tt)*])? enum $type:ty {
            $($variant:ident $({ $($field:ident),* $(,)? })? $(( $($item:ident),* ))?),* $(,)?
        }
    ) => {
        impl $(<$($generics)*>)? $crate::foundation::hash::HashState for $type {
            fn hash_state(&self, hash: &mut $crate::foundation::hash::Hash) {
                match self {
                    $(Self::$variant $({ $($field),* })? $(( $($item),* ))? => {
                        const NAME: u64 =
                            $crate::foundation::hash::Hash::of(stringify!($variant).as_bytes());
                        hash.add(NAME);
                        $($($crate::foundation::hash::HashState::hash_state($field, hash);)*)?
                        $($($crate::foundation::hash::HashState::hash_state($item, hash);)*)?
                    })*
                }
            }
        }
    };
}

pub(crate) use hash_state;

/// Adds the state of each item to a hash, then the number of items.
pub fn hash_all<'a, T: HashState + 'a>(items: impl Iterator<Item = &'a T>, hash: &mut Hash) {
    let mut count = 0;
    for item in items {
        item.hash_state(hash);
        count += 1;
    }
    hash.add(count);
}

/// Implements [`HashState`] for numbers of at most 32 bits.
macro_rules! short_numbers {
    ($($number:ty => $bits:expr),* $(,)?) => {
        $(impl HashState for $number {
            #[inline(always)]
            fn hash_state(&self, hash: &mut Hash) {
                let bits: fn($number) -> u32 = $bits;
                hash.add(u64::from(bits(*self)));
            }
        })*
    };
}

short_numbers! {
    bool => u32::from,
    i8 => |number| u32::from(number.cast_unsigned()),
    u8 => u32::from,
    u32 => |number| number,
    i32 => i32::cast_unsigned,
    f32 => f32::to_bits,
}

/// Hashes a 64-bit number as two halves. The multiplication in [`Hash::add`] carries a difference only to
/// higher bits, so differences in the highest bits of two 64-bit words could cancel. Without the halves, the
/// quaternions q and −q would have the same hash.
impl HashState for u64 {
    #[inline]
    fn hash_state(&self, hash: &mut Hash) {
        hash.add(self & 0xffff_ffff);
        hash.add(self >> 32);
    }
}

impl HashState for usize {
    #[inline]
    fn hash_state(&self, hash: &mut Hash) {
        (*self as u64).hash_state(hash);
    }
}

impl HashState for f64 {
    #[inline]
    fn hash_state(&self, hash: &mut Hash) {
        self.to_bits().hash_state(hash);
    }
}

impl<T: HashState, const K: usize> HashState for [T; K] {
    #[inline]
    fn hash_state(&self, hash: &mut Hash) {
        self.iter().for_each(|item| item.hash_state(hash));
    }
}

/// Hashed like a [`Vec3`] whose third coordinate is 0.
impl HashState for Vec2 {
    #[inline]
    fn hash_state(&self, hash: &mut Hash) {
        self.extend(0.0).hash_state(hash);
    }
}

impl HashState for Vec3 {
    #[inline]
    fn hash_state(&self, hash: &mut Hash) {
        self.to_array().hash_state(hash);
    }
}

impl HashState for DVec3 {
    #[inline]
    fn hash_state(&self, hash: &mut Hash) {
        self.to_array().hash_state(hash);
    }
}

impl HashState for Row {
    #[inline]
    fn hash_state(&self, hash: &mut Hash) {
        self.as_array().hash_state(hash);
    }
}

impl<T: HashState> HashState for Vec<T> {
    fn hash_state(&self, hash: &mut Hash) {
        self.len().hash_state(hash);
        self.iter().for_each(|item| item.hash_state(hash));
    }
}

impl<T: HashState> HashState for Option<T> {
    fn hash_state(&self, hash: &mut Hash) {
        self.is_some().hash_state(hash);
        self.iter().for_each(|item| item.hash_state(hash));
    }
}

impl<A: HashState, B: HashState> HashState for (A, B) {
    #[inline]
    fn hash_state(&self, hash: &mut Hash) {
        self.0.hash_state(hash);
        self.1.hash_state(hash);
    }
}

impl<K: HashState, T: HashState> HashState for BTreeMap<K, T> {
    fn hash_state(&self, hash: &mut Hash) {
        self.len().hash_state(hash);
        for (key, item) in self {
            key.hash_state(hash);
            item.hash_state(hash);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hash_matches_published_fnv_1a_values() {
        assert_eq!(Hash::of(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(Hash::of(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(Hash::of(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn hash_of_state_detects_sign_changes_in_pairs() {
        let hash = |numbers: [f64; 4]| {
            let mut hash = Hash::NONE;
            numbers.hash_state(&mut hash);
            hash.number()
        };
        let numbers = [0.1, 0.2, 0.3, 0.4];
        assert_ne!(hash(numbers), hash(numbers.map(|k: f64| -k)));
    }
}
