//! Header of a NIfTI file: layout of its fields, and the valid range of each.
//!
//! The header has 348 bytes in NIfTI-1 and 540 in NIfTI-2, with the same fields at different offsets [Cox
//! 2004]. The first number of a file is the length of the header, which also reveals the byte order.

use crate::placement::{Placement, PlacementForm, Quaternion};
use fuwafuwa_scenes::import::{FilePosition, FileType, PositionedProblem, too_large, unexpected};

/// Maximum number of voxels in a scan: as many as in 512 × 512 × 512, which take half a gigabyte in memory.
pub const MAX_VOXELS: u64 = 1 << 27;

/// Length of the longer of the two header versions [bytes]: 540 in NIfTI-2, against 348 in NIfTI-1.
pub const LONGEST: usize = 540;

/// Maximum offset of the first voxel [bytes]. Header extensions lie between the header and the first voxel.
const MAX_OFFSET: f64 = (1 << 26) as f64;

/// Length of the field between the header and the first voxel that tells whether header extensions follow
/// [bytes].
const EXTENDER: usize = 4;

/// Number format of a field or a voxel.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum NumberFormat {
    U8,
    I8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// Header field of one or more consecutive numbers. `at` and `number` hold its offset and format, in NIfTI-1
/// and in NIfTI-2.
struct Field {
    name: &'static str,
    at: [usize; 2],
    number: [NumberFormat; 2],
}

const fn field(
    name: &'static str,
    first: (usize, NumberFormat),
    second: (usize, NumberFormat),
) -> Field {
    Field {
        name,
        at: [first.0, second.0],
        number: [first.1, second.1],
    }
}

use NumberFormat::{F32, F64, I16, I32, I64, U8};
const DIM: Field = field("dim", (40, I16), (16, I64));
const DATATYPE: Field = field("datatype", (70, I16), (12, I16));
const BITPIX: Field = field("bitpix", (72, I16), (14, I16));
const PIXDIM: Field = field("pixdim", (76, F32), (104, F64));
const VOX_OFFSET: Field = field("vox_offset", (108, F32), (168, I64));
const SCL_SLOPE: Field = field("scl_slope", (112, F32), (176, F64));
const SCL_INTER: Field = field("scl_inter", (116, F32), (184, F64));
const XYZT_UNITS: Field = field("xyzt_units", (123, U8), (500, I32));
const QFORM_CODE: Field = field("qform_code", (252, I16), (344, I32));
const SFORM_CODE: Field = field("sform_code", (254, I16), (348, I32));
const QUATERN: Field = field("quatern", (256, F32), (352, F64));
const QOFFSET: Field = field("qoffset", (268, F32), (376, F64));
const SROW: Field = field("srow", (280, F32), (400, F64));

/// Values of a header that passed all checks.
#[derive(Debug)]
pub struct Header {
    /// Number of voxels on each axis of the scan.
    pub size: [usize; 3],
    /// Number format of a voxel.
    pub number: NumberFormat,
    pub is_big_endian: bool,
    /// Offset of the first voxel [bytes].
    pub offset: usize,
    /// Slope and intercept of the values: value = slope · stored number + intercept.
    pub scale: [f64; 2],
    pub placement: Placement,
    /// Fields that were replaced or ignored, as sentences for the user.
    pub notes: Vec<String>,
}

impl Header {
    /// Reads the header from `bytes`, the first [`LONGEST`] bytes of a file, or all bytes of a shorter file.
    pub fn read(bytes: &[u8]) -> Result<Self, PositionedProblem> {
        let bytes = Bytes::of(bytes)?;
        let mut notes = Vec::new();
        let size = size(&bytes)?;
        let number = number(&bytes, &mut notes)?;
        Ok(Self {
            size,
            number,
            is_big_endian: bytes.is_big_endian,
            offset: offset(&bytes, &mut notes)?,
            scale: scale(&bytes)?,
            placement: placement(&bytes, &mut notes)?,
            notes,
        })
    }

    /// Returns the number of voxels, at most [`MAX_VOXELS`], as [`Header::read`] has checked.
    pub fn voxels(&self) -> usize {
        self.size.iter().product()
    }

