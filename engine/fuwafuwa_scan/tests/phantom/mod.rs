//! Synthetic patient and scans of it. Left and right, front and back, head and feet differ:
//!
//! ```text
//!   from behind      S             from the left     S
//!             ╭──────────────╮               ╭──────────────────╮
//!             │      4       │               │        4         │
//!           L │         2    │ R           A │ 3                │ P      72 × 96 × 60 mm
//!             ╰──────────────╯               ╰──────────────────╯
//! ```
#![allow(dead_code)] // no test file uses all of it

use fuwafuwa_scan::{Options, Organ, Scan, Segmentation};

/// Half axes of the ellipsoid [mm]: to the right, to the front, up. In a round shape, as many voxels at the
/// border are too large as too small, so that the volume is right on average.
pub const HALF: [f64; 3] = [36.0, 48.0, 30.0];

/// Balls of other materials in the phantom: label, centre (RAS+) and radius [mm].
pub const MARKS: [(i32, [f64; 3], f64); 3] = [
    (2, [20.0, 0.0, 0.0], 9.0),
    (3, [0.0, 30.0, 0.0], 9.0),
    (4, [0.0, 0.0, 14.0], 9.0),
];

/// Returns the label of the phantom at a position in the patient, RAS+ [mm].
pub fn label(patient: [f64; 3]) -> i32 {
    let squared = |middle: [f64; 3]| -> f64 {
        (0..3)
            .map(|axis| (patient[axis] - middle[axis]).powi(2))
            .sum()
    };
    let mark = MARKS.iter().find(|mark| squared(mark.1) < mark.2 * mark.2);
    let share = |axis: usize| patient[axis] / HALF[axis];
    let is_inside = (0..3).map(|axis| share(axis).powi(2)).sum::<f64>() < 1.0;
    mark.map_or(i32::from(is_inside), |mark| mark.0)
}

/// Unit vectors along the three axes of a scan, in patient coordinates, RAS+.
pub type Axes = [[f64; 3]; 3];

pub const RAS: Axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Part of the header that gives the placement.
#[derive(Copy, Clone)]
pub enum Form {
    Sform,
    /// Quaternion: its imaginary part, and whether the third axis is reversed.
    Qform([f64; 3], bool),
    Spacing,
}

/// Content of a NIfTI file.
#[derive(Clone)]
pub struct File {
    pub version: usize,
    pub is_big_endian: bool,
    pub datatype: i16,
    pub size: [usize; 3],
    pub spacing: [f64; 3],
    pub affine: [[f64; 4]; 3],
    pub form: Form,
    pub unit: u8,
    /// Slope and intercept; a slope of 0 or NaN means no scaling.
    pub scale: [f64; 2],
    pub values: Vec<f64>,
}

