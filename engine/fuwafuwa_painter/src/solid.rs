//! Rendering of 3D bodies to an image: triangles through a depth buffer, two lights, dark creases and a soft
//! shadow on the floor. It is meant for judging shape, cracks and levels.

use crate::PaintError;
pub use crate::canvas::{Camera, Triangle};
use crate::canvas::{Canvas, unit};
use crate::role::Role;
use crate::shadow::Shadow;
use fuwafuwa::{Rotation, Vec3};
use tiny_skia::Pixmap;

/// A 3D scene to be rendered.
#[derive(Clone, Debug)]
pub struct Scene3d {
    camera: Camera,
    triangles: Vec<Triangle>,
    /// Lines of the scene: both end points [m], width [px] and role.
    segments: Vec<([Vec3; 2], f32, Role)>,
    floor: Option<f32>,
}

impl Scene3d {
    /// Creates an empty scene.
    pub fn new(camera: Camera) -> Self {
        Self {
            camera,
            triangles: Vec::new(),
            segments: Vec::new(),
            floor: None,
        }
    }

    /// Adds a flat face; its corners [m] run counterclockwise when seen from outside.
    pub fn quad(&mut self, corners: [Vec3; 4], role: Role) {
        let [a, b, c, d] = corners;
        let normal = unit((c - a).cross(d - b));
        self.smooth_quad(corners, [normal; 4], role);
    }

    /// Adds a face with a normal at each corner.
    pub fn smooth_quad(&mut self, corners: [Vec3; 4], normals: [Vec3; 4], role: Role) {
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            self.triangles.push(Triangle {
                corners: [corners[a], corners[b], corners[c]],
                normals: [normals[a], normals[b], normals[c]],
                role,
            });
        }
    }

    /// Adds a line between two points [m], with a width [px].
    pub fn segment(&mut self, ends: [Vec3; 2], width: f32, role: Role) {
        self.segments.push((ends, width, role));
    }

    /// Adds a ball of a radius [m].
    pub fn ball(&mut self, centre: Vec3, radius: f32, role: Role) {
        const ROUND: usize = 48;
        let normal = |i: usize, j: usize| {
            let turn = i as f32 / ROUND as f32 * std::f32::consts::TAU;
            let rise = (j as f32 / (ROUND / 2) as f32 - 0.5) * std::f32::consts::PI;
            Vec3::new(
                turn.cos() * rise.cos(),
                rise.sin(),
                -turn.sin() * rise.cos(),
            )
        };
        for j in 0..ROUND / 2 {
            for i in 0..ROUND {
                let normals = [
                    normal(i, j),
                    normal(i + 1, j),
                    normal(i + 1, j + 1),
                    normal(i, j + 1),
                ];
                let corners = normals.map(|normal| centre + normal * radius);
                self.smooth_quad(corners, normals, role);
            }
        }
    }

    /// Adds a capsule between two points, with a radius [m].
    pub fn bar(&mut self, [from, to]: [Vec3; 2], radius: f32, role: Role) {
        const ROUND: usize = 32;
        self.ball(from, radius, role);
        self.ball(to, radius, role);
        let along = to - from;
        // The axis along which `along` extends least is never parallel to `along`, so the cross product is not 0.
        let least = (0..3).min_by(|&a, &b| along[a].abs().total_cmp(&along[b].abs()));
        let aside = Vec3::AXES[least.expect("there are three axes")];
        let across = unit(along.cross(aside));
        let up = unit(across.cross(along));
        let normal = |step: usize| {
            let (sin, cos) = (step as f32 / ROUND as f32 * std::f32::consts::TAU).sin_cos();
            across * cos + up * sin
        };
        for step in 0..ROUND {
            let [a, b] = [normal(step), normal(step + 1)];
            let at = |end: Vec3, normal: Vec3| end + normal * radius;
            let corners = [at(from, a), at(from, b), at(to, b), at(to, a)];
            self.smooth_quad(corners, [a, b, b, a], role);
        }
    }

    /// Adds a box with half extents `half` [m], rotated about its centre.
    pub fn block(&mut self, centre: Vec3, half: Vec3, rotation: Rotation, role: Role) {
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let corners = [[-1.0, -side], [1.0, -side], [1.0, side], [-1.0, side]];
                let corners = corners.map(|[u, v]| corner(half, axis, [side, u, v]));
                let corners = corners.map(|corner| centre + rotation.apply(corner));
                self.quad(corners, role);
            }
        }
    }

    /// Adds a floor at `height` [m].
    pub fn floor(&mut self, height: f32) {
        self.floor = Some(height);
    }

    /// Renders an image of `width` × `height` pixels.
    ///
    /// # Errors
    /// [`PaintError::NoSize`] if the image has no area.
    pub fn pixels(&self, width: u32, height: u32) -> Result<Pixmap, PaintError> {
        let mut canvas = Canvas::new(self.camera, width, height);
        for triangle in &self.triangles {
            canvas.triangle(triangle);
        }
        canvas.darken_creases(0.06 * self.camera.across);
        for &(ends, width, role) in &self.segments {
            canvas.segment(ends, 0.5 * width, role);
        }
        if let Some(height) = self.floor {
            canvas.floor(height, &self.shadow(height));
        }
        canvas.averaged()
    }

    fn shadow(&self, height: f32) -> Shadow {
        let corners = self.triangles.iter().map(|triangle| triangle.corners);
        Shadow::of(&corners.collect::<Vec<_>>(), height)
    }
}

