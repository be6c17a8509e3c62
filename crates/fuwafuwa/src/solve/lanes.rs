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
    /// Eight vectors of so many components, one after the other, from three columns.
    fn scatter(columns: [Self; 3], components: usize, vectors: &mut [f32]);
    /// The sum of the four numbers that begin at each of the first `count` places, in their order.
    fn sum(numbers: &[f32], places: &[u32; LANES], count: usize) -> Row;
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
    fn scatter(columns: [Self; 3], components: usize, vectors: &mut [f32]) {
        for (lane, vector) in vectors.chunks_exact_mut(components).enumerate() {
            for (number, column) in vector.iter_mut().zip(&columns) {
                *number = column.0[lane];
            }
        }
    }

    #[inline(always)]
    fn sum(numbers: &[f32], places: &[u32; LANES], count: usize) -> Row {
        let four = |place: u32| {
            let four = &numbers[place as usize..][..4];
            [four[0], four[1], four[2], four[3]]
        };
        let mut sum = four(places[0]);
        for &place in &places[1..count] {
            sum = plus(sum, four(place));
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
    /// rows and numbers are read unchecked only at places that `check` let pass, and vectors written
    /// where their length was compared.
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
                check(rows.len(), places);
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
        fn scatter(columns: [Self; 3], components: usize, vectors: &mut [f32]) {
            let [x, y, z] = columns.map(|column| column.0);
            assert!(vectors.len() == components * LANES && matches!(components, 2 | 3));
            unsafe {
                // The first half of the vectors in the low halves of the registers.
                let quads = if components == 2 {
                    [_mm256_unpacklo_ps(x, y), _mm256_unpackhi_ps(x, y), x]
                } else {
                    let xy = _mm256_shuffle_ps::<0x88>(x, y);
                    let yz = _mm256_shuffle_ps::<0xDD>(y, z);
                    let zx = _mm256_shuffle_ps::<0xD8>(z, x);
                    [
                        _mm256_shuffle_ps::<0x88>(xy, zx),
                        _mm256_shuffle_ps::<0xD8>(yz, xy),
                        _mm256_shuffle_ps::<0xDD>(zx, yz),
                    ]
                };
                let start = vectors.as_mut_ptr();
                for (place, &quad) in quads[..components].iter().enumerate() {
                    _mm_storeu_ps(start.add(4 * place), _mm256_castps256_ps128(quad));
                    let high = start.add(4 * (place + components));
                    _mm_storeu_ps(high, _mm256_extractf128_ps::<1>(quad));
                }
            }
        }

        #[inline(always)]
        fn sum(numbers: &[f32], places: &[u32; LANES], count: usize) -> Row {
            let mut total = [0.0; 4];
            unsafe {
                check(numbers.len().saturating_sub(3), places);
                let four = |k: usize| numbers.as_ptr().add(places[k] as usize);
                let mut sum = _mm_loadu_ps(four(0));
                for k in 1..count {
                    sum = _mm_add_ps(sum, _mm_loadu_ps(four(k)));
                }
                _mm_storeu_ps(total.as_mut_ptr(), sum);
            }
            total
        }
    }

    /// Panics when one of the places is not below `end`: one comparison for all eight.
    #[inline(always)]
    unsafe fn check(end: usize, places: &[u32; LANES]) {
        unsafe {
            // An opaque load: of a plain one the compiler would take the places out of the
            // register again, one by one, where loading each is cheaper.
            let wanted = _mm256_lddqu_si256(places.as_ptr().cast());
            // Of an end that no place can name the low bits alone: a smaller number, or all.
            let last = _mm256_set1_epi32((end as i32).wrapping_sub(1));
            let greatest = _mm256_max_epu32(wanted, last);
            let within = _mm256_cmpeq_epi32(greatest, last);
            assert!(end > 0 && _mm256_movemask_epi8(within) == -1);
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
        // The last of so many numbers where four begin is the last of the rows.
        let numbers = vec![1.0; (rows.len() + 3) * usize::from(!rows.is_empty())];
        let sum = catch_unwind(|| L::sum(&numbers, &places, LANES));
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
