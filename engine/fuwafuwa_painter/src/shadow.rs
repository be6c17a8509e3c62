//! Soft shadow of bodies on the floor: their silhouette, seen from the stronger light and blurred.

use fuwafuwa::glam::Vec3Swizzles;
use fuwafuwa::{Vec2, Vec3};

/// Unit vector towards the stronger light, which casts the shadow.
pub const KEY: Vec3 = Vec3::new(0.44, 0.71, 0.55);
/// Number of cells of the shadow map on each axis.
const CELLS: usize = 256;

/// Shadow map of the floor around the bodies: share of the stronger light that the bodies block in each cell.
pub struct Shadow {
    low: Vec2,
    cell: f32,
    dark: Vec<f32>,
}

impl Shadow {
    /// Creates the shadow of triangles on a floor at `height` [m].
    pub fn of(triangles: &[[Vec3; 3]], height: f32) -> Self {
        let fallen: Vec<[Vec2; 3]> = triangles
            .iter()
            .map(|triangle| triangle.map(|at| projected(at, height)))
            .collect();
        let corners = fallen.iter().flatten();
        let (low, high) = corners.fold((Vec2::MAX, Vec2::MIN), |(low, high), &at| {
            (low.min(at), high.max(at))
        });
        let wide = (high - low).max_element().max(1e-3);
        let margin = 0.25 * wide;
        let mut shadow = Self {
            low: low - margin,
            cell: (wide + 2.0 * margin) / CELLS as f32,
            dark: vec![0.0; CELLS * CELLS],
        };
        for triangle in fallen {
            shadow.fill(triangle);
        }
        for _ in 0..3 {
            shadow.blur(CELLS / 36);
        }
        shadow
    }

    fn fill(&mut self, triangle: [Vec2; 3]) {
        let [a, b, c] = triangle.map(|at| self.place(at));
        let area = (b - a).perp_dot(c - a);
        if area.abs() < 1e-9 {
            return;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let range = |axis: usize| low[axis] as usize..CELLS.min(high[axis] as usize + 1);
        for y in range(1) {
            for x in range(0) {
                let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let edge = |p: Vec2, q: Vec2| (q - p).perp_dot(at - p) / area;
                if edge(a, b) >= 0.0 && edge(b, c) >= 0.0 && edge(c, a) >= 0.0 {
                    self.dark[y * CELLS + x] = 1.0;
                }
            }
        }
    }

    /// Applies a box blur along each axis, over `reach` cells to both sides.
    fn blur(&mut self, reach: usize) {
        for (along, across) in [(1, CELLS), (CELLS, 1)] {
            let old = self.dark.clone();
            for start in (0..CELLS).map(|line| line * across) {
                for k in 0..CELLS {
                    let (from, to) = (k.saturating_sub(reach), (k + reach).min(CELLS - 1));
                    let sum: f32 = (from..=to).map(|k| old[start + k * along]).sum();
                    self.dark[start + k * along] = sum / (2 * reach + 1) as f32;
                }
            }
        }
    }

    fn place(&self, at: Vec2) -> Vec2 {
        (at - self.low) / self.cell
    }

    /// Returns the shadow at a point of the floor: 0 in the light, 1 in full shadow.
    pub fn at(&self, at: Vec3) -> f32 {
        let [x, y] = self.place(at.xz()).to_array();
        let last = CELLS as f32 - 1.001;
        if !(0.0..last).contains(&x) || !(0.0..last).contains(&y) {
            return 0.0;
        }
        let (column, row) = (x as usize, y as usize);
        let (u, v) = (x - column as f32, y - row as f32);
        let dark = |i: usize, j: usize| self.dark[(row + j) * CELLS + column + i];
        (1.0 - v) * ((1.0 - u) * dark(0, 0) + u * dark(1, 0))
            + v * ((1.0 - u) * dark(0, 1) + u * dark(1, 1))
    }

    /// Returns the distance of a point from the centre of the shadow map, in multiples of half the map's
    /// width.
    pub fn distance(&self, at: Vec3) -> f32 {
        let half = 0.5 * self.cell * CELLS as f32;
        (at.xz() - self.low - half).length() / half
    }
}

/// Projects a point onto the floor at `height` [m], along the direction of the stronger light.
fn projected(at: Vec3, height: f32) -> Vec2 {
    let drop = (at.y - height) / KEY.y;
    at.xz() - drop * KEY.xz()
}
