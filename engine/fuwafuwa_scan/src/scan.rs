//! Scans: a number for each voxel of a box, and the position of the box in the patient.

use crate::header::{Header, LONGEST};
use crate::placement::Placement;
use crate::stream::Stream;
use fuwafuwa_scenes::import::{FilePosition, ImportError, PositionedProblem, in_file, unexpected};

/// Number of voxels read between two calls of `progress`.
const CHUNK: usize = 1 << 16;

/// A scan: an intensity, a label or a probability for each voxel of a box.
#[derive(Clone, Debug)]
pub struct Scan {
    size: [usize; 3],
    /// Values of the voxels, with the first axis fastest; all finite.
    values: Vec<f32>,
    lowest: f32,
    highest: f32,
    placement: Placement,
    notes: Vec<String>,
}

impl Scan {
    /// Decodes a NIfTI file, version 1 or 2, with header and voxels in one file, plain or gzipped. `file` is
    /// the name used in errors; `progress` is called with increasing numbers from 0 to 1.
    ///
    /// Values are stored in single precision. Values that are not finite are replaced by the lowest finite
    /// value. [`Scan::notes`] tells what was replaced or ignored.
    ///
    /// # Errors
    /// [`ImportError`] names the field of the header or the byte, what was expected and what was found.
    pub fn decode(
        file: &str,
        bytes: &[u8],
        progress: impl FnMut(f32),
    ) -> Result<Self, ImportError> {
        in_file(file, try_decode(bytes, progress))
    }

    /// Returns the number of voxels on each axis of the scan.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Returns the map between voxels and patient coordinates.
    pub fn placement(&self) -> &Placement {
        &self.placement
    }

    /// Returns the lowest and the highest value.
    pub fn range(&self) -> [f32; 2] {
        [self.lowest, self.highest]
    }

    /// Returns sentences for the user about fields and values that were replaced, and bytes that were ignored.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Returns the values of all voxels, with the first axis fastest.
    pub(crate) fn values(&self) -> &[f32] {
        &self.values
    }

    /// Returns the value of the voxel nearest to a position in the scan [voxels]; outside the scan, the
    /// lowest value.
    pub fn nearest(&self, voxel: [f64; 3]) -> f32 {
        let at = voxel.map(|k| (k + 0.5).floor() as i64);
        self.value(at)
    }

    /// Interpolates trilinearly at a position in the scan [voxels]; more than half a voxel outside the scan,
    /// returns the lowest value.
    pub fn interpolate(&self, voxel: [f64; 3]) -> f32 {
        let high = self.size.map(|extent| extent as f64 - 1.0);
        let is_inside = |axis: usize| (-0.5..=high[axis] + 0.5).contains(&voxel[axis]);
        if !(0..3).all(is_inside) {
            return self.lowest;
        }
        let mut low = [0; 3];
        let mut next = [0; 3];
        let mut share = [0.0_f32; 3];
        for axis in 0..3 {
            let at = voxel[axis].clamp(0.0, high[axis]);
            low[axis] = at as usize;
            next[axis] = (low[axis] + 1).min(self.size[axis] - 1);
            share[axis] = (at - low[axis] as f64) as f32;
        }
        let along_x = |y: usize, z: usize| {
            let row = (z * self.size[1] + y) * self.size[0];
            let (a, b) = (self.values[row + low[0]], self.values[row + next[0]]);
            a + share[0] * (b - a)
        };
        let along_y = |z: usize| {
            let (a, b) = (along_x(low[1], z), along_x(next[1], z));
            a + share[1] * (b - a)
        };
        let (a, b) = (along_y(low[2]), along_y(next[2]));
        a + share[2] * (b - a)
    }

    fn value(&self, at: [i64; 3]) -> f32 {
        let is_inside = |axis: usize| (0..self.size[axis] as i64).contains(&at[axis]);
        if !(0..3).all(is_inside) {
            return self.lowest;
        }
        let [x, y, z] = at.map(|k| k as usize);
        self.values[(z * self.size[1] + y) * self.size[0] + x]
    }
}

