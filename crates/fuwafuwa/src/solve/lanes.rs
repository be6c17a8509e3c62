//! Eight numbers side by side, one for each element of a block.
//!
//! Two types do the same arithmetic: [`Portable`] arrays anywhere, [`Wide`] registers where the
//! machine has AVX2. Every operation works within a lane and rounds once, so their bits agree.

use super::{LANES, Row};
use crate::vector::plus;
use std::ops::{Add, Div, Mul, Sub};

/// One number for each element of a block.
pub trait Lanes:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The same number in every lane.
    fn splat(value: f32) -> Self;
    /// From memory.
    fn load(values: &[f32; LANES]) -> Self;
    /// To memory.
    fn store(self, values: &mut [f32; LANES]);
    /// √
    fn sqrt(self) -> Self;
    /// The greater of two numbers, lane by lane; the second where they do not compare.
    fn at_least(self, least: Self) -> Self;
    /// `yes` in the lanes where self > 0, `no` elsewhere.
    fn if_positive(self, yes: Self, no: Self) -> Self;
    /// The lanes where self > 0, as a mask.
    fn positive(self) -> u8;
    /// The three columns of the rows at eight places.
    fn gather(rows: &[Row], places: &[u32; LANES]) -> [Self; 3];
    /// Eight rows from three columns, the fourth number 0.
    fn scatter(columns: [Self; 3], rows: &mut [Row; LANES]);
    /// The sum of the rows at the first `count` places, in their order.
    fn sum(rows: &[Row], places: &[u32; LANES], count: usize) -> Row;
}

/// Eight numbers in an array.
#[derive(Copy, Clone)]
pub struct Portable([f32; LANES]);

impl Lanes for Portable {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn load(values: &[f32; LANES]) -> Self {
        Self(*values)
    }

    #[inline(always)]
    fn store(self, values: &mut [f32; LANES]) {
        *values = self.0;
    }

    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for value in &mut self.0 {
            *value = value.sqrt();
        }
        self
    }

    #[inline(always)]
    fn at_least(mut self, least: Self) -> Self {
        for (value, least) in self.0.iter_mut().zip(least.0) {
            *value = if *value > least { *value } else { least };
        }
        self
    }

    #[inline(always)]
    fn if_positive(self, yes: Self, no: Self) -> Self {
        let mut chosen = no;
        for lane in 0..LANES {
            if self.0[lane] > 0.0 {
                chosen.0[lane] = yes.0[lane];
            }
        }
        chosen
    }

    #[inline(always)]
    fn positive(self) -> u8 {
        let lanes = self.0.iter().enumerate();
        lanes.fold(0, |mask, (lane, &value)| {
            mask | u8::from(value > 0.0) << lane
        })
    }

    #[inline(always)]
    fn gather(rows: &[Row], places: &[u32; LANES]) -> [Self; 3] {
        let mut columns = [Self::splat(0.0); 3];
        for (lane, &place) in places.iter().enumerate() {
            let row = &rows[place as usize];
            for axis in 0..3 {
                columns[axis].0[lane] = row[axis];
            }
        }
        columns
    }

    #[inline(always)]
    fn scatter(columns: [Self; 3], rows: &mut [Row; LANES]) {
        for (lane, row) in rows.iter_mut().enumerate() {
            *row = [
                columns[0].0[lane],
                columns[1].0[lane],
                columns[2].0[lane],
                0.0,
            ];
        }
    }

    #[inline(always)]
    fn sum(rows: &[Row], places: &[u32; LANES], count: usize) -> Row {
        let mut sum = rows[places[0] as usize];
        for &place in &places[1..count] {
            sum = plus(sum, rows[place as usize]);
        }
        sum
    }
}

macro_rules! portable_operator {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl $trait for Portable {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for lane in 0..LANES {
                    self.0[lane] $operator other.0[lane];
                }
                self
            }
        }
    };
}

portable_operator!(Add, add, +=);
portable_operator!(Sub, sub, -=);
portable_operator!(Mul, mul, *=);
portable_operator!(Div, div, /=);

#[cfg(target_arch = "x86_64")]
pub use wide::Wide;

