//! One number for many: hashes and checksums.

/// A hash [FNV-1a] that numbers are added to one after the other: bytes, as it was meant for, or words of 64 bits as they
/// are, which is quicker and tells as much.
#[derive(Copy, Clone, Debug)]
pub struct Hash(u64);

impl Hash {
    /// Of nothing.
    pub const NONE: Self = Self(0xcbf2_9ce4_8422_2325);

    /// That of bytes.
    pub fn of(bytes: &[u8]) -> u64 {
        let mut hash = Self::NONE;
        bytes.iter().for_each(|&byte| hash.add(byte.into()));
        hash.number()
    }

    /// Takes in one more number.
    #[inline]
    pub fn add(&mut self, number: u64) {
        self.0 = (self.0 ^ number).wrapping_mul(0x0100_0000_01b3);
    }

    /// What it has come to.
    pub fn number(self) -> u64 {
        self.0
    }
}

#[test]
fn the_hashes_are_those_that_were_published() {
    assert_eq!(Hash::of(b""), 0xcbf2_9ce4_8422_2325);
    assert_eq!(Hash::of(b"a"), 0xaf63_dc4c_8601_ec8c);
    assert_eq!(Hash::of(b"foobar"), 0x8594_4171_f739_67e8);
}
