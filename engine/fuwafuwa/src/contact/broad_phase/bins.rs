//! Spatial hash of points in cubic bins, for finding the points near a position.

use crate::foundation::dim::{Dim, Point};
use crate::foundation::threads::SEARCHES_PER_CHUNK;
use crate::math::lanes::{LANES, Lanes, splat};
use crate::math::row::Row;
use fearless_simd::prelude::*;
use std::ops::Range;

/// 1.5 · 2²³. Around this value, single precision represents only integers. So adding a number of at most 2²²
/// to it rounds that number.
const LARGE: f32 = 12_582_912.0;

/// Points sorted into the bins of a periodic grid: positions that differ by a multiple of the grid's extent
/// share a bin. So a few bins cover coordinates of up to two million bin widths.
#[derive(Clone, Debug)]
pub struct Bins {
    /// Inverse width of a bin [1/m].
    inverse: f32,
    /// log₂ of the number of bins on each axis.
    bits: usize,
    /// Bit mask that wraps a bin coordinate to the periodic grid: the number of bins on an axis, minus 1.
    mask: i32,
    /// Index in `numbers` of the first point of each bin. The points `numbers[start[b]..start[b + 1]]` are in
    /// bin b, in ascending order.
    start: Vec<u32>,
    /// Numbers of the points, sorted by bin. The number of a point is its index in the list given to
    /// [`Bins::new`].
    numbers: Vec<u32>,
    /// Coordinates of the points [m], in one list for each axis and in the order of `numbers`. Padded, so
    /// that a SIMD read of eight values may start at any index.
    places: [Vec<f32>; 3],
}

impl Bins {
    /// Sorts points [m] into bins of a `width` [m].
    pub fn new<D: Dim>(points: &[Row], width: f32) -> Self {
        // About one bin per point, and at least four on an axis, so that a bin and its two neighbours are
        // three different bins.
        let wanted = points.len().max(1).ilog2() as usize;
        let bits = wanted.div_ceil(D::N).max(2);
        let places = || vec![0.0; points.len() + LANES];
        let mut bins = Self {
            // The bins are slightly wider than `width`. So points within `width` of each other are in the
            // same or in adjacent bins in spite of rounding.
            inverse: 0.999 / width,
            bits,
            mask: (1 << bits) - 1,
            start: vec![0; (1 << (D::N * bits)) + 1],
            numbers: vec![0; points.len()],
            places: [places(), places(), places()],
        };
        let of_point: Vec<u32> = points
            .iter()
            .map(|at| bins.bin(bins.coordinates(at)))
            .collect();
        for &bin in &of_point {
            bins.start[bin as usize + 1] += 1;
        }
        for bin in 1..bins.start.len() {
            bins.start[bin] += bins.start[bin - 1];
        }
        let mut next = bins.start.clone();
        for (number, (point, &bin)) in points.iter().zip(&of_point).enumerate() {
            let place = next[bin as usize] as usize;
            bins.numbers[place] = number as u32;
            for (places, &along) in bins.places.iter_mut().zip(point.as_array()) {
                places[place] = along;
            }
            next[bin as usize] += 1;
        }
        bins
    }

    /// Iterates over the bins that contain points. Each item is the index range of the bin's points in
    /// `numbers`.
    pub fn filled(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let ends = self.start.windows(2);
        let ranges = ends.map(|ends| ends[0] as usize..ends[1] as usize);
        ranges.filter(|range| !range.is_empty())
    }

    /// Returns the numbers of the points, sorted by bin. The number of a point is its index in the list given
    /// to [`Bins::new`].
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// Returns the position [m] of the point number `numbers[place]`.
    #[inline(always)]
    pub fn point(&self, place: usize) -> Row {
        let [x, y, z] = self.places.each_ref().map(|places| places[place]);
        Row::from_array([x, y, z, 0.0])
    }

    /// Iterates over ranges of bins that threads can search independently.
    pub fn shares(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let bins = self.start.len() - 1;
        let firsts = (0..bins).step_by(SEARCHES_PER_CHUNK);
        firsts.map(move |first| first..bins.min(first + SEARCHES_PER_CHUNK))
    }