/// Returns a corner of a box relative to its centre. Each of `sides` is −1 or 1: the first for `axis`, the
/// others for the two axes that follow cyclically.
fn corner(half: Vec3, axis: usize, sides: [f32; 3]) -> Vec3 {
    let mut corner = Vec3::ZERO;
    for (step, side) in sides.into_iter().enumerate() {
        let along = (axis + step) % 3;
        corner[along] += side * half[along];
    }
    corner
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::role::colour;

    const CAMERA: Camera = Camera {
        eye: Vec3::new(0.0, 1.0, 4.0),
        target: Vec3::ZERO,
        across: 3.0,
    };

    fn at(pixels: &Pixmap, x: u32, y: u32) -> [u8; 3] {
        let pixel = pixels.pixel(x, y).unwrap();
        [pixel.red(), pixel.green(), pixel.blue()]
    }

    #[test]
    fn pixels_show_nearer_ball_in_front() {
        let mut solid = Scene3d::new(CAMERA);
        solid.ball(Vec3::ZERO, 0.5, Role::Hand);
        solid.ball(Vec3::NEG_Z, 0.5, Role::Skin);
        let pixels = solid.pixels(60, 60).unwrap();
        let [red, _, blue] = at(&pixels, 30, 30);
        assert!(blue > red, "the blue ball must be in front");
        assert_eq!(at(&pixels, 2, 2), colour(Role::Paper));
    }

    #[test]
    fn bar_and_block_are_visible_from_each_side() {
        for eye in [
            [0.0, 1.0, 4.0],
            [0.0, 1.0, -4.0],
            [4.0, 1.0, 0.1],
            [-4.0, 1.0, 0.1],
        ] {
            for is_bar in [true, false] {
                let eye = Vec3::from(eye);
                let mut solid = Scene3d::new(Camera { eye, ..CAMERA });
                let end = Vec3::new(0.5, 0.0, 0.5);
                let half = Vec3::new(0.4, 0.3, 0.5);
                match is_bar {
                    true => solid.bar([-end, end], 0.3, Role::Hand),
                    false => solid.block(Vec3::ZERO, half, Rotation::NONE, Role::Hand),
                }
                let [red, _, blue] = at(&solid.pixels(60, 60).unwrap(), 30, 30);
                assert!(blue > red, "{eye:?} {is_bar}");
            }
        }
    }

    #[test]
    fn ball_darkens_floor() {
        let mut solid = Scene3d::new(CAMERA);
        solid.floor(-0.5);
        let bright = solid.pixels(60, 60).unwrap();
        solid.ball(Vec3::ZERO, 0.5, Role::Hand);
        let dark = solid.pixels(60, 60).unwrap();
        let sum = |pixels: &Pixmap| -> u32 {
            (0..60)
                .map(|x| at(pixels, x, 44).iter().map(|&k| u32::from(k)).sum::<u32>())
                .sum()
        };
        assert!(sum(&dark) < sum(&bright));
    }
}
