//! Depth buffer used by [`crate::solid`].

use crate::PaintError;
use crate::role::{Role, colour};
use crate::shadow::{KEY, Shadow};
use fuwafuwa::Vector;
use fuwafuwa::inspect::vector::{cross, dot, length, minus, plus, scaled};
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// Perspective camera.
#[derive(Copy, Clone, Debug)]
pub struct Camera {
    /// Position of the camera [m].
    pub eye: Vector,
    /// Target [m], which appears at the centre of the image.
    pub target: Vector,
    /// Width of the view at the target [m].
    pub across: f32,
}

/// A triangle with a normal at each corner.
#[derive(Copy, Clone, Debug)]
pub struct Triangle {
    /// Corners [m].
    pub corners: [Vector; 3],
    /// Outward normal at each corner; any length.
    pub normals: [Vector; 3],
    /// Role of the surface.
    pub role: Role,
}

/// Supersampling factor on each axis.
const FINE: usize = 2;
/// Direction to the weaker light.
const FILL: Vector = [-0.76, 0.38, 0.53];

/// Depth and light of every supersampled pixel.
pub struct Canvas {
    width: usize,
    height: usize,
    eye: Vector,
    /// Unit vectors to the right, up, and away from the camera.
    axes: [Vector; 3],
    /// Focal length [px].
    focal: f32,
    depth: Vec<f32>,
    light: Vec<Vector>,
}

impl Canvas {
    /// Creates an empty canvas for an image of `width` × `height` pixels.
    pub fn new(camera: Camera, width: u32, height: u32) -> Self {
        let away = minus(camera.target, camera.eye);
        let forward = unit(away);
        let right = unit(cross(forward, [0.0, 1.0, 0.0]));
        let (width, height) = (width as usize * FINE, height as usize * FINE);
        Self {
            width,
            height,
            eye: camera.eye,
            axes: [right, cross(right, forward), forward],
            focal: width as f32 * length(away) / camera.across,
            depth: vec![f32::INFINITY; width * height],
            light: vec![light_of(Role::Paper); width * height],
        }
    }

    /// Returns the pixel coordinates and the depth of a point.
    fn project(&self, at: Vector) -> [f32; 3] {
        let reach = minus(at, self.eye);
        let [x, y, depth] = self.axes.map(|axis| dot(axis, reach));
        let scale = self.focal / depth.max(1e-3);
        [
            0.5 * self.width as f32 + x * scale,
            0.5 * self.height as f32 - y * scale,
            depth,
        ]
    }

