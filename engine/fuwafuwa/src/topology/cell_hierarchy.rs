//! Cell hierarchy: the set of cells of every size that exist, and the children that each cell fills.
//!
//! The same rule determines the initial cells and the cells after every crack [Endo 2004, §3.2, Figs. 2 and
//! 4]:
//!
//! - A voxel at an open point, or where materials meet, is a cell of level 0.
//! - A cell of level l exists if it contains or touches a cell of level l − 1. All cells of the topmost level
//!   exist, which limits the width of elements to about an eighth of the grid.
//! - A cell fills those of its children that are solid and do not exist as cells. Each face-connected part of
//!   the filled children forms one element.
//!
//! A crack never closes, so a release only adds cells. The update after a release starts at the voxels around
//! the released point, goes up level by level, and ends at the first level without new cells. The cost of a
//! cut is proportional to the number of affected cells, not to the size of the body.

use crate::foundation::dim::{
    Dim, Point, add, corner, neighbourhood, points_in, scale, voxel_around,
};
use crate::foundation::hash::hash_state;
use crate::topology::connectivity::Connectivity;
use crate::topology::grid::VoxelGrid;
use std::marker::PhantomData;

/// Cell of the hierarchy: a square or cube of 2^level voxels across.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cell {
    /// Level; 0 = a single voxel.
    pub level: u8,
    /// Coordinates of the cell on its level: the position of its low corner, in widths of the cell.
    pub at: Point,
}

hash_state! { struct Cell { level, at } }

impl Cell {
    /// Returns the width in voxels.
    #[inline]
    pub fn width(self) -> i32 {
        1 << self.level
    }

    /// Returns the cell of the next coarser level that contains this cell.
    #[inline]
    pub fn parent(self) -> Self {
        Self {
            level: self.level + 1,
            at: self.at.map(|k| k >> 1),
        }
    }

    /// Returns the index of this cell among the children of its parent.
    #[inline]
    pub fn child_index<D: Dim>(self) -> usize {
        (0..D::N).fold(0, |index, axis| {
            index | ((self.at[axis] & 1) as usize) << axis
        })
    }

    /// Returns the child with number `index`.
    ///
    /// # Panics
    /// At level 0, which has no children.
    #[inline]
    pub fn child(self, index: usize) -> Self {
        Self {
            level: self.level - 1,
            at: add(scale(self.at, 2), corner(index)),
        }
    }

    /// Returns the level-0 cell of a voxel.
    #[inline]
    pub fn of(voxel: Point) -> Self {
        Self {
            level: 0,
            at: voxel,
        }
    }

    /// Returns the voxel in the low corner of the cell.
    #[inline]
    pub fn first_voxel(self) -> Point {
        scale(self.at, self.width())
    }
}

/// Numbering of all possible cells of a grid, level by level. Tables with one entry for each cell use these
/// numbers as indices.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CellIndexing {
    /// For each level, the number of cells on each axis, and the index of the level's first cell.
    levels: Vec<(Point, usize)>,
    count: usize,
}

hash_state! { struct CellIndexing { levels, count } }

/// Ratio of the longest axis of a grid to the largest allowed width of a cell. Levels up to `SMALL_LEVEL` are
/// exempt.
///
/// The mass of an element of width H lies in its nodes, so that its second moment ∫ x² dm is too large by
/// H²/6 per unit of mass. A disc of diameter D with cells up to H = D/4 therefore vibrates 3 % too slowly,
/// even with very small voxels. With H = D/8 the error is 1 %, at the cost of a dozen additional elements.
const WIDEST: i32 = 8;
/// Highest level that is exempt from [`WIDEST`]. Without the exemption, small bodies would have elements of
/// level 0 only: level 1 would require a grid of 16 voxels across, and level 2 one of 32.
const SMALL_LEVEL: usize = 2;

impl CellIndexing {
    /// Numbers the cells of a grid of `size` voxels, from level 0 up to the largest allowed cells.
    fn new(mut size: Point) -> Self {
        let longest = size[0].max(size[1]).max(size[2]);
        let mut cell_indexing = Self {
            levels: Vec::new(),
            count: 0,
        };
        loop {
            let next = cell_indexing.levels.len() + 1;
            cell_indexing.levels.push((size, cell_indexing.count));
            cell_indexing.count += cell_indexing.count_of(next - 1);
            if size == [1; 3] || next > SMALL_LEVEL && WIDEST << next > longest {
                return cell_indexing;
            }
            size = size.map(|extent| (extent + 1) / 2);
        }
    }

    /// Returns the number of possible cells.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the number of possible cells of a level.
    pub fn count_of(&self, level: usize) -> usize {
        let (size, _) = self.levels[level];
        size.iter().map(|&extent| extent as usize).product()
    }

    /// Returns the index of a cell; `None` if the cell is outside the grid.
    #[inline]
    pub fn index(&self, cell: Cell) -> Option<usize> {
        let &(size, first) = self.levels.get(cell.level as usize)?;
        let inside = (0..3).all(|axis| cell.at[axis] >= 0 && cell.at[axis] < size[axis]);
        let [x, y, z] = cell.at.map(|k| k as usize);
        inside.then(|| first + (z * size[1] as usize + y) * size[0] as usize + x)
    }

