//! Mapping from the colours of a file to materials.

use std::collections::BTreeMap;

/// Mapping from colours or palette indices of a file to material numbers; 0 leaves a voxel empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Colours {
    /// Materials by palette index, 1 to 255; only for models.
    pub indices: BTreeMap<u8, u8>,
    /// Materials by red, green and blue. A voxel gets the material of the nearest colour, by the sum of
    /// squared differences, and the first of equally near colours. Shades of a colour and smoothed edges
    /// therefore need no entries.
    pub named: BTreeMap<[u8; 3], u8>,
}

impl Colours {
    pub(super) fn nearest(&self, colour: [u8; 3]) -> Option<u8> {
        let apart = |other: &[u8; 3]| -> u32 {
            let squares = (0..3).map(|k| u32::from(colour[k].abs_diff(other[k])).pow(2));
            squares.sum()
        };
        let nearest = self.named.iter().min_by_key(|(other, _)| apart(other));
        nearest.map(|(_, &material)| material)
    }
}
