//! Warnings about scans: what was replaced, ignored or lost.

use crate::placement::PlacementSource;
use crate::scan::Scan;
use crate::segmentation::{SOLID, Segmentation};
use std::collections::BTreeSet;

/// Maximum number of labels of a scan. Whole numbers with more different values count as intensities.
const MAX_LABELS: usize = 128;

/// Maximum number of labels that a warning lists.
const MAX_LISTED: usize = 8;

/// Returns sentences for the user about scans, each given with its name: replaced and ignored parts of the
/// files, missing orientation, and labels that the segmentation loses or does not find.
pub fn warnings(scans: &[(&str, &Scan)], segmentation: &Segmentation) -> Vec<String> {
    let mut warnings = Vec::new();
    for (name, scan) in scans {
        let mut warn = |text: &str| warnings.push(format!("{name}: {text}"));
        scan.notes().iter().for_each(|note| warn(note));
        if scan.placement().source() == PlacementSource::Spacing {
            warn("the scan has no orientation: left and right may be swapped");
        }
    }
    for (index, (name, scan)) in scans.iter().enumerate() {
        let text = match (scans, segmentation) {
            ([_], _) => lost_labels(scan, segmentation),
            (_, Segmentation::Maps) => labels_as_map(scan, index + 1),
            _ => None,
        };
        warnings.extend(text.map(|text| format!("{name}: {text}")));
    }
    warnings
}

/// Returns the warning about labels in one of several maps, that of `material`.
fn labels_as_map(scan: &Scan, material: usize) -> Option<String> {
    let labels: Vec<i32> = labels_of(scan)?.into_iter().collect();
    (labels.len() > 1).then(|| {
        format!(
            "the values look like labels ({}), but were read as probabilities of material {material}; to choose a \
             material for each label, import this scan alone with --label",
            list(&labels)
        )
    })
}

fn lost_labels(scan: &Scan, segmentation: &Segmentation) -> Option<String> {
    let labels = labels_of(scan)?;
    match segmentation {
        Segmentation::Thresholds(_) => None,
        Segmentation::Labels(materials) => {
            let absent: Vec<i32> = materials
                .keys()
                .filter(|label| **label != 0 && !labels.contains(label))
                .copied()
                .collect();
            let labels: Vec<i32> = labels.into_iter().collect();
            (!absent.is_empty()).then(|| {
                format!(
                    "no voxel has the label {}; the labels of the scan are {}",
                    list(&absent),
                    list(&labels)
                )
            })
        }
        Segmentation::Maps if labels.len() > 1 => {
            let half = SOLID * scan.range()[1].max(1.0);
            let is_lost = |label: &&i32| (**label as f32) < half;
            let lost: Vec<i32> = labels.iter().filter(is_lost).copied().collect();
            let lost = match lost.is_empty() {
                true => String::new(),
                false => format!(
                    "values below {half}, half of the highest, became empty ({}), and ",
                    list(&lost)
                ),
            };
            Some(format!(
                "the values look like labels, but were read as probabilities: {lost}all others became material 1; to \
                 choose a material for each label, use --label"
            ))
        }
        Segmentation::Maps => None,
    }
}

/// Returns the different values of a scan without 0, if they are few and whole numbers.
fn labels_of(scan: &Scan) -> Option<BTreeSet<i32>> {
    let mut labels = BTreeSet::new();
    for &value in scan.values() {
        if value.fract() != 0.0 || value.abs() > i32::MAX as f32 {
            return None;
        }
        if value != 0.0 && labels.insert(value as i32) && labels.len() > MAX_LABELS {
            return None;
        }
    }
    Some(labels)
}

/// Lists labels, at most [`MAX_LISTED`] of them.
fn list(labels: &[i32]) -> String {
    let listed = labels.iter().take(MAX_LISTED).map(i32::to_string);
    let listed = listed.collect::<Vec<_>>().join(", ");
    match labels.len().saturating_sub(MAX_LISTED) {
        0 => listed,
        more => format!("{listed} and {more} more"),
    }
}
