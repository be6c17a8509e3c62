//! Tools that change the cells of a drawing.

use super::Drawing;
use fuwafuwa::inspect::points_in;
use fuwafuwa::{Dim, Dim2, Dim3, Vec3, VoxelGrid};
use fuwafuwa_scenes::scene::Form;

/// Effect of a stroke on the cells that it covers.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Brush {
    /// Fills cells with a crayon; crayon 0 empties them.
    Draw(u8),
    /// Gives solid cells another crayon; empty cells stay empty.
    Paint(u8),
    /// Empties cells.
    Erase,
}

impl Brush {
    fn applied(self, cell: u8) -> u8 {
        match self {
            Self::Draw(crayon) => crayon,
            Self::Paint(_) if cell == 0 => 0,
            Self::Paint(crayon) => crayon,
            Self::Erase => 0,
        }
    }
}

/// Stroke that was not ended yet.
#[derive(Clone, Debug, Default)]
pub(super) struct Stroke {
    /// Whether the stroke changed a cell.
    pub(super) is_changed: bool,
    /// Crayon with which the stroke last drew.
    crayon: Option<u8>,
}

/// All points within a radius of a line.
struct Capsule {
    from: [f64; 3],
    to: [f64; 3],
    squared_radius: f64,
}

impl Capsule {
    fn contains(&self, point: [f64; 3]) -> bool {
        let line = difference(self.to, self.from);
        let offset = difference(point, self.from);
        let squared_length = dot(line, line);
        let share = match squared_length > 0.0 {
            true => (dot(offset, line) / squared_length).clamp(0.0, 1.0),
            false => 0.0,
        };
        let nearest = line.map(|k| share * k);
        let apart = difference(offset, nearest);
        dot(apart, apart) <= self.squared_radius
    }

