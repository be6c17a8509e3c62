//! Contact manifolds between shapes: a common normal and the contact points.

use super::Solid;
use super::oriented_box::{OrientedBox, SeparatingFeature, Separation};
use glam::Vec3;

/// Cosine of the largest allowed angle, 26°, between the normal of the manifold and the normal of the other
/// shape at an end of a capsule. At a larger angle, the end is no contact point. The angle is 0 if the
/// capsule lies flat on a face.
const MIN_END_COSINE: f32 = 0.9;
/// Distance below which two contact points of a capsule are duplicates, as a share of the capsule's radius.
/// The point nearest to the other shape is left out if a contact point at an end of the capsule is closer
/// than this.
const MIN_POINT_SPACING: f32 = 0.5;

/// Contact manifold of two shapes.
#[derive(Clone, Debug, Default)]
pub struct Manifold {
    /// Common unit normal of all contact points, from the second shape towards the first.
    pub normal: Vec3,
    pub points: Vec<ManifoldPoint>,
}

/// Contact point of a manifold.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ManifoldPoint {
    /// Position of the contact point, midway between both surfaces [m].
    pub at: Vec3,
    /// Distance between both surfaces at the contact point [m], negative if they overlap.
    pub gap: f32,
    /// Identifier of the touching corners or edges. It stays equal between substeps while the same corners
    /// and edges touch, so that the solver can start from the previous impulse.
    pub key: u32,
}

impl Solid {
    /// Returns the contact manifold with another shape: up to eight points with a gap below `margin` [m].
    pub fn manifold(&self, other: &Self, margin: f32) -> Manifold {
        let found = match (*self, *other) {
            (Self::Ball { centre, radius }, _) => {
                let (distance, normal) = other.distance(centre);
                let point = beneath(centre, normal, radius, distance - radius, 0);
                let points = vec![point];
                Manifold { normal, points }
            }
            (Self::Capsule { .. }, _) if !matches!(other, Self::Ball { .. }) => {
                capsule(self, other)
            }
            (_, Self::Ball { .. } | Self::Capsule { .. }) => other.manifold(self, margin).turned(),
            _ => match (OrientedBox::of(self), OrientedBox::of(other), other) {
                (Some(own), Some(others), _) => boxes(&own, &others, margin),
                (Some(own), None, &Self::HalfSpace { normal, offset }) => {
                    on_plane(&own, normal, offset)
                }
                (None, Some(_), _) => other.manifold(self, margin).turned(),
                _ => Manifold::default(),
            },
        };
        found.within(margin)
    }
}

impl Manifold {
    /// Reverses the normal, as if the two shapes had been swapped.
    fn turned(mut self) -> Self {
        self.normal = -self.normal;
        self
    }

    fn within(mut self, margin: f32) -> Self {
        self.points.retain(|point| point.gap < margin);
        self
    }
}

/// Returns the contact point between a ball and a surface. `normal` is the unit normal of the surface at the
/// point nearest to the ball. `gap` [m] is the distance from the ball to the surface, negative if they
/// overlap.
fn beneath(centre: Vec3, normal: Vec3, radius: f32, gap: f32, key: u32) -> ManifoldPoint {
    let at = centre - normal * (radius + 0.5 * gap);
    ManifoldPoint { at, gap, key }
}

/// Returns the manifold of a capsule with any shape except a ball. Possible contact points are the ends of
/// the capsule's segment, and the point of this segment nearest to the other shape. If the other shape is a
/// capsule, the ends of its segment are possible contact points, too.
fn capsule(own: &Solid, other: &Solid) -> Manifold {
    let &Solid::Capsule { from, to, radius } = own else {
        return Manifold::default();
    };
    let (distance, normal, share) = other.nearest_of_segment(from, to);
    let nearest = from + (to - from) * share;
    let mut points = Vec::new();
    for (key, end) in [(1, from), (2, to)] {
        let (far, way) = other.distance(end);
        if way.dot(normal) > MIN_END_COSINE {
            points.push(beneath(end, normal, radius, far - radius, key));
        }
    }
    if let Solid::Capsule {
        from,
        to,
        radius: thickness,
    } = *other
    {
        for (key, end) in [(3, from), (4, to)] {
            let (far, way) = own.distance(end);
            if way.dot(normal) < -MIN_END_COSINE {
                let point = beneath(end, -normal, thickness, far - thickness, key);
                points.push(point);
            }
        }
    }
    let middle = beneath(nearest, normal, radius, distance - radius, 0);
    let is_apart =
        |point: &ManifoldPoint| (point.at - middle.at).length() > MIN_POINT_SPACING * radius;
    if points.iter().all(is_apart) {
        points.push(middle);
    }
    Manifold { normal, points }
}

fn on_plane(cuboid: &OrientedBox, normal: Vec3, offset: f32) -> Manifold {
    let corners = (0..cuboid.corner_count()).map(|number| (number as u32, cuboid.corner(number)));
    let points = corners.map(|(key, corner)| {
        let gap = normal.dot(corner) - offset;
        beneath(corner, normal, 0.0, gap, key)
    });
    Manifold {
        normal,
        points: points.collect(),
    }
}