    /// Returns the indices of the voxels around a lattice point, by octant; `None` if some of them are
    /// outside the grid.
    #[inline]
    pub fn voxels_around<D: Dim>(&self, at: Point) -> Option<[usize; 8]> {
        let (size, _) = self.levels[0];
        let inside = (0..D::N).all(|axis| at[axis] > 0 && at[axis] < size[axis]);
        let low = self.index(Cell::of(voxel_around::<D>(at, 0)))?;
        let steps = [1, size[0] as usize, (size[0] * size[1]) as usize];
        let step = |octant: usize, axis: usize| (octant >> axis & 1) * steps[axis];
        inside.then(|| {
            std::array::from_fn(|octant| low + (0..3).map(|axis| step(octant, axis)).sum::<usize>())
        })
    }
}

/// Grading: how the size of elements grows from the surface of a body to the inside.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Grading {
    /// Elements of one voxel at the surface, larger elements inside. Required for cutting.
    #[default]
    Graded,
    /// Elements of one voxel everywhere. Serves as the reference for graded bodies.
    Uniform,
    /// Elements two voxels wide at the surface, with a node at every lattice point of the surface. This is
    /// the mesh whose vertices [Endo 2004, §3.1] counts. For counting and comparison only: the body does not
    /// tear, cannot be cut, and has no surface for drawing or contact.
    Coarse,
}

hash_state! { enum Grading { Graded, Uniform, Coarse } }

/// Cell hierarchy of a body: for each possible cell, whether the cell exists.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct CellHierarchy<D: Dim> {
    cell_indexing: CellIndexing,
    grading: Grading,
    exists: Vec<bool>,
    dim: PhantomData<D>,
}

hash_state! { [D: Dim] struct CellHierarchy<D> { cell_indexing, grading, exists } skip { dim } }

impl<D: Dim> CellHierarchy<D> {
    /// Builds the cell hierarchy of a body from scratch.
    #[inline(never)]
    pub fn new(grid: &VoxelGrid<D>, connectivity: &Connectivity<D>, grading: Grading) -> Self {
        let cell_indexing = CellIndexing::new(grid.size());
        let mut exists = vec![false; cell_indexing.count()];
        // All cells of the topmost level exist, so that each voxel belongs to some cell.
        if let [_, .., (_, first)] = cell_indexing.levels[..] {
            exists[first..].fill(true);
        }
        let mut hierarchy = Self {
            cell_indexing,
            grading,
            exists,
            dim: PhantomData,
        };
        hierarchy.refine(grid, connectivity, connectivity.points());
        hierarchy
    }

    /// Returns the grading of the body.
    pub fn grading(&self) -> Grading {
        self.grading
    }

    /// Returns the number of levels, including the topmost one.
    pub fn level_count(&self) -> usize {
        self.cell_indexing.levels.len()
    }

    /// Returns the numbering of all possible cells.
    pub fn cell_indexing(&self) -> &CellIndexing {
        &self.cell_indexing
    }

    /// Returns whether a cell exists. An existing cell has no elements of its own if all its solid children
    /// exist as cells, too.
    #[inline]
    pub fn exists(&self, cell: Cell) -> bool {
        let number = self.cell_indexing.index(cell);
        number.is_some_and(|number| self.exists[number])
    }

    /// Returns the mask of the children that a cell fills: those that are solid and do not exist as cells.
    /// Every bit is set at level 0, where cells have no children, and no bit if the cell does not exist.
    pub fn filled(&self, grid: &VoxelGrid<D>, cell: Cell) -> u8 {
        if !self.exists(cell) {
            return 0;
        }
        if cell.level == 0 {
            return D::ALL_CORNERS;
        }
        (0..D::CORNERS).fold(0, |mask, index| {
            let child = cell.child(index);
            let own = !self.exists(child) && grid.is_present(child.first_voxel());
            mask | u8::from(own) << index
        })
    }

    /// Returns the finest existing cell that contains a solid voxel, and the index of its child that contains
    /// the voxel.
    ///
    /// # Panics
    /// If the voxel is outside the grid of the hierarchy.
    pub fn owner(&self, voxel: Point) -> (Cell, usize) {
        let mut cell = Cell {
            level: 0,
            at: voxel,
        };
        if self.exists(cell) {
            return (cell, 0);
        }
        loop {
            let parent = cell.parent();
            assert!(
                (parent.level as usize) < self.level_count(),
                "no cell owns the voxel: voxel outside the grid"
            );
            if self.exists(parent) {
                return (parent, cell.child_index::<D>());
            }
            cell = parent;
        }
    }

