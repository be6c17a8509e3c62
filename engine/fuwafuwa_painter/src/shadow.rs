//! Soft shadow of bodies on the floor: their silhouette from the light, blurred.

use fuwafuwa::Vector;

/// Unit vector to the stronger light, which casts the shadow.
pub const KEY: Vector = [0.44, 0.71, 0.55];
/// Number of cells of the map on each axis.
const CELLS: usize = 256;

/// Map around the bodies of the share of the stronger light that does not reach the floor.
pub struct Shadow {
    low: [f32; 2],
    cell: f32,
    dark: Vec<f32>,
}

impl Shadow {
    /// Creates the shadow of triangles on a floor at `height` [m].
    pub fn of(triangles: &[[Vector; 3]], height: f32) -> Self {
        let fallen: Vec<[[f32; 2]; 3]> = triangles
            .iter()
            .map(|triangle| triangle.map(|at| projected(at, height)))
            .collect();
        let corners = fallen.iter().flatten();
        let (mut low, mut high) = ([f32::MAX; 2], [f32::MIN; 2]);
        for at in corners {
            for axis in 0..2 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis]);
            }
        }
        let wide = (high[0] - low[0]).max(high[1] - low[1]).max(1e-3);
        let margin = 0.25 * wide;
        let mut shadow = Self {
            low: low.map(|k| k - margin),
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

    fn fill(&mut self, triangle: [[f32; 2]; 3]) {
        let [a, b, c] = triangle.map(|at| self.place(at));
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area.abs() < 1e-9 {
            return;
        }
        let range = |axis: usize| {
            let values = [a[axis], b[axis], c[axis]];
            let low = values.iter().fold(f32::MAX, |a, &b| a.min(b)).max(0.0);
            let high = values.iter().fold(f32::MIN, |a, &b| a.max(b));
            low as usize..CELLS.min(high as usize + 1)
        };
        for y in range(1) {
            for x in range(0) {
                let at = [x as f32 + 0.5, y as f32 + 0.5];
                let edge = |p: [f32; 2], q: [f32; 2]| {
                    ((q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0])) / area
                };
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

    fn place(&self, at: [f32; 2]) -> [f32; 2] {
        [0, 1].map(|k: usize| (at[k] - self.low[k]) / self.cell)
    }

    /// Returns the shadow at a point of the floor: 0 in the light, 1 in full shadow.
    pub fn at(&self, at: Vector) -> f32 {
        let [x, y] = self.place([at[0], at[2]]);
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

    /// Returns the distance of a point from the centre of the map, in multiples of half the map's width.
    pub fn distance(&self, at: Vector) -> f32 {
        let half = 0.5 * self.cell * CELLS as f32;
        let away = [at[0] - self.low[0] - half, at[2] - self.low[1] - half];
        (away[0] * away[0] + away[1] * away[1]).sqrt() / half
    }
}

/// Projects a point along the light onto the floor.
fn projected(at: Vector, height: f32) -> [f32; 2] {
    let drop = (at[1] - height) / KEY[1];
    [at[0] - drop * KEY[0], at[2] - drop * KEY[2]]
}
