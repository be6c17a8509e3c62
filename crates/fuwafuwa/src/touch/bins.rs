//! Points sorted into square bins, so that those near a place are found without looking at all.

use crate::dim::{Dim, Point};
use crate::solve::Row;
use crate::vector::{dot, minus};
use std::ops::Range;

/// A point [m] and its number.
type Numbered = (Row, u32);

/// Points in the bins of a grid that goes round and round: what lies a multiple of the grid's
/// extent apart shares a bin, so bodies may fly off as far as they like.
pub struct Bins {
    /// One over the width of a bin [1/m].
    inverse: f32,
    /// log₂ of the number of bins on each axis, and that number − 1.
    bits: usize,
    mask: i32,
    /// `points[start[b]..start[b + 1]]` lie in bin b, with their numbers, ascending.
    start: Vec<u32>,
    points: Vec<Numbered>,
}

impl Bins {
    /// Sorts points [m] into bins of a `width` [m].
    pub fn new<D: Dim>(points: &[Row], width: f32) -> Self {
        // About a bin for each point; four on an axis, so that three neighbours differ.
        let wanted = points.len().max(1).ilog2() as usize;
        let bits = wanted.div_ceil(D::N).max(2);
        let mut bins = Self {
            inverse: 1.0 / width,
            bits,
            mask: (1 << bits) - 1,
            start: vec![0; (1 << (D::N * bits)) + 1],
            points: vec![([0.0; 4], 0); points.len()],
        };
        let places: Vec<u32> = points.iter().map(|at| bins.bin(bins.square(at))).collect();
        for &bin in &places {
            bins.start[bin as usize + 1] += 1;
        }
        for bin in 1..bins.start.len() {
            bins.start[bin] += bins.start[bin - 1];
        }
        let mut next = bins.start.clone();
        for (number, (point, &bin)) in points.iter().zip(&places).enumerate() {
            let place = &mut next[bin as usize];
            bins.points[*place as usize] = (*point, number as u32);
            *place += 1;
        }
        bins
    }

    /// Where the points of each bin that has any begin and end.
    pub fn filled(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let ends = self.start.windows(2);
        let ranges = ends.map(|ends| ends[0] as usize..ends[1] as usize);
        ranges.filter(|range| !range.is_empty())
    }

    /// Some points with their numbers.
    pub fn points(&self, range: &Range<usize>) -> &[Numbered] {
        &self.points[range.clone()]
    }

    /// Calls `visit` once with the numbers of any two points that are no further apart than `reach`
    /// [m], which may be no more than a bin is wide.
    #[inline]
    pub fn pairs<D: Dim>(&self, reach: f32, mut visit: impl FnMut(u32, u32)) {
        let mut look = |(at, number): Numbered, others: &[Numbered]| {
            for &(point, other) in others {
                let apart = minus(point, at);
                if dot(apart, apart) <= reach * reach {
                    visit(number, other);
                }
            }
        };
        // Of two bins side by side one looks at the other.
        let ahead: &[[i32; 2]] = match D::N {
            2 => &[[1, 0]],
            _ => &[[1, 0], [-1, 1], [0, 1], [1, 1]],
        };
        for bin in 0..self.start.len() - 1 {
            let own = self.points_from(bin, bin);
            if own.is_empty() {
                continue;
            }
            let along = |axis: usize| bin as i32 >> (axis * self.bits) & self.mask;
            let (x, y, z) = (along(0), along(1), along(2));
            let mut rows: [[&[Numbered]; 2]; 4] = [[&[]; 2]; 4];
            for (row, [dy, dz]) in rows.iter_mut().zip(ahead) {
                *row = self.row([x, y + dy, z + dz]);
            }
            let next = self.bin([x + 1, y, z]) as usize;
            let next = self.points_from(next, next);
            for (place, &point) in own.iter().enumerate() {
                look(point, &own[place + 1..]);
                look(point, next);
                for stretch in rows[..ahead.len()].iter().flatten() {
                    look(point, stretch);
                }
            }
        }
    }