    /// Returns the length of the file up to the end of the last voxel [bytes].
    pub fn bytes(&self) -> u64 {
        self.offset as u64 + self.voxels() as u64 * self.number.bytes() as u64
    }
}

impl NumberFormat {
    pub fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Decodes a number. 64-bit integers are rounded to 53 bits; all limits are far below 2⁵³.
    pub fn value(self, bytes: &[u8], is_big_endian: bool) -> f64 {
        let word = self.word(bytes, is_big_endian);
        let [a, b, c, d, ..] = word;
        match self {
            Self::U8 => f64::from(a),
            Self::I8 => f64::from(a as i8),
            Self::I16 => f64::from(i16::from_le_bytes([a, b])),
            Self::U16 => f64::from(u16::from_le_bytes([a, b])),
            Self::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Self::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::I64 => i64::from_le_bytes(word) as f64,
            Self::U64 => u64::from_le_bytes(word) as f64,
            Self::F64 => f64::from_le_bytes(word),
        }
    }

    /// Returns whether numbers of this format can be integers that single precision does not hold exactly.
    pub fn may_be_inexact(self) -> bool {
        matches!(self, Self::I32 | Self::U32 | Self::I64 | Self::U64)
    }

    /// Returns an integer of 32 or 64 bits that single precision does not hold exactly. `None` for other
    /// numbers.
    pub fn inexact_integer(self, bytes: &[u8], is_big_endian: bool) -> Option<i128> {
        let word = self.word(bytes, is_big_endian);
        let [a, b, c, d, ..] = word;
        let integer = match self {
            Self::I32 => i128::from(i32::from_le_bytes([a, b, c, d])),
            Self::U32 => i128::from(u32::from_le_bytes([a, b, c, d])),
            Self::I64 => i128::from(i64::from_le_bytes(word)),
            Self::U64 => i128::from(u64::from_le_bytes(word)),
            _ => return None,
        };
        (integer as f32 as i128 != integer).then_some(integer)
    }

    /// Returns the bytes of a number in little-endian order, followed by zeros.
    fn word(self, bytes: &[u8], is_big_endian: bool) -> [u8; 8] {
        let mut word = [0; 8];
        let used = &mut word[..self.bytes()];
        used.copy_from_slice(bytes);
        if is_big_endian {
            used.reverse();
        }
        word
    }
}

/// Bytes of a complete header, with the version that determines its layout.
struct Bytes<'a> {
    bytes: &'a [u8],
    /// Index of the version: 0 for NIfTI-1, 1 for NIfTI-2.
    version: usize,
    is_big_endian: bool,
}

impl<'a> Bytes<'a> {
    fn of(bytes: &'a [u8]) -> Result<Self, PositionedProblem> {
        let Some(first) = bytes.first_chunk::<4>() else {
            return Err(no_scan(bytes));
        };
        let lengths = [i32::from_le_bytes(*first), i32::from_be_bytes(*first)];
        let known = [(348, 0), (540, 1)];
        let found = known.iter().find(|(length, _)| lengths.contains(length));
        let &(length, version) = found.ok_or_else(|| no_scan(bytes))?;
        let kind = FileType::of(bytes);
        let Some(bytes) = bytes.get(..length as usize) else {
            let expected = format!("a header of {length} bytes");
            return Err(unexpected(FilePosition::Byte(0), expected, bytes.len()));
        };
        let (at, magic) = [(344, &b"n+1\0"[..]), (4, b"n+2\0\r\n\x1a\n")][version];
        let found = &bytes[at..at + magic.len()];
        if found != magic {
            let expected = format!(
                "\"{}\", header and voxels in one file",
                magic.escape_ascii()
            );
            let mut text = format!("\"{}\"", found.escape_ascii());
            if found.starts_with(b"ni") {
                text += ", the header of a pair of files (.hdr and .img)";
            } else if kind == FileType::Analyze {
                text += ", as in an Analyze header (.hdr)";
            }
            return Err(unexpected(FilePosition::Field("magic", at), expected, text));
        }
        Ok(Self {
            bytes,
            version,
            is_big_endian: lengths[0] != length,
        })
    }

    fn place(&self, field: &Field, index: usize) -> FilePosition {
        let width = field.number[self.version].bytes();
        FilePosition::Field(field.name, field.at[self.version] + index * width)
    }

