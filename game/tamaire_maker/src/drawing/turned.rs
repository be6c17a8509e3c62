//! Blocks made from drawings on paper.
//!
//! The drawing keeps its size in cells, so that small drawings stay visible, and comes to the middle of the block. A
//! drawing that is longer than [`LONGEST`] cells is reduced first.

use super::{BLOCK, Drawing, margin, shrink};

/// Maximum width and height of a drawing in a block [cells]. A layer of the block stays empty on every side.
const LONGEST: usize = BLOCK - 2;

/// Distance from the middle of the paper within which half an outline begins [cells].
const NEAR_MIDDLE: usize = 2;

impl Drawing {
    /// Returns the solid part of the paper, reduced so that it fits into a block; `None` if the paper is empty.
    pub(super) fn small(&self) -> Option<Self> {
        let part = self.trimmed()?;
        let size = shrink::reduced(part.size(), LONGEST);
        let cells = shrink::sampled(part.size(), size, |at| part.cell(at.map(|k| k as i32)));
        Some(Self::of(size, cells))
    }

    /// Returns the block that `make` makes from the small drawing. A block stays as it is.
    fn raised(&self, make: impl Fn(&Self) -> Self) -> Self {
        if !self.is_paper() {
            return self.clone();
        }
        self.small().map_or_else(Self::block, |small| make(&small))
    }

    /// Returns a block in which the drawing is a cushion. Half its thickness is √(d (2 R − d)), at least one cell: d is
    /// the distance of a cell's centre to the rim, and R the largest distance in the same piece. A disc becomes a ball.
    /// The cushion is symmetric in z. A block stays as it is.
    pub fn puffed(&self) -> Self {
        self.raised(|small| {
            let halves = small.half_thicknesses();
            small.stacked(|index| halves[index].round().max(1.0) as usize)
        })
    }

    /// Returns a block in which the drawing is a plate of `thickness` cells, 1 to [`BLOCK`]. A block stays as it is.
    pub fn slab(&self, thickness: usize) -> Self {
        let thickness = thickness.clamp(1, BLOCK) as i32;
        let low = (BLOCK as i32 - thickness) / 2;
        self.raised(|small| {
            let [left, bottom, _] = margin([BLOCK; 3], small.size());
            Self::of_fn([BLOCK; 3], |[x, y, z]| {
                match (low..low + thickness).contains(&z) {
                    true => small.cell([x - left, y - bottom, 0]),
                    false => 0,
                }
            })
        })
    }

    /// Returns a block in which the drawing was turned on a lathe, about the vertical axis through the middle of its
    /// solid part. A voxel takes the cell of the drawing at its height and at its distance right of the axis, or left of
    /// the axis if that one is empty. Half an outline, which begins at the middle of the paper, is turned about that middle.
    /// A block stays as it is.
    pub fn lathed(&self) -> Self {
        self.completed().raised(|small| {
            let [width, ..] = small.size();
            let [left, bottom, _] = margin([BLOCK; 3], small.size());
            let middle = 0.5 * width as f32;
            let axis = left as f32 + middle;
            Self::of_fn([BLOCK; 3], |[x, y, z]| {
                let [aside, deep] = [x, z].map(|k| k as f32 + 0.5 - axis);
                let radius = (aside * aside + deep * deep).sqrt();
                let cell = |x: f32| small.cell([x.floor() as i32, y - bottom, 0]);
                match cell(middle + radius) {
                    0 => cell(middle - radius),
                    crayon => crayon,
                }
            })
        })
    }

    /// Returns a drawing of half an outline with its mirror image; any other drawing as it is.
    pub(super) fn completed(&self) -> Self {
        let middle = self.size()[0] / 2;
        let is_half = self.is_paper()
            && self.bounds().is_some_and(|[low, high]| {
                let ends = [low[0], high[0] + 1];
                ends.iter().any(|end| end.abs_diff(middle) <= NEAR_MIDDLE)
            });
        let mut whole = self.clone();
        if is_half {
            for (index, crayon) in self.cells.iter().enumerate() {
                let mirrored = self.lattice.mirrored(index);
                if whole.cells[mirrored] == 0 {
                    whole.cells[mirrored] = *crayon;
                }
            }
        }
        whole
    }

    /// Returns a block in which each cell of this paper becomes a column. `half` returns half its height in z [cells]
    /// from the index of the cell.
    fn stacked(&self, half: impl Fn(usize) -> usize) -> Self {
        let [left, bottom, _] = margin([BLOCK; 3], self.size());
        let middle = BLOCK / 2;
        Self::of_fn([BLOCK; 3], |[x, y, z]| {
            let Some(index) = self.lattice.index([x - left, y - bottom, 0]) else {
                return 0;
            };
            let z = z as usize;
            let layer = if z < middle {
                middle - 1 - z
            } else {
                z - middle
            };
            match layer < half(index) {
                true => self.cells[index],
                false => 0,
            }
        })
    }

    /// Returns half the thickness of the cushion at each cell of the paper [cells]; 0 at empty cells.
    fn half_thicknesses(&self) -> Vec<f32> {
        let pieces = self.pieces();
        let distances = self.rim_distances();
        let mut largest = vec![0.0f32; pieces.count + 1];
        for (&piece, &distance) in pieces.of_cell.iter().zip(&distances) {
            let largest = &mut largest[usize::from(piece)];
            *largest = largest.max(distance);
        }
        let halves = pieces.of_cell.iter().zip(distances);
        halves
            .map(|(&piece, d)| (d * (2.0 * largest[usize::from(piece)] - d)).sqrt())
            .collect()
    }

    /// Returns the distance of each solid cell's centre to the rim of the drawing [cells]; 0 at empty cells. The rim is
    /// half a cell before the centre of the nearest empty cell, on the paper or outside.
    pub(super) fn rim_distances(&self) -> Vec<f32> {
        let [width, height, _] = self.size();
        // Rows above and below the paper are empty, too.
        let rows: Vec<Vec<usize>> = (-1..=height as i32)
            .map(|y| self.row_distances(y))
            .collect();
        let squared = |x: usize, y: usize| {
            let rows = rows.iter().enumerate();
            let squares = rows.map(|(row, distances)| {
                distances[x] * distances[x] + row.abs_diff(y + 1) * row.abs_diff(y + 1)
            });
            squares.min().unwrap_or(0)
        };
        let cells = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        cells
            .map(|(x, y)| ((squared(x, y) as f32).sqrt() - 0.5).max(0.0))
            .collect()
    }

    /// Returns the distance of each cell in a row to the nearest empty cell of this row, on the paper or outside [cells].
    fn row_distances(&self, y: i32) -> Vec<usize> {
        let width = self.size()[0];
        let mut distances = vec![0; width];
        let mut distance = 0;
        let is_solid = |x: usize| self.cell([x as i32, y, 0]) != 0;
        for x in 0..width {
            distance = if is_solid(x) { distance + 1 } else { 0 };
            distances[x] = distance;
        }
        distance = 0;
        for x in (0..width).rev() {
            distance = if is_solid(x) { distance + 1 } else { 0 };
            distances[x] = distances[x].min(distance);
        }
        distances
    }
}
