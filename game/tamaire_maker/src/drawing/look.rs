//! Rays and faces, for pictures of a block and for brushes on its surface.

use super::Drawing;
use fuwafuwa::Vec3;

/// Cell that a ray meets.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Hit {
    /// Cell.
    pub cell: [i32; 3],
    /// Point at which the ray enters the cell [cells].
    pub point: Vec3,
    /// Unit vector out of the face through which the ray enters. 0 if the ray starts in the cell.
    pub normal: [i32; 3],
}

/// Face between a solid and an empty cell.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Face {
    /// Solid cell.
    pub cell: [usize; 3],
    /// Axis at right angles to the face: 0, 1 or 2.
    pub axis: usize,
    /// Whether the face is on the high side of the cell.
    pub is_high: bool,
    /// Crayon of the cell.
    pub crayon: u8,
}

/// Ray in double precision. A position on the ray is a multiple of the direction.
struct Ray {
    origin: [f64; 3],
    direction: [f64; 3],
}

impl Ray {
    /// Returns `None` for non-finite values and for a direction of length 0.
    fn of(origin: Vec3, direction: Vec3) -> Option<Self> {
        let is_ray = origin.is_finite() && direction.is_finite() && direction != Vec3::ZERO;
        is_ray.then(|| Self {
            origin: origin.to_array().map(f64::from),
            direction: direction.to_array().map(f64::from),
        })
    }

    /// Returns the position at which the ray meets a plane at right angles to an axis; `None` if they are parallel.
    fn meets(&self, axis: usize, plane: f64) -> Option<f64> {
        let along = self.direction[axis];
        (along != 0.0).then(|| (plane - self.origin[axis]) / along)
    }

    /// Returns 1 if the ray goes up on an axis, −1 if it goes down, and 0 if it does neither.
    fn step(&self, axis: usize) -> i32 {
        i32::from(self.direction[axis] > 0.0) - i32::from(self.direction[axis] < 0.0)
    }

    fn point(&self, position: f64) -> [f64; 3] {
        [0, 1, 2].map(|axis: usize| self.origin[axis] + position * self.direction[axis])
    }

    /// Returns the position at which the ray enters a box with its low corner at 0, and the axis of the face through
    /// which it enters. Without an axis, the ray starts in the box.
    fn entry(&self, size: [usize; 3]) -> Option<(f64, Option<usize>)> {
        let (mut first, mut last, mut through) = (0.0, f64::INFINITY, None);
        for axis in 0..3 {
            let high = size[axis] as f64;
            let ends = [0.0, high].map(|plane| self.meets(axis, plane));
            let [Some(low), Some(high)] = ends else {
                if !(0.0..=high).contains(&self.origin[axis]) {
                    return None;
                }
                continue;
            };
            if low.min(high) >= first {
                (first, through) = (low.min(high), Some(axis));
            }
            last = low.max(high).min(last);
        }
        (first <= last).then_some((first, through))
    }

    /// Returns the hit of a cell that the ray enters at a position, through the face of an axis.
    fn hit(&self, cell: [i32; 3], position: f64, through: Option<usize>) -> Hit {
        let mut normal = [0; 3];
        let mut point = self.point(position);
        for axis in 0..3 {
            let [low, high] = [cell[axis], cell[axis] + 1].map(f64::from);
            point[axis] = point[axis].clamp(low, high);
            if through == Some(axis) {
                normal[axis] = -self.step(axis);
                point[axis] = if normal[axis] < 0 { low } else { high };
            }
        }
        Hit {
            cell,
            point: Vec3::from(point.map(|k| k as f32)),
            normal,
        }
    }
}

impl Drawing {
    /// Returns the first solid cell on a ray from `origin` [cells] in a direction of any length; `None` if there is none.
    ///
    /// The ray visits the cells one after the other [Amanatides and Woo 1987].
    pub fn hit(&self, origin: Vec3, direction: Vec3) -> Option<Hit> {
        let ray = Ray::of(origin, direction)?;
        let size = self.size().map(|extent| extent as i32);
        let (mut position, mut through) = ray.entry(self.size())?;
        let start = ray.point(position);
        let mut cell =
            [0, 1, 2].map(|axis: usize| (start[axis].floor() as i32).clamp(0, size[axis] - 1));
        while self.cell(cell) == 0 {
            let next = (0..3).filter_map(|axis| {
                let border = cell[axis] + i32::from(ray.step(axis) > 0);
                Some((ray.meets(axis, f64::from(border))?, axis))
            });
            let (at, axis) = next.min_by(|a, b| a.0.total_cmp(&b.0))?;
            (position, through) = (position.max(at), Some(axis));
            cell[axis] += ray.step(axis);
            if !(0..size[axis]).contains(&cell[axis]) {
                return None;
            }
        }
        Some(ray.hit(cell, position, through))
    }

    /// Returns where a ray meets the middle plane in z within the drawing, for a brush in an empty block. The normal
    /// points to the side from which the ray comes. `None` if the ray misses the plane or starts behind it.
    pub fn floor_hit(&self, origin: Vec3, direction: Vec3) -> Option<Hit> {
        let ray = Ray::of(origin, direction)?;
        let middle = 0.5 * self.size()[2] as f64;
        let position = ray.meets(2, middle).filter(|&position| position >= 0.0)?;
        let mut point = ray.point(position);
        point[2] = middle;
        let size = self.size().map(|extent| extent as f64);
        let is_inside = (0..3).all(|axis| (0.0..=size[axis]).contains(&point[axis]));
        is_inside.then(|| Hit {
            cell: [0, 1, 2].map(|axis: usize| point[axis].min(size[axis] - 1.0).floor() as i32),
            point: Vec3::from(point.map(|k| k as f32)),
            normal: [0, 0, -ray.step(2)],
        })
    }

    /// Returns the faces between solid and empty cells; all cells outside are empty. Paper has no faces in z.
    pub fn visible_faces(&self) -> impl Iterator<Item = Face> {
        self.solid_cells().flat_map(move |index| {
            let sides = self.lattice.neighbours(index).enumerate();
            let open = sides.filter(|(_, next)| next.is_none_or(|next| self.cells[next] == 0));
            open.map(move |(side, _)| Face {
                cell: self.lattice.cell(index),
                axis: side / 2,
                is_high: side % 2 == 1,
                crayon: self.cells[index],
            })
        })
    }
}
