//! One mesh for all bounded rigid shapes: a ball that can be stretched into capsules and boxes.
//!
//! ```text
//!   ╭─╮      ╭┬───┬╮      Each octant of the ball has its own vertices, which move away from
//!   │┼│  →   ├┼───┼┤      the centre together. The faces between octants have no area in a ball.
//!   ╰─╯      ╰┴───┴╯
//! ```

use bytemuck::{Pod, Zeroable};
use fuwafuwa::{Dim3, Shape};
use glam::{Mat3, Vec3};

/// Edge radius of boxes [m], at most the smallest half extent.
const EDGE: f32 = 0.02;

/// Vertex of the mesh.
#[repr(C)]
#[derive(Copy, Clone, Debug, PartialEq, Pod, Zeroable)]
pub struct RoundedVertex {
    /// Outward unit normal.
    pub normal: Vec3,
    /// Octant of the vertex: −1 or 1 along each axis.
    pub eighth: Vec3,
}

/// Instance of a ball, a capsule or a box with rounded edges.
#[repr(C)]
#[derive(Copy, Clone, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RoundedInstance {
    /// Centre [m].
    pub centre: Vec3,
    /// Radius of the rounded edges [lengths of `axes`].
    pub radius: f32,
    /// Axes [m].
    pub axes: Mat3,
    /// Half extents between the centres of opposite rounded edges [lengths of `axes`].
    pub half: Vec3,
    /// Red, green, blue, opacity.
    pub colour: [f32; 4],
    /// Player number of a hand, fill level of a basket, variation seed of a crumb, or 1 for a bar that is a curtain.
    pub number: f32,
}

/// Returns vertices and triangle indices of the mesh, with 3 · `fine` × `fine` quads per octant.
pub fn mesh(fine: usize) -> (Vec<RoundedVertex>, Vec<u32>) {
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    let side = 2 * (fine + 1);
    // Parameters from −1 to 1 along an edge. The parameter 0 occurs twice, because octants do not share
    // vertices.
    let along = |k: usize| match k > fine {
        false => (k as f32 / fine as f32 - 1.0, -1.0),
        true => ((k - fine - 1) as f32 / fine as f32, 1.0),
    };
    for face in 0..6 {
        let axis = face / 2;
        let end = if face % 2 == 1 { 1.0 } else { -1.0 };
        // The two axes in the plane of the face, ordered so that triangles turn around the outward normal.
        let (u, v) = match face % 2 {
            1 => ((axis + 1) % 3, (axis + 2) % 3),
            _ => ((axis + 2) % 3, (axis + 1) % 3),
        };
        let first = vertices.len();
        for j in 0..side {
            for i in 0..side {
                let ((x, left), (y, low)) = (along(i), along(j));
                let (mut normal, mut eighth) = (Vec3::ZERO, Vec3::ZERO);
                (normal[axis], normal[u], normal[v]) = (end, bent(x), bent(y));
                (eighth[axis], eighth[u], eighth[v]) = (end, left, low);
                let normal = normal.normalize();
                vertices.push(RoundedVertex { normal, eighth });
            }
        }
        for j in 0..side - 1 {
            for i in 0..side - 1 {
                let corner = |i: usize, j: usize| (first + j * side + i) as u32;
                let [a, b] = [corner(i, j), corner(i + 1, j)];
                let [c, d] = [corner(i + 1, j + 1), corner(i, j + 1)];
                indices.extend([a, b, c, a, c, d]);
            }
        }
    }
    (vertices, indices)
}

/// Maps a coordinate on a cube face so that points are about equally spaced on the ball.
fn bent(k: f32) -> f32 {
    (k * std::f32::consts::FRAC_PI_4).tan()
}

impl RoundedInstance {
    /// Returns the instance of a bounded shape, or `None` for a half-space.
    pub fn of(shape: Shape<Dim3>, [red, green, blue]: crate::Colour, number: f32) -> Option<Self> {
        let plain = Self {
            colour: [red, green, blue, 1.0],
            number,
            ..Self::default()
        };
        match shape {
            Shape::HalfSpace { .. } => None,
            Shape::Ball { centre, radius } => Some(Self {
                centre,
                radius,
                ..plain
            }),
            Shape::Box { centre, half } => {
                let radius = half.min_element().min(EDGE);
                Some(Self {
                    centre,
                    radius,
                    half: half - radius,
                    ..plain
                })
            }
            Shape::OrientedBox {
                centre,
                half,
                rotation,
            } => Self::of(Shape::Box { centre, half }, [red, green, blue], number).map(|upright| {
                let [x, y, z] = rotation.axes();
                Self {
                    axes: Mat3::from_cols(x, y, z),
                    ..upright
                }
            }),
            Shape::Capsule { from, to, radius } => Some(Self {
                centre: from.midpoint(to),
                radius,
                axes: frame_along(to - from),
                half: Vec3::X * 0.5 * from.distance(to),
                ..plain
            }),
        }
    }
}

/// Returns orthonormal axes, the first of them along a direction.
fn frame_along(direction: Vec3) -> Mat3 {
    let first = direction.try_normalize().unwrap_or(Vec3::X);
    let aside = if first.y.abs() < 0.9 {
        Vec3::Y
    } else {
        Vec3::Z
    };
    let third = first.cross(aside).normalize();
    Mat3::from_cols(first, third.cross(first), third)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::Rotation;

    /// Returns the volume of the mesh after stretching it to an instance.
    fn volume(instance: &RoundedInstance) -> f32 {
        let (vertices, indices) = mesh(8);
        let place = |index: u32| {
            let vertex = vertices[index as usize];
            let by = vertex.eighth * instance.half + instance.radius * vertex.normal;
            instance.centre + instance.axes * by
        };
        let triangles = indices
            .chunks(3)
            .map(|t| [place(t[0]), place(t[1]), place(t[2])]);
        triangles
            .map(|[a, b, c]: [Vec3; 3]| a.dot(b.cross(c)))
            .sum::<f32>()
            / 6.0
    }

    #[test]
    fn mesh_has_the_volume_of_each_shape() {
        let pi = std::f32::consts::PI;
        let centre = Vec3::new(1.0, 2.0, -1.0);
        let along = Vec3::new(0.6, 1.0, 0.3);
        let round = 4.0 / 3.0 * pi * 0.125;
        let upright = Shape::cuboid(Vec3::new(0.5, 1.0, 0.25)).translated(centre);
        let turned = Rotation::about(Vec3::new(1.0, 2.0, 3.0), 0.7);
        for (shape, expected) in [
            (Shape::ball(0.5).translated(centre), round),
            (
                Shape::capsule(Vec3::ZERO, along, 0.5),
                round + pi * 0.25 * along.length(),
            ),
            (upright, 1.0),
            (upright.rotated(turned), 1.0),
        ] {
            let instance = RoundedInstance::of(shape, [1.0; 3], 0.0).unwrap();
            let found = volume(&instance);
            assert!((found / expected - 1.0).abs() < 0.015, "{shape:?}: {found}");
        }
        let floor = Shape::half_space(Vec3::Y, Vec3::ZERO);
        assert_eq!(RoundedInstance::of(floor, [1.0; 3], 0.0), None);
    }
}