    /// Finds the pairs of points within `reach` [m] of each other, and calls `visit` with their indices in
    /// `numbers`. `reach` may be at most the width of a bin. A call searches only from the given `bins`:
    /// calls with all ranges of [`Bins::shares`] together visit each pair once.
    ///
    /// `is_out` receives the index of a point and the first of eight consecutive indices of other points. It
    /// returns a bit mask of those of the eight to skip. `is_idle` receives the index range of a bin's
    /// points. Two bins are not compared if it returns true for both.
    #[inline(always)]
    pub fn pairs<D: Dim, S: Simd>(
        &self,
        simd: S,
        bins: Range<usize>,
        reach: f32,
        is_idle: impl Fn(&Range<usize>) -> bool,
        is_out: impl Fn(usize, usize) -> u64,
        mut visit: impl FnMut(usize, usize),
    ) {
        // Offsets [dy, dz] of the rows of three bins that each bin searches, in addition to the next bin of
        // its own row. These bins are half of its neighbours, so that two adjacent bins are compared once.
        let ahead: &[[i32; 2]] = match D::N {
            2 => &[[1, 0]],
            _ => &[[1, 0], [-1, 1], [0, 1], [1, 1]],
        };
        let mut others: Vec<Range<usize>> = Vec::new();
        let mut near: Vec<u32> = Vec::new();
        for bin in bins {
            let own = self.range(bin, bin);
            if own.is_empty() {
                continue;
            }
            let along = |axis: usize| bin as i32 >> (axis * self.bits) & self.mask;
            let (x, y, z) = (along(0), along(1), along(2));
            let next = self.bin([x + 1, y, z]) as usize;
            others.clear();
            others.push(self.range(next, next));
            for [dy, dz] in ahead {
                others.extend(self.row([x - 1, y + dy, z + dz], 3));
            }
            let own_is_idle = is_idle(&own);
            others.retain(|range| !(range.is_empty() || own_is_idle && is_idle(range)));
            if own_is_idle && others.is_empty() {
                continue;
            }
            for place in own.clone() {
                let at = self.point(place);
                near.clear();
                let later = std::iter::once(place + 1..own.end).filter(|_| !own_is_idle);
                for range in later.chain(others.iter().cloned()) {
                    self.look(
                        simd,
                        range,
                        at,
                        reach,
                        #[inline(always)]
                        |first| is_out(place, first),
                        &mut near,
                    );
                }
                for &other in &near {
                    visit(place, other as usize);
                }
            }
        }
    }

    /// Sets `near` to the indices in `numbers` of the points within `reach` [m] of the position `at` [m].
    /// `is_out` receives the first of eight consecutive indices, and returns a bit mask of those to skip.
    #[inline(always)]
    pub fn near<D: Dim, S: Simd>(
        &self,
        simd: S,
        at: Row,
        reach: f32,
        is_out: impl Fn(usize) -> u64 + Copy,
        near: &mut Vec<u32>,
    ) {
        near.clear();
        // Half the width of the search box, slightly enlarged for rounding.
        let mut aside = Row::ZERO;
        aside[..D::N].fill(1.01 * reach);
        let low = self.coordinates(&(at - aside));
        let high = self.coordinates(&(at + aside));
        let count = |axis: usize| high[axis].wrapping_sub(low[axis]).wrapping_add(1);
        // Whether the search box covers the whole periodic grid along an axis.
        let is_far = |axis: usize| !(1..=self.mask).contains(&count(axis));
        if reach.is_nan() || (0..D::N).any(is_far) {
            self.look(simd, 0..self.numbers.len(), at, reach, is_out, near);
            return;
        }
        for z in 0..count(2) {
            for y in 0..count(1) {
                let first = [low[0], low[1].wrapping_add(y), low[2].wrapping_add(z)];
                for range in self.row(first, count(0)) {
                    self.look(simd, range, at, reach, is_out, near);
                }
            }
        }
    }

    /// Adds to `near` the indices of those points in a range that are within `reach` [m] of the position `at`
    /// [m].
    #[inline(always)]
    fn look<S: Simd>(
        &self,
        simd: S,
        range: Range<usize>,
        at: Row,
        reach: f32,
        is_out: impl Fn(usize) -> u64,
        near: &mut Vec<u32>,
    ) {
        let own = [0, 1, 2].map(|axis: usize| splat(simd, at[axis]));
        for first in range.clone().step_by(LANES) {
            let along = |axis: usize| {
                let eight = &self.places[axis][first..first + LANES];
                Lanes::from_slice(simd, eight) - own[axis]
            };
            let (x, y, z) = (along(0), along(1), along(2));
            let squared = x * x + y * y + z * z;
            let mut lanes = squared.simd_le(reach * reach).to_bitmask();
            // Masks out lanes beyond the range, which may hold points of another bin.
            let left = range.end - first;
            if left < LANES {
                lanes &= (1 << left) - 1;
            }
            if lanes != 0 {
                lanes &= !is_out(first);
            }
            while lanes != 0 {
                near.push(first as u32 + lanes.trailing_zeros());
                lanes &= lanes - 1;
            }
        }
    }

