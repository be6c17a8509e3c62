//! Bodies in space as an image: triangles through a depth buffer, two lights, dark creases and a
//! soft shadow on the floor. Enough to judge shape, cracks and levels; no more.

use super::shadow::{KEY, Shadow};
use super::theme::{Role, colour};
use anyhow::{Context, Result};
use fuwafuwa::shape::Vector;
use fuwafuwa::vector::{cross, dot, length, minus, plus, scaled};
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// Pixels are painted this many times as fine on each axis, and averaged.
const FINE: u32 = 2;
/// Towards the weaker light.
const FILL: Vector = [-0.76, 0.38, 0.53];
/// From where space is seen.
#[derive(Copy, Clone, Debug)]
pub struct Camera {
    /// Where the eye is [m].
    pub eye: Vector,
    /// What it looks at [m]; this falls in the middle of the image.
    pub target: Vector,
    /// What fits across the image at the target [m].
    pub across: f32,
}

/// A triangle with a normal at each corner.
#[derive(Copy, Clone, Debug)]
struct Triangle {
    corners: [Vector; 3],
    normals: [Vector; 3],
    role: Role,
}

/// What stands in space, to become an image.
#[derive(Clone, Debug)]
pub struct Solid {
    camera: Camera,
    triangles: Vec<Triangle>,
    /// Ends [m] and width [px].
    segments: Vec<([Vector; 2], f32, Role)>,
    floor: Option<f32>,
}

impl Solid {
    /// Empty space.
    pub fn new(camera: Camera) -> Self {
        Self {
            camera,
            triangles: Vec::new(),
            segments: Vec::new(),
            floor: None,
        }
    }

    /// Adds a flat face; its corners [m] run counterclockwise seen from outside.
    pub fn quad(&mut self, corners: [Vector; 4], role: Role) {
        let [a, b, c, d] = corners;
        let normal = unit(cross(minus(c, a), minus(d, b)));
        self.smooth_quad(corners, [normal; 4], role);
    }

    /// Adds a face with a normal at each corner.
    pub fn smooth_quad(&mut self, corners: [Vector; 4], normals: [Vector; 4], role: Role) {
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            self.triangles.push(Triangle {
                corners: [corners[a], corners[b], corners[c]],
                normals: [normals[a], normals[b], normals[c]],
                role,
            });
        }
    }

    /// Adds a line from one place to another [m], of a width [px].
    pub fn segment(&mut self, ends: [Vector; 2], width: f32, role: Role) {
        self.segments.push((ends, width, role));
    }

    /// Adds a ball.
    pub fn ball(&mut self, centre: Vector, radius: f32, role: Role) {
        const ROUND: usize = 48;
        let normal = |i: usize, j: usize| {
            let turn = i as f32 / ROUND as f32 * std::f32::consts::TAU;
            let rise = (j as f32 / (ROUND / 2) as f32 - 0.5) * std::f32::consts::PI;
            [
                turn.cos() * rise.cos(),
                rise.sin(),
                -turn.sin() * rise.cos(),
            ]
        };
        for j in 0..ROUND / 2 {
            for i in 0..ROUND {
                let normals = [
                    normal(i, j),
                    normal(i + 1, j),
                    normal(i + 1, j + 1),
                    normal(i, j + 1),
                ];
                let corners = normals.map(|n| plus(centre, scaled(n, radius)));
                self.smooth_quad(corners, normals, role);
            }
        }
    }

    /// Adds a floor at a height [m].
    pub fn floor(&mut self, height: f32) {
        self.floor = Some(height);
    }

    /// The image, `width` × `height` pixels.
    ///
    /// # Errors
    /// When the image has no area.
    pub fn pixels(&self, width: u32, height: u32) -> Result<Pixmap> {
        let mut canvas = Canvas::new(self.camera, width * FINE, height * FINE);
        for triangle in &self.triangles {
            canvas.triangle(triangle);
        }
        canvas.darken_creases(0.06 * self.camera.across);
        let fine = FINE as f32;
        for &(ends, width, role) in &self.segments {
            canvas.segment(ends, 0.5 * width * fine, role);
        }
        if let Some(height) = self.floor {
            canvas.floor(height, &self.shadow(height));
        }
        canvas.averaged(width, height)
    }

    fn shadow(&self, height: f32) -> Shadow {
        let corners = self.triangles.iter().map(|triangle| triangle.corners);
        Shadow::of(&corners.collect::<Vec<_>>(), height)
    }
}

/// Depth and light of every fine pixel.
struct Canvas {
    width: usize,
    height: usize,
    eye: Vector,
    /// To the right, upwards, and away from the eye; each of length 1.
    axes: [Vector; 3],
    /// Pixels a metre at a distance of 1 m.
    focal: f32,
    depth: Vec<f32>,
    light: Vec<Vector>,
}