fn try_decode(bytes: &[u8], mut progress: impl FnMut(f32)) -> Result<Scan, PositionedProblem> {
    let mut stream = Stream::of(bytes)?;
    let mut beginning = [0; LONGEST];
    let length = stream.fill(&mut beginning)?;
    let beginning = &beginning[..length];
    let header = Header::read(beginning)?;
    stream.check(header.bytes())?;
    let mut notes = header.notes.clone();
    let mut values = read(&header, beginning, &mut stream, &mut progress, &mut notes)?;
    let ignored = stream.finish()?;
    if ignored > 0 {
        notes.push(format!(
            "{ignored} bytes after the gzip data are not gzip data, and were ignored"
        ));
    }

    let finite = || values.iter().copied().filter(|k| k.is_finite());
    let lowest = finite().min_by(f32::total_cmp).unwrap_or(0.0);
    let highest = finite().max_by(f32::total_cmp).unwrap_or(0.0);
    let mut replaced = 0;
    for value in values.iter_mut().filter(|k| !k.is_finite()) {
        *value = lowest;
        replaced += 1;
    }
    if replaced > 0 {
        notes.push(format!(
            "{replaced} of {} values are not finite, and were replaced by {lowest}, the lowest",
            values.len()
        ));
    }
    Ok(Scan {
        size: header.size,
        values,
        lowest,
        highest,
        placement: header.placement,
        notes,
    })
}

/// Reads the values of all voxels. `beginning` holds the bytes that were already read from the stream.
fn read(
    header: &Header,
    beginning: &[u8],
    stream: &mut Stream,
    progress: &mut impl FnMut(f32),
    notes: &mut Vec<String>,
) -> Result<Vec<f32>, PositionedProblem> {
    let (count, width) = (header.voxels(), header.number.bytes());
    let [slope, inter] = header.scale;
    let value = |bytes: &[u8]| {
        let number = header.number.value(bytes, header.is_big_endian);
        (number * slope + inter) as f32
    };
    let mut buffer = beginning.get(header.offset..).unwrap_or_default().to_vec();
    let mut ahead = header.offset.saturating_sub(beginning.len());
    let mut skipped = [0; 1 << 12];
    while ahead > 0 {
        let part = ahead.min(skipped.len());
        stream.fill_all(&mut skipped[..part], header.bytes())?;
        ahead -= part;
    }
    let mut values = Vec::with_capacity(count);
    let mut rounded = 0;
    while values.len() < count {
        progress(values.len() as f32 / count as f32);
        let wanted = (count - values.len()).min(CHUNK) * width;
        let had = buffer.len().min(wanted);
        buffer.resize(wanted, 0);
        stream.fill_all(&mut buffer[had..], header.bytes())?;
        let first = header.offset + values.len() * width;
        rounded += check_integers(header, &buffer, first)?;
        values.extend(buffer.chunks_exact(width).map(value));
        buffer.clear();
    }
    if rounded > 0 {
        notes.push(format!(
            "{rounded} of {count} values are integers beyond 16777216, and were rounded to single precision"
        ));
    }
    progress(1.0);
    Ok(values)
}

/// Returns the number of integers that single precision does not hold exactly. `first` is the offset of the
/// first integer in the file [bytes].
///
/// # Errors
/// The first such integer of 64 bits. Integers of that length are labels, so that a rounded one is another
/// label.
fn check_integers(header: &Header, bytes: &[u8], first: usize) -> Result<usize, PositionedProblem> {
    if !header.number.may_be_inexact() {
        return Ok(0);
    }
    let mut rounded = 0;
    let width = header.number.bytes();
    for (index, number) in bytes.chunks_exact(width).enumerate() {
        let Some(found) = header.number.inexact_integer(number, header.is_big_endian) else {
            continue;
        };
        if width == 8 {
            let at = FilePosition::Byte(first + index * width);
            let expected =
                "64-bit integers that single precision holds exactly, as all up to 16777216";
            return Err(unexpected(at, expected, found));
        }
        rounded += 1;
    }
    Ok(rounded)
}