    /// Returns the index ranges of the points in `count` bins, from the bin at [x, y, z] on along the first
    /// axis. The second range is empty, unless the bins wrap around the periodic grid.
    #[inline(always)]
    fn row(&self, [x, y, z]: Point, count: i32) -> [Range<usize>; 2] {
        let (x, start) = (x & self.mask, self.bin([0, y, z]) as usize);
        let from =
            |first: i32, last: i32| self.range(start + first as usize, start + last as usize);
        let (last, all) = (x + count - 1, self.mask + 1);
        if last < all {
            [from(x, last), 0..0]
        } else {
            [from(x, all - 1), from(0, last - all)]
        }
    }

    /// Returns the index range of the points in the bins from `first` to `last`, both included.
    #[inline(always)]
    fn range(&self, first: usize, last: usize) -> Range<usize> {
        self.start[first] as usize..self.start[last + 1] as usize
    }

    /// Returns the coordinates of the bin of a point, not yet wrapped to the periodic grid.
    #[inline(always)]
    fn coordinates(&self, at: &Row) -> Point {
        // Adding `LARGE` leaves the coordinate, in bins and rounded to an integer, in the lowest bits of the
        // sum. This is faster than a checked conversion.
        let whole = |along: f32| (along * self.inverse + LARGE).to_bits() as i32;
        [whole(at[0]), whole(at[1]), whole(at[2])]
    }

    #[inline(always)]
    fn bin(&self, coordinates: Point) -> u32 {
        let [x, y, z] = coordinates;
        let along = |k: i32| (k & self.mask) as u32;
        along(x) | along(y) << self.bits | along(z) << (2 * self.bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};
    use crate::math::lanes::on_widest_lanes;

    fn check<D: Dim>() {
        on_widest_lanes!(simd => check_on::<D, _>(simd));
    }

    fn check_on<D: Dim, S: Simd>(simd: S) {
        let mut seed = 7u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32 * 8.0 - 4.0
        };
        let point = |_| {
            let z = if D::N == 3 { random() } else { 0.0 };
            Row::from_array([random(), random(), z, 0.0])
        };
        let points: Vec<Row> = (0..900).map(point).collect();
        let reach = 0.4;
        let bins = Bins::new::<D>(&points, reach);
        let mut found = Vec::new();
        for share in bins.shares() {
            bins.pairs::<D, _>(
                simd,
                share,
                reach,
                |_| false,
                |_, _| 0,
                |a, b| {
                    let [a, b] = [a, b].map(|place| bins.numbers()[place] as usize);
                    found.push((a.min(b), a.max(b)));
                },
            );
        }
        found.sort_unstable();
        let is_near = |a: usize, b: usize| {
            let apart = points[a] - points[b];
            apart.dot(apart) <= reach * reach
        };
        let all = (0..points.len()).flat_map(|a| (a + 1..points.len()).map(move |b| (a, b)));
        let expected: Vec<_> = all.filter(|&(a, b)| is_near(a, b)).collect();
        assert_eq!(found, expected);
        let mut total = 0;
        // Search radii that reach one bin, several bins, and around the whole grid.
        let reaches = [0.5, 1.0, 2.7, 40.0].into_iter().cycle();
        for ((place, &at), steps) in points.iter().enumerate().zip(reaches) {
            let reach = steps * reach;
            let is_near = |a: usize, b: usize| {
                let apart = points[a] - points[b];
                apart.dot(apart) <= reach * reach
            };
            let mut found = Vec::new();
            bins.near::<D, _>(simd, at, reach, |_| 0, &mut found);
            for found in &mut found {
                *found = bins.numbers()[*found as usize];
            }
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
    fn pairs_and_near_find_each_point_exactly_once() {
        check::<Dim2>();
        check::<Dim3>();
    }
}