    /// Returns the number at `index` in a field.
    fn number(&self, field: &Field, index: usize) -> f64 {
        let number = field.number[self.version];
        let at = field.at[self.version] + index * number.bytes();
        let bytes = &self.bytes[at..at + number.bytes()];
        number.value(bytes, self.is_big_endian)
    }

    fn vector(&self, field: &Field, first: usize) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.number(field, first + axis))
    }

    fn wrong(&self, field: &Field, index: usize, expected: &str) -> PositionedProblem {
        let found = self.number(field, index);
        unexpected(self.place(field, index), expected, found)
    }
}

/// Returns the problem of a file that does not begin as a scan. Names the type of its content, if known.
fn no_scan(bytes: &[u8]) -> PositionedProblem {
    let kind = FileType::of(bytes);
    let is_scan = matches!(kind, FileType::Nifti1 | FileType::Nifti2);
    if !is_scan && kind != FileType::Unknown {
        return unexpected(FilePosition::File, "a NIfTI scan (.nii or .nii.gz)", kind);
    }
    let expected = "the length of a header, 348 or 540";
    match bytes.first_chunk::<4>() {
        Some(first) => {
            let found = i32::from_le_bytes(*first);
            unexpected(FilePosition::Field("sizeof_hdr", 0), expected, found)
        }
        None => {
            let found = format!("{} bytes", bytes.len());
            unexpected(FilePosition::Byte(0), expected, found)
        }
    }
}

fn size(bytes: &Bytes) -> Result<[usize; 3], PositionedProblem> {
    let axes = bytes.number(&DIM, 0);
    if !(3.0..=7.0).contains(&axes) {
        return Err(bytes.wrong(&DIM, 0, "3 axes, or more with one voxel on each"));
    }
    for axis in 4..=axes as usize {
        if bytes.number(&DIM, axis) != 1.0 {
            return Err(bytes.wrong(&DIM, axis, "1 (only one volume is supported)"));
        }
    }
    let mut voxels = 1.0;
    for axis in 1..=3 {
        let found = bytes.number(&DIM, axis);
        if found < 1.0 {
            return Err(bytes.wrong(&DIM, axis, "at least one voxel"));
        }
        voxels *= found;
        if voxels > MAX_VOXELS as f64 {
            let place = bytes.place(&DIM, axis);
            return Err(too_large(place, "voxels", voxels as u64, MAX_VOXELS));
        }
    }
    Ok(bytes.vector(&DIM, 1).map(|voxels| voxels as usize))
}

/// Returns the number format of a voxel. The datatype alone decides, as in the reference library; the field
/// `bitpix` repeats its number of bits.
fn number(bytes: &Bytes, notes: &mut Vec<String>) -> Result<NumberFormat, PositionedProblem> {
    let number = match bytes.number(&DATATYPE, 0) as i32 {
        2 => NumberFormat::U8,
        4 => NumberFormat::I16,
        8 => NumberFormat::I32,
        16 => NumberFormat::F32,
        64 => NumberFormat::F64,
        256 => NumberFormat::I8,
        512 => NumberFormat::U16,
        768 => NumberFormat::U32,
        1024 => NumberFormat::I64,
        1280 => NumberFormat::U64,
        _ => {
            let expected = "2, 4, 8, 16, 64, 256, 512, 768, 1024 or 1280: integers, or floating-point numbers of 32 or 64 bits";
            return Err(bytes.wrong(&DATATYPE, 0, expected));
        }
    };
    let bits = 8 * number.bytes();
    let found = bytes.number(&BITPIX, 0);
    if found != bits as f64 {
        notes.push(format!(
            "bitpix: expected {bits}, the bits of datatype {}, found {found}; the datatype was used",
            bytes.number(&DATATYPE, 0)
        ));
    }
    Ok(number)
}

