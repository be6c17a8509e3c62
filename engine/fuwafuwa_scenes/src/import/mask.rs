//! Masks: pixels that are on or off, and the shapes that they form.

use std::ops::Range;

/// Pixels that are on or off, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mask {
    /// Width and height [pixels].
    pub size: [usize; 2],
    /// Whether each pixel is on.
    pub on: Vec<bool>,
}

/// Columns and rows.
pub(super) type Extent = [Range<usize>; 2];

/// Pixels that are connected along edges or at corners.
#[derive(Clone, Debug)]
pub(super) struct Component {
    /// Number of pixels.
    pub area: usize,
    /// Number of pixels at the edge of the mask.
    pub at_edge: usize,
    /// Columns and rows that the pixels lie in.
    pub extent: Extent,
}

/// Components of a mask, in the order of their first pixels.
pub(super) struct Components {
    pub list: Vec<Component>,
    /// Index of the component of each pixel; of a pixel that is off, the number of components.
    index: Vec<u32>,
}

impl Mask {
    /// Returns a mask in which `is_on` decides each pixel, given its column and row.
    pub fn from_fn(size: [usize; 2], mut is_on: impl FnMut(usize, usize) -> bool) -> Self {
        let rows = 0..size[1];
        let all = rows.flat_map(|row| (0..size[0]).map(move |column| (column, row)));
        let on = all.map(|(column, row)| is_on(column, row)).collect();
        Self { size, on }
    }

    /// Returns the length of the longer side [pixels].
    pub fn longer(&self) -> usize {
        self.size[0].max(self.size[1])
    }

    /// Returns the columns and rows that pixels which are on lie in; empty ranges if there are none.
    pub fn extent(&self) -> Extent {
        let [width, height] = self.size;
        let mut extent = [width..0, height..0];
        for (row, pixels) in self.on.chunks_exact(width.max(1)).enumerate() {
            let (first, last) = (
                pixels.iter().position(|&on| on),
                pixels.iter().rposition(|&on| on),
            );
            if let (Some(first), Some(last)) = (first, last) {
                grow(&mut extent, [first, row]);
                grow(&mut extent, [last, row]);
            }
        }
        extent.map(|range| if range.start < range.end { range } else { 0..0 })
    }

    /// Returns the part of the mask in some columns and rows.
    pub fn part(&self, [columns, rows]: &Extent) -> Self {
        Self::from_fn([columns.len(), rows.len()], |column, row| {
            self.on[(rows.start + row) * self.size[0] + columns.start + column]
        })
    }

    /// Returns the mask with a margin on all sides [pixels].
    pub fn padded(&self, margin: usize) -> Self {
        Self::from_fn(self.size.map(|side| side + 2 * margin), |column, row| {
            let inner = column.checked_sub(margin).zip(row.checked_sub(margin));
            inner.is_some_and(|(column, row)| {
                column < self.size[0] && row < self.size[1] && self.on[row * self.size[0] + column]
            })
        })
    }

    /// Returns a smaller mask, in which a pixel stands for a block of `factor` × `factor` pixels. A pixel is
    /// on if any pixel of its block is.
    pub fn reduced(&self, factor: usize) -> Self {
        let size = self.size.map(|side| side.div_ceil(factor));
        let mut on = vec![false; size[0] * size[1]];
        for (row, pixels) in self.on.chunks_exact(self.size[0].max(1)).enumerate() {
            for (column, &is_on) in pixels.iter().enumerate() {
                on[row / factor * size[0] + column / factor] |= is_on;
            }
        }
        Self { size, on }
    }

    pub fn inverted(mut self) -> Self {
        self.on.iter_mut().for_each(|on| *on = !*on);
        self
    }

    pub fn and(mut self, other: &Self) -> Self {
        self.on
            .iter_mut()
            .zip(&other.on)
            .for_each(|(on, &other)| *on &= other);
        self
    }

    pub fn or(mut self, other: &Self) -> Self {
        self.on
            .iter_mut()
            .zip(&other.on)
            .for_each(|(on, &other)| *on |= other);
        self
    }

    /// Returns all pixels whose centres lie within `radius` [pixels] of the centre of a pixel that is on.
    pub fn dilated(&self, radius: f64) -> Self {
        let [width, height] = self.size;
        let reach = radius as usize;
        // Distance to the nearest pixel of the column that is on, at most `reach` + 1.
        let mut apart: Vec<usize> = self
            .on
            .iter()
            .map(|&on| if on { 0 } else { reach + 1 })
            .collect();
        for at in width..apart.len() {
            apart[at] = apart[at].min(apart[at - width] + 1);
        }
        for at in (0..apart.len().saturating_sub(width)).rev() {
            apart[at] = apart[at].min(apart[at + width] + 1);
        }
        let square = radius * radius;
        let half_width: Vec<usize> = (0..=reach)
            .map(|apart| (square - (apart * apart) as f64).max(0.0).sqrt() as usize)
            .collect();
        let mut on = Vec::with_capacity(width * height);
        let mut change = vec![0i32; width + 1];
        for row in apart.chunks_exact(width.max(1)) {
            change.fill(0);
            for (column, &apart) in row.iter().enumerate() {
                if let Some(half) = half_width.get(apart) {
                    change[column.saturating_sub(*half)] += 1;
                    change[(column + half + 1).min(width)] -= 1;
                }
            }
            let mut count = 0;
            on.extend(change[..width].iter().map(|change| {
                count += change;
                count > 0
            }));
        }
        Self { on, ..*self }
    }

