//! Camera of a 3D picture. The second axis points up.

use crate::anchor::columns;
use glam::camera::rh::proj::directx::perspective;
use glam::{Mat3, Mat4, Vec3};

/// Camera that orbits a target.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Camera {
    /// Target point, in the middle of the picture [m].
    pub target: Vec3,
    /// Distance to the target [m].
    pub distance: f32,
    /// Azimuth of the camera around the target [rad], positive to the right. At 0 the camera looks along the
    /// negative third axis.
    pub azimuth: f32,
    /// Elevation [rad]. At a right angle the camera looks straight down.
    pub elevation: f32,
    /// Vertical field of view [rad]. The usual value is 0.6; values above 1 distort.
    pub fov_y: f32,
    /// Shake offset of camera and target [m].
    pub shake: Vec3,
    /// Cut through the bodies, for the element view only.
    pub cut: Option<Cut>,
}

/// Cut through each piece, along the plane of the piece's voxel grid that best faces `direction`. Elements
/// therefore stay whole, and the cut moves along with a rolling or trembling body.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Cut {
    /// Unit vector towards the removed part.
    pub direction: Vec3,
    /// Remaining fraction of a piece, 0 to 1.
    pub share: f32,
}

/// Near clipping plane, in multiples of the camera distance.
const NEAR: f32 = 0.1;
/// Far clipping plane, in multiples of the camera distance.
const FAR: f32 = 12.0;

impl Camera {
    /// Returns the camera that shows a box between two corners [m] in a target of `size` pixels, from the
    /// front and a little from above.
    pub fn fit(low: Vec3, high: Vec3, size: [u32; 2]) -> Self {
        let field = 0.6f32;
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        // The bounding sphere of the box must fit into the narrower of the horizontal and vertical fields of
        // view.
        let across = (0.5 * field).tan() * aspect.min(1.0);
        let radius = 0.5 * low.distance(high);
        Self {
            target: low.midpoint(high),
            distance: radius / across.atan().sin(),
            azimuth: 0.0,
            elevation: 0.45,
            fov_y: field,
            shake: Vec3::ZERO,
            cut: None,
        }
    }

    /// Returns the position of the camera [m].
    pub fn eye(&self) -> Vec3 {
        self.target + self.shake + self.distance * self.turned().z_axis
    }

    /// Returns the unit vectors to the right, up and backwards.
    pub fn axes(&self) -> [Vec3; 3] {
        columns(self.turned())
    }

    fn turned(&self) -> Mat3 {
        Mat3::from_rotation_y(self.azimuth) * Mat3::from_rotation_x(-self.elevation)
    }

    /// Returns the pixel of a point [m] in a target of `size` pixels, measured from its upper left corner.
    /// Returns `None` for points behind the camera.
    pub fn to_pixel(&self, at: Vec3, size: [u32; 2]) -> Option<[f32; 2]> {
        let seen = self.turned().transpose() * (at - self.eye());
        let [x, y, z] = seen.to_array();
        let scale = 0.5 * size[1] as f32 / (0.5 * self.fov_y).tan();
        let [left, top] = size.map(|side| 0.5 * side as f32);
        (z < 0.0).then(|| [left - x / z * scale, top + y / z * scale])
    }

    /// Returns the origin [m] and the unit direction of the ray through a pixel of a target of `size` pixels.
    pub fn ray(&self, pixel: [f32; 2], size: [u32; 2]) -> (Vec3, Vec3) {
        let scale = 2.0 * (0.5 * self.fov_y).tan() / size[1].max(1) as f32;
        let right = (pixel[0] - 0.5 * size[0] as f32) * scale;
        let up = (0.5 * size[1] as f32 - pixel[1]) * scale;
        let towards = self.turned() * Vec3::new(right, up, -1.0);
        (self.eye(), towards.normalize())
    }

    /// Returns the matrix from world coordinates [m] to clip coordinates of a target of `size` pixels.
    pub(crate) fn to_clip(self, size: [u32; 2]) -> Mat4 {
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        let (near, far) = (NEAR * self.distance, FAR * self.distance);
        perspective(self.fov_y, aspect, near, far) * seen_from(self.eye(), self.turned())
    }
}

/// Returns the view matrix of an observer at `eye` with orthonormal axes.
pub(crate) fn seen_from(eye: Vec3, axes: Mat3) -> Mat4 {
    Mat4::from_mat3(axes.transpose()) * Mat4::from_translation(-eye)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

    const SIZE: [u32; 2] = [640, 480];
    const LOW: Vec3 = Vec3::new(-1.0, 0.0, -1.0);
    const HIGH: Vec3 = Vec3::new(1.0, 1.5, 2.0);

    fn camera() -> Camera {
        Camera {
            azimuth: 0.7,
            shake: Vec3::new(0.01, -0.02, 0.0),
            ..Camera::fit(LOW, HIGH, SIZE)
        }
    }

    #[test]
    fn to_pixel_agrees_with_ray_and_clip_matrix() {
        let camera = camera();
        let at = Vec3::new(0.3, 0.8, -0.4);
        let pixel = camera.to_pixel(at, SIZE).unwrap();
        let (eye, towards) = camera.ray(pixel, SIZE);
        let hit = eye + towards * at.distance(eye);
        assert!(hit.distance(at) < 1e-4, "{hit:?}");

        let [x, y, z] = camera.to_clip(SIZE).project_point3(at).to_array();
        let seen = Vec2::new(320.0 + 320.0 * x, 240.0 - 240.0 * y);
        assert!(seen.distance(pixel.into()) < 1e-2, "{seen:?} {pixel:?}");
        assert!((0.0..1.0).contains(&z));
        let behind = eye + camera.turned().z_axis;
        assert_eq!(camera.to_pixel(behind, SIZE), None);
    }

    #[test]
    fn fit_shows_the_whole_box_from_every_side() {
        for turn in 0..6 {
            let camera = Camera {
                azimuth: turn as f32,
                ..camera()
            };
            for corner in 0..8 {
                let end = |axis: usize| [LOW, HIGH][corner >> axis & 1][axis];
                let at = Vec3::from([0, 1, 2].map(end));
                let [x, y] = camera.to_pixel(at, SIZE).unwrap();
                assert!(
                    (-9.0..649.0).contains(&x) && (-9.0..489.0).contains(&y),
                    "{x} {y}"
                );
            }
        }
    }
}
