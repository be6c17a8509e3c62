//! Command-line notation of thresholds and labels.

use crate::segmentation::Segmentation;
use std::str::FromStr;

/// A range of intensities and its material, as in `40:120=1`; `120:=2` has no upper limit.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Threshold {
    /// Lowest intensity.
    pub low: f32,
    /// Highest intensity.
    pub high: f32,
    /// Number of the material.
    pub material: u8,
}

/// A label and its material, as in `17=1`.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Label in the scan.
    pub label: i32,
    /// Number of the material.
    pub material: u8,
}

impl FromStr for Threshold {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let read = || {
            let (range, material) = word.split_once('=')?;
            let (low, high) = range.split_once(':')?;
            let end = |text: &str, open| match text.trim() {
                "" => Some(open),
                text => text.parse().ok().filter(|k: &f32| !k.is_nan()),
            };
            let threshold = Self {
                low: end(low, f32::NEG_INFINITY)?,
                high: end(high, f32::INFINITY)?,
                material: material.trim().parse().ok()?,
            };
            (threshold.low <= threshold.high).then_some(threshold)
        };
        read().ok_or_else(|| "expected intensities and a material, as in 40:120=1 or 120:=2".into())
    }
}

impl FromStr for Label {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let read = || {
            let (label, material) = word.split_once('=')?;
            Some(Self {
                label: label.trim().parse().ok()?,
                material: material.trim().parse().ok()?,
            })
        };
        read().ok_or_else(|| "expected a label and a material, as in 17=1".into())
    }
}

impl Segmentation {
    /// Chooses the kind of segmentation: by thresholds if there are any, otherwise by labels if there are
    /// any, otherwise by one probability map per material.
    pub fn chosen(thresholds: &[Threshold], labels: &[Label]) -> Self {
        match (thresholds, labels) {
            ([], []) => Self::Maps,
            ([], labels) => {
                let labels = labels.iter().map(|label| (label.label, label.material));
                Self::Labels(labels.collect())
            }
            (thresholds, _) => {
                let ranges = thresholds.iter().map(|k| (k.low..=k.high, k.material));
                Self::Thresholds(ranges.collect())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parse_accepts_open_thresholds_and_negative_labels() {
        let threshold = |low, high, material| Threshold {
            low,
            high,
            material,
        };
        let read = str::parse::<Threshold>;
        assert_eq!(read("-40:120.5=1"), Ok(threshold(-40.0, 120.5, 1)));
        assert_eq!(read("120:=2"), Ok(threshold(120.0, f32::INFINITY, 2)));
        for word in ["", "1=1", "5:4=1", "nan:=1", "1:2", "1:2=256", "1:2=-1"] {
            assert!(read(word).is_err(), "{word}");
        }
        let (label, material) = (-3, 7);
        assert_eq!("-3=7".parse(), Ok(Label { label, material }));
        assert!("3".parse::<Label>().is_err());
    }
}
