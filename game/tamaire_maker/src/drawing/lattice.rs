//! Boxes of cells: their order, neighbours and regions.

/// Box of cells in the order of memory, the first axis fastest.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct Lattice {
    /// Number of cells on each axis; at least 1.
    pub(super) size: [usize; 3],
}

impl Lattice {
    /// Returns the number of axes: 2 if the box is one cell deep.
    pub(super) fn axes(self) -> usize {
        if self.size[2] == 1 { 2 } else { 3 }
    }

    /// Returns the number of cells.
    pub(super) fn count(self) -> usize {
        self.size.iter().product()
    }

    /// Returns the index of a cell; `None` outside.
    pub(super) fn index(self, at: [i32; 3]) -> Option<usize> {
        let mut index = 0;
        for axis in (0..3).rev() {
            let k = usize::try_from(at[axis]).ok()?;
            if k >= self.size[axis] {
                return None;
            }
            index = index * self.size[axis] + k;
        }
        Some(index)
    }

    /// Returns the coordinates of the cell with an index.
    pub(super) fn cell(self, index: usize) -> [usize; 3] {
        let [width, height, _] = self.size;
        [
            index % width,
            index / width % height,
            index / (width * height),
        ]
    }

    /// Returns the index of the mirror image of a cell in x.
    pub(super) fn mirrored(self, index: usize) -> usize {
        let x = self.cell(index)[0];
        index - x + (self.size[0] - 1 - x)
    }

    /// Returns the coordinates of the cell with an index.
    pub(super) fn point(self, index: usize) -> [i32; 3] {
        self.cell(index).map(|k| k as i32)
    }

    /// Returns the neighbour at each face of a cell, the low face of an axis before the high one; `None` outside. A box
    /// of one layer has no neighbours on the third axis.
    pub(super) fn neighbours(self, index: usize) -> impl Iterator<Item = Option<usize>> {
        let cell = self.cell(index);
        let stride = [1, self.size[0], self.size[0] * self.size[1]];
        (0..2 * self.axes()).map(move |face| {
            let axis = face / 2;
            match face % 2 {
                0 => (cell[axis] > 0).then(|| index - stride[axis]),
                _ => (cell[axis] + 1 < self.size[axis]).then(|| index + stride[axis]),
            }
        })
    }

    /// Returns whether a face of the cell is on the border of the box.
    pub(super) fn is_at_border(self, index: usize) -> bool {
        self.neighbours(index).any(|next| next.is_none())
    }

    /// Returns for each cell whether a way through faces leads to it from a start. The cells of the way, with the start,
    /// must fulfil `passes`.
    pub(super) fn flooded(
        self,
        starts: impl Iterator<Item = usize>,
        passes: impl Fn(usize) -> bool,
    ) -> Vec<bool> {
        let mut is_reached = vec![false; self.count()];
        let mut open = Vec::new();
        for start in starts {
            open.push(start);
            while let Some(index) = open.pop() {
                if !is_reached[index] && passes(index) {
                    is_reached[index] = true;
                    open.extend(self.neighbours(index).flatten());
                }
            }
        }
        is_reached
    }

    /// Returns for each cell whether it is empty and a way through faces of empty cells leads to the border.
    pub(super) fn outside(self, cells: &[u8]) -> Vec<bool> {
        let border = (0..self.count()).filter(|&index| self.is_at_border(index));
        self.flooded(border, |index| cells[index] == 0)
    }
}