/// Measured against `Portable` compiled for AVX2: 2 to 3 times faster, because the compiler keeps
/// arrays in memory and transposes through it.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod wide {
    use super::{LANES, Lanes, Row};
    use std::arch::x86_64::*;
    use std::ops::{Add, Div, Mul, Sub};

    /// Eight numbers in an AVX register.
    ///
    /// SAFETY of every function here: they need AVX, and are only reached from
    /// `evaluate_group_wide` and `kick_wide` in `solve`, which are called after the machine was asked for
    /// AVX2. Loads and stores go through references to arrays of the right length and need no alignment;
    /// rows are read unchecked only at places that `check` let pass.
    #[derive(Copy, Clone)]
    pub struct Wide(__m256);

    impl Lanes for Wide {
        #[inline(always)]
        fn splat(value: f32) -> Self {
            unsafe { Self(_mm256_set1_ps(value)) }
        }

        #[inline(always)]
        fn load(values: &[f32; LANES]) -> Self {
            unsafe { Self(_mm256_loadu_ps(values.as_ptr())) }
        }

        #[inline(always)]
        fn store(self, values: &mut [f32; LANES]) {
            unsafe { _mm256_storeu_ps(values.as_mut_ptr(), self.0) }
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            unsafe { Self(_mm256_sqrt_ps(self.0)) }
        }

        #[inline(always)]
        fn at_least(self, least: Self) -> Self {
            // The second operand where they do not compare, as in `Portable`.
            unsafe { Self(_mm256_max_ps(self.0, least.0)) }
        }

        #[inline(always)]
        fn if_positive(self, yes: Self, no: Self) -> Self {
            unsafe {
                let positive = _mm256_cmp_ps::<_CMP_GT_OQ>(self.0, _mm256_setzero_ps());
                Self(_mm256_blendv_ps(no.0, yes.0, positive))
            }
        }

        #[inline(always)]
        fn positive(self) -> u8 {
            unsafe {
                let positive = _mm256_cmp_ps::<_CMP_GT_OQ>(self.0, _mm256_setzero_ps());
                _mm256_movemask_ps(positive) as u8
            }
        }

        #[inline(always)]
        fn gather(rows: &[Row], places: &[u32; LANES]) -> [Self; 3] {
            unsafe {
                check(rows, places);
                let row = |lane: usize| rows.get_unchecked(places[lane] as usize);
                let (a, b) = (pair(row(0), row(4)), pair(row(1), row(5)));
                let (c, d) = (pair(row(2), row(6)), pair(row(3), row(7)));
                let (ab, cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
                let (ab_high, cd_high) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
                [
                    Self(_mm256_shuffle_ps::<0x44>(ab, cd)),
                    Self(_mm256_shuffle_ps::<0xEE>(ab, cd)),
                    Self(_mm256_shuffle_ps::<0x44>(ab_high, cd_high)),
                ]
            }
        }

        #[inline(always)]
        fn scatter(columns: [Self; 3], rows: &mut [Row; LANES]) {
            let [x, y, z] = columns.map(|column| column.0);
            unsafe {
                let zero = _mm256_setzero_ps();
                let (xy, xy_high) = (_mm256_unpacklo_ps(x, y), _mm256_unpackhi_ps(x, y));
                let (z, z_high) = (_mm256_unpacklo_ps(z, zero), _mm256_unpackhi_ps(z, zero));
                let pairs = [
                    _mm256_shuffle_ps::<0x44>(xy, z),
                    _mm256_shuffle_ps::<0xEE>(xy, z),
                    _mm256_shuffle_ps::<0x44>(xy_high, z_high),
                    _mm256_shuffle_ps::<0xEE>(xy_high, z_high),
                ];
                for lane in 0..LANES / 2 {
                    _mm_storeu_ps(rows[lane].as_mut_ptr(), _mm256_castps256_ps128(pairs[lane]));
                    let high = _mm256_extractf128_ps::<1>(pairs[lane]);
                    _mm_storeu_ps(rows[lane + LANES / 2].as_mut_ptr(), high);
                }
            }
        }

        #[inline(always)]
        fn sum(rows: &[Row], places: &[u32; LANES], count: usize) -> Row {
            let mut total = [0.0; 4];
            unsafe {
                check(rows, places);
                let row = |k: usize| rows.get_unchecked(places[k] as usize).as_ptr();
                let mut sum = _mm_loadu_ps(row(0));
                for k in 1..count {
                    sum = _mm_add_ps(sum, _mm_loadu_ps(row(k)));
                }
                _mm_storeu_ps(total.as_mut_ptr(), sum);
            }
            total
        }
    }

    /// Panics when one of the places is not among the rows: one comparison for all eight.
    #[inline(always)]
    unsafe fn check(rows: &[Row], places: &[u32; LANES]) {
        unsafe {
            // An opaque load: of a plain one the compiler would take the places out of the
            // register again, one by one, where loading each is cheaper.
            let wanted = _mm256_lddqu_si256(places.as_ptr().cast());
            // Of more rows than a place can name the low bits alone: a smaller number, or all.
            let last = _mm256_set1_epi32((rows.len() as i32).wrapping_sub(1));
            let greatest = _mm256_max_epu32(wanted, last);
            let within = _mm256_cmpeq_epi32(greatest, last);
            assert!(!rows.is_empty() && _mm256_movemask_epi8(within) == -1);
        }
    }

    #[inline(always)]
    unsafe fn pair(low: &Row, high: &Row) -> __m256 {
        unsafe {
            let low = _mm256_castps128_ps256(_mm_loadu_ps(low.as_ptr()));
            _mm256_insertf128_ps::<1>(low, _mm_loadu_ps(high.as_ptr()))
        }
    }

    macro_rules! wide_operator {
        ($trait:ident, $method:ident, $intrinsic:ident) => {
            impl $trait for Wide {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    unsafe { Self($intrinsic(self.0, other.0)) }
                }
            }
        };
    }

    wide_operator!(Add, add, _mm256_add_ps);
    wide_operator!(Sub, sub, _mm256_sub_ps);
    wide_operator!(Mul, mul, _mm256_mul_ps);
    wide_operator!(Div, div, _mm256_div_ps);
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::catch_unwind;

    /// Whether rows at these places are refused, by a gather and by a sum.
    fn refuses<L: Lanes>(rows: &[Row], places: [u32; LANES]) -> [bool; 2] {
        let gather = catch_unwind(|| L::gather(rows, &places).len());
        let sum = catch_unwind(|| L::sum(rows, &places, LANES));
        [gather.is_err(), sum.is_err()]
    }

    fn check<L: Lanes>() {
        let rows = [[1.0; 4]; 3];
        for lane in 0..LANES {
            for (place, expected) in [(0, false), (2, false), (3, true), (u32::MAX, true)] {
                let mut places = [1; LANES];
                places[lane] = place;
                assert_eq!(refuses::<L>(&rows, places), [expected; 2], "{places:?}");
            }
        }
        assert_eq!(refuses::<L>(&[], [0; LANES]), [true; 2]);
        assert_eq!(refuses::<L>(&[], [u32::MAX; LANES]), [true; 2]);
    }

    #[test]
    fn places_that_are_not_among_the_rows_are_refused() {
        check::<Portable>();
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            check::<Wide>();
        }
    }
}
