//! Geometric primitives of queries: intersections, nearest points and containment for segments, triangles and
//! deformed cells.

use crate::foundation::dim::{Dim, corner};
use crate::rigid_body::solid::flat;
use glam::Vec3;

/// Number of Newton iterations that find the local coordinates of a point in a deformed cell. 6 iterations
/// suffice if corners are displaced at random by up to 0.6 of the cell's width; 12 are a safety factor of 2.
const NEWTON_STEPS: usize = 12;
/// Relative tolerance at the borders of segments, triangles and cells, so that rounding leaves no gap between
/// neighbours. At 16 m from the origin, it equals the rounding error of single precision for a voxel of 1 cm.
const TOLERANCE: f32 = 1e-4;

/// Returns the distance along a ray to a segment in 2D, as a multiple of the length of `direction`. Returns
/// `None` if the ray misses the segment.
pub fn ray_meets_segment(from: Vec3, direction: Vec3, [a, b]: [Vec3; 2]) -> Option<f32> {
    let flat = |a: Vec3, b: Vec3| a[0] * b[1] - a[1] * b[0];
    let (along, reach) = (b - a, a - from);
    let across = flat(direction, along);
    let (far, share) = (flat(reach, along) / across, flat(reach, direction) / across);
    // For parallel lines, `far` and `share` are infinite or NaN, so the result is `None`.
    let is_in = (-TOLERANCE..=1.0 + TOLERANCE).contains(&share);
    (is_in && far >= 0.0 && far.is_finite()).then_some(far)
}

/// Returns the distance along a ray to a triangle, as a multiple of the length of `direction` [Möller 1997].
/// Returns `None` if the ray misses the triangle.
pub fn ray_meets_triangle(from: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (one, two, reach) = (b - a, c - a, from - a);
    let across = direction.cross(two);
    let determinant = one.dot(across);
    let u = reach.dot(across) / determinant;
    let beside = reach.cross(one);
    let v = direction.dot(beside) / determinant;
    let far = two.dot(beside) / determinant;
    let is_in = u >= -TOLERANCE && v >= -TOLERANCE && u + v <= 1.0 + TOLERANCE;
    (is_in && far >= 0.0 && far.is_finite()).then_some(far)
}

/// Returns the nearest point on a segment.
pub fn nearest_on_segment(at: Vec3, [a, b]: [Vec3; 2]) -> Vec3 {
    let along = b - a;
    let share = (at - a).dot(along) / along.dot(along).max(f32::MIN_POSITIVE);
    a + along * share.clamp(0.0, 1.0)
}

/// Returns the nearest point on a triangle: the projection if it is inside, otherwise the nearest point of an
/// edge.
pub fn nearest_on_triangle(at: Vec3, [a, b, c]: [Vec3; 3]) -> Vec3 {
    let normal = (b - a).cross(c - a);
    let squared = normal.dot(normal);
    let is_left = |from: Vec3, to: Vec3| (to - from).cross(at - from).dot(normal) >= 0.0;
    if squared > 0.0 && is_left(a, b) && is_left(b, c) && is_left(c, a) {
        let height = (at - a).dot(normal) / squared;
        return at - normal * height;
    }
    let edges = [[a, b], [b, c], [c, a]].map(|edge| nearest_on_segment(at, edge));
    let squared = |place: &Vec3| {
        let apart = *place - at;
        apart.dot(apart)
    };
    let [first, others @ ..] = edges;
    let nearer = |best: Vec3, next: Vec3| match squared(&next) < squared(&best) {
        true => next,
        false => best,
    };
    others.into_iter().fold(first, nearer)
}

/// Returns whether a point is in a deformed cell with corners in the order of [`corner`]. It is inside if
/// multilinear interpolation of the corners yields the point at local coordinates from 0 to 1.
pub fn is_in_cell<D: Dim>(at: Vec3, corners: &[Vec3]) -> bool {
    // Moves the origin to the point, because absolute coordinates lose precision far from the world's origin.
    let corners: Vec<Vec3> = corners.iter().map(|&corner| corner - at).collect();
    let mut shares = flat::<D>(Vec3::splat(0.5));
    for _ in 0..NEWTON_STEPS {
        let (place, slopes) = interpolate::<D>(shares, &corners);
        let Some(step) = solved(slopes, -place) else {
            return false;
        };
        shares += step;
        if !shares.to_array().iter().all(|share| share.abs() < 10.0) {
            return false;
        }
    }
    let (miss, _) = interpolate::<D>(shares, &corners);
    let width = corners[D::CORNERS - 1] - corners[0];
    let is_there = miss.dot(miss) <= TOLERANCE * TOLERANCE * width.dot(width);
    is_there
        && shares.to_array()[..D::N]
            .iter()
            .all(|share| (-TOLERANCE..=1.0 + TOLERANCE).contains(share))
}

