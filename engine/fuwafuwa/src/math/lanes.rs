//! SIMD vectors of eight numbers, one for each element of a batch.
//!
//! The code is written once on the vectors of `fearless_simd`, and compiled for several instruction sets.
//! Every operation works within a lane and rounds once, so that all machines give the same bits. Only + − × ÷
//! √, comparisons and selections are used; no fused or approximate operations.

use super::row::Row;
use fearless_simd::{f32x4, f32x8, prelude::*};

/// Number of elements in a batch.
pub const LANES: usize = 8;

/// One number for each element of a batch.
pub type Lanes<S> = f32x8<S>;

/// Array that holds one number for each lane.
pub type Eight = [f32; LANES];

/// Evaluates an expression with `$simd`, the widest instruction set that the machine supports. Each
/// instruction set adds a copy of all code that the expression calls. So on x86-64 only SSE2 and AVX2 are
/// used: AVX-512 gains little with eight lanes, and few machines have instruction sets between SSE2 and AVX2.
#[cfg(target_arch = "x86_64")]
macro_rules! on_widest_lanes {
    ($simd:ident => $do:expr) => {{
        let level = fearless_simd::Level::new();
        if let Some($simd) = level.as_avx2() {
            fearless_simd::Simd::vectorize(
                $simd,
                #[inline(always)]
                || $do,
            )
        } else {
            let $simd = level.as_sse2().expect("every x86-64 has SSE2");
            fearless_simd::Simd::vectorize(
                $simd,
                #[inline(always)]
                || $do,
            )
        }
    }};
}

#[cfg(not(target_arch = "x86_64"))]
macro_rules! on_widest_lanes {
    ($simd:ident => $do:expr) => {
        fearless_simd::dispatch!(fearless_simd::Level::new(), $simd => $do)
    };
}

pub(crate) use on_widest_lanes;

/// Sets every lane to one number.
#[inline(always)]
pub fn splat<S: Simd>(simd: S, value: f32) -> Lanes<S> {
    Lanes::simd_from(simd, value)
}

/// Loads an array into lanes.
#[inline(always)]
pub fn load<S: Simd>(simd: S, values: &Eight) -> Lanes<S> {
    Lanes::load_array_ref(simd, values)
}

/// Maximum of `value` and `least` in each lane; `least` if either is NaN.
#[inline(always)]
pub fn at_least<S: Simd>(value: Lanes<S>, least: Lanes<S>) -> Lanes<S> {
    value.simd_gt(least).select(value, least)
}

/// Returns `yes` in the lanes where `value` > 0, and `no` in all other lanes.
#[inline(always)]
pub fn if_positive<S: Simd>(value: Lanes<S>, yes: Lanes<S>, no: Lanes<S>) -> Lanes<S> {
    value.simd_gt(0.0).select(yes, no)
}

/// Returns the bit mask of the lanes where `value` > 0.
#[inline(always)]
pub fn positive<S: Simd>(value: Lanes<S>) -> u8 {
    value.simd_gt(0.0).to_bitmask() as u8
}

/// Loads the rows at the eight indices `places`, and returns their first three columns: lane k of each column
/// belongs to the row at `places[k]`.
#[inline(always)]
pub fn gather<S: Simd>(simd: S, rows: &[Row], places: &[u32; LANES]) -> [Lanes<S>; 3] {
    let [a, b, c, d, e, f, g, h] = *places;
    let (a, b) = (row(simd, rows, a), row(simd, rows, b));
    let (c, d) = (row(simd, rows, c), row(simd, rows, d));
    let (e, f) = (row(simd, rows, e), row(simd, rows, f));
    let (g, h) = (row(simd, rows, g), row(simd, rows, h));
    #[cfg(target_arch = "x86_64")]
    if let Some(avx2) = simd.level().as_avx2() {
        let (ae, bf) = (a.combine(e).to_array(), b.combine(f).to_array());
        let (cg, dh) = (c.combine(g).to_array(), d.combine(h).to_array());
        let [x, y, z] = columns_of_both_halves(avx2, ae, bf, cg, dh);
        return [load(simd, &x), load(simd, &y), load(simd, &z)];
    }
    let ([x, y, z], [u, v, w]) = (columns(a, b, c, d), columns(e, f, g, h));
    [x.combine(u), y.combine(v), z.combine(w)]
}

