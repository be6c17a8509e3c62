//! How far two shapes are from each other.

use super::brick::Brick;
use super::{Shape, Vector, distance_from_box};
use crate::vector::{dot, minus, plus, scaled};

/// The nearest point of a bar's axis is narrowed down so many times, each time to two thirds: 1e-7 of its
/// length are left, what single precision tells apart.
const NARROWINGS: usize = 40;

impl Shape {
    /// How far it is from another shape [m], negative where they overlap, and the direction in which it gets away
    /// from it. Boxes that are turned and apart corner to corner may be further apart than that.
    pub fn gap(&self, other: &Self) -> (f32, Vector) {
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
            ) => distance_from_box(minus(centre, middle), plus(half, size)),
            (Self::Box { centre, half }, Self::HalfSpace { normal, offset }) => {
                let reach = [0, 1, 2].map(|axis: usize| half[axis] * normal[axis].abs());
                let reach = reach.into_iter().sum::<f32>();
                (dot(normal, centre) - offset - reach, normal)
            }
            (Self::HalfSpace { .. }, Self::Box { .. } | Self::OrientedBox { .. }) => {
                turned(other.gap(self))
            }
            (Self::OrientedBox { centre, .. }, Self::HalfSpace { normal, offset }) => {
                let reach = Brick::of(self).map_or(0.0, |brick| brick.reach(normal));
                (dot(normal, centre) - offset - reach, normal)
            }
            (Self::Box { .. } | Self::OrientedBox { .. }, _) => {
                let both = Brick::of(self).zip(Brick::of(other));
                let separation = both.map(|(own, other)| own.separation(&other));
                separation.map_or((f32::INFINITY, [0.0, 1.0, 0.0]), |found| {
                    (found.gap, found.normal)
                })
            }
            // Each fills half of everything: no push would part them.
            (Self::HalfSpace { normal, .. }, Self::HalfSpace { .. }) => (f32::INFINITY, normal),
        }
    }
}

/// The same gap as seen from the other side.
fn turned((gap, normal): (f32, Vector)) -> (f32, Vector) {
    (gap, scaled(normal, -1.0))
}

impl Shape {
    /// The least distance of the points of a segment from it, the normal there, and where on the segment that is, from 0 to
    /// 1: along a segment the distance from something convex has one valley.
    pub(super) fn nearest_of_segment(&self, from: Vector, to: Vector) -> (f32, Vector, f32) {
        let at = |share: f32| self.distance(plus(from, scaled(minus(to, from), share)));
        let (mut low, mut high) = (0.0f32, 1.0f32);
        for _ in 0..NARROWINGS {
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
            .expect("there are three")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotation::Rotation;

    /// Gap and direction, and the same from the other side.
    fn check(a: Shape, b: Shape, gap: f32, normal: Vector) {
        for (first, second, sign) in [(a, b, 1.0), (b, a, -1.0)] {
            let (found, way) = first.gap(&second);
            assert!((found - gap).abs() < 1e-5, "{first:?} {second:?}: {found}");
            let off = minus(way, scaled(normal, sign));
            assert!(dot(off, off) < 1e-4, "{first:?} {second:?}: {way:?}");
        }
    }

    #[test]
    fn every_shape_knows_how_far_it_is_from_every_other() {
        let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
        let ball = |centre| Shape::Ball {
            centre,
            radius: 0.5,
        };
        let cube = |centre| Shape::Box {
            centre,
            half: [1.0, 0.5, 1.0],
        };
        let bar = |from, to| Shape::Capsule {
            from,
            to,
            radius: 0.25,
        };
        let (up, right) = ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]);
        check(ball([0.0, 2.0, 0.0]), floor, 1.5, up);
        check(ball([3.0, 0.0, 0.0]), cube([0.0; 3]), 1.5, right);
        check(cube([0.0, 0.25, 0.0]), floor, -0.25, up);
        check(cube([3.0, 0.0, 0.0]), cube([0.0; 3]), 1.0, right);
        check(cube([1.9, 0.0, 0.0]), cube([0.0; 3]), -0.1, right);
        let leaning = bar([0.0, 1.0, 0.0], [3.0, 2.0, 0.0]);
        check(leaning, floor, 0.75, up);
        check(leaning, ball([-2.0, 1.0, 0.0]), 1.25, right);
        check(
            bar([-4.0, 1.5, 0.0], [4.0, 1.5, 0.1]),
            cube([0.0; 3]),
            0.75,
            up,
        );
        // Bars that cross each other have their nearest points within.
        let [along, across] =
            [[2.0, 0.0, 0.0], [0.0, 0.0, 2.0]].map(|way: Vector| (scaled(way, -1.0), way));
        let above = |k: Vector| plus(k, up);
        check(
            bar(above(along.0), above(along.1)),
            bar(across.0, across.1),
            0.5,
            up,
        );
        assert_eq!(floor.gap(&floor).0, f32::INFINITY);
        let quarter = Rotation::about([0.0, 0.0, 1.0], std::f32::consts::FRAC_PI_4);
        let edge = |y| {
            Shape::Box {
                centre: [0.0; 3],
                half: [1.0; 3],
            }
            .rotated(quarter)
            .moved([0.0, y, 0.0])
        };
        check(edge(2.0), floor, 2.0 - 2.0f32.sqrt(), up);
        check(edge(2.0), cube([0.0; 3]), 1.5 - 2.0f32.sqrt(), up);
    }
}
