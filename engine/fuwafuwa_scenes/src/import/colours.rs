//! Which colours of a file are which material.

use std::collections::BTreeMap;

/// Which material a colour in a file stands for; 0 leaves its voxels empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Colours {
    /// Materials by palette index, 1 to 255; for models only.
    pub indices: BTreeMap<u8, u8>,
    /// Materials by red, green and blue. A voxel is of the material whose colour is nearest to its
    /// own (least sum of squared differences, the first of several), so that shades of a colour and
    /// smoothed edges need no entries.
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
