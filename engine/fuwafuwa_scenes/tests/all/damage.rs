//! Random damage to files, which every import must survive.

use fuwafuwa::{Dim, VoxelGrid};
use fuwafuwa_scenes::import::ImportError;

/// A linear congruential generator with the constants of Knuth's MMIX, for reproducible noise.
pub struct Noise(pub u64);

impl Noise {
    pub fn below(&mut self, limit: usize) -> usize {
        let (factor, step) = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
        self.0 = self.0.wrapping_mul(factor).wrapping_add(step);
        (self.0 >> 33) as usize % limit
    }

    /// Returns a copy of `bytes` with one to four bytes changed: a flipped bit, an extreme value, or a random
    /// value.
    pub fn damaged(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut damaged = bytes.to_vec();
        for _ in 0..=self.below(4) {
            let at = self.below(bytes.len());
            damaged[at] = match self.below(3) {
                0 => damaged[at] ^ 1 << self.below(8),
                1 => [0, 1, 0x7f, 0x80, 0xff][self.below(5)],
                _ => self.below(256) as u8,
            };
        }
        damaged
    }
}

/// Checks that a damaged file gives either a shape or an error that names the file.
pub fn check<D: Dim>(outcome: Result<VoxelGrid<D>, ImportError>) {
    match outcome {
        Ok(grid) => assert!(grid.solid_count() > 0),
        Err(error) => assert!(error.to_string().starts_with("test."), "{error}"),
    }
}
