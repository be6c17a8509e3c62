//! Depth buffer with which [`crate::solid`] renders.

use crate::PaintError;
use crate::role::{Role, colour};
use crate::shadow::{KEY, Shadow};
use fuwafuwa::glam::Vec3Swizzles;
use fuwafuwa::{Vec2, Vec3};
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// Perspective camera.
#[derive(Copy, Clone, Debug)]
pub struct Camera {
    /// Position of the camera [m].
    pub eye: Vec3,
    /// Target [m], which appears at the centre of the image.
    pub target: Vec3,
    /// Width of the visible region at the distance of the target [m].
    pub across: f32,
}

/// A triangle with a normal at each corner.
#[derive(Copy, Clone, Debug)]
pub struct Triangle {
    /// Corners [m].
    pub corners: [Vec3; 3],
    /// Outward normal at each corner; any length.
    pub normals: [Vec3; 3],
    /// Role of the surface.
    pub role: Role,
}

/// Number of supersampled pixels per image pixel on each axis.
const FINE: usize = 2;
/// Unit vector towards the weaker of the two lights.
const FILL: Vec3 = Vec3::new(-0.76, 0.38, 0.53);

/// Image under construction, with a depth and a reflected light for every supersampled pixel.
pub struct Canvas {
    width: usize,
    height: usize,
    eye: Vec3,
    /// Unit vectors to the right, up, and away from the camera.
    axes: [Vec3; 3],
    /// Focal length [px].
    focal: f32,
    depth: Vec<f32>,
    light: Vec<Vec3>,
}

impl Canvas {
    /// Creates an empty canvas for an image of `width` × `height` pixels.
    pub fn new(camera: Camera, width: u32, height: u32) -> Self {
        let away = camera.target - camera.eye;
        let forward = unit(away);
        let right = unit(forward.cross(Vec3::Y));
        let (width, height) = (width as usize * FINE, height as usize * FINE);
        Self {
            width,
            height,
            eye: camera.eye,
            axes: [right, right.cross(forward), forward],
            focal: width as f32 * away.length() / camera.across,
            depth: vec![f32::INFINITY; width * height],
            light: vec![light_of(Role::Paper); width * height],
        }
    }

    /// Returns the pixel coordinates (x, y) and the depth (z) of a point.
    fn project(&self, at: Vec3) -> Vec3 {
        let reach = at - self.eye;
        let [x, y, depth] = self.axes.map(|axis| axis.dot(reach));
        let scale = self.focal / depth.max(1e-3);
        Vec3::new(
            0.5 * self.width as f32 + x * scale,
            0.5 * self.height as f32 - y * scale,
            depth,
        )
    }

    /// Paints a triangle, with a depth test.
    pub fn triangle(&mut self, triangle: &Triangle) {
        let spots = triangle.corners.map(|at| self.project(at));
        let [a, b, c] = spots.map(Vec3::xy);
        let area = (b - a).perp_dot(c - a);
        if area.abs() < 1e-6 {
            return;
        }
        let colour = light_of(triangle.role);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let range = |axis: usize, most: usize| {
            low[axis] as usize..most.min((high[axis] + 1.0).max(0.0) as usize)
        };
        for y in range(1, self.height) {
            for x in range(0, self.width) {
                let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let edge = |p: Vec2, q: Vec2| (q - p).perp_dot(at - p) / area;
                let shares = [edge(b, c), edge(c, a), edge(a, b)];
                if shares.iter().any(|&share| share < 0.0) {
                    continue;
                }
                // Perspective-correct interpolation: 1/depth is linear on the image.
                let near: f32 = (0..3).map(|k| shares[k] / spots[k].z).sum();
                let (depth, pixel) = (1.0 / near, y * self.width + x);
                if depth < self.depth[pixel] {
                    self.depth[pixel] = depth;
                    let normal = (0..3).map(|k| triangle.normals[k] * shares[k]).sum();
                    let look = self.view_direction(x, y);
                    self.light[pixel] = shaded(colour, unit(normal), look);
                }
            }
        }
    }

    /// Returns the unit vector from the camera through a pixel.
    fn view_direction(&self, x: usize, y: usize) -> Vec3 {
        let right = (x as f32 + 0.5 - 0.5 * self.width as f32) / self.focal;
        let up = (0.5 * self.height as f32 - y as f32 - 0.5) / self.focal;
        let [rightwards, upwards, away] = self.axes;
        unit(rightwards * right + upwards * up + away)
    }

    /// Darkens creases: pixels that lie deeper than the mean of two opposite pixels around them, at most
    /// `reach` [m] away.
    pub fn darken_creases(&mut self, reach: f32) {
        const DIRECTIONS: [[f32; 2]; 6] = [
            [1.0, 0.0],
            [0.5, 0.866],
            [-0.5, 0.866],
            [0.43, 0.25],
            [0.0, 0.5],
            [-0.43, 0.25],
        ];
        let mut dark = vec![0.0f32; self.depth.len()];
        for y in 0..self.height {
            for x in 0..self.width {
                let pixel = y * self.width + x;
                let depth = self.depth[pixel];
                if depth.is_infinite() {
                    continue;
                }
                let radius = reach * self.focal / depth;
                let mut sum = 0.0;
                for [u, v] in DIRECTIONS {
                    let near = |sign: f32| {
                        let at = [x as f32 + sign * u * radius, y as f32 + sign * v * radius];
                        let inside = at[0] >= 0.0
                            && at[1] >= 0.0
                            && at[0] < self.width as f32
                            && at[1] < self.height as f32;
                        let other = if inside {
                            self.depth[at[1] as usize * self.width + at[0] as usize]
                        } else {
                            depth
                        };
                        (depth - other).clamp(-reach, reach)
                    };
                    sum += (0.5 * (near(1.0) + near(-1.0)) / reach).max(0.0);
                }
                dark[pixel] = (sum / DIRECTIONS.len() as f32 * 1.5).min(0.6);
            }
        }
        for (light, dark) in self.light.iter_mut().zip(dark) {
            *light *= 1.0 - dark;
        }
    }

