//! Deviations of crack tips from their ideal paths.
//!
//! A crack can advance only along the faces of voxels. A crack in any other direction is a staircase, and a
//! tip follows a straight path only on average. So the deviation from the path is stored, and the next step returns to it, as in
//! the line algorithm of [Bresenham 1965].

use crate::foundation::dim::{Dim, Point};
use crate::foundation::hash::hash_state;
use glam::Vec3;
use std::collections::BTreeMap;

/// Distance along each axis within which tips of one front share their deviations [voxels].
const FRONT_REACH: i32 = 2;

/// Largest deviation within one front [voxels]; a tip that follows its path stays within 1.
const MAX_DEVIATION: f32 = 1.5;

/// Deviation of each crack tip from its ideal path, by lattice point. Tips without an entry have none.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TipDeviations {
    /// Vector from the ideal path to the tip [voxels], along the axes of the undeformed body.
    at: BTreeMap<Point, [f32; 3]>,
}

hash_state! { struct TipDeviations { at } }

impl TipDeviations {
    /// Returns the deviation of a tip [voxels]. `project` removes the components of a deviation that do not
    /// matter: those along the direction of growth and along the front. In 3D this is the mean of the estimates
    /// of all tips of the front within [`FRONT_REACH`], so that the front stays together.
    pub fn of_tip<D: Dim>(&self, tip: Point, project: impl Fn(Vec3) -> Vec3) -> Vec3 {
        let reach = if D::N == 2 { 0 } else { FRONT_REACH };
        let (mut sum, mut count) = (Vec3::ZERO, 0.0f32);
        let [low, high] = [-reach, reach].map(|reach| tip.map(|k| k + reach));
        // The range also holds points outside the box, because it is sorted by the first axis.
        for (point, &deviation) in self.at.range(low..=high) {
            let offset = [0, 1, 2].map(|k: usize| tip[k] - point[k]);
            if offset.iter().any(|k| k.abs() > reach) {
                continue;
            }
            let offset = Vec3::from(offset.map(|k| k as f32));
            let estimate = project(offset + Vec3::from(deviation));
            // A larger deviation belongs to another crack.
            if estimate.length() < MAX_DEVIATION {
                sum += estimate;
                count += 1.0;
            }
        }
        sum / count.max(1.0)
    }

    /// Moves tips: each entry has the old and the new lattice point of a tip, and its new deviation [voxels]. If
    /// two tips move to one point, the deviation of the later one counts.
    pub fn advance(&mut self, tips: &[(Point, Point, Vec3)]) {
        for (from, ..) in tips {
            self.at.remove(from);
        }
        for &(_, to, deviation) in tips {
            self.at.insert(to, deviation.to_array());
        }
    }

    /// Removes the deviations at those of `points` that are no longer tips.
    pub fn keep_tips(
        &mut self,
        points: impl Iterator<Item = Point>,
        is_tip: impl Fn(Point) -> bool,
    ) {
        if self.at.is_empty() {
            return;
        }
        for point in points {
            if self.at.contains_key(&point) && !is_tip(point) {
                self.at.remove(&point);
            }
        }
    }

    /// Returns the lattice points of all entries; `None` if a deviation is not a number or too large. A cut adds
    /// at most a step of √3 voxels to a mean deviation.
    #[cfg(feature = "serde")]
    pub fn valid_points(&self) -> Option<impl Iterator<Item = Point> + '_> {
        let most = MAX_DEVIATION + 3f32.sqrt();
        let is_valid = |&deviation: &[f32; 3]| Vec3::from(deviation).length() <= most;
        self.at
            .values()
            .all(is_valid)
            .then(|| self.at.keys().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};

    #[test]
    fn tips_of_one_front_share_their_deviation() {
        let mut deviations = TipDeviations::default();
        let across = |deviation: Vec3| Vec3::Y * deviation.y;
        let none = [0, 0, 0];
        deviations.advance(&[
            (none, [5, 4, 3], Vec3::Y * -0.4),
            // One step higher, so its deviation from the same plane is 1 higher, with an error of 0.2.
            (none, [5, 5, 4], Vec3::Y * 0.8),
            // Another crack, two voxels lower.
            (none, [5, 2, 4], Vec3::Y * 0.9),
        ]);
        let shared = deviations.of_tip::<Dim3>([5, 4, 3], across);
        assert!((shared - Vec3::Y * -0.3).length() < 1e-6, "{shared}");
        let own = deviations.of_tip::<Dim2>([5, 4, 3], across);
        assert!((own - Vec3::Y * -0.4).length() < 1e-6, "{own}");
        assert_eq!(deviations.of_tip::<Dim3>([50, 4, 3], across), Vec3::ZERO);
    }

    #[test]
    fn deviations_of_former_tips_are_removed() {
        let mut deviations = TipDeviations::default();
        let none = [0, 0, 0];
        deviations.advance(&[(none, [1, 0, 0], Vec3::Y), (none, [2, 0, 0], Vec3::Y)]);
        // The tips move one after the other along one line.
        deviations.advance(&[
            ([1, 0, 0], [2, 0, 0], Vec3::Y),
            ([2, 0, 0], [3, 0, 0], Vec3::Y),
        ]);
        assert_eq!(
            deviations.at.keys().copied().collect::<Vec<_>>(),
            [[2, 0, 0], [3, 0, 0]]
        );
        deviations.keep_tips([[2, 0, 0], [3, 0, 0]].into_iter(), |at| at == [3, 0, 0]);
        assert_eq!(
            deviations.at.keys().copied().collect::<Vec<_>>(),
            [[3, 0, 0]]
        );
    }
}