    /// Returns all existing cells of a level, in memory order.
    pub fn cells(&self, level: u8) -> impl Iterator<Item = Cell> + '_ {
        let (size, _) = self.cell_indexing.levels[level as usize];
        points_in([0; 3], size.map(|extent| extent - 1))
            .map(move |at| Cell { level, at })
            .filter(|&cell| self.exists(cell))
    }

    /// Adds the cells that are required after voxel groups at the `changed` lattice points have been split.
    /// Returns the new cells, ascending by level, then in memory order [Endo 2004, §3.2, phase 1].
    pub fn refine(
        &mut self,
        grid: &VoxelGrid<D>,
        connectivity: &Connectivity<D>,
        changed: impl Iterator<Item = Point>,
    ) -> Vec<Cell> {
        let mut born = Vec::new();
        let mut layer: Vec<Cell> = Vec::new();
        let everywhere = self.grading == Grading::Uniform;
        let is_coarse = self.grading == Grading::Coarse && self.level_count() > 1;
        for at in changed.filter(|&at| everywhere || is_fine(grid, connectivity, at)) {
            for voxel in (0..D::CORNERS).map(|octant| voxel_around::<D>(at, octant)) {
                let finest = Cell {
                    level: 0,
                    at: voxel,
                };
                let cell = if is_coarse { finest.parent() } else { finest };
                if grid.is_present(voxel) && self.add(cell) {
                    layer.push(cell);
                }
            }
        }
        while !layer.is_empty() {
            let mut above = Vec::new();
            for &cell in &layer {
                for touched in neighbourhood::<D>(cell.at, 1) {
                    let parent = Cell {
                        level: cell.level,
                        at: touched,
                    }
                    .parent();
                    if self.add(parent) {
                        above.push(parent);
                    }
                }
            }
            born.append(&mut layer);
            layer = above;
        }
        born.sort_unstable_by_key(|cell| (cell.level, [cell.at[2], cell.at[1], cell.at[0]]));
        born
    }

    /// Removes the cells of removed voxels, and the coarser cells that existed only because of these cells.
    /// The result equals a hierarchy built from scratch. A cell of which some voxels remain is never removed:
    /// the remaining voxels touched the removed ones at open points, so they are cells of level 0, which
    /// require the coarser cell.
    pub(crate) fn remove_voxels(
        &mut self,
        grid: &VoxelGrid<D>,
        connectivity: &Connectivity<D>,
        voxels: &[Point],
    ) {
        if self.grading == Grading::Coarse {
            // Rebuilds the hierarchy. A body of this grading has no cells of level 0, from which the update
            // below starts.
            *self = Self::new(grid, connectivity, self.grading);
            return;
        }
        let mut gone: Vec<Cell> = voxels.iter().map(|&voxel| Cell::of(voxel)).collect();
        gone.retain(|&cell| self.remove(cell));
        while let Some(&Cell { level, .. }) = gone.first() {
            if usize::from(level) + 2 >= self.level_count() {
                return;
            }
            let around = |cell: &Cell| {
                let near = neighbourhood::<D>(cell.at, 1);
                near.map(move |at| Cell { level, at }.parent())
            };
            let mut above: Vec<Cell> = gone.iter().flat_map(around).collect();
            above.sort_unstable();
            above.dedup();
            let is_alone = |cell: &Cell| {
                let [low, high] = [-1, 2].map(|by| {
                    let mut at = scale(cell.at, 2);
                    at.iter_mut().take(D::N).for_each(|k| *k += by);
                    at
                });
                !points_in(low, high).any(|at| self.exists(Cell { level, at }))
            };
            above.retain(is_alone);
            above.retain(|&cell| self.remove(cell));
            gone = above;
        }
    }

    /// Removes a cell; returns false if the cell did not exist.
    fn remove(&mut self, cell: Cell) -> bool {
        let number = self.cell_indexing.index(cell);
        number.is_some_and(|number| std::mem::replace(&mut self.exists[number], false))
    }

    /// Adds a cell; returns false if the cell already existed or lies outside the grid.
    fn add(&mut self, cell: Cell) -> bool {
        let number = self.cell_indexing.index(cell);
        number.is_some_and(|number| !std::mem::replace(&mut self.exists[number], true))
    }
}

/// Returns whether the voxels around a lattice point must be cells of level 0, because the point is open or
/// because different materials meet at the point.
fn is_fine<D: Dim>(grid: &VoxelGrid<D>, connectivity: &Connectivity<D>, at: Point) -> bool {
    if connectivity.is_open(at) {
        return true;
    }
    let first = grid.material(voxel_around::<D>(at, 0));
    (1..D::CORNERS).any(|octant| grid.material(voxel_around::<D>(at, octant)) != first)
}

/// Returns the face-connected parts of a mask of children, each as a mask, ascending by lowest child.
pub fn parts<D: Dim>(mask: u8) -> impl Iterator<Item = u8> {
    let mut left = mask;
    std::iter::from_fn(move || {
        if left == 0 {
            return None;
        }
        let mut part = left & left.wrapping_neg();
        // Repeats the pass, because a child that is found late may connect children that were tested before.
        // As many passes as children suffice, because no path through the children is longer.
        for _ in 0..D::CORNERS {
            let known = part;
            for child in (0..D::CORNERS).filter(|child| known >> child & 1 == 1) {
                part |= (0..D::N).fold(0, |near, axis| near | left & 1 << (child ^ 1 << axis));
            }
        }
        left &= !part;
        Some(part)
    })
}
