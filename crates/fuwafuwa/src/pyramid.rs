//! The multi-level look-up table: which cells of which size exist, and which children each fills.
//!
//! One rule gives the first placement and every later one [Endo 2004, §3.2, Figs. 2 and 4]: a
//! voxel at a front point, or where materials meet, is a cell of level 0; a cell of level l exists
//! when it contains or touches a cell of level l − 1. A cell fills those of its children that are
//! solid and do not exist as cells themselves, and every face-connected part of them is one element.
//!
//! Cracks only grow, so cells only come into being: a release is followed upwards from the voxels
//! at the released point, and the walk ends at the first level where nothing new appears. The cost
//! of a cut goes with what it touches, not with the body.

use crate::dim::{Dim, Point, add, corner, neighbourhood, scale, voxel_around};
use crate::grid::VoxelGrid;
use crate::sharing::Sharing;
use std::marker::PhantomData;

/// A place in the pyramid: level 0 is one voxel, level l is 2^l voxels wide.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cell {
    /// 0 = finest.
    pub level: u8,
    /// Position in units of the cell's own size.
    pub at: Point,
}

impl Cell {
    /// Width in voxels.
    pub fn width(self) -> i32 {
        1 << self.level
    }

    /// The cell of the next level that contains this one.
    pub fn parent(self) -> Self {
        Self {
            level: self.level + 1,
            at: self.at.map(|k| k >> 1),
        }
    }

    /// Which child of its parent this cell is.
    pub fn child_index<D: Dim>(self) -> usize {
        (0..D::N).fold(0, |index, axis| {
            index | ((self.at[axis] & 1) as usize) << axis
        })
    }

    /// Its child `index`.
    ///
    /// # Panics
    /// At level 0, which has no children.
    pub fn child(self, index: usize) -> Self {
        Self {
            level: self.level - 1,
            at: add(scale(self.at, 2), corner(index)),
        }
    }

    /// The voxel in its low corner.
    pub fn first_voxel(self) -> Point {
        scale(self.at, self.width())
    }
}

/// How fine the elements are, and where.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Grading {
    /// Single voxels at the surface, larger ones inside: what cutting needs.
    #[default]
    Graded,
    /// Single voxels everywhere: the reference that graded bodies are measured against.
    Uniform,
    /// Two voxels wide at the surface, every lattice point there a node: the variant that the
    /// paper counts [Endo 2004, §3.1]. It cannot be cut.
    Coarse,
}

/// Which cells exist, level by level.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Pyramid<D: Dim> {
    levels: Vec<Table>,
    grading: Grading,
    dim: PhantomData<D>,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Table {
    size: Point,
    exists: Vec<bool>,
}

impl Table {
    fn index(&self, at: Point) -> Option<usize> {
        let inside = (0..3).all(|axis| at[axis] >= 0 && at[axis] < self.size[axis]);
        inside.then(|| ((at[2] * self.size[1] + at[1]) * self.size[0] + at[0]) as usize)
    }
}

impl<D: Dim> Pyramid<D> {
    /// The cells of a body from scratch.
    pub fn new(grid: &VoxelGrid<D>, sharing: &Sharing<D>, grading: Grading) -> Self {
        let mut pyramid = Self {
            levels: Vec::new(),
            grading,
            dim: PhantomData,
        };
        let mut size = grid.size();
        loop {
            let count = size.iter().map(|&extent| extent as usize).product();
            let top = size == [1; 3];
            // The topmost cell always exists, so that every voxel is owned.
            let exists = vec![top && !pyramid.levels.is_empty(); count];
            pyramid.levels.push(Table { size, exists });
            if top {
                break;
            }
            size = size.map(|extent| (extent + 1) / 2);
        }
        pyramid.refine(grid, sharing, sharing.points());
        pyramid
    }

    /// How fine the cells are.
    pub fn grading(&self) -> Grading {
        self.grading
    }

    /// Number of cells of a level on each axis, whether they exist or not.
    ///
    /// # Panics
    /// When there is no such level.
    pub fn size(&self, level: u8) -> Point {
        self.levels[level as usize].size
    }

