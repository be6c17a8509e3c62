//! The room: boundary planes of half-spaces as polygons of floor and walls.

use bytemuck::{Pod, Zeroable};
use fuwafuwa::{Dim3, Shape};
use glam::{Vec3, Vec4};

/// Vertex of the room.
#[repr(C)]
#[derive(Copy, Clone, Debug, PartialEq, Pod, Zeroable)]
pub struct RoomVertex {
    /// Position [m].
    pub at: Vec3,
    /// Outward unit normal of the wall.
    pub normal: Vec3,
}

/// Adds the triangles of all planes, each given by its outward normal and offset [m]. Each plane is clipped
/// by the other half-spaces and limited to a square around `middle` with half extent `reach` [m].
pub fn add_planes(triangles: &mut Vec<RoomVertex>, planes: &[[f32; 4]], middle: Vec3, reach: f32) {
    for (own, plane) in planes.iter().enumerate() {
        let mut polygon = sheet(plane, middle, reach);
        for (_, other) in planes.iter().enumerate().filter(|&(k, _)| k != own) {
            polygon = clipped(&polygon, other);
        }
        let normal = normal(plane);
        for k in 2..polygon.len() {
            let corners = [polygon[0], polygon[k - 1], polygon[k]];
            triangles.extend(corners.map(|at| RoomVertex { at, normal }));
        }
    }
}

/// Returns the outward normal and offset of a half-space, or `None` for bounded shapes.
pub fn plane(shape: &Shape<Dim3>) -> Option<[f32; 4]> {
    match *shape {
        Shape::HalfSpace { normal, offset } => Some(normal.extend(offset).to_array()),
        _ => None,
    }
}

/// Returns the signed distance of a point from a plane [m], positive outside the half-space.
fn above(plane: &[f32; 4], at: Vec3) -> f32 {
    normal(plane).dot(at) - plane[3]
}

fn normal(plane: &[f32; 4]) -> Vec3 {
    Vec4::from(*plane).truncate()
}

/// Returns a square of a plane with half extent `reach` [m], counterclockwise seen from outside. Its centre
/// is the projection of `middle`.
fn sheet(plane: &[f32; 4], middle: Vec3, reach: f32) -> Vec<Vec3> {
    let normal = normal(plane);
    let foot = middle - above(plane, middle) * normal;
    let aside = if normal.y.abs() < 0.9 {
        Vec3::Y
    } else {
        Vec3::Z
    };
    let along = reach * aside.cross(normal).normalize();
    let across = normal.cross(along);
    let corner = |x: f32, y: f32| foot + x * along + y * across;
    vec![
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ]
}

/// Returns the part of a polygon outside a half-space.
fn clipped(polygon: &[Vec3], plane: &[f32; 4]) -> Vec<Vec3> {
    let mut rest = Vec::new();
    for (k, &to) in polygon.iter().enumerate() {
        let from = polygon[(k + polygon.len() - 1) % polygon.len()];
        let (before, after) = (above(plane, from), above(plane, to));
        if (before < 0.0) != (after < 0.0) {
            rest.push(from.lerp(to, before / (before - after)));
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
    fn five_planes_form_an_open_room() {
        let planes = [
            [0.0, 1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0, -1.0],
            [-1.0, 0.0, 0.0, -1.0],
            [0.0, 0.0, 1.0, -2.0],
            [0.0, 0.0, -1.0, -2.0],
        ];
        let mut triangles = Vec::new();
        add_planes(&mut triangles, &planes, 0.5 * Vec3::Y, 3.0);
        let mut floor = 0.0;
        for corners in triangles.chunks(3) {
            let [a, b, c] = [corners[0].at, corners[1].at, corners[2].at];
            let area = 0.5 * (b - a).cross(c - a);
            assert!(
                area.dot(corners[0].normal) >= 0.0,
                "a triangle faces into the wall"
            );
            for corner in corners {
                assert!(planes.iter().all(|plane| above(plane, corner.at) > -1e-5));
            }
            floor += area.y;
        }
        assert!((floor - 8.0).abs() < 1e-4, "{floor}");
    }
}