fn boxes(own: &OrientedBox, other: &OrientedBox, margin: f32) -> Manifold {
    let separation = own.separation(other);
    if separation.gap >= margin {
        return Manifold::default();
    }
    let Separation {
        gap,
        normal,
        feature,
    } = separation;
    let points = match feature {
        SeparatingFeature::First(axis) => on_face(own, axis, -normal, other),
        SeparatingFeature::Second(axis) => on_face(other, axis, normal, own),
        SeparatingFeature::Edges(first, second) => {
            let [a, b] = [edge(own, first, -normal), edge(other, second, normal)];
            let at = between(a, own.axes[first], b, other.axes[second]);
            let key = 1000 + 3 * first as u32 + second as u32;
            vec![ManifoldPoint { at, gap, key }]
        }
    };
    Manifold { normal, points }
}

/// Returns the contact points between a face of the box `ground` and the box `cuboid`. The face is
/// perpendicular to `axis` and has the outward normal `out`.
fn on_face(
    ground: &OrientedBox,
    axis: usize,
    out: Vec3,
    cuboid: &OrientedBox,
) -> Vec<ManifoldPoint> {
    let others: Vec<usize> = (0..cuboid.axis_count).filter(|&k| k != axis).collect();
    let level = out.dot(ground.centre) + ground.half[axis];
    // Selects the face of `cuboid` that lies on the ground: the face with the normal most opposite to `out`.
    let facing = |k: &usize| cuboid.axes[*k].dot(out).abs();
    let face = (0..cuboid.axis_count).max_by(|a, b| facing(a).total_cmp(&facing(b)));
    let face = face.unwrap_or(axis);
    let is_upper = cuboid.axes[face].dot(out) < 0.0;
    let mut polygon: Vec<(Vec3, u32)> = around(cuboid, face, is_upper);
    for (number, side) in others.into_iter().enumerate() {
        for (sign, plane) in [(1.0, 2 * number), (-1.0, 2 * number + 1)] {
            let way = ground.axes[side] * sign;
            let max = way.dot(ground.centre) + ground.half[side];
            polygon = clipped(&polygon, way, max, plane as u32);
        }
    }
    let point = |&(corner, key): &(Vec3, u32)| {
        let gap = out.dot(corner) - level;
        let at = corner - out * (0.5 * gap);
        ManifoldPoint { at, gap, key }
    };
    polygon.iter().map(point).collect()
}

/// Returns the corners of a face in circular order, each with its corner number as key.
fn around(cuboid: &OrientedBox, face: usize, is_upper: bool) -> Vec<(Vec3, u32)> {
    let fixed = usize::from(is_upper) << face;
    let others: Vec<usize> = (0..cuboid.axis_count).filter(|&k| k != face).collect();
    let numbers: Vec<usize> = match others[..] {
        [a] => vec![0, 1 << a],
        [a, b] => vec![0, 1 << a, 1 << a | 1 << b, 1 << b],
        _ => Vec::new(),
    };
    let corners = numbers.into_iter().map(|number| number | fixed);
    corners
        .map(|number| (cuboid.corner(number), number as u32))
        .collect()
}

/// Clips a polygon (in 2D a segment) by a plane: keeps the part in which the coordinate along the direction
/// `way` is at most `max` [m]. New corners get a key derived from the clipped edge and `plane`.
fn clipped(polygon: &[(Vec3, u32)], way: Vec3, max: f32, plane: u32) -> Vec<(Vec3, u32)> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    let is_line = polygon.len() == 2;
    for (number, &(at, key)) in polygon.iter().enumerate() {
        let beyond = way.dot(at) - max;
        if beyond <= 0.0 {
            kept.push((at, key));
        }
        if is_line && number == 1 {
            break;
        }
        let (next, next_key) = polygon[(number + 1) % polygon.len()];
        let next_beyond = way.dot(next) - max;
        if (beyond <= 0.0) != (next_beyond <= 0.0) {
            let share = beyond / (beyond - next_beyond);
            let at = at + (next - at) * share;
            let (low, high) = (key.min(next_key), key.max(next_key));
            let own = low.wrapping_add(high.wrapping_mul(131));
            kept.push((at, own.wrapping_mul(4).wrapping_add(8 + plane)));
        }
    }
    kept
}

/// Returns the midpoint of the box edge that is parallel to the axis `along` and lies farthest in the
/// direction `way`.
fn edge(cuboid: &OrientedBox, along: usize, way: Vec3) -> Vec3 {
    let others = (0..cuboid.axis_count).filter(|&axis| axis != along);
    others.fold(cuboid.centre, |at, axis| {
        let sign = if cuboid.axes[axis].dot(way) < 0.0 {
            -1.0
        } else {
            1.0
        };
        at + cuboid.axes[axis] * (sign * cuboid.half[axis])
    })
}