    /// Paints a line with a half width of `radius` [px], with a depth test.
    pub fn segment(&mut self, ends: [Vec3; 2], radius: f32, role: Role) {
        let radius = radius * FINE as f32;
        let colour = light_of(role);
        let [from, to] = ends.map(|at| self.project(at));
        let far = (to - from).xy().abs().max_element();
        let steps = (far * 1.5).ceil().clamp(1.0, 4000.0) as usize;
        for step in 0..=steps {
            let t = step as f32 / steps as f32;
            let at = (from + t * (to - from)).xy();
            let depth = 1.0 / ((1.0 - t) / from.z + t / to.z);
            self.stamp(at, radius, depth * 0.9985, colour);
        }
    }

    fn stamp(&mut self, at: Vec2, radius: f32, depth: f32, colour: Vec3) {
        let range = |middle: f32, most: usize| {
            let low = (middle - radius).max(0.0) as usize;
            low..most.min((middle + radius + 1.0).max(0.0) as usize)
        };
        for row in range(at.y, self.height) {
            for column in range(at.x, self.width) {
                let away = Vec2::new(column as f32 + 0.5, row as f32 + 0.5) - at;
                let pixel = row * self.width + column;
                let inside = away.length_squared() <= radius * radius;
                if inside && depth < self.depth[pixel] {
                    self.light[pixel] = colour;
                }
            }
        }
    }

    /// Fills empty pixels below the horizon with a floor at `height` [m]. In the distance, the floor fades
    /// into the background.
    pub fn floor(&mut self, height: f32, shadow: &Shadow) {
        let (paper, floor) = (light_of(Role::Paper), light_of(Role::Floor));
        for y in 0..self.height {
            for x in 0..self.width {
                let pixel = y * self.width + x;
                let look = self.view_direction(x, y);
                if self.depth[pixel].is_finite() || look.y >= -1e-3 {
                    continue;
                }
                let along = (height - self.eye.y) / look.y;
                if along <= 0.0 {
                    continue;
                }
                let at = self.eye + look * along;
                let lit = floor * (1.0 - 0.42 * shadow.at(at));
                let fade = shadow.distance(at);
                let fade = (1.0 - (fade - 0.9) / 1.6).clamp(0.0, 1.0);
                self.light[pixel] = paper.lerp(lit, fade * fade * (3.0 - 2.0 * fade));
            }
        }
    }

    /// Averages the supersampled pixels to an image.
    ///
    /// # Errors
    /// [`PaintError::NoSize`] if the image has no area.
    pub fn averaged(&self) -> Result<Pixmap, PaintError> {
        let (width, height) = (self.width / FINE, self.height / FINE);
        let mut pixels = Pixmap::new(width as u32, height as u32)
            .ok_or(PaintError::NoSize { what: "an image" })?;
        for (k, pixel) in pixels.pixels_mut().iter_mut().enumerate() {
            let (x, y) = (k % width, k / width);
            let mut sum = Vec3::ZERO;
            for (i, j) in (0..FINE).flat_map(|j| (0..FINE).map(move |i| (i, j))) {
                let fine = (y * FINE + j) * self.width + x * FINE + i;
                sum += self.light[fine];
            }
            let mean = sum * (1.0 / (FINE * FINE) as f32);
            let [red, green, blue] = mean.to_array().map(shown);
            *pixel = PremultipliedColorU8::from_rgba(red, green, blue, 255)
                .expect("an opaque colour is premultiplied");
        }
        Ok(pixels)
    }
}

/// Returns the light that a surface of a given colour reflects from both lights and the sky. Back faces are
/// lit like front faces.
fn shaded(colour: Vec3, normal: Vec3, look: Vec3) -> Vec3 {
    let normal = if normal.dot(look) > 0.0 {
        -normal
    } else {
        normal
    };
    let sky = 0.5 + 0.5 * normal.y;
    let key = Vec3::new(1.0, 0.97, 0.92) * (0.50 * normal.dot(KEY).max(0.0));
    let fill = Vec3::new(0.90, 0.95, 1.0) * (0.24 * normal.dot(FILL).max(0.0));
    let sky = Vec3::new(0.92, 0.96, 1.0) * (0.34 + 0.22 * sky);
    colour * (key + fill + sky)
}

fn light_of(role: Role) -> Vec3 {
    // Squaring approximates the conversion from sRGB to linear light.
    let colour = Vec3::from(colour(role).map(f32::from)) / 255.0;
    colour * colour
}

fn shown(light: f32) -> u8 {
    (light.clamp(0.0, 1.0).sqrt() * 255.0).round() as u8
}

/// Returns the unit vector in the direction of `v`.
pub fn unit(v: Vec3) -> Vec3 {
    v * (1.0 / v.length().max(1e-12))
}
