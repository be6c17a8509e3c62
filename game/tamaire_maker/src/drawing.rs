//! Bodies that players draw with crayons: on paper (2D) or in space (3D).
//!
//! A [`Drawing`] is a box of cells. A cell holds the number of a crayon, 1 to 255, or 0 if it is empty. The numbers are
//! those of the materials of the level into which the body goes.
//!
//! Positions are in units of cells, from the low corner of the box: the first cell reaches from 0 to 1 on each axis. The
//! second axis points up. Paper has one layer of cells, and its third axis is ignored.
//!
//! - `lattice`: neighbours of cells, and regions of cells
//! - `brush`: tools that change cells
//! - `shrink`: fewer, larger cells
//! - `turned`: blocks made from paper
//! - `look`: rays and faces, for pictures of a block

mod brush;
mod lattice;
mod look;
mod shrink;
#[cfg(test)]
mod tests;
mod turned;

pub use brush::Brush;
pub use look::{Face, Hit};

use crate::history::History;
use brush::Stroke;
use fuwafuwa::inspect::points_in;
use fuwafuwa::{Dim, VoxelGrid};
use fuwafuwa_scenes::scene::VoxelsText;
use lattice::Lattice;

/// Width and height of the paper [cells].
pub const PAPER: usize = 64;
/// Width, height and depth of a block [cells].
pub const BLOCK: usize = 32;

/// Body of cells, drawn on paper or in space, with its history.
///
/// Two drawings are equal if their sizes and cells are equal.
#[derive(Clone, Debug)]
pub struct Drawing {
    lattice: Lattice,
    cells: Vec<u8>,
    history: History<Runs>,
    mirror: bool,
    closes: bool,
    stroke: Stroke,
}

impl PartialEq for Drawing {
    fn eq(&self, other: &Self) -> bool {
        (self.lattice, &self.cells) == (other.lattice, &other.cells)
    }
}

/// Cells as run lengths: number of cells and their crayon.
#[derive(Clone, Debug, PartialEq)]
struct Runs(Vec<(u16, u8)>);

impl Runs {
    fn of(cells: &[u8]) -> Self {
        let runs = cells.chunk_by(|a, b| a == b);
        // A drawing has at most `BLOCK`³ cells, which a `u16` can count.
        Self(runs.map(|run| (run.len() as u16, run[0])).collect())
    }

    fn cells(&self) -> Vec<u8> {
        let runs = self.0.iter();
        runs.flat_map(|&(length, crayon)| std::iter::repeat_n(crayon, usize::from(length)))
            .collect()
    }
}

/// Face-connected pieces of a drawing, see [`Drawing::pieces`].
#[derive(Clone, Debug, PartialEq)]
pub struct Pieces {
    /// Number of the piece of each cell, counted from 1 in the order of the cells; 0 for empty cells.
    pub of_cell: Vec<u16>,
    /// Number of pieces.
    pub count: usize,
}

impl Drawing {
    /// Creates empty paper, [`PAPER`] cells wide and high.
    pub fn paper() -> Self {
        Self::empty([PAPER, PAPER, 1])
    }

    /// Creates an empty block, [`BLOCK`] cells wide, high and deep.
    pub fn block() -> Self {
        Self::empty([BLOCK; 3])
    }

    /// Creates a drawing from its cells, the first axis fastest. `None` if the number of cells is not that of the size,
    /// or if the drawing would be larger than paper (with a depth of 1) or than a block.
    pub fn of_cells(size: [usize; 3], cells: Vec<u8>) -> Option<Self> {
        let most = if size[2] == 1 { PAPER } else { BLOCK };
        let fits = size.iter().all(|extent| (1..=most).contains(extent));
        let is_complete = fits && cells.len() == size.iter().product::<usize>();
        is_complete.then(|| Self::of(size, cells))
    }

    /// Creates a drawing from the grid of a body, in the middle of paper or of a block. The drawing is only as large as
    /// the solid part of the grid. A larger body is reduced, without change of its proportions: each cell takes the
    /// majority of the voxels that it covers, and is solid if at least a third of them are.
    pub fn of_grid<D: Dim>(grid: &VoxelGrid<D>) -> Self {
        Self::of_grid_scaled(grid).0
    }