    /// Number of levels, the topmost included.
    pub fn level_count(&self) -> usize {
        self.levels.len()
    }

    /// Whether a cell exists: it may own an element, or have handed all its children on.
    pub fn exists(&self, cell: Cell) -> bool {
        let table = self.levels.get(cell.level as usize);
        table.is_some_and(|table| {
            table
                .index(cell.at)
                .is_some_and(|index| table.exists[index])
        })
    }

    /// The children that a cell fills itself: solid, and no cells of their own.
    /// At level 0 the whole voxel, as a mask with every corner set.
    pub fn filled(&self, grid: &VoxelGrid<D>, cell: Cell) -> u8 {
        if !self.exists(cell) {
            return 0;
        }
        if cell.level == 0 {
            return D::ALL_CORNERS;
        }
        (0..D::CORNERS).fold(0, |mask, index| {
            let child = cell.child(index);
            let own = !self.exists(child) && grid.is_solid(child.first_voxel());
            mask | u8::from(own) << index
        })
    }

    /// The cell that owns a solid voxel, and its child that the voxel lies in.
    ///
    /// # Panics
    /// When the voxel is outside the grid the pyramid was made for.
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
                (parent.level as usize) < self.levels.len(),
                "the topmost cell exists"
            );
            if self.exists(parent) {
                return (parent, cell.child_index::<D>());
            }
            cell = parent;
        }
    }

    /// All cells of a level that exist, in memory order.
    pub fn cells(&self, level: u8) -> impl Iterator<Item = Cell> + '_ {
        let size = self.levels[level as usize].size;
        crate::dim::points_in([0; 3], size.map(|extent| extent - 1))
            .map(move |at| Cell { level, at })
            .filter(|&cell| self.exists(cell))
    }

    /// Brings the cells up to date after the groups at `changed` points have changed. Returns the
    /// cells that came into being, level by level in ascending order [Endo 2004, §3.2, phase 1].
    pub fn refine(
        &mut self,
        grid: &VoxelGrid<D>,
        sharing: &Sharing<D>,
        changed: impl Iterator<Item = Point>,
    ) -> Vec<Cell> {
        let mut born = Vec::new();
        let mut layer: Vec<Cell> = Vec::new();
        let everywhere = self.grading == Grading::Uniform;
        let is_coarse = self.grading == Grading::Coarse && self.levels.len() > 1;
        for at in changed.filter(|&at| everywhere || is_fine(grid, sharing, at)) {
            for voxel in (0..D::CORNERS).map(|octant| voxel_around::<D>(at, octant)) {
                let finest = Cell {
                    level: 0,
                    at: voxel,
                };
                let cell = if is_coarse { finest.parent() } else { finest };
                if grid.is_solid(voxel) && self.add(cell) {
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

    /// Makes a cell exist; false when it did already or lies outside the pyramid.
    fn add(&mut self, cell: Cell) -> bool {
        let Some(table) = self.levels.get_mut(cell.level as usize) else {
            return false;
        };
        let Some(index) = table.index(cell.at) else {
            return false;
        };
        !std::mem::replace(&mut table.exists[index], true)
    }
}

/// Whether the voxels around a point must be cells of level 0: a front, or a meeting of materials.
fn is_fine<D: Dim>(grid: &VoxelGrid<D>, sharing: &Sharing<D>, at: Point) -> bool {
    if sharing.is_front(at) {
        return true;
    }
    let first = grid.material(voxel_around::<D>(at, 0));
    (1..D::CORNERS).any(|octant| grid.material(voxel_around::<D>(at, octant)) != first)
}

/// The face-connected parts of a mask of children, in ascending order of their lowest child.
pub fn parts<D: Dim>(mask: u8) -> impl Iterator<Item = u8> {
    let mut left = mask;
    std::iter::from_fn(move || {
        if left == 0 {
            return None;
        }
        let mut part = left & left.wrapping_neg();
        // A child found late may join others before it: a path has at most this many steps.
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