/// Interpolates the corners of a deformed cell at local coordinates. Returns the interpolated point and its
/// derivative by each local coordinate.
fn interpolate<D: Dim>(shares: Vec3, corners: &[Vec3]) -> (Vec3, [Vec3; 3]) {
    let mut place = Vec3::ZERO;
    let mut slopes = Vec3::AXES;
    slopes[..D::N].fill(Vec3::ZERO);
    for (index, &at) in corners.iter().enumerate() {
        let ends = corner(index);
        let weight = |axis: usize| match ends[axis] {
            0 => 1.0 - shares[axis],
            _ => shares[axis],
        };
        // In 2D, all corners have the same third coordinate, so the weight along the third axis is 1.
        let weights = [0, 1, 2].map(|axis| if axis < D::N { weight(axis) } else { 1.0 });
        place += at * weights.iter().product::<f32>();
        for axis in 0..D::N {
            let others = (0..3).filter(|&other| other != axis);
            let others: f32 = others.map(|other| weights[other]).product();
            let sign = 2.0 * ends[axis] as f32 - 1.0;
            slopes[axis] += at * (sign * others);
        }
    }
    (place, slopes)
}

/// Returns the solution x of the 3×3 system with columns `a`, `b`, `c`, or `None` if it is singular.
fn solved([a, b, c]: [Vec3; 3], wanted: Vec3) -> Option<Vec3> {
    let determinant = a.dot(b.cross(c));
    let parts = [b.cross(c), c.cross(a), a.cross(b)];
    let found = Vec3::from(parts.map(|part| wanted.dot(part))) / determinant;
    found.is_finite().then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};

    const TRIANGLE: [Vec3; 3] = [Vec3::Z, Vec3::new(2.0, 0.0, 1.0), Vec3::new(0.0, 2.0, 1.0)];

    #[test]
    fn ray_hits_only_in_front_of_its_origin() {
        let up = Vec3::new(0.0, 0.0, 2.0);
        assert_eq!(
            ray_meets_triangle(Vec3::new(0.5, 0.5, 0.0), up, TRIANGLE),
            Some(0.5)
        );
        assert_eq!(
            ray_meets_triangle(Vec3::new(0.5, 0.5, 2.0), up, TRIANGLE),
            None
        );
        assert_eq!(
            ray_meets_triangle(Vec3::new(1.5, 1.5, 0.0), up, TRIANGLE),
            None
        );
        assert_eq!(
            ray_meets_triangle(Vec3::new(0.5, 0.5, 0.0), Vec3::X, TRIANGLE),
            None
        );
        let wall = [Vec3::new(1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 0.0)];
        assert_eq!(
            ray_meets_segment(Vec3::ZERO, Vec3::new(0.5, 0.0, 0.0), wall),
            Some(2.0)
        );
        assert_eq!(ray_meets_segment(Vec3::ZERO, Vec3::Y, wall), None);
        assert_eq!(
            ray_meets_segment(Vec3::new(0.0, 3.0, 0.0), Vec3::new(0.5, 0.0, 0.0), wall),
            None
        );
    }

    #[test]
    fn nearest_point_on_triangle_is_inside_on_edge_or_at_corner() {
        let check = |at, expect| assert_eq!(nearest_on_triangle(at, TRIANGLE), expect);
        check(Vec3::new(0.5, 0.5, 3.0), Vec3::new(0.5, 0.5, 1.0));
        check(Vec3::new(1.0, -4.0, 0.0), Vec3::new(1.0, 0.0, 1.0));
        check(Vec3::new(2.0, 2.0, 1.0), Vec3::new(1.0, 1.0, 1.0));
        check(Vec3::new(-1.0, -1.0, 0.0), Vec3::Z);
    }

    #[test]
    fn is_in_block_is_exact_for_deformed_blocks() {
        let crooked = |at: [i32; 3]| {
            let [x, y, z] = at.map(|k| k as f32);
            Vec3::new(x + 0.2 * y, 1.5 * y - 0.1 * x * z, z + 0.3 * x * y)
        };
        let corners: Vec<Vec3> = (0..8).map(|index| crooked(corner(index))).collect();
        let (inside, _) = interpolate::<Dim3>(Vec3::new(0.9, 0.1, 0.5), &corners);
        let (outside, _) = interpolate::<Dim3>(Vec3::new(0.9, 1.1, 0.5), &corners);
        assert!(is_in_cell::<Dim3>(inside, &corners));
        assert!(!is_in_cell::<Dim3>(outside, &corners));
        let flat: Vec<Vec3> = corners[..4].iter().map(|at| at.with_z(0.0)).collect();
        assert!(is_in_cell::<Dim2>(Vec3::new(0.6, 0.7, 0.0), &flat));
        assert!(!is_in_cell::<Dim2>(Vec3::new(0.05, 0.9, 0.0), &flat));
        assert!(!is_in_cell::<Dim2>(Vec3::splat(f32::NAN), &flat));
    }
}
