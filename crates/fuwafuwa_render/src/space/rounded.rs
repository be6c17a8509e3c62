//! One mesh for everything that is rigid: a ball that can be drawn out into capsules and boxes.
//!
//! ```text
//!   ╭─╮      ╭┬───┬╮      Each eighth of the ball has vertices of its own, which move away from the
//!   │┼│  →   ├┼───┼┤      middle together; between them are faces that have no area in a ball.
//!   ╰─╯      ╰┴───┴╯
//! ```

use bytemuck::{Pod, Zeroable};
use fuwafuwa::vector::{cross, length, minus, plus, scaled};
use fuwafuwa::{Shape, Vector};

/// How round the edges of boxes are [m], if they are that large.
const EDGE: f32 = 0.02;

/// A corner of the mesh.
#[repr(C)]
#[derive(Copy, Clone, Debug, PartialEq, Pod, Zeroable)]
pub struct RoundedVertex {
    /// Outwards, of length 1.
    pub normal: Vector,
    /// Which eighth it belongs to: −1 or 1 along each axis.
    pub eighth: Vector,
}

/// A ball, a capsule or a box with round edges, to be drawn.
#[repr(C)]
#[derive(Copy, Clone, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RoundedInstance {
    /// Its middle [m].
    pub centre: Vector,
    /// Of its edges, in lengths of its axes.
    pub radius: f32,
    /// Its axes [m].
    pub axes: [Vector; 3],
    /// How far the middles of its round edges are from its middle, in lengths of its axes.
    pub half: Vector,
    /// Red, green, blue, opacity.
    pub colour: [f32; 4],
    /// Which player's hand it is, how far a basket is filled, or what makes a crumb differ from
    /// others.
    pub number: f32,
}

/// The mesh, each eighth in `fine` × `fine` faces three times; triangles as indices.
pub fn mesh(fine: usize) -> (Vec<RoundedVertex>, Vec<u32>) {
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    let side = 2 * (fine + 1);
    // From −1 to 1, the middle twice.
    let along = |k: usize| match k > fine {
        false => (k as f32 / fine as f32 - 1.0, -1.0),
        true => ((k - fine - 1) as f32 / fine as f32, 1.0),
    };
    for face in 0..6 {
        let axis = face / 2;
        let end = if face % 2 == 1 { 1.0 } else { -1.0 };
        // The other two axes, so that triangles turn around the outward normal.
        let (u, v) = match face % 2 {
            1 => ((axis + 1) % 3, (axis + 2) % 3),
            _ => ((axis + 2) % 3, (axis + 1) % 3),
        };
        let first = vertices.len();
        for j in 0..side {
            for i in 0..side {
                let ((x, left), (y, low)) = (along(i), along(j));
                let (mut normal, mut eighth) = ([0.0; 3], [0.0; 3]);
                (normal[axis], normal[u], normal[v]) = (end, bent(x), bent(y));
                (eighth[axis], eighth[u], eighth[v]) = (end, left, low);
                let normal = scaled(normal, 1.0 / length(normal));
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

/// Spreads places on the side of a cube so that they are about as far apart on the ball.
fn bent(k: f32) -> f32 {
    (k * std::f32::consts::FRAC_PI_4).tan()
}

impl RoundedInstance {
    /// A shape that ends somewhere.
    pub fn of(shape: Shape, [red, green, blue]: crate::Colour, number: f32) -> Option<Self> {
        let plain = Self {
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
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
                let radius = half.into_iter().fold(EDGE, f32::min);
                Some(Self {
                    centre,
                    radius,
                    half: half.map(|k| k - radius),
                    ..plain
                })
            }
            Shape::Capsule { from, to, radius } => Some(Self {
                centre: scaled(plus(from, to), 0.5),
                radius,
                axes: frame_along(minus(to, from)),
                half: [0.5 * length(minus(to, from)), 0.0, 0.0],
                ..plain
            }),
        }
    }
}

/// Three axes square to each other, of length 1, the first of them along a direction.
fn frame_along(direction: Vector) -> [Vector; 3] {
    let long = length(direction);
    if long < 1e-9 {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    }
    let first = scaled(direction, 1.0 / long);
    let aside = match first[1].abs() < 0.9 {
        true => [0.0, 1.0, 0.0],
        false => [0.0, 0.0, 1.0],
    };
    let third = cross(first, aside);
    let third = scaled(third, 1.0 / length(third));
    [first, cross(third, first), third]
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::vector::dot;

    /// What the mesh encloses when it is drawn out to an instance.
    fn volume(instance: &RoundedInstance) -> f32 {
        let (vertices, indices) = mesh(8);
        let place = |index: u32| {
            let vertex = vertices[index as usize];
            (0..3).fold(instance.centre, |at, k| {
                let by = vertex.eighth[k] * instance.half[k] + instance.radius * vertex.normal[k];
                plus(at, scaled(instance.axes[k], by))
            })
        };
        let triangles = indices
            .chunks(3)
            .map(|t| [place(t[0]), place(t[1]), place(t[2])]);
        triangles.map(|[a, b, c]| dot(a, cross(b, c))).sum::<f32>() / 6.0
    }

    #[test]
    fn shapes_have_their_volume() {
        let pi = std::f32::consts::PI;
        let (centre, radius) = ([1.0, 2.0, -1.0], 0.5);
        let ball = Shape::Ball { centre, radius };
        let capsule = Shape::Capsule {
            from: [0.0; 3],
            to: [0.6, 1.0, 0.3],
            radius,
        };
        let long = length([0.6, 1.0, 0.3]);
        let half = [0.5, 1.0, 0.25];
        let round = 4.0 / 3.0 * pi * 0.125;
        for (shape, expected) in [
            (ball, round),
            (capsule, round + pi * 0.25 * long),
            (Shape::Box { centre, half }, 1.0),
        ] {
            let instance = RoundedInstance::of(shape, [1.0; 3], 0.0).unwrap();
            let found = volume(&instance);
            assert!((found / expected - 1.0).abs() < 0.015, "{shape:?}: {found}");
        }
        let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
        assert_eq!(RoundedInstance::of(floor, [1.0; 3], 0.0), None);
    }
}
