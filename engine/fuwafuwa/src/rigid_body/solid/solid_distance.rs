//! Distances between shapes.

use super::oriented_box::OrientedBox;
use super::{Solid, distance_from_box};
use glam::Vec3;

/// Number of ternary-search steps that find the point of a segment nearest to a shape. Each step shrinks the
/// search interval to two thirds of its length. After 40 steps, 1e-7 of the segment remains, the resolution
/// of single precision.
const TERNARY_STEPS: usize = 40;

impl Solid {
    /// Returns the distance to another shape [m], negative if the shapes overlap, and the unit direction from
    /// the other shape to this one. For two oriented boxes whose nearest points are corners, the distance is
    /// only a lower bound.
    pub fn gap(&self, other: &Self) -> (f32, Vec3) {
        match (*self, *other) {
            (Self::Ball { centre, radius }, _) => {
                let (distance, normal) = other.distance(centre);
                (distance - radius, normal)
            }
            (_, Self::Ball { .. }) => turned(other.gap(self)),
            (Self::Capsule { from, to, radius }, _) => {
                let (distance, normal, _) = other.nearest_of_segment(from, to);
                (distance - radius, normal)
            }
            (_, Self::Capsule { .. }) => turned(other.gap(self)),
            (
                Self::Box { centre, half },
                Self::Box {
                    centre: middle,
                    half: size,
                },
            ) => distance_from_box(centre - middle, half + size),
            (Self::Box { centre, half }, Self::HalfSpace { normal, offset }) => {
                let reach = [0, 1, 2].map(|axis: usize| half[axis] * normal[axis].abs());
                let reach = reach.into_iter().sum::<f32>();
                (normal.dot(centre) - offset - reach, normal)
            }
            (Self::HalfSpace { .. }, Self::Box { .. } | Self::OrientedBox { .. }) => {
                turned(other.gap(self))
            }
            (Self::OrientedBox { centre, .. }, Self::HalfSpace { normal, offset }) => {
                let reach = OrientedBox::of(self).map_or(0.0, |cuboid| cuboid.reach(normal));
                (normal.dot(centre) - offset - reach, normal)
            }
            (Self::Box { .. } | Self::OrientedBox { .. }, _) => {
                let both = OrientedBox::of(self).zip(OrientedBox::of(other));
                let separation = both.map(|(own, other)| own.separation(&other));
                separation.map_or((f32::INFINITY, Vec3::Y), |found| (found.gap, found.normal))
            }
            // Half-spaces are unbounded and cannot be pushed apart. The infinite distance excludes the pair
            // from contacts.
            (Self::HalfSpace { normal, .. }, Self::HalfSpace { .. }) => (f32::INFINITY, normal),
        }
    }
}

/// Reverses the direction, as if the two shapes had been swapped. The distance stays the same.
fn turned((gap, normal): (f32, Vec3)) -> (f32, Vec3) {
    (gap, -normal)
}

impl Solid {
    /// Finds the point of a segment that is nearest to the shape. Returns its distance from the shape [m],
    /// the outward normal of the shape at this point, and its position on the segment, from 0 to 1. The
    /// ternary search is valid because the distance from a convex shape has a single minimum along a segment.
    pub(super) fn nearest_of_segment(&self, from: Vec3, to: Vec3) -> (f32, Vec3, f32) {
        let at = |share: f32| self.distance(from + (to - from) * share);
        let (mut low, mut high) = (0.0f32, 1.0f32);
        for _ in 0..TERNARY_STEPS {
            let third = (high - low) / 3.0;
            let [left, right] = [low + third, high - third];
            if at(left).0 > at(right).0 {
                low = left;
            } else {
                high = right;
            }
        }
        [0.5 * (low + high), 0.0, 1.0]
            .map(|share| (at(share).0, at(share).1, share))
            .into_iter()
            .reduce(|best, end| if end.0 < best.0 { end } else { best })
            .expect("the array is not empty")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rotation::Rotation;

    /// Checks the gap and the direction between two shapes, in both orders.
    fn check(a: Solid, b: Solid, gap: f32, normal: Vec3) {
        for (first, second, sign) in [(a, b, 1.0), (b, a, -1.0)] {
            let (found, way) = first.gap(&second);
            assert!((found - gap).abs() < 1e-5, "{first:?} {second:?}: {found}");
            let off = way - normal * sign;
            assert!(off.dot(off) < 1e-4, "{first:?} {second:?}: {way:?}");
        }
    }

    #[test]
    fn gap_and_normal_are_correct_for_all_pairs_of_shapes() {
        let floor = Solid::half_space(Vec3::Y, Vec3::ZERO);
        let ball = |centre| Solid::Ball {
            centre,
            radius: 0.5,
        };
        let cube = |centre| Solid::Box {
            centre,
            half: Vec3::new(1.0, 0.5, 1.0),
        };
        let capsule = |from, to| Solid::Capsule {
            from,
            to,
            radius: 0.25,
        };
        let (up, right) = (Vec3::Y, Vec3::X);
        check(ball(Vec3::new(0.0, 2.0, 0.0)), floor, 1.5, up);
        check(ball(Vec3::new(3.0, 0.0, 0.0)), cube(Vec3::ZERO), 1.5, right);
        check(cube(Vec3::new(0.0, 0.25, 0.0)), floor, -0.25, up);
        check(cube(Vec3::new(3.0, 0.0, 0.0)), cube(Vec3::ZERO), 1.0, right);
        check(
            cube(Vec3::new(1.9, 0.0, 0.0)),
            cube(Vec3::ZERO),
            -0.1,
            right,
        );
        let leaning = capsule(Vec3::Y, Vec3::new(3.0, 2.0, 0.0));
        check(leaning, floor, 0.75, up);
        check(leaning, ball(Vec3::new(-2.0, 1.0, 0.0)), 1.25, right);
        check(
            capsule(Vec3::new(-4.0, 1.5, 0.0), Vec3::new(4.0, 1.5, 0.1)),
            cube(Vec3::ZERO),
            0.75,
            up,
        );
        // The nearest points of crossing capsules are inside their segments.
        let [along, across] =
            [Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 2.0)].map(|way: Vec3| (-way, way));
        let above = |k: Vec3| k + up;
        check(
            capsule(above(along.0), above(along.1)),
            capsule(across.0, across.1),
            0.5,
            up,
        );
        assert_eq!(floor.gap(&floor).0, f32::INFINITY);
        let quarter = Rotation::about(Vec3::Z, std::f32::consts::FRAC_PI_4);
        let edge = |y| {
            Solid::Box {
                centre: Vec3::ZERO,
                half: Vec3::ONE,
            }
            .rotated(quarter)
            .translated(Vec3::new(0.0, y, 0.0))
        };
        check(edge(2.0), floor, 2.0 - 2.0f32.sqrt(), up);
        check(edge(2.0), cube(Vec3::ZERO), 1.5 - 2.0f32.sqrt(), up);
    }
}