    /// Returns all pixels for which every pixel within `radius` [pixels] is on.
    pub fn eroded(self, radius: f64) -> Self {
        self.inverted().dilated(radius).inverted()
    }

    /// Returns the pixels that are off and connected with the edge of the mask along edges of pixels.
    pub fn outside(&self) -> Self {
        let [width, height] = self.size;
        let mut outside = Self::from_fn(self.size, |_, _| false);
        let mut to_visit = Vec::new();
        let visit = |at: usize, outside: &mut Self, to_visit: &mut Vec<usize>| {
            if !self.on[at] && !outside.on[at] {
                outside.on[at] = true;
                to_visit.push(at);
            }
        };
        for at in 0..self.on.len() {
            if self.is_at_edge(at) {
                visit(at, &mut outside, &mut to_visit);
            }
        }
        while let Some(at) = to_visit.pop() {
            let (column, row) = (at % width, at / width);
            let near = [
                (column > 0).then(|| at - 1),
                (column + 1 < width).then(|| at + 1),
                (row > 0).then(|| at - width),
                (row + 1 < height).then(|| at + width),
            ];
            for near in near.into_iter().flatten() {
                visit(near, &mut outside, &mut to_visit);
            }
        }
        outside
    }

    /// Returns the mean width of what is on [pixels]: twice the area per length of the boundary. For strokes, this
    /// is the width of the pen, or up to a fifth less if they are slanted; for a disc, about its radius.
    pub fn stroke_width(&self) -> f64 {
        let [width, height] = self.size;
        let is_on = |column: usize, row: usize| {
            column < width && row < height && self.on[row * width + column]
        };
        let (mut area, mut boundary) = (0_usize, 0_usize);
        for at in (0..self.on.len()).filter(|&at| self.on[at]) {
            let (column, row) = (at % width, at / width);
            // A column or row before the first one wraps, and so is outside.
            let near = [
                is_on(column.wrapping_sub(1), row),
                is_on(column + 1, row),
                is_on(column, row.wrapping_sub(1)),
                is_on(column, row + 1),
            ];
            area += 1;
            boundary += near.iter().filter(|is_on| !**is_on).count();
        }
        2.0 * area as f64 / boundary.max(1) as f64
    }

    /// Returns the mask with pixels that touch only at a corner joined by another pixel. The added pixel is in the
    /// lower row, so that corners at which it touches others are joined in later rows.
    pub fn joined(mut self) -> Self {
        let [width, height] = self.size;
        for row in 1..height {
            for column in 1..width {
                let at = row * width + column;
                match [at - width - 1, at - width, at - 1, at].map(|at| self.on[at]) {
                    [true, false, false, true] => self.on[at - 1] = true,
                    [false, true, true, false] => self.on[at] = true,
                    _ => {}
                }
            }
        }
        self
    }

    /// Finds the components of the pixels that are on.
    pub fn components(&self) -> Components {
        let [width, height] = self.size;
        let unvisited = u32::MAX;
        let mut index = vec![unvisited; self.on.len()];
        let mut list: Vec<Component> = Vec::new();
        let mut to_visit = Vec::new();
        for start in 0..self.on.len() {
            if !self.on[start] || index[start] != unvisited {
                continue;
            }
            let own = list.len() as u32;
            let mut component = Component {
                area: 0,
                at_edge: 0,
                extent: [width..0, height..0],
            };
            index[start] = own;
            to_visit.push(start);
            while let Some(at) = to_visit.pop() {
                let (column, row) = (at % width, at / width);
                component.area += 1;
                component.at_edge += usize::from(self.is_at_edge(at));
                grow(&mut component.extent, [column, row]);
                for row in row.saturating_sub(1)..(row + 2).min(height) {
                    for column in column.saturating_sub(1)..(column + 2).min(width) {
                        let near = row * width + column;
                        if self.on[near] && index[near] == unvisited {
                            index[near] = own;
                            to_visit.push(near);
                        }
                    }
                }
            }
            list.push(component);
        }
        let none = list.len() as u32;
        index
            .iter_mut()
            .filter(|index| **index == unvisited)
            .for_each(|index| *index = none);
        Components { list, index }
    }

    fn is_at_edge(&self, at: usize) -> bool {
        let [width, height] = self.size;
        let (column, row) = (at % width, at / width);
        column == 0 || row == 0 || column + 1 == width || row + 1 == height
    }
}

impl Components {
    /// Returns the pixels of the components that `is_kept` accepts.
    pub fn kept(&self, size: [usize; 2], is_kept: impl Fn(&Component) -> bool) -> Mask {
        let mut kept: Vec<bool> = self.list.iter().map(is_kept).collect();
        kept.push(false);
        let on = self
            .index
            .iter()
            .map(|&index| kept[index as usize])
            .collect();
        Mask { size, on }
    }
}

/// Returns the length of the longer side of an extent [pixels].
pub(super) fn longer([columns, rows]: &Extent) -> usize {
    columns.len().max(rows.len())
}

/// Extends ranges of columns and rows to a pixel.
fn grow(extent: &mut Extent, pixel: [usize; 2]) {
    for (range, at) in extent.iter_mut().zip(pixel) {
        *range = range.start.min(at)..range.end.max(at + 1);
    }
}