    /// Creates a drawing as [`Drawing::of_grid`] does. Also returns the edge length of a cell in voxels, at least 1.
    pub fn of_grid_scaled<D: Dim>(grid: &VoxelGrid<D>) -> (Self, f32) {
        let size = match D::N {
            2 => [PAPER, PAPER, 1],
            _ => [BLOCK; 3],
        };
        let solid = grid.voxels().filter(|&voxel| grid.is_present(voxel));
        let Some([low, high]) = box_around(solid) else {
            return (Self::empty(size), 1.0);
        };
        let extent = [0, 1, 2].map(|axis: usize| (high[axis] - low[axis] + 1) as usize);
        let reduced = shrink::reduced(extent, size[0]);
        let cells = shrink::sampled(extent, reduced, |at| {
            let voxel = [0, 1, 2].map(|axis: usize| low[axis] + at[axis] as i32);
            match grid.is_present(voxel) {
                true => grid.material(voxel),
                false => 0,
            }
        });
        let [before, after] = [extent, reduced].map(|sides| sides.into_iter().max().unwrap_or(1));
        let drawing = Self::centred(size, &Self::of(reduced, cells));
        (drawing, before as f32 / after as f32)
    }

    fn empty(size: [usize; 3]) -> Self {
        Self::of(size, vec![0; size.iter().product()])
    }

    fn of(size: [usize; 3], cells: Vec<u8>) -> Self {
        Self {
            lattice: Lattice { size },
            history: History::new(Runs::of(&cells)),
            cells,
            mirror: false,
            closes: true,
            stroke: Stroke::default(),
        }
    }

    /// Creates a drawing of `size` from a function of the cell.
    fn of_fn(size: [usize; 3], crayon: impl FnMut([i32; 3]) -> u8) -> Self {
        let high = size.map(|extent| extent as i32 - 1);
        Self::of(size, points_in([0; 3], high).map(crayon).collect())
    }

    /// Creates a drawing of `size` with another drawing, which is not larger, in its middle.
    fn centred(size: [usize; 3], drawing: &Self) -> Self {
        let low = margin(size, drawing.size());
        Self::of_fn(size, |at| {
            drawing.cell([0, 1, 2].map(|axis: usize| at[axis] - low[axis]))
        })
    }

    /// Returns a copy without steps to undo.
    pub fn without_history(&self) -> Self {
        let mut copy = Self::empty(self.size());
        copy.cells.clone_from(&self.cells);
        copy.history = History::new(Runs::of(&copy.cells));
        copy
    }

    /// Returns a copy with other crayons, without steps to undo. `numbers` has the new crayon of each crayon.
    pub fn renumbered(&self, numbers: &[u8; 256]) -> Self {
        let mut copy = self.clone();
        for cell in &mut copy.cells {
            *cell = numbers[usize::from(*cell)];
        }
        copy.history = History::new(Runs::of(&copy.cells));
        copy
    }

    /// Returns the number of cells on each axis; 1 on the third axis of paper.
    pub fn size(&self) -> [usize; 3] {
        self.lattice.size
    }

    /// Returns whether the drawing is on paper.
    pub fn is_paper(&self) -> bool {
        self.lattice.axes() == 2
    }

    /// Returns the crayon of a cell: 0 if the cell is empty or outside.
    pub fn cell(&self, at: [i32; 3]) -> u8 {
        self.lattice.index(at).map_or(0, |index| self.cells[index])
    }

    /// Returns the crayon of each cell, the first axis fastest, like the voxels of a [`VoxelGrid`].
    pub fn cells(&self) -> &[u8] {
        &self.cells
    }

    /// Returns whether strokes and stamps also draw their mirror image in x; default false.
    pub fn mirror(&self) -> bool {
        self.mirror
    }

    /// Sets whether strokes and stamps also draw their mirror image in x.
    pub fn set_mirror(&mut self, mirror: bool) {
        self.mirror = mirror;
    }

    /// Returns whether the end of a stroke fills what the stroke enclosed, see [`Drawing::end_stroke`]; default true.
    pub fn closes(&self) -> bool {
        self.closes
    }

    /// Sets whether the end of a stroke fills what the stroke enclosed.
    pub fn set_closes(&mut self, closes: bool) {
        self.closes = closes;
    }

    /// Undoes the last change. A stroke that was not ended is ended first. Returns whether there was a change.
    pub fn undo(&mut self) -> bool {
        self.end_stroke();
        let is_undone = self.history.undo();
        self.restore(is_undone)
    }

    /// Makes the change again that was undone last. Returns whether there was one.
    pub fn redo(&mut self) -> bool {
        self.end_stroke();
        let is_redone = self.history.redo();
        self.restore(is_redone)
    }

    fn restore(&mut self, is_changed: bool) -> bool {
        if is_changed {
            self.cells = self.history.present().cells();
        }
        is_changed
    }

    /// Returns whether there is a change to undo.
    pub fn can_undo(&self) -> bool {
        self.stroke.is_changed || self.history.can_undo()
    }

    /// Returns whether there is an undone change.
    pub fn can_redo(&self) -> bool {
        !self.stroke.is_changed && self.history.can_redo()
    }

