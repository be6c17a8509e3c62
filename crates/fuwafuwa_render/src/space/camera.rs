//! From where a world in space is seen. Up is the second axis.

use fuwafuwa::Vector;
use fuwafuwa::vector::{cross, dot, length, minus, plus, scaled};

/// A matrix by columns, as shaders have them.
pub(crate) type Matrix = [[f32; 4]; 4];

/// A camera that goes around what it looks at.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Camera {
    /// What is in the middle [m].
    pub target: Vector,
    /// How far away it is [m].
    pub distance: f32,
    /// By how much it went around to the right, seen from above [rad]; at 0 it looks against the
    /// third axis.
    pub turn: f32,
    /// By how much it went up [rad]; a right angle looks straight down.
    pub rise: f32,
    /// The angle that is seen from bottom to top [rad]. 0.6 looks at toys; more than 1 distorts.
    pub field: f32,
    /// By how much it is shaken out of place [m].
    pub shake: Vector,
    /// In the element view, what is left out of bodies, so that one looks into them.
    pub cut: Option<Cut>,
}

/// Pieces that are cut open, each along the plane of its own grid that faces a direction most: so elements stay whole,
/// and what was cut stays so while a body rolls and trembles.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Cut {
    /// Where what is left out would be, of length 1.
    pub towards: Vector,
    /// How much of a piece is left, 0 to 1.
    pub share: f32,
}

/// What is nearer than this share of the distance is not seen.
const NEAR: f32 = 0.1;
/// What is farther than so many distances is not seen.
const FAR: f32 = 12.0;

impl Camera {
    /// The camera that sees a box between two corners [m] from the front, a little from above, in a
    /// target of `size` pixels.
    pub fn fit(low: Vector, high: Vector, size: [u32; 2]) -> Self {
        let field = 0.6f32;
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        // The ball around the box fits into the narrower of the two angles.
        let across = (0.5 * field).tan() * aspect.min(1.0);
        let radius = 0.5 * length(minus(high, low));
        Self {
            target: scaled(plus(low, high), 0.5),
            distance: radius / across.atan().sin(),
            turn: 0.0,
            rise: 0.45,
            field,
            shake: [0.0; 3],
            cut: None,
        }
    }

    /// Where it is [m].
    pub fn eye(&self) -> Vector {
        let [_, _, back] = self.axes();
        plus(plus(self.target, self.shake), scaled(back, self.distance))
    }

    /// What is to its right, what is up for it, and what is behind it; of length 1.
    pub fn axes(&self) -> [Vector; 3] {
        let ((sin, cos), (up, out)) = (self.turn.sin_cos(), self.rise.sin_cos());
        let back = [sin * out, up, cos * out];
        let right = [cos, 0.0, -sin];
        [right, cross(back, right), back]
    }

    /// Where a place [m] is in a target of `size` pixels, from its upper left corner; none when it is
    /// behind the camera.
    pub fn to_pixel(&self, at: Vector, size: [u32; 2]) -> Option<[f32; 2]> {
        let by = minus(at, self.eye());
        let [x, y, z] = self.axes().map(|axis| dot(axis, by));
        let scale = 0.5 * size[1] as f32 / (0.5 * self.field).tan();
        let [left, top] = size.map(|side| 0.5 * side as f32);
        (z < 0.0).then(|| [left - x / z * scale, top + y / z * scale])
    }

    /// Where the ray through a pixel of a target of `size` pixels begins [m], and its direction, of
    /// length 1.
    pub fn ray(&self, pixel: [f32; 2], size: [u32; 2]) -> (Vector, Vector) {
        let [right, up, back] = self.axes();
        let scale = 2.0 * (0.5 * self.field).tan() / size[1].max(1) as f32;
        let across = scaled(right, (pixel[0] - 0.5 * size[0] as f32) * scale);
        let along = scaled(up, (0.5 * size[1] as f32 - pixel[1]) * scale);
        let towards = minus(plus(across, along), back);
        (self.eye(), scaled(towards, 1.0 / length(towards)))
    }

    /// From metres to the coordinates of a target of `size` pixels that shaders want.
    pub(crate) fn to_clip(self, size: [u32; 2]) -> Matrix {
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        let over = 1.0 / (0.5 * self.field).tan();
        let (near, far) = (NEAR * self.distance, FAR * self.distance);
        let depth = far / (near - far);
        let projection = [
            [over / aspect, 0.0, 0.0, 0.0],
            [0.0, over, 0.0, 0.0],
            [0.0, 0.0, depth, -1.0],
            [0.0, 0.0, near * depth, 0.0],
        ];
        product(projection, seen_from(self.eye(), self.axes()))
    }
}

/// From metres to the coordinates of something at a place with axes of its own, of length 1.
pub(crate) fn seen_from(eye: Vector, axes: [Vector; 3]) -> Matrix {
    let [x, y, z] = axes;
    let last = axes.map(|axis| -dot(axis, eye));
    [
        [x[0], y[0], z[0], 0.0],
        [x[1], y[1], z[1], 0.0],
        [x[2], y[2], z[2], 0.0],
        [last[0], last[1], last[2], 1.0],
    ]
}

/// The matrix that does what the second one does, then what the first one does.
pub(crate) fn product(a: Matrix, b: Matrix) -> Matrix {
    b.map(|column| {
        let parts = a.iter().zip(column).map(|(&of, share)| scaled(of, share));
        parts.fold([0.0; 4], plus)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [640, 480];

    fn camera() -> Camera {
        Camera {
            turn: 0.7,
            shake: [0.01, -0.02, 0.0],
            ..Camera::fit([-1.0, 0.0, -1.0], [1.0, 1.5, 2.0], SIZE)
        }
    }

    #[test]
    fn pixels_rays_and_shaders_agree() {
        let camera = camera();
        let at = [0.3, 0.8, -0.4];
        let pixel = camera.to_pixel(at, SIZE).unwrap();
        let (eye, towards) = camera.ray(pixel, SIZE);
        let reach = length(minus(at, eye));
        let hit = plus(eye, scaled(towards, reach));
        assert!(length(minus(hit, at)) < 1e-4, "{hit:?}");

        let clip = camera.to_clip(SIZE);
        let [x, y, z, w] = [at[0], at[1], at[2], 1.0]
            .iter()
            .zip(clip)
            .fold([0.0; 4], |sum, (&k, column)| plus(sum, scaled(column, k)));
        let seen = [320.0 + 320.0 * x / w, 240.0 - 240.0 * y / w];
        assert!(length(minus(seen, pixel)) < 1e-2, "{seen:?} {pixel:?}");
        assert!((0.0..1.0).contains(&(z / w)));
        assert_eq!(camera.to_pixel(plus(eye, camera.axes()[2]), SIZE), None);
    }

    #[test]
    fn a_box_that_is_fitted_is_seen_whole_from_everywhere() {
        for turn in 0..6 {
            let camera = Camera {
                turn: turn as f32,
                ..camera()
            };
            for corner in 0..8 {
                let end = |axis: usize, low: f32, high: f32| {
                    if corner >> axis & 1 == 0 { low } else { high }
                };
                let at = [end(0, -1.0, 1.0), end(1, 0.0, 1.5), end(2, -1.0, 2.0)];
                let [x, y] = camera.to_pixel(at, SIZE).unwrap();
                assert!(
                    (-9.0..649.0).contains(&x) && (-9.0..489.0).contains(&y),
                    "{x} {y}"
                );
            }
        }
    }
}
