//! From where a world in space is seen. Up is the second axis.

use fuwafuwa::Vector;
use glam::camera::rh::proj::directx::perspective;
use glam::{Mat3, Mat4, Vec3};

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
        let (low, high) = (Vec3::from(low), Vec3::from(high));
        let radius = 0.5 * low.distance(high);
        Self {
            target: low.midpoint(high).into(),
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
        self.place().into()
    }

    /// What is to its right, what is up for it, and what is behind it; of length 1.
    pub fn axes(&self) -> [Vector; 3] {
        self.turned().to_cols_array_2d()
    }

    fn turned(&self) -> Mat3 {
        Mat3::from_rotation_y(self.turn) * Mat3::from_rotation_x(-self.rise)
    }

    fn place(&self) -> Vec3 {
        let [target, shake] = [self.target, self.shake].map(Vec3::from);
        target + shake + self.distance * self.turned().z_axis
    }

    /// Where a place [m] is in a target of `size` pixels, from its upper left corner; none when it is
    /// behind the camera.
    pub fn to_pixel(&self, at: Vector, size: [u32; 2]) -> Option<[f32; 2]> {
        let seen = self.turned().transpose() * (Vec3::from(at) - self.place());
        let [x, y, z] = seen.to_array();
        let scale = 0.5 * size[1] as f32 / (0.5 * self.field).tan();
        let [left, top] = size.map(|side| 0.5 * side as f32);
        (z < 0.0).then(|| [left - x / z * scale, top + y / z * scale])
    }

    /// Where the ray through a pixel of a target of `size` pixels begins [m], and its direction, of
    /// length 1.
    pub fn ray(&self, pixel: [f32; 2], size: [u32; 2]) -> (Vector, Vector) {
        let scale = 2.0 * (0.5 * self.field).tan() / size[1].max(1) as f32;
        let right = (pixel[0] - 0.5 * size[0] as f32) * scale;
        let up = (0.5 * size[1] as f32 - pixel[1]) * scale;
        let towards = self.turned() * Vec3::new(right, up, -1.0);
        (self.eye(), towards.normalize().into())
    }

    /// From metres to the coordinates of a target of `size` pixels that shaders want.
    pub(crate) fn to_clip(self, size: [u32; 2]) -> Mat4 {
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        let (near, far) = (NEAR * self.distance, FAR * self.distance);
        perspective(self.field, aspect, near, far) * seen_from(self.place(), self.turned())
    }
}

/// From metres to the coordinates of something at a place with axes of its own, of length 1.
pub(crate) fn seen_from(eye: Vec3, axes: Mat3) -> Mat4 {
    Mat4::from_mat3(axes.transpose()) * Mat4::from_translation(-eye)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

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
        let [at, eye, towards] = [at, eye, towards].map(Vec3::from);
        let hit = eye + towards * at.distance(eye);
        assert!(hit.distance(at) < 1e-4, "{hit:?}");

        let [x, y, z] = camera.to_clip(SIZE).project_point3(at).to_array();
        let seen = Vec2::new(320.0 + 320.0 * x, 240.0 - 240.0 * y);
        assert!(seen.distance(pixel.into()) < 1e-2, "{seen:?} {pixel:?}");
        assert!((0.0..1.0).contains(&z));
        let behind = eye + camera.turned().z_axis;
        assert_eq!(camera.to_pixel(behind.into(), SIZE), None);
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