    /// Notes the present cells as a step of the history. Returns whether they differ from those of the step before.
    fn commit(&mut self) -> bool {
        self.stroke = Stroke::default();
        let next = Runs::of(&self.cells);
        let is_changed = next != *self.history.present();
        self.history.commit(next);
        is_changed
    }

    /// Returns whether all cells are empty.
    pub fn is_empty(&self) -> bool {
        self.cells.iter().all(|&crayon| crayon == 0)
    }

    /// Returns the number of solid cells.
    pub fn solid_count(&self) -> usize {
        self.cells.iter().filter(|&&crayon| crayon != 0).count()
    }

    /// Returns the lowest and the highest solid cell on each axis; `None` if the drawing is empty.
    pub fn bounds(&self) -> Option<[[usize; 3]; 2]> {
        let solid = self.solid_cells();
        box_around(solid.map(|index| self.lattice.point(index)))
            .map(|corners| corners.map(|corner| corner.map(|k| k as usize)))
    }

    fn solid_cells(&self) -> impl Iterator<Item = usize> {
        let cells = self.cells.iter().enumerate();
        cells.filter_map(|(index, &crayon)| (crayon != 0).then_some(index))
    }

    /// Returns the face-connected pieces of solid cells. Each becomes a piece of the body.
    pub fn pieces(&self) -> Pieces {
        let mut pieces = Pieces {
            of_cell: vec![0; self.cells.len()],
            count: 0,
        };
        for start in self.solid_cells() {
            if pieces.of_cell[start] != 0 {
                continue;
            }
            pieces.count += 1;
            pieces.of_cell[start] = pieces.count as u16;
            let mut open = vec![start];
            while let Some(index) = open.pop() {
                for next in self.lattice.neighbours(index).flatten() {
                    if self.cells[next] != 0 && pieces.of_cell[next] == 0 {
                        pieces.of_cell[next] = pieces.count as u16;
                        open.push(next);
                    }
                }
            }
        }
        pieces
    }

    /// Returns for each cell whether it is a thin part that breaks at a touch: solid, but in no solid block of two
    /// cells on each axis (2 × 2 on paper, 2 × 2 × 2 in space).
    pub fn thin_cells(&self) -> Vec<bool> {
        let mut thin: Vec<bool> = self.cells.iter().map(|&crayon| crayon != 0).collect();
        let axes = self.lattice.axes();
        for low in self.solid_cells() {
            let low = self.lattice.point(low);
            let mut high = low;
            high[..axes].iter_mut().for_each(|k| *k += 1);
            if points_in(low, high).all(|at| self.cell(at) != 0) {
                for index in points_in(low, high).filter_map(|at| self.lattice.index(at)) {
                    thin[index] = false;
                }
            }
        }
        thin
    }

    /// Returns the solid part as the voxels of a body with the edge length `voxel_size` [m], and the cell in its low
    /// corner. `None` if the drawing is empty.
    pub fn voxels(&self, voxel_size: f32) -> Option<(VoxelsText, [usize; 3])> {
        let part = self.trimmed()?;
        let [low, _] = self.bounds()?;
        let runs = part.cells.chunk_by(|a, b| a == b);
        let runs: Vec<String> = runs
            .map(|run| format!("{}x{}", run.len(), run[0]))
            .collect();
        let text = VoxelsText {
            size: part.size(),
            voxel_size,
            runs: runs.join(" "),
            surface: None,
        };
        Some((text, low))
    }

    /// Returns the drawing without its empty margin; `None` if the drawing is empty.
    fn trimmed(&self) -> Option<Self> {
        let [low, high] = self.bounds()?;
        let size = [0, 1, 2].map(|axis: usize| high[axis] - low[axis] + 1);
        Some(Self::of_fn(size, |at| {
            self.cell([0, 1, 2].map(|axis: usize| low[axis] as i32 + at[axis]))
        }))
    }
}

/// Returns the low corner of a box of `extent` cells in the middle of a box of `size` cells.
fn margin(size: [usize; 3], extent: [usize; 3]) -> [i32; 3] {
    [0, 1, 2].map(|axis: usize| (size[axis].saturating_sub(extent[axis]) / 2) as i32)
}

/// Returns the lowest and the highest coordinates of points; `None` without a point.
fn box_around(points: impl Iterator<Item = [i32; 3]>) -> Option<[[i32; 3]; 2]> {
    points.fold(None, |found, point| {
        let [low, high] = found.unwrap_or([point; 2]);
        Some([
            [0, 1, 2].map(|axis: usize| low[axis].min(point[axis])),
            [0, 1, 2].map(|axis: usize| high[axis].max(point[axis])),
        ])
    })
}
