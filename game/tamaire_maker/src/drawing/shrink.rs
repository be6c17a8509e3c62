//! Fewer, larger cells.

/// Returns the size of a box that is reduced so that its longest side has at most `most` cells, without change of its
/// proportions. A smaller box keeps its size.
pub(super) fn reduced(size: [usize; 3], most: usize) -> [usize; 3] {
    let longest = size.into_iter().max().unwrap_or(1);
    if longest <= most {
        return size;
    }
    size.map(|extent| ((2 * extent * most + longest) / (2 * longest)).max(1))
}

/// Returns a box of `to` cells in place of one of `from` cells. `cell` returns the crayon of a cell of the latter.
///
/// A new cell is solid if at least a third of the cells that it covers are solid, so that thin lines do not vanish. It
/// takes the crayon that covers most of it, and of several such crayons the one with the lowest number. If all new cells
/// would be empty, the fullest of them are solid. Cells that a new cell covers in part count with this part.
pub(super) fn sampled(
    from: [usize; 3],
    to: [usize; 3],
    cell: impl Fn([usize; 3]) -> u8,
) -> Vec<u8> {
    let [across, up, deep] = [0, 1, 2].map(|axis: usize| covers(from[axis], to[axis]));
    let mut found = Vec::with_capacity(to.iter().product());
    for layer in &deep {
        for row in &up {
            for column in &across {
                found.push(majority([column, row, layer], &cell));
            }
        }
    }
    let total: u64 = from.iter().map(|&extent| extent as u64).product();
    let fullest = found.iter().map(|&(solid, _)| solid).max().unwrap_or(0);
    let least = total.min(3 * fullest).max(1);
    let is_solid = |solid: u64| 3 * solid >= least;
    let crayons = found.into_iter();
    crayons
        .map(|(solid, crayon)| if is_solid(solid) { crayon } else { 0 })
        .collect()
}

/// Overlap of an old cell with a new one on one axis: index of the old cell, and length in units of 1/`to` of an old cell.
type Part = (usize, u64);

/// Returns the parts of `from` cells that each of `to` cells covers on one axis.
fn covers(from: usize, to: usize) -> Vec<Vec<Part>> {
    let parts = (0..to).map(|new| {
        let (low, high) = (new * from, (new + 1) * from);
        let old = low / to..high.div_ceil(to);
        old.map(|old| {
            let length = high.min((old + 1) * to) - low.max(old * to);
            (old, length as u64)
        })
        .collect()
    });
    parts.collect()
}

/// Returns the volume of the solid cells in a box of parts, and the most frequent crayon.
fn majority(parts: [&Vec<Part>; 3], cell: impl Fn([usize; 3]) -> u8) -> (u64, u8) {
    let mut volumes = [0u64; 256];
    for &(z, deep) in parts[2] {
        for &(y, high) in parts[1] {
            for &(x, wide) in parts[0] {
                volumes[usize::from(cell([x, y, z]))] += wide * high * deep;
            }
        }
    }
    let mut most = (0, 0);
    for (crayon, &volume) in (1..=u8::MAX).zip(&volumes[1..]) {
        if volume > most.0 {
            most = (volume, crayon);
        }
    }
    (volumes[1..].iter().sum(), most.1)
}
