//! Assignment of materials to positions in a scan: by intensity, by label, or by probability maps.

use crate::scan::Scan;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// Minimum sum of the probability maps at a solid position.
pub(crate) const SOLID: f32 = 0.5;

/// Rule that gives the material at a position; 0 means empty.
#[derive(Clone, Debug, PartialEq)]
pub enum Segmentation {
    /// Ranges of intensity and their materials, for one scan. The intensity is interpolated between voxels
    /// and the first matching range decides; without a match, the position is empty.
    Thresholds(Vec<(RangeInclusive<f32>, u8)>),
    /// Integer labels and their materials, for one scan. The nearest voxel decides, because a value between
    /// two labels is not a label. Other labels are empty.
    Labels(BTreeMap<i32, u8>),
    /// Probability maps: one scan for each material, number 1 first. A position is solid if the sum of all
    /// probabilities is at least 0.5, so that no gap appears between two equally probable materials. It gets
    /// the most probable material. A scan with values above 1 is divided by its highest value, because some
    /// programs write percentages or bytes up to 255.
    Maps,
}

impl Segmentation {
    /// Creates [`Segmentation::Thresholds`] from a list.
    pub fn thresholds(ranges: &[(RangeInclusive<f32>, u8)]) -> Self {
        Self::Thresholds(ranges.to_vec())
    }

    /// Creates [`Segmentation::Labels`] from a list of labels and materials.
    pub fn labels(labels: &[(i32, u8)]) -> Self {
        Self::Labels(labels.iter().copied().collect())
    }

    /// Returns the material at a position in the patient, RAS+ [mm]; 0 if empty.
    pub(crate) fn material(&self, scans: &[&Scan], patient: [f64; 3]) -> u8 {
        let voxel = |scan: &Scan| scan.placement().voxel_at(patient);
        let first = scans[0];
        match self {
            Self::Thresholds(ranges) => {
                let intensity = first.interpolate(voxel(first));
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
                    let probability = (scan.interpolate(voxel(scan)) / highest).max(0.0);
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
