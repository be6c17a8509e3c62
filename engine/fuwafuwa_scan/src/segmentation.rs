//! Which material is where: by intensity, by label, or by maps of how probable each is.

use crate::scan::Scan;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// Least sum of the maps at a place for it to be solid: there it is more probably one of the materials than none.
const SOLID: f32 = 0.5;

/// What tells the material of a place; 0 leaves it empty.
#[derive(Clone, Debug, PartialEq)]
pub enum Segmentation {
    /// The first range that the intensity of the one scan is in, between voxels as well; beyond all of them nothing.
    Thresholds(Vec<(RangeInclusive<f32>, u8)>),
    /// The label in the one scan, a whole number, of the nearest voxel, as what lies between two labels is no label.
    /// Those that are not named are empty.
    Labels(BTreeMap<i32, u8>),
    /// A scan for each material, number 1 first, that says how probable it is. A place is solid where the sum is a half
    /// or more, and of the most probable material, so that there is no gap where two are alike. A scan whose highest
    /// value is above 1 is divided by it: programs write percents, and bytes up to 255.
    Maps,
}

impl Segmentation {
    /// [`Segmentation::Thresholds`] from a list.
    pub fn thresholds(ranges: &[(RangeInclusive<f32>, u8)]) -> Self {
        Self::Thresholds(ranges.to_vec())
    }

    /// [`Segmentation::Labels`] from a list of labels and materials.
    pub fn labels(labels: &[(i32, u8)]) -> Self {
        Self::Labels(labels.iter().copied().collect())
    }

    /// The material at a place in the patient, RAS+ [mm]; 0 where it is empty.
    pub(crate) fn material(&self, scans: &[&Scan], patient: [f64; 3]) -> u8 {
        let voxel = |scan: &Scan| scan.placement().voxel_at(patient);
        let first = scans[0];
        match self {
            Self::Thresholds(ranges) => {
                let intensity = first.between(voxel(first));
                let found = ranges.iter().find(|(range, _)| range.contains(&intensity));
                found.map_or(0, |&(_, material)| material)
            }
            Self::Labels(materials) => {
                let label = first.nearest(voxel(first)).round() as i32;
                materials.get(&label).copied().unwrap_or(0)
            }
            Self::Maps => {
                let (mut sum, mut best) = (0.0, (0.0, 0));
                for (index, scan) in scans.iter().enumerate() {
                    let highest = scan.range()[1].max(1.0);
                    let probability = (scan.between(voxel(scan)) / highest).max(0.0);
                    sum += probability;
                    if probability > best.0 {
                        best = (probability, index + 1);
                    }
                }
                if sum < SOLID { 0 } else { best.1 as u8 }
            }
        }
    }
}
