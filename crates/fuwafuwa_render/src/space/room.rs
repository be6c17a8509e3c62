//! The room: where half-spaces end, as flat pieces of floor and walls.

use bytemuck::{Pod, Zeroable};
use fuwafuwa::vector::{cross, dot, length, minus, plus, scaled};
use fuwafuwa::{Shape, Vector};

/// A corner of a triangle of the room.
#[repr(C)]
#[derive(Copy, Clone, Debug, PartialEq, Pod, Zeroable)]
pub struct RoomVertex {
    /// Where [m].
    pub at: Vector,
    /// Out of the wall, of length 1.
    pub normal: Vector,
}

/// Adds the triangles of all planes, each given by its outward normal and its offset [m], as far as no
/// other hides them and not much farther than `reach` [m] from a middle.
pub fn add_planes(
    triangles: &mut Vec<RoomVertex>,
    planes: &[[f32; 4]],
    middle: Vector,
    reach: f32,
) {
    for (own, plane) in planes.iter().enumerate() {
        let mut polygon = sheet(plane, middle, reach);
        for (_, other) in planes.iter().enumerate().filter(|&(k, _)| k != own) {
            polygon = clipped(&polygon, other);
        }
        let normal = [plane[0], plane[1], plane[2]];
        for k in 2..polygon.len() {
            let corners = [polygon[0], polygon[k - 1], polygon[k]];
            triangles.extend(corners.map(|at| RoomVertex { at, normal }));
        }
    }
}

/// The outward normal and the offset of a half-space; nothing for what ends somewhere.
pub fn plane(shape: &Shape) -> Option<[f32; 4]> {
    match *shape {
        Shape::HalfSpace { normal, offset } => Some([normal[0], normal[1], normal[2], offset]),
        _ => None,
    }
}

/// How far outside a plane a place is [m].
fn above([x, y, z, offset]: &[f32; 4], at: Vector) -> f32 {
    dot([*x, *y, *z], at) - offset
}

/// A large square of a plane, counterclockwise seen from outside.
fn sheet(plane: &[f32; 4], middle: Vector, reach: f32) -> Vec<Vector> {
    let normal = [plane[0], plane[1], plane[2]];
    let foot = minus(middle, scaled(normal, above(plane, middle)));
    let aside = match normal[1].abs() < 0.9 {
        true => [0.0, 1.0, 0.0],
        false => [0.0, 0.0, 1.0],
    };
    let along = cross(aside, normal);
    let along = scaled(along, reach / length(along));
    let across = cross(normal, along);
    let corner = |x: f32, y: f32| plus(foot, plus(scaled(along, x), scaled(across, y)));
    vec![
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ]
}

/// What of a polygon is outside a plane.
fn clipped(polygon: &[Vector], plane: &[f32; 4]) -> Vec<Vector> {
    let mut rest = Vec::new();
    for (k, &to) in polygon.iter().enumerate() {
        let from = polygon[(k + polygon.len() - 1) % polygon.len()];
        let (before, after) = (above(plane, from), above(plane, to));
        if (before < 0.0) != (after < 0.0) {
            let share = before / (before - after);
            rest.push(plus(from, scaled(minus(to, from), share)));
        }
        if after >= 0.0 {
            rest.push(to);
        }
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_planes_make_a_room_without_a_lid() {
        let planes = [
            [0.0, 1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0, -1.0],
            [-1.0, 0.0, 0.0, -1.0],
            [0.0, 0.0, 1.0, -2.0],
            [0.0, 0.0, -1.0, -2.0],
        ];
        let mut triangles = Vec::new();
        add_planes(&mut triangles, &planes, [0.0, 0.5, 0.0], 3.0);
        let mut floor = 0.0;
        for corners in triangles.chunks(3) {
            let [a, b, c] = [corners[0].at, corners[1].at, corners[2].at];
            let area = scaled(cross(minus(b, a), minus(c, a)), 0.5);
            assert!(dot(area, corners[0].normal) >= 0.0, "it faces inwards");
            for corner in corners {
                assert!(planes.iter().all(|plane| above(plane, corner.at) > -1e-5));
            }
            floor += area[1];
        }
        assert!((floor - 8.0).abs() < 1e-4, "{floor}");
    }
}
