//! Area that an edge sweeps in rest coordinates of a body, and the faces between voxels that this area
//! crosses.
//!
//! The area crosses the face between two voxels if it crosses the line segment between their centres. For
//! each axis, the lines through the voxel centres along that axis are tested, like the pixels of a rasteriser
//! that looks along the axis. The area is made of triangles that leave no gap between them, so no crossed
//! face is missed.

use crate::foundation::dim::{Dim, Point};
use glam::DVec3;
use std::collections::BTreeSet;

/// Rest position in the lattice of a body [voxels].
pub type RestPosition = DVec3;

/// Faces between voxels, each given by the voxel on its low side and its axis.
pub type Faces = BTreeSet<(Point, usize)>;

/// Adds the faces of a grid of `size` [voxels] that a quadrilateral patch crosses. The corners of the patch
/// are given in order around its outline.
pub fn add_crossed_faces<D: Dim>([a, b, c, d]: [RestPosition; 4], size: Point, faces: &mut Faces) {
    for triangle in [[a, b, c], [a, c, d]] {
        for axis in 0..D::N {
            add_faces_along(triangle, axis, size, faces);
        }
    }
}

/// Returns the area of a quadrilateral patch [voxel²].
pub fn area([a, b, c, d]: [RestPosition; 4]) -> f64 {
    let half = |u: RestPosition, v: RestPosition| {
        let square = |i: usize, j: usize| {
            let k = u[i] * v[j] - u[j] * v[i];
            k * k
        };
        0.5 * (square(0, 1) + square(1, 2) + square(2, 0)).sqrt()
    };
    half(b - a, c - a) + half(c - a, d - a)
}

/// Finds the faces that a triangle crosses, among the faces normal to `axis`, and adds them to `faces`.
fn add_faces_along(triangle: [RestPosition; 3], axis: usize, size: Point, faces: &mut Faces) {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let seen = triangle.map(|corner| [corner[u], corner[v]]);
    let double = side(seen[0], seen[1], seen[2]);
    if double == 0.0 || !double.is_finite() {
        return;
    }
    for at_u in middles(triangle.map(|corner| corner[u]), size[u]) {
        for at_v in middles(triangle.map(|corner| corner[v]), size[v]) {
            let middle = [at_u as f64 + 0.5, at_v as f64 + 0.5];
            let shares = [
                side(seen[1], seen[2], middle),
                side(seen[2], seen[0], middle),
                side(seen[0], seen[1], middle),
            ];
            // A line that meets the common edge of two triangles is counted for both, so that no face is
            // missed.
            if shares.iter().any(|share| share * double < 0.0) {
                continue;
            }
            let depth: f64 = (0..3).map(|k| shares[k] / double * triangle[k][axis]).sum();
            let mut voxel = [0; 3];
            (voxel[u], voxel[v]) = (at_u, at_v);
            voxel[axis] = (depth - 0.5).floor() as i32;
            if (0..size[axis] - 1).contains(&voxel[axis]) {
                faces.insert((voxel, axis));
            }
        }
    }
}

/// Returns a number whose sign tells on which side of the line from `a` to `b` the point is. Swapping `a` and
/// `b` changes only the sign, bit by bit, so two triangles agree about points near their common edge.
fn side(a: [f64; 2], b: [f64; 2], point: [f64; 2]) -> f64 {
    let is_forward = a <= b;
    let (low, high) = if is_forward { (a, b) } else { (b, a) };
    let turn = (high[0] - low[0]) * (point[1] - low[1]) - (high[1] - low[1]) * (point[0] - low[0]);
    if is_forward { turn } else { -turn }
}

/// Returns the range of the voxels along an axis whose centres lie between the smallest and the largest of
/// three coordinates. The range is limited to the `count` voxels of the grid.
fn middles(along: [f64; 3], count: i32) -> std::ops::RangeInclusive<i32> {
    let low = along.into_iter().fold(f64::INFINITY, f64::min);
    let high = along.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let (first, last) = ((low - 0.5).ceil() as i32, (high - 0.5).floor() as i32);
    first.max(0)..=last.min(count - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};

    #[test]
    fn flat_area_opens_exactly_the_crossed_faces() {
        let mut faces = Faces::new();
        let at = DVec3::new;
        let corners = [
            at(2.9, 0.0, 0.0),
            at(2.9, 4.0, 0.0),
            at(2.9, 4.0, 4.0),
            at(2.9, 0.0, 4.0),
        ];
        add_crossed_faces::<Dim3>(corners, [4; 3], &mut faces);
        let sixteen: Faces = (0..16).map(|k| ([2, k % 4, k / 4], 0)).collect();
        assert_eq!(faces, sixteen);
        assert!((area(corners) - 16.0).abs() < 1e-12);
    }

    #[test]
    fn area_of_small_patches_separates_the_lattice_without_gaps() {
        // A wavy swept area over 12 by 12 voxels: no closed face joins the voxels above it to those below.
        let height =
            |x: f64, z: f64| 6.0 + 2.3 * libm::sin(0.7 * x) + 1.9 * libm::cos(0.55 * z + 0.3 * x);
        let place = |i: i32, k: i32| {
            let (x, z) = (0.173 * f64::from(i) - 0.5, 0.311 * f64::from(k) - 0.5);
            DVec3::new(x, height(x, z), z)
        };
        let mut faces = Faces::new();
        for i in 0..80 {
            for k in 0..45 {
                let patch = [
                    place(i, k),
                    place(i + 1, k),
                    place(i + 1, k + 1),
                    place(i, k + 1),
                ];
                add_crossed_faces::<Dim3>(patch, [12; 3], &mut faces);
            }
        }
        let mut reached = std::collections::BTreeSet::from([[0, 0, 0]]);
        let mut next = vec![[0, 0, 0]];
        while let Some(voxel) = next.pop() {
            for axis in 0..3 {
                for far in [false, true] {
                    let mut other: Point = voxel;
                    other[axis] += if far { 1 } else { -1 };
                    let face = (if far { voxel } else { other }, axis);
                    let is_inside = other.iter().all(|k| (0..12).contains(k));
                    if is_inside && !faces.contains(&face) && reached.insert(other) {
                        next.push(other);
                    }
                }
            }
        }
        assert!(reached.len() > 300, "{} below", reached.len());
        let above = (0..12).filter(|&x| reached.contains(&[x, 11, 5])).count();
        assert_eq!(above, 0);
    }

    #[test]
    fn area_far_beyond_the_grid_is_clipped() {
        let far = 1e12;
        let corners = [
            [-far, 1.4, -far],
            [far, 1.4, -far],
            [far, 1.4, far],
            [-far, 1.4, far],
        ]
        .map(DVec3::from);
        let mut faces = Faces::new();
        add_crossed_faces::<Dim3>(corners, [3; 3], &mut faces);
        let nine: Faces = (0..9).map(|k| ([k % 3, 0, k / 3], 1)).collect();
        assert_eq!(faces, nine);
    }

    #[test]
    fn path_of_a_point_opens_the_crossed_faces_in_2d() {
        let mut faces = Faces::new();
        let (from, to) = ([0.2, 2.3], [4.1, 2.3]);
        let corners = [
            [from[0], from[1], 0.0],
            [from[0], from[1], 1.0],
            [to[0], to[1], 1.0],
            [to[0], to[1], 0.0],
        ]
        .map(DVec3::from);
        add_crossed_faces::<Dim2>(corners, [6, 4, 1], &mut faces);
        let four: Faces = (0..4).map(|x| ([x, 1, 0], 1)).collect();
        assert_eq!(faces, four);
    }
}
