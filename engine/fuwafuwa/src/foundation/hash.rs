//! Hashes and checksums.

/// Incremental hash [FNV-1a]. Accepts bytes, for which FNV-1a is defined, or 64-bit words, which is faster
/// and equally sensitive to changes.
#[derive(Copy, Clone, Debug)]
pub struct Hash(u64);

impl Hash {
    /// Hash of no data.
    pub const NONE: Self = Self(0xcbf2_9ce4_8422_2325);

    /// Hash of bytes.
    pub fn of(bytes: &[u8]) -> u64 {
        let mut hash = Self::NONE;
        bytes.iter().for_each(|&byte| hash.add(byte.into()));
        hash.number()
    }

    /// Adds a byte or word.
    #[inline]
    pub fn add(&mut self, number: u64) {
        self.0 = (self.0 ^ number).wrapping_mul(0x0100_0000_01b3);
    }

    /// Returns the hash value.
    pub fn number(self) -> u64 {
        self.0
    }
}

#[test]
fn hash_matches_published_fnv_1a_values() {
    assert_eq!(Hash::of(b""), 0xcbf2_9ce4_8422_2325);
    assert_eq!(Hash::of(b"a"), 0xaf63_dc4c_8601_ec8c);
    assert_eq!(Hash::of(b"foobar"), 0x8594_4171_f739_67e8);
}