    /// Paints a triangle, with a depth test.
    pub fn triangle(&mut self, triangle: &Triangle) {
        let spots = triangle.corners.map(|at| self.project(at));
        let [a, b, c] = spots;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area.abs() < 1e-6 {
            return;
        }
        let colour = light_of(triangle.role);
        let range = |axis: usize, most: usize| {
            let values = spots.map(|spot| spot[axis]);
            let low = values.iter().fold(f32::MAX, |a, &b| a.min(b)).max(0.0);
            let high = values.iter().fold(f32::MIN, |a, &b| a.max(b));
            low as usize..most.min((high + 1.0).max(0.0) as usize)
        };
        for y in range(1, self.height) {
            for x in range(0, self.width) {
                let at = [x as f32 + 0.5, y as f32 + 0.5];
                let edge = |p: [f32; 3], q: [f32; 3]| {
                    ((q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0])) / area
                };
                let shares = [edge(b, c), edge(c, a), edge(a, b)];
                if shares.iter().any(|&share| share < 0.0) {
                    continue;
                }
                // Perspective-correct interpolation: 1/depth is linear on the image.
                let near: f32 = (0..3).map(|k| shares[k] / spots[k][2]).sum();
                let (depth, pixel) = (1.0 / near, y * self.width + x);
                if depth < self.depth[pixel] {
                    self.depth[pixel] = depth;
                    let normal = (0..3).fold([0.0; 3], |sum, k| {
                        plus(sum, scaled(triangle.normals[k], shares[k]))
                    });
                    let look = self.view_direction(x, y);
                    self.light[pixel] = shaded(colour, unit(normal), look);
                }
            }
        }
    }

    /// Returns the unit vector from the camera through a pixel.
    fn view_direction(&self, x: usize, y: usize) -> Vector {
        let right = (x as f32 + 0.5 - 0.5 * self.width as f32) / self.focal;
        let up = (0.5 * self.height as f32 - y as f32 - 0.5) / self.focal;
        let sideways = plus(scaled(self.axes[0], right), scaled(self.axes[1], up));
        unit(plus(sideways, self.axes[2]))
    }

    /// Darkens creases: pixels that lie deeper than the mean of two opposite pixels at most `reach` [m] away.
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
            *light = scaled(*light, 1.0 - dark);
        }
    }

    /// Paints a line with a half width of `radius` [px], with a depth test.
    pub fn segment(&mut self, ends: [Vector; 2], radius: f32, role: Role) {
        let radius = radius * FINE as f32;
        let colour = light_of(role);
        let [from, to] = ends.map(|at| self.project(at));
        let far = (to[0] - from[0]).abs().max((to[1] - from[1]).abs());
        let steps = (far * 1.5).ceil().clamp(1.0, 4000.0) as usize;
        for step in 0..=steps {
            let t = step as f32 / steps as f32;
            let [x, y] = [0, 1].map(|k: usize| from[k] + t * (to[k] - from[k]));
            let depth = 1.0 / ((1.0 - t) / from[2] + t / to[2]);
            self.stamp([x, y], radius, depth * 0.9985, colour);
        }
    }

    fn stamp(&mut self, [x, y]: [f32; 2], radius: f32, depth: f32, colour: Vector) {
        let range = |middle: f32, most: usize| {
            let low = (middle - radius).max(0.0) as usize;
            low..most.min((middle + radius + 1.0).max(0.0) as usize)
        };
        for row in range(y, self.height) {
            for column in range(x, self.width) {
                let away = [column as f32 + 0.5 - x, row as f32 + 0.5 - y];
                let pixel = row * self.width + column;
                let inside = away[0] * away[0] + away[1] * away[1] <= radius * radius;
                if inside && depth < self.depth[pixel] {
                    self.light[pixel] = colour;
                }
            }
        }
    }

    /// Fills empty pixels below the horizon with a floor at `height` [m], which fades into the paper in the
    /// distance.
    pub fn floor(&mut self, height: f32, shadow: &Shadow) {
        let (paper, floor) = (light_of(Role::Paper), light_of(Role::Floor));
        for y in 0..self.height {
            for x in 0..self.width {
                let pixel = y * self.width + x;
                let look = self.view_direction(x, y);
                if self.depth[pixel].is_finite() || look[1] >= -1e-3 {
                    continue;
                }
                let along = (height - self.eye[1]) / look[1];
                if along <= 0.0 {
                    continue;
                }
                let at = plus(self.eye, scaled(look, along));
                let lit = scaled(floor, 1.0 - 0.42 * shadow.at(at));
                let fade = shadow.distance(at);
                let fade = (1.0 - (fade - 0.9) / 1.6).clamp(0.0, 1.0);
                self.light[pixel] = mixed(paper, lit, fade * fade * (3.0 - 2.0 * fade));
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
            let mut sum = [0.0; 3];
            for (i, j) in (0..FINE).flat_map(|j| (0..FINE).map(move |i| (i, j))) {
                let fine = (y * FINE + j) * self.width + x * FINE + i;
                sum = plus(sum, self.light[fine]);
            }
            let [red, green, blue] = scaled(sum, 1.0 / (FINE * FINE) as f32).map(shown);
            *pixel = PremultipliedColorU8::from_rgba(red, green, blue, 255)
                .expect("an opaque colour is premultiplied");
        }
        Ok(pixels)
    }
}

/// Returns the light that a surface of a colour reflects from both lights and the sky. Back faces are lit
/// like front faces.
fn shaded(colour: Vector, normal: Vector, look: Vector) -> Vector {
    let normal = if dot(normal, look) > 0.0 {
        scaled(normal, -1.0)
    } else {
        normal
    };
    let sky = 0.5 + 0.5 * normal[1];
    let key = dot(normal, KEY).max(0.0);
    let fill = dot(normal, FILL).max(0.0);
    let light = plus(
        scaled([1.0, 0.97, 0.92], 0.50 * key),
        scaled([0.90, 0.95, 1.0], 0.24 * fill),
    );
    let light = plus(light, scaled([0.92, 0.96, 1.0], 0.34 + 0.22 * sky));
    [0, 1, 2].map(|k: usize| colour[k] * light[k])
}

fn light_of(role: Role) -> Vector {
    // A square approximates the sRGB transfer curve.
    colour(role).map(|byte| (f32::from(byte) / 255.0).powi(2))
}

fn shown(light: f32) -> u8 {
    (light.clamp(0.0, 1.0).sqrt() * 255.0).round() as u8
}

fn mixed(a: Vector, b: Vector, share: f32) -> Vector {
    plus(scaled(a, 1.0 - share), scaled(b, share))
}

/// Returns the unit vector in the direction of `v`.
pub fn unit(v: Vector) -> Vector {
    scaled(v, 1.0 / length(v).max(1e-12))
}