impl Canvas {
    fn new(camera: Camera, width: u32, height: u32) -> Self {
        let away = minus(camera.target, camera.eye);
        let forward = unit(away);
        let right = unit(cross(forward, [0.0, 1.0, 0.0]));
        let (width, height) = (width as usize, height as usize);
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

    /// Pixel coordinates and depth of a place.
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

    fn triangle(&mut self, triangle: &Triangle) {
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
                // Straight in space means straight in one over the depth on the image.
                let near: f32 = (0..3).map(|k| shares[k] / spots[k][2]).sum();
                let (depth, pixel) = (1.0 / near, y * self.width + x);
                if depth < self.depth[pixel] {
                    self.depth[pixel] = depth;
                    let normal = (0..3).fold([0.0; 3], |sum, k| {
                        plus(sum, scaled(triangle.normals[k], shares[k]))
                    });
                    let look = self.look(x, y);
                    self.light[pixel] = shaded(colour, unit(normal), look);
                }
            }
        }
    }

    /// The direction in which the eye sees a pixel.
    fn look(&self, x: usize, y: usize) -> Vector {
        let right = (x as f32 + 0.5 - 0.5 * self.width as f32) / self.focal;
        let up = (0.5 * self.height as f32 - y as f32 - 0.5) / self.focal;
        let sideways = plus(scaled(self.axes[0], right), scaled(self.axes[1], up));
        unit(plus(sideways, self.axes[2]))
    }

    /// Darkens what lies deeper than the mean of two opposite neighbours within `reach` [m].
    fn darken_creases(&mut self, reach: f32) {
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

    fn segment(&mut self, ends: [Vector; 2], radius: f32, role: Role) {
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

    /// Fills what is still empty with the floor, which fades into the paper far off.
    fn floor(&mut self, height: f32, shadow: &Shadow) {
        let (paper, floor) = (light_of(Role::Paper), light_of(Role::Floor));
        for y in 0..self.height {
            for x in 0..self.width {
                let pixel = y * self.width + x;
                let look = self.look(x, y);
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

    fn averaged(&self, width: u32, height: u32) -> Result<Pixmap> {
        let mut pixels = Pixmap::new(width, height).context("the image has no area")?;
        for (k, pixel) in pixels.pixels_mut().iter_mut().enumerate() {
            let (x, y) = (k as u32 % width, k as u32 / width);
            let mut sum = [0.0; 3];
            for (i, j) in (0..FINE).flat_map(|j| (0..FINE).map(move |i| (i, j))) {
                let fine = (y * FINE + j) as usize * self.width + (x * FINE + i) as usize;
                sum = plus(sum, self.light[fine]);
            }
            let [red, green, blue] = scaled(sum, 1.0 / (FINE * FINE) as f32).map(shown);
            *pixel = PremultipliedColorU8::from_rgba(red, green, blue, 255)
                .context("an opaque colour is premultiplied")?;
        }
        Ok(pixels)
    }
}

/// A colour under both lights and the sky; what is seen from behind is lit like the front.
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
    // Squares stand in for the curve between bytes and light.
    colour(role).map(|byte| (f32::from(byte) / 255.0).powi(2))
}

fn shown(light: f32) -> u8 {
    (light.clamp(0.0, 1.0).sqrt() * 255.0).round() as u8
}

fn mixed(a: Vector, b: Vector, share: f32) -> Vector {
    plus(scaled(a, 1.0 - share), scaled(b, share))
}

fn unit(v: Vector) -> Vector {
    scaled(v, 1.0 / length(v).max(1e-12))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera {
        eye: [0.0, 1.0, 4.0],
        target: [0.0; 3],
        across: 3.0,
    };

    fn at(pixels: &Pixmap, x: u32, y: u32) -> [u8; 3] {
        let pixel = pixels.pixel(x, y).unwrap();
        [pixel.red(), pixel.green(), pixel.blue()]
    }

    #[test]
    fn what_is_nearer_hides_what_is_farther() {
        let mut solid = Solid::new(CAMERA);
        solid.ball([0.0; 3], 0.5, Role::Hand);
        solid.ball([0.0, 0.0, -1.0], 0.5, Role::Skin);
        let pixels = solid.pixels(60, 60).unwrap();
        let [red, _, blue] = at(&pixels, 30, 30);
        assert!(blue > red, "the blue ball stands in front");
        assert_eq!(at(&pixels, 2, 2), colour(Role::Paper));
    }

    #[test]
    fn a_ball_throws_a_shadow() {
        let mut solid = Solid::new(CAMERA);
        solid.floor(-0.5);
        let bright = solid.pixels(60, 60).unwrap();
        solid.ball([0.0; 3], 0.5, Role::Hand);
        let dark = solid.pixels(60, 60).unwrap();
        let sum = |pixels: &Pixmap| -> u32 {
            (0..60)
                .map(|x| at(pixels, x, 44).iter().map(|&k| u32::from(k)).sum::<u32>())
                .sum()
        };
        assert!(sum(&dark) < sum(&bright));
    }
}