    /// Returns the lowest and the highest cell of a box of `size` cells that the capsule may reach. The lowest is above
    /// the highest if it reaches none.
    fn cells(&self, size: [usize; 3]) -> [[i32; 3]; 2] {
        let radius = self.squared_radius.sqrt();
        let low = [0, 1, 2].map(|axis: usize| {
            let low = self.from[axis].min(self.to[axis]) - radius;
            (low.floor() as i32).clamp(0, size[axis] as i32)
        });
        let high = [0, 1, 2].map(|axis: usize| {
            let high = self.from[axis].max(self.to[axis]) + radius;
            (high.floor() as i32).clamp(-1, size[axis] as i32 - 1)
        });
        [low, high]
    }
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Drawing {
    /// Draws a part of a stroke: changes all cells whose centres are within `radius` [cells] of the line between two
    /// points [cells], and their mirror image if [`Drawing::mirror`] is set. Returns whether a cell changed.
    ///
    /// The radius is raised to half the diagonal of a cell, so that thin strokes have no gaps. Non-finite values do
    /// nothing.
    pub fn stroke(&mut self, from: Vec3, to: Vec3, radius: f32, brush: Brush) -> bool {
        let (from, to) = (self.on_sheet(from), self.on_sheet(to));
        if !(from.is_finite() && to.is_finite() && radius.is_finite()) {
            return false;
        }
        let wide = |point: Vec3| point.to_array().map(f64::from);
        let radius = f64::from(radius.max(0.0));
        let capsule = Capsule {
            from: wide(from),
            to: wide(to),
            squared_radius: (radius * radius).max(0.25 * self.lattice.axes() as f64),
        };
        let [low, high] = capsule.cells(self.size());
        let mut is_changed = false;
        for at in points_in(low, high) {
            if capsule.contains(at.map(|k| f64::from(k) + 0.5)) {
                is_changed |= self.apply(at, brush);
            }
        }
        self.stroke.is_changed |= is_changed;
        if let Brush::Draw(crayon) = brush {
            self.stroke.crayon = Some(crayon).filter(|&crayon| crayon != 0);
        }
        is_changed
    }

    /// Returns a point in the middle plane of the paper; in space the point itself.
    fn on_sheet(&self, point: Vec3) -> Vec3 {
        match self.is_paper() {
            true => Vec3::new(point.x, point.y, 0.5),
            false => point,
        }
    }

    /// Applies a brush to a cell, and to its mirror image if that is set. Returns whether a cell changed. Cells outside
    /// are ignored.
    fn apply(&mut self, at: [i32; 3], brush: Brush) -> bool {
        let Some(index) = self.lattice.index(at) else {
            return false;
        };
        let image = match self.mirror {
            true => self.lattice.mirrored(index),
            false => index,
        };
        let mut is_changed = false;
        for index in [index, image] {
            let cell = brush.applied(self.cells[index]);
            is_changed |= cell != self.cells[index];
            self.cells[index] = cell;
        }
        is_changed
    }

    /// Ends a stroke, which is then one step of undo.
    ///
    /// A stroke of [`Brush::Draw`] fills the empty cells that it enclosed with its crayon, if [`Drawing::closes`] is
    /// set. Cells are enclosed if no way through faces of empty cells leads out of the drawing, and if there was such a
    /// way before the stroke.
    pub fn end_stroke(&mut self) {
        if let Some(crayon) = self.stroke.crayon.filter(|_| self.closes) {
            self.fill_enclosed(crayon);
        }
        self.commit();
    }

    fn fill_enclosed(&mut self, crayon: u8) {
        let before = self.lattice.outside(&self.history.present().cells());
        let now = self.lattice.outside(&self.cells);
        for (index, cell) in self.cells.iter_mut().enumerate() {
            if *cell == 0 && before[index] && !now[index] {
                *cell = crayon;
            }
        }
    }

    /// Gives a crayon to the face-connected region of equal cells around `at`; crayon 0 empties the region. Returns
    /// whether a cell changed. An empty region that reaches the border of the drawing stays empty. This is one step of
    /// undo.
    pub fn fill(&mut self, at: [i32; 3], crayon: u8) -> bool {
        self.end_stroke();
        let Some(start) = self.lattice.index(at) else {
            return false;
        };
        let known = self.cells[start];
        let cells = &self.cells;
        let is_in_region =
            (self.lattice).flooded(std::iter::once(start), |index| cells[index] == known);
        let mut region = (0..cells.len()).filter(|&index| is_in_region[index]);
        if known == 0 && region.any(|index| self.lattice.is_at_border(index)) {
            return false;
        }
        for (cell, _) in self
            .cells
            .iter_mut()
            .zip(is_in_region)
            .filter(|pair| pair.1)
        {
            *cell = crayon;
        }
        self.commit()
    }

    /// Fills a shape of `width` cells around `centre` [cells] with a crayon, and its mirror image if [`Drawing::mirror`]
    /// is set; crayon 0 empties the shape. Returns whether a cell changed. This is one step of undo.
    ///
    /// The width is rounded to whole cells, and is at most twice that of the drawing. Non-finite values, widths of 0 or
    /// less and [`Form::Empty`] do nothing, nor does a shape that is too small to contain the centre of a cell.
    pub fn stamp(&mut self, form: Form, centre: Vec3, width: f32, crayon: u8) -> bool {
        self.end_stroke();
        let centre = self.on_sheet(centre);
        if !(centre.is_finite() && width.is_finite() && width > 0.0) {
            return false;
        }
        match self.is_paper() {
            true => self.stamp_in::<Dim2>(form, centre, width, crayon),
            false => self.stamp_in::<Dim3>(form, centre, width, crayon),
        }
        self.commit()
    }

    fn stamp_in<D: Dim>(&mut self, form: Form, centre: Vec3, width: f32, crayon: u8) {
        let most = 2 * self.size().into_iter().max().unwrap_or(1);
        let Some(shape) = shape_of::<D>(form, (width.round() as usize).clamp(1, most)) else {
            return;
        };
        let extent = Vec3::from(shape.size().map(|extent| extent as f32));
        let low = (centre - 0.5 * extent).round().to_array();
        let low = low.map(|k| k as i32);
        for voxel in shape.voxels().filter(|&voxel| shape.is_solid(voxel)) {
            let at = [0, 1, 2].map(|axis: usize| low[axis].saturating_add(voxel[axis]));
            self.apply(at, Brush::Draw(crayon));
        }
    }

    /// Takes over the cells of a drawing of the same size. This is one step of undo. Does nothing for another size. Returns
    /// whether a cell changed.
    pub fn replace(&mut self, other: &Self) -> bool {
        if self.size() != other.size() {
            return false;
        }
        self.end_stroke();
        self.cells.clone_from(&other.cells);
        self.commit()
    }

    /// Takes over the cells of a drawing of the same size in place of those of the last step, without a further step of
    /// undo. Does nothing for another size.
    pub fn replace_again(&mut self, other: &Self) {
        if self.size() == other.size() {
            self.end_stroke();
            self.cells.clone_from(&other.cells);
            self.history.amend(super::Runs::of(&self.cells));
        }
    }

    /// Empties all cells. This is one step of undo.
    pub fn clear(&mut self) {
        self.end_stroke();
        self.cells.fill(0);
        self.commit();
    }
}

/// Returns a shape of `n` voxels across; `None` if no voxel is solid.
fn shape_of<D: Dim>(form: Form, n: usize) -> Option<VoxelGrid<D>> {
    let shape = match form {
        Form::Ball => VoxelGrid::ball(n, 1.0),
        Form::Box => VoxelGrid::from_fn([n, n, D::depth(n)], 1.0, |_| 1),
        Form::Ring => VoxelGrid::ring(n, 1.0),
        Form::Heart => VoxelGrid::heart(n, 1.0),
        Form::Flower => VoxelGrid::flower(n, 1.0),
        Form::Empty => return None,
    };
    shape.ok()
}