    /// Calls `visit` with the number of each point that is no further from `at` than `reach` [m],
    /// which may be no more than a bin is wide.
    #[inline]
    pub fn near<D: Dim>(&self, at: Row, reach: f32, mut visit: impl FnMut(u32)) {
        let [x, y, z] = self.square(&at);
        let layers = if D::N == 3 { -1..=1 } else { 0..=0 };
        for (dy, dz) in layers.flat_map(|dz| (-1..=1).map(move |dy| (dy, dz))) {
            let row = self.row([x, y.wrapping_add(dy), z.wrapping_add(dz)]);
            for &(point, number) in row.into_iter().flatten() {
                let apart = minus(point, at);
                if dot(apart, apart) <= reach * reach {
                    visit(number);
                }
            }
        }
    }

    /// The points in the bin of a square and in those before and after it on the first axis: one
    /// stretch, and another where the grid goes round.
    #[inline]
    fn row(&self, [x, y, z]: Point) -> [&[Numbered]; 2] {
        let (x, start) = (x & self.mask, self.bin([0, y, z]) as usize);
        let from =
            |first: i32, last: i32| self.points_from(start + first as usize, start + last as usize);
        match x {
            0 => [from(0, 1), from(self.mask, self.mask)],
            x if x == self.mask => [from(x - 1, x), from(0, 0)],
            x => [from(x - 1, x + 1), &[]],
        }
    }

    /// The points in the bins from the first to the last.
    #[inline]
    fn points_from(&self, first: usize, last: usize) -> &[Numbered] {
        &self.points[self.start[first] as usize..self.start[last + 1] as usize]
    }

    /// The square of the endless grid that a place lies in.
    #[inline]
    fn square(&self, at: &Row) -> Point {
        let mut square = [0; 3];
        for axis in 0..3 {
            let place = at[axis] * self.inverse;
            // Rounded down: towards zero alone, the squares around zero would be twice as wide.
            square[axis] = (place as i32).wrapping_sub(i32::from(place < 0.0));
        }
        square
    }

    #[inline]
    fn bin(&self, square: Point) -> u32 {
        let [x, y, z] = square;
        let along = |k: i32| (k & self.mask) as u32;
        along(x) | along(y) << self.bits | along(z) << (2 * self.bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{Dim2, Dim3};

    fn check<D: Dim>() {
        let mut seed = 7u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32 * 8.0 - 4.0
        };
        let point = |_| {
            let z = if D::N == 3 { random() } else { 0.0 };
            [random(), random(), z, 0.0]
        };
        let points: Vec<Row> = (0..900).map(point).collect();
        let reach = 0.4;
        let bins = Bins::new::<D>(&points, reach);
        let is_near = |a: usize, b: usize| {
            let apart = minus(points[a], points[b]);
            dot(apart, apart) <= reach * reach
        };
        let mut found = Vec::new();
        bins.pairs::<D>(reach, |a, b| {
            found.push((a.min(b) as usize, a.max(b) as usize));
        });
        found.sort_unstable();
        let all = (0..points.len()).flat_map(|a| (a + 1..points.len()).map(move |b| (a, b)));
        let expected: Vec<_> = all.filter(|&(a, b)| is_near(a, b)).collect();
        assert_eq!(found, expected);
        let mut total = 0;
        for (place, &at) in points.iter().enumerate() {
            let mut found = Vec::new();
            bins.near::<D>(at, reach, |number| found.push(number));
            found.sort_unstable();
            let numbers = 0..points.len() as u32;
            let expected: Vec<u32> = numbers
                .filter(|&other| is_near(place, other as usize))
                .collect();
            total += expected.len();
            assert_eq!(found, expected);
        }
        assert!(total > points.len() + 100);
    }

    #[test]
    fn points_nearby_are_found_once_each() {
        check::<Dim2>();
        check::<Dim3>();
    }
}
