//! Ray casts against shapes.

use super::Solid;
use glam::DVec3;
use glam::Vec3;

impl Solid {
    /// Casts a ray with a unit direction. Returns the distance [m] to the first intersection with the
    /// surface, from outside or inside, and the outward unit normal at this point. Returns `None` if the ray
    /// misses.
    pub fn ray(&self, from: Vec3, direction: Vec3) -> Option<(f32, Vec3)> {
        let (begin, way) = (from.as_dvec3(), direction.as_dvec3());
        let crossings: Vec<f64> = match *self {
            Self::HalfSpace { normal, offset } => {
                let normal = normal.as_dvec3();
                vec![(f64::from(offset) - normal.dot(begin)) / normal.dot(way)]
            }
            Self::Box { centre, half } => through_box((from - centre).as_dvec3(), way, half),
            Self::OrientedBox {
                centre,
                half,
                rotation,
            } => {
                let back = rotation.inverse();
                let begin = back.apply(from - centre).as_dvec3();
                through_box(begin, back.apply(direction).as_dvec3(), half)
            }
            Self::Ball { centre, radius } => through_ball(from - centre, way, radius),
            Self::Capsule {
                from: low,
                to: high,
                radius,
            } => {
                let ends = [low, high].map(|end| through_ball(from - end, way, radius));
                let side = through_side(from - low, way, high - low, radius);
                // Part of each end ball is inside the capsule. Only intersections on the surface of the
                // capsule are kept.
                let is_bare = |far: &f64| {
                    let at = (begin + way * *far).as_vec3();
                    self.distance(at).0 >= -1e-4 * radius
                };
                let ends = ends.into_iter().flatten().filter(is_bare);
                ends.chain(side).collect()
            }
        };
        let ahead = crossings
            .into_iter()
            .filter(|far| *far >= 0.0 && far.is_finite());
        let far = ahead.reduce(f64::min)?;
        let at = (begin + way * far).as_vec3();
        Some((far as f32, self.distance(at).1))
    }
}

/// Returns the distances [m] along a ray at which its line enters and leaves a box around the origin,
/// negative behind the start of the ray. Empty if the line misses the box.
fn through_box(from: DVec3, way: DVec3, half: Vec3) -> Vec<f64> {
    let (mut enters, mut leaves) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let half = f64::from(half[axis]);
        if way[axis] == 0.0 {
            if from[axis].abs() > half {
                return Vec::new();
            }
            continue;
        }
        let ends = [-half, half].map(|end| (end - from[axis]) / way[axis]);
        enters = enters.max(ends[0].min(ends[1]));
        leaves = leaves.min(ends[0].max(ends[1]));
    }
    match enters <= leaves {
        true => vec![enters, leaves],
        false => Vec::new(),
    }
}

/// Returns the distances [m] along a ray at which its line enters and leaves a ball around the origin,
/// negative behind the start of the ray. Empty if the line misses the ball.
fn through_ball(from: Vec3, way: DVec3, radius: f32) -> Vec<f64> {
    let from = from.as_dvec3();
    roots(
        1.0,
        from.dot(way),
        from.dot(from) - f64::from(radius) * f64::from(radius),
    )
}

/// Returns the distances [m] along a ray at which its line crosses the curved side of a cylinder, negative
/// behind the start of the ray. The axis of the cylinder runs from the origin to `axis`. Empty if the line
/// misses.
fn through_side(from: Vec3, way: DVec3, axis: Vec3, radius: f32) -> Vec<f64> {
    let (from, axis) = (from.as_dvec3(), axis.as_dvec3());
    let squared = axis.dot(axis);
    let across = |v: DVec3| v - axis * (v.dot(axis) / squared);
    let (begin, step) = (across(from), across(way));
    let far = roots(
        step.dot(step),
        begin.dot(step),
        begin.dot(begin) - f64::from(radius) * f64::from(radius),
    );
    let is_between = |far: &f64| {
        let along = (from + way * *far).dot(axis) / squared;
        (0.0..=1.0).contains(&along)
    };
    far.into_iter().filter(is_between).collect()
}

/// Returns the real roots of a x² + 2 b x + c = 0; empty unless a is positive.
fn roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let under = b * b - a * c;
    match under >= 0.0 && a > 0.0 {
        true => [-1.0, 1.0]
            .map(|sign| (sign * under.sqrt() - b) / a)
            .to_vec(),
        false => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rotation::Rotation;

    #[test]
    fn ray_hits_every_shape_from_outside_and_inside() {
        let shapes = [
            Solid::half_space(Vec3::Y, Vec3::new(0.0, -0.3, 0.0)),
            Solid::Box {
                centre: Vec3::new(0.1, 0.0, 0.0),
                half: Vec3::new(0.5, 0.3, 0.7),
            },
            Solid::Box {
                centre: Vec3::new(0.0, 0.1, 0.0),
                half: Vec3::new(0.5, 0.3, 0.7),
            }
            .rotated(Rotation::about(Vec3::new(1.0, 2.0, 3.0), 0.8)),
            Solid::Ball {
                centre: Vec3::new(0.1, 0.2, 0.0),
                radius: 0.6,
            },
            Solid::Capsule {
                from: Vec3::new(-0.5, 0.0, 0.1),
                to: Vec3::new(0.6, 0.2, 0.0),
                radius: 0.25,
            },
        ];
        let (mut met, mut missed) = (0, 0);
        for shape in shapes {
            for k in 0..400 {
                let number = |step: i32| (k * step % 199) as f32 / 99.5 - 1.0;
                let from = Vec3::new(2.0 * number(7), 2.0 * number(31), 2.0 * number(57));
                let way = Vec3::new(number(3), number(5), number(11)) * 0.5 - from;
                let way = way * (1.0 / way.length());
                let at = |far: f32| shape.distance(from + way * far);
                let begins_inside = at(0.0).0 < 0.0;
                let Some((far, normal)) = shape.ray(from, way) else {
                    // A ray that misses never crosses the surface, so all its points are on one side of the
                    // surface, inside or outside.
                    assert!((0..400).all(|step| (at(0.02 * step as f32).0 < 0.0) == begins_inside));
                    missed += 1;
                    continue;
                };
                assert!(at(far).0.abs() < 1e-4, "{shape:?} {from:?} {way:?}: {far}");
                let before = (0..50).map(|step| at(0.0199 * far * step as f32).0);
                assert!({ before }.all(|gap| (gap < 1e-4) == begins_inside || gap.abs() < 1e-3));
                let out = normal.dot(way);
                assert!(
                    (out > -1e-3) == begins_inside || out.abs() < 1e-2,
                    "{shape:?} {out}"
                );
                met += 1;
            }
        }
        assert!(met > 1100 && missed > 100, "{met} {missed}");
        // Rays that start far away, and a ray that meets the floor at a small angle.
        let floor = Solid::half_space(Vec3::Y, Vec3::ZERO);
        assert_eq!(
            floor
                .ray(Vec3::new(0.0, 1000.0, 0.0), Vec3::NEG_Y)
                .unwrap()
                .0,
            1000.0
        );
        let (far, _) = floor.ray(Vec3::Y, Vec3::new(0.9998, -0.02, 0.0)).unwrap();
        assert!((far - 50.0).abs() < 1e-3);
        let ball = Solid::Ball {
            centre: Vec3::new(3000.0, 0.0, 0.0),
            radius: 0.5,
        };
        assert!((ball.ray(Vec3::ZERO, Vec3::X).unwrap().0 - 2999.5).abs() < 1e-3);
    }
}