impl File {
    /// Samples `value` at positions in the patient, RAS+ [mm], in a box around the phantom.
    pub fn of(axes: Axes, spacing: [f64; 3], value: impl Fn([f64; 3]) -> f64) -> Self {
        let size = spacing.map(|k| (124.0 / k) as usize);
        // Offsets the centre of the box from the origin of the patient [mm], so that errors of the offset
        // show.
        let middle = [3.0, -4.0, 2.0];
        let affine = [0, 1, 2].map(|row: usize| {
            let column = |axis: usize| axes[axis][row] * spacing[axis];
            let half = |axis: usize| column(axis) * (size[axis] as f64 - 1.0) / 2.0;
            let offset = middle[row] - half(0) - half(1) - half(2);
            [column(0), column(1), column(2), offset]
        });
        let mut values = Vec::new();
        for z in 0..size[2] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let [x, y, z] = [x, y, z].map(|k| k as f64);
                    values.push(value(affine.map(|[a, b, c, d]| a * x + b * y + c * z + d)));
                }
            }
        }
        Self {
            version: 1,
            is_big_endian: false,
            datatype: 4,
            size,
            spacing,
            affine,
            form: Form::Sform,
            unit: 2,
            scale: [1.0, 0.0],
            values,
        }
    }

    /// Creates a file of a few voxels with a spacing of 1 mm.
    pub fn small(size: [usize; 3], values: &[f64]) -> Self {
        let mut file = Self::of(RAS, [62.0; 3], |_| 0.0);
        file.size = size;
        file.spacing = [1.0; 3];
        file.affine = [0, 1, 2].map(|row: usize| {
            let mut affine = [0.0; 4];
            affine[row] = 1.0;
            affine
        });
        file.values = values.to_vec();
        file
    }

    /// Encodes the file as the standard defines.
    pub fn bytes(&self) -> Vec<u8> {
        let is_first = self.version == 1;
        let (length, offset) = if is_first { (348, 352) } else { (540, 544) };
        let mut bytes = vec![0; offset];
        let at = |first: usize, second: usize| if is_first { first } else { second };
        self.put(&mut bytes, 0, 8, length as f64);
        match is_first {
            true => bytes[344..348].copy_from_slice(b"n+1\0"),
            false => bytes[4..12].copy_from_slice(b"n+2\0\r\n\x1a\n"),
        }
        // NIfTI datatypes of the fields, in version 1 or 2: 16-bit or 64-bit integers, single or double
        // precision, and 16-bit or 32-bit form codes.
        let (whole, real, code) = if is_first { (4, 16, 4) } else { (1024, 64, 8) };
        let width = if is_first { [2, 4] } else { [8, 8] };
        let [x, y, z] = self.size.map(|k| k as f64);
        for (index, number) in [3.0, x, y, z, 1.0, 1.0, 1.0, 1.0].into_iter().enumerate() {
            self.put(&mut bytes, at(40, 16) + index * width[0], whole, number);
        }
        self.put(&mut bytes, at(70, 12), 4, f64::from(self.datatype));
        let bits = 8 * self.number(0.0, self.datatype).len();
        self.put(&mut bytes, at(72, 14), 4, bits as f64);
        let is_left_handed = matches!(self.form, Form::Qform(_, true));
        let factor = if is_left_handed { -1.0 } else { 1.0 };
        let [x, y, z] = self.spacing;
        for (index, number) in [factor, x, y, z].into_iter().enumerate() {
            self.put(&mut bytes, at(76, 104) + index * width[1], real, number);
        }
        self.put(
            &mut bytes,
            at(108, 168),
            if is_first { 16 } else { 1024 },
            offset as f64,
        );
        self.put(&mut bytes, at(112, 176), real, self.scale[0]);
        self.put(&mut bytes, at(116, 184), real, self.scale[1]);
        self.put(
            &mut bytes,
            at(123, 500),
            if is_first { 2 } else { 8 },
            f64::from(self.unit),
        );
        match self.form {
            Form::Sform => {
                self.put(&mut bytes, at(254, 348), code, 1.0);
                for (index, &number) in self.affine.as_flattened().iter().enumerate() {
                    self.put(&mut bytes, at(280, 400) + index * width[1], real, number);
                }
            }
            Form::Qform(imaginary, _) => {
                self.put(&mut bytes, at(252, 344), code, 1.0);
                let offset = self.affine.map(|row| row[3]);
                for (index, number) in imaginary.into_iter().chain(offset).enumerate() {
                    self.put(&mut bytes, at(256, 352) + index * width[1], real, number);
                }
            }
            Form::Spacing => {}
        }
        let [slope, inter] = match self.scale {
            [slope, inter] if slope.is_finite() && slope != 0.0 => [slope, inter],
            _ => [1.0, 0.0],
        };
        for value in &self.values {
            bytes.extend(self.number((value - inter) / slope, self.datatype));
        }
        bytes
    }

    pub fn scan(&self) -> Scan {
        let scan = Scan::decode("test.nii", &self.bytes(), |_| {});
        scan.unwrap_or_else(|error| panic!("{error}"))
    }

    fn put(&self, bytes: &mut [u8], at: usize, kind: i16, value: f64) {
        let number = self.number(value, kind);
        bytes[at..at + number.len()].copy_from_slice(&number);
    }

    /// Encodes a number in a NIfTI `datatype`.
    fn number(&self, value: f64, datatype: i16) -> Vec<u8> {
        let mut bytes = match datatype {
            2 => (value as u8).to_le_bytes().to_vec(),
            4 => (value as i16).to_le_bytes().to_vec(),
            8 => (value as i32).to_le_bytes().to_vec(),
            16 => (value as f32).to_le_bytes().to_vec(),
            64 => value.to_le_bytes().to_vec(),
            256 => (value as i8).to_le_bytes().to_vec(),
            512 => (value as u16).to_le_bytes().to_vec(),
            768 => (value as u32).to_le_bytes().to_vec(),
            1024 => (value as i64).to_le_bytes().to_vec(),
            1280 => (value as u64).to_le_bytes().to_vec(),
            _ => panic!("datatype {datatype}"),
        };
        if self.is_big_endian {
            bytes.reverse();
        }
        bytes
    }
}

/// Returns a segmentation with the phantom's labels as materials.
pub fn labels() -> Segmentation {
    Segmentation::labels(&[(1, 1), (2, 2), (3, 3), (4, 4)])
}

pub fn organ(scan: &Scan, segmentation: &Segmentation, resolution: usize) -> Organ {
    let options = Options {
        resolution,
        ..Options::default()
    };
    let organ = Organ::of(&[scan], segmentation, &options, |_| {});
    organ.unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the volume of a ball [ml] of a radius [mm].
pub fn ball(radius: f64) -> f64 {
    ellipsoid([radius; 3])
}

/// Returns the volume of an ellipsoid [ml] of half axes [mm].
pub fn ellipsoid(half: [f64; 3]) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * half.iter().product::<f64>() / 1000.0
}