/// Returns the offset of the first voxel. In a single file, four bytes stand between the header and the first
/// voxel: they tell whether header extensions follow. Some programs leave out these bytes, and others write an
/// offset of 0 in place of the least one; both are taken with a note.
fn offset(bytes: &Bytes, notes: &mut Vec<String>) -> Result<usize, PositionedProblem> {
    let found = bytes.number(&VOX_OFFSET, 0);
    let header = bytes.bytes.len();
    let usual = header + EXTENDER;
    if found == 0.0 {
        notes.push(format!(
            "vox_offset: expected {usual} or more, found 0; {usual} was used"
        ));
        return Ok(usual);
    }
    if found == header as f64 {
        notes.push(format!(
            "vox_offset: expected {usual} or more, found {header}; the voxels were read right after the header"
        ));
        return Ok(header);
    }
    let least = usual as f64;
    if found < least {
        let expected = format!(
            "voxels after the header of {header} bytes and its {EXTENDER} bytes for extensions, at byte {least} or later"
        );
        return Err(bytes.wrong(&VOX_OFFSET, 0, &expected));
    }
    if !(least..=MAX_OFFSET).contains(&found) || found % 1.0 != 0.0 {
        let expected = format!("a whole number from {least} to {MAX_OFFSET}");
        return Err(bytes.wrong(&VOX_OFFSET, 0, &expected));
    }
    Ok(found as usize)
}

/// Returns slope and intercept. A slope of 0 means no scaling, and so does a slope that is not finite, which
/// some programs write.
fn scale(bytes: &Bytes) -> Result<[f64; 2], PositionedProblem> {
    let slope = bytes.number(&SCL_SLOPE, 0);
    if slope == 0.0 || !slope.is_finite() {
        return Ok([1.0, 0.0]);
    }
    let inter = bytes.number(&SCL_INTER, 0);
    let complaint = || bytes.wrong(&SCL_INTER, 0, "a finite number");
    inter
        .is_finite()
        .then_some([slope, inter])
        .ok_or_else(complaint)
}

/// Returns the placement by the first of sform, qform and pixdim that is valid. Adds a note for each form that
/// the header declares valid but is not.
fn placement(bytes: &Bytes, notes: &mut Vec<String>) -> Result<Placement, PositionedProblem> {
    // The lowest three bits of the field give the unit of length. Most programs that leave it at 0 mean
    // millimetres.
    let unit = match bytes.number(&XYZT_UNITS, 0) as i32 & 7 {
        0 | 2 => 1.0,
        1 => 1000.0,
        3 => 0.001,
        _ => {
            let expected = "a length in metres (1), millimetres (2) or micrometres (3)";
            return Err(bytes.wrong(&XYZT_UNITS, 0, expected));
        }
    };
    let mut wrong = Vec::new();
    for (name, field, form) in placement_forms(bytes) {
        match Placement::of(&form, unit) {
            Ok(placement) => {
                notes.extend(wrong.iter().map(|(form, _, problem)| {
                    format!("the {form} is invalid: {problem}; the {name} was used")
                }));
                return Ok(placement);
            }
            Err(problem) => wrong.push((name, field, problem)),
        }
    }
    let (_, field, problem) = wrong.remove(0);
    let others = wrong.iter();
    let others: String = others
        .map(|(form, _, problem)| format!("; nor is the {form} valid: {problem}"))
        .collect();
    let found = problem.found + &others;
    Err(unexpected(bytes.place(field, 0), problem.expected, found))
}

/// Returns the forms of the placement that a header contains, each with its name and field. The most precise
/// form is the first.
fn placement_forms(bytes: &Bytes) -> Vec<(&'static str, &'static Field, PlacementForm)> {
    let spacing = bytes.vector(&PIXDIM, 1);
    let mut forms = Vec::new();
    if bytes.number(&SFORM_CODE, 0) > 0.0 {
        let row = |row: usize| [0, 1, 2, 3].map(|column| bytes.number(&SROW, 4 * row + column));
        let affine = [0, 1, 2].map(row);
        forms.push(("sform", &SROW, PlacementForm::Matrix(affine)));
    }
    if bytes.number(&QFORM_CODE, 0) > 0.0 {
        let rotation = Quaternion {
            imaginary: bytes.vector(&QUATERN, 0),
            offset: bytes.vector(&QOFFSET, 0),
            is_left_handed: bytes.number(&PIXDIM, 0) < 0.0,
        };
        let form = PlacementForm::Rotation(rotation, spacing);
        forms.push(("qform", &QUATERN, form));
    }
    forms.push(("pixdim", &PIXDIM, PlacementForm::Spacing(spacing)));
    forms
}