#[inline(always)]
fn row<S: Simd>(simd: S, rows: &[Row], place: u32) -> f32x4<S> {
    f32x4::load_array_ref(simd, rows[place as usize].as_array())
}

/// Transposes four rows of four numbers, and returns the first three columns.
#[inline(always)]
fn columns<S: Simd>(a: f32x4<S>, b: f32x4<S>, c: f32x4<S>, d: f32x4<S>) -> [f32x4<S>; 3] {
    let (ac, bd) = (a.zip_low(c), b.zip_low(d));
    let z = a.zip_high(c).zip_low(b.zip_high(d));
    [ac.zip_low(bd), ac.zip_high(bd), z]
}

#[cfg(target_arch = "x86_64")]
fearless_simd::kernel!(
    /// Evaluates [`columns`] for two sets of four rows at once: the low halves of `a` to `d` are one set, the
    /// high halves the other. This takes seven shuffles instead of fourteen. Uses intrinsics, because
    /// `fearless_simd` has no zip within each half.
    #[inline(always)]
    fn columns_of_both_halves(avx2: Avx2, a: Eight, b: Eight, c: Eight, d: Eight) -> [Eight; 3] {
        use std::arch::x86_64::*;
        let (a, b): (__m256, __m256) = (load(avx2, &a).into(), load(avx2, &b).into());
        let (c, d): (__m256, __m256) = (load(avx2, &c).into(), load(avx2, &d).into());
        let (ab, cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
        let (ab_high, cd_high) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
        let x: Lanes<_> = _mm256_shuffle_ps::<0x44>(ab, cd).simd_into(avx2);
        let y: Lanes<_> = _mm256_shuffle_ps::<0xEE>(ab, cd).simd_into(avx2);
        let z: Lanes<_> = _mm256_shuffle_ps::<0x44>(ab_high, cd_high).simd_into(avx2);
        [x.to_array(), y.to_array(), z.to_array()]
    }
);

/// Stores eight vectors one after the other. `columns` holds their x, y and z components; `components` is 2
/// or 3.
#[inline(always)]
pub fn scatter<S: Simd>(simd: S, columns: [Lanes<S>; 3], components: usize, vectors: &mut [f32]) {
    let [x, y, z] = columns;
    if components == 2 {
        let ((a, c), (b, d)) = (x.split(), y.split());
        store(a.zip_low(b), vectors, 0);
        store(a.zip_high(b), vectors, 4);
        store(c.zip_low(d), vectors, 8);
        store(c.zip_high(d), vectors, 12);
        return;
    }
    let (x, y, z) = (x.to_array(), y.to_array(), z.to_array());
    #[cfg(target_arch = "x86_64")]
    if let Some(avx2) = simd.level().as_avx2() {
        let [a, b, c] = vectors_of_both_halves(avx2, x, y, z);
        let (a, b, c) = (load(simd, &a), load(simd, &b), load(simd, &c));
        let ((a, d), (b, e), (c, f)) = (a.split(), b.split(), c.split());
        store(a, vectors, 0);
        store(b, vectors, 4);
        store(c, vectors, 8);
        store(d, vectors, 12);
        store(e, vectors, 16);
        store(f, vectors, 20);
        return;
    }
    // Lists every component, because the compiler turns this list into the best shuffles of each instruction
    // set.
    store(four(simd, [x[0], y[0], z[0], x[1]]), vectors, 0);
    store(four(simd, [y[1], z[1], x[2], y[2]]), vectors, 4);
    store(four(simd, [z[2], x[3], y[3], z[3]]), vectors, 8);
    store(four(simd, [x[4], y[4], z[4], x[5]]), vectors, 12);
    store(four(simd, [y[5], z[5], x[6], y[6]]), vectors, 16);
    store(four(simd, [z[6], x[7], y[7], z[7]]), vectors, 20);
}

#[cfg(target_arch = "x86_64")]
fearless_simd::kernel!(
    /// Interleaves the components x, y and z of eight vectors: the low halves of the result hold the first
    /// four vectors, the high halves the last four. Faster than the portable version in `scatter`.
    #[inline(always)]
    fn vectors_of_both_halves(avx2: Avx2, x: Eight, y: Eight, z: Eight) -> [Eight; 3] {
        use std::arch::x86_64::*;
        let (x, y): (__m256, __m256) = (load(avx2, &x).into(), load(avx2, &y).into());
        let z: __m256 = load(avx2, &z).into();
        let xy = _mm256_shuffle_ps::<0x88>(x, y);
        let yz = _mm256_shuffle_ps::<0xDD>(y, z);
        let zx = _mm256_shuffle_ps::<0xD8>(z, x);
        let a: Lanes<_> = _mm256_shuffle_ps::<0x88>(xy, zx).simd_into(avx2);
        let b: Lanes<_> = _mm256_shuffle_ps::<0xD8>(yz, xy).simd_into(avx2);
        let c: Lanes<_> = _mm256_shuffle_ps::<0xDD>(zx, yz).simd_into(avx2);
        [a.to_array(), b.to_array(), c.to_array()]
    }
);

/// Loads four numbers.
#[inline(always)]
pub fn four<S: Simd>(simd: S, values: [f32; 4]) -> f32x4<S> {
    f32x4::load_array(simd, values)
}

/// Stores four numbers. A store of eight numbers would cross a cache line in half of all cases.
#[inline(always)]
fn store<S: Simd>(values: f32x4<S>, numbers: &mut [f32], first: usize) {
    values.store_slice(&mut numbers[first..first + 4]);
}

/// Returns the sum of several rows of four numbers, added in the order of `places`, with zeros in place of the
/// components from index `components` on. Each place is the index in `numbers` at which a row begins. Unused places
/// follow the used ones and are 0, because `numbers` begins with a row of zeros.
#[inline(always)]
pub fn sum<S: Simd>(simd: S, numbers: &[f32], places: &[u32; 8], components: usize) -> f32x4<S> {
    let mut sum = row_at(simd, numbers, places[0]);
    for &place in &places[1..4] {
        sum += row_at(simd, numbers, place);
    }
    // Nodes at surfaces have at most four elements.
    if places[4] != 0 {
        for &place in &places[4..] {
            sum += row_at(simd, numbers, place);
        }
    }
    // Selects instead of writing zeros into an array: the array would be stored and loaded again.
    let third = if components == 2 { 0.0 } else { 1.0 };
    let is_kept = four(simd, [1.0, 1.0, third, 0.0]).simd_gt(0.0);
    is_kept.select(sum, f32x4::splat(simd, 0.0))
}

/// Returns, for each of the four columns, the sum of squares over several rows. Each of `places` is the index
/// in `numbers` at which a row begins. An unused place is 0, because `numbers` begins with a row of zeros.
#[inline(always)]
pub fn sum_of_squares<S: Simd>(simd: S, numbers: &[f32], places: &[u32]) -> Row {
    let mut sum = f32x4::splat(simd, 0.0);
    for &place in places {
        let row = row_at(simd, numbers, place);
        sum += row * row;
    }
    Row::from_array(sum.to_array())
}

#[inline(always)]
fn row_at<S: Simd>(simd: S, numbers: &[f32], place: u32) -> f32x4<S> {
    let first = place as usize;
    f32x4::from_slice(simd, &numbers[first..first + 4])
}