/// Returns the midpoint between the nearest points of two lines that are not parallel: the line through `a`
/// along the unit vector `along`, and the line through `b` along the unit vector `across`.
fn between(a: Vec3, along: Vec3, b: Vec3, across: Vec3) -> Vec3 {
    let (apart, cosine) = (b - a, along.dot(across));
    let under = (1.0 - cosine * cosine).max(1e-6);
    let (first, second) = (apart.dot(along), apart.dot(across));
    let on_first = a + along * ((first - cosine * second) / under);
    let on_second = b + across * ((cosine * first - second) / under);
    (on_first + on_second) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rotation::Rotation;

    fn cube(centre: Vec3, half: Vec3) -> Solid {
        Solid::Box { centre, half }
    }

    /// Checks the number of contact points, the smallest gap and the normal, for both orders of the shapes.
    fn check(a: Solid, b: Solid, count: usize, gap: f32, normal: Vec3) {
        for (first, second, sign) in [(a, b, 1.0), (b, a, -1.0)] {
            let found = first.manifold(&second, 0.1);
            assert_eq!(found.points.len(), count, "{first:?} {second:?} {found:?}");
            let gaps = found.points.iter().map(|point| point.gap);
            let least = gaps.fold(f32::INFINITY, f32::min);
            assert!((least - gap).abs() < 1e-4, "{found:?}");
            let off = found.normal - normal * sign;
            assert!(off.dot(off) < 1e-5, "{found:?}");
            for point in &found.points {
                let [one, two] = [first, second].map(|shape| shape.distance(point.at).0);
                assert!((one - 0.5 * point.gap).abs() < 6e-3, "{point:?} {one}");
                assert!((two - 0.5 * point.gap).abs() < 6e-3, "{point:?} {two}");
            }
            let mut keys: Vec<u32> = found.points.iter().map(|point| point.key).collect();
            keys.sort_unstable();
            keys.dedup();
            assert_eq!(keys.len(), count, "{found:?}");
        }
    }

    #[test]
    fn manifold_points_are_correct_for_all_pairs_of_shapes() {
        let up = Vec3::Y;
        let floor = Solid::half_space(up, Vec3::ZERO);
        let cuboid = cube(Vec3::new(0.0, 0.49, 0.0), Vec3::new(1.0, 0.5, 0.7));
        check(cuboid, floor, 4, -0.01, up);
        check(
            cube(Vec3::new(0.3, 1.5, 0.2), Vec3::new(1.0, 0.5, 0.7)),
            cuboid,
            4,
            0.01,
            up,
        );
        let turned = Rotation::about(up, 0.7);
        let above = cube(Vec3::ZERO, Vec3::new(0.9, 0.5, 0.9)).rotated(turned);
        check(
            above.translated(Vec3::new(0.0, 1.48, 0.0)),
            cuboid,
            8,
            -0.01,
            up,
        );
        // Boxes in 2D, one on another and one on the floor.
        let flat = |centre: Vec3| cube(centre, Vec3::new(1.0, 0.5, f32::MAX));
        check(
            flat(Vec3::new(0.4, 0.99, 0.0)),
            flat(Vec3::ZERO),
            2,
            -0.01,
            up,
        );
        check(flat(Vec3::new(0.4, 0.49, 0.0)), floor, 2, -0.01, up);
        // Capsules on the floor, on a box and on another capsule.
        let capsule = |y: f32, to: Vec3| {
            Solid::Capsule {
                from: -to,
                to,
                radius: 0.25,
            }
            .translated(Vec3::new(0.0, y, 0.0))
        };
        check(capsule(0.24, Vec3::X), floor, 2, -0.01, up);
        check(
            capsule(1.23, Vec3::new(0.8, 0.0, 0.0)),
            cuboid,
            2,
            -0.01,
            up,
        );
        check(
            capsule(1.23, Vec3::new(3.0, 0.0, 0.0)),
            cuboid,
            1,
            -0.01,
            up,
        );
        check(capsule(0.49, Vec3::X), capsule(0.0, Vec3::Z), 1, -0.01, up);
        check(
            capsule(0.49, Vec3::X),
            capsule(0.0, Vec3::new(2.0, 0.0, 0.0)),
            2,
            -0.01,
            up,
        );
        let ball = Solid::Ball {
            centre: Vec3::new(0.0, 1.24, 0.0),
            radius: 0.25,
        };
        check(ball, cuboid, 1, 0.0, up);
        check(capsule(1.73, Vec3::X), ball, 1, -0.01, up);
        // Two boxes that touch at crossing edges.
        let quarter = std::f32::consts::FRAC_PI_4;
        let beam = |axis| cube(Vec3::ZERO, Vec3::ONE).rotated(Rotation::about(axis, quarter));
        let high = beam(Vec3::X).translated(Vec3::new(0.0, 2.0 * 2.0f32.sqrt() - 0.01, 0.0));
        check(high, beam(Vec3::Z), 1, -0.01, up);
        assert!(floor.manifold(&floor, 1.0).points.is_empty());
        assert!(
            cuboid
                .manifold(&cuboid.translated(Vec3::new(0.0, 3.0, 0.0)), 0.1)
                .points
                .is_empty()
        );
    }
}
