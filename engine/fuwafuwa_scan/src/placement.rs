//! Position of a scan's voxels in the patient.

use std::fmt;
use std::ops::RangeInclusive;

/// Allowed spacing of a scan's voxels [mm].
pub const SPACINGS: RangeInclusive<f64> = 1e-3..=100.0;

/// Maximum distance of the first voxel from the origin of the patient coordinates on each axis [mm]. Beyond
/// it, positions lose precision.
const MAX_OFFSET: f64 = 1e6;

/// Minimum volume of a voxel, relative to a box with the same edge lengths. Flatter voxels are rejected as
/// degenerate.
const LEAST_VOLUME: f64 = 0.05;

/// Amount by which rounding to single precision may raise the squared length of a quaternion's imaginary part
/// above 1.
const ROUNDING: f64 = 1e-3;

/// Affine map: rows of a 3 × 3 matrix, each followed by its offset.
pub type Affine = [[f64; 4]; 3];

/// Map between voxels of a scan and patient coordinates, RAS+ [mm].
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    affine: Affine,
    inverse: Affine,
    source: PlacementSource,
}

/// Part of the header that gives the placement.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum PlacementSource {
    /// Matrix, the sform of the header.
    Matrix,
    /// Rotation, the qform of the header; used if there is no valid matrix.
    Rotation,
    /// Spacing of voxels only. Left and right are then unknown, and the usual orientation is assumed.
    Spacing,
}

/// Placement data of a header, in one of the three forms that NIfTI defines. Lengths are in units of the
/// header.
pub enum PlacementForm {
    Matrix(Affine),
    /// Rotation, and spacing of voxels.
    Rotation(Quaternion, [f64; 3]),
    Spacing([f64; 3]),
}

/// Rotation, and position of the first voxel.
pub struct Quaternion {
    pub imaginary: [f64; 3],
    pub offset: [f64; 3],
    /// Whether the third axis of the scan is reversed.
    pub is_left_handed: bool,
}

/// Problem with a placement.
#[derive(Debug)]
pub struct PlacementProblem {
    pub expected: &'static str,
    pub found: String,
}

impl fmt::Display for PlacementProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected {}, found {}", self.expected, self.found)
    }
}

impl Placement {
    /// Creates a placement from a form. `unit` is the length of one unit of the form [mm].
    pub(crate) fn of(form: &PlacementForm, unit: f64) -> Result<Self, PlacementProblem> {
        let (affine, source) = match form {
            PlacementForm::Matrix(affine) => (*affine, PlacementSource::Matrix),
            PlacementForm::Rotation(rotation, spacing) => {
                (rotation.affine(*spacing)?, PlacementSource::Rotation)
            }
            PlacementForm::Spacing(spacing) => (scaling(*spacing), PlacementSource::Spacing),
        };
        let affine = affine.map(|row| row.map(|k| k * unit));
        check(&affine)?;
        Ok(Self {
            affine,
            inverse: inverse(&affine),
            source,
        })
    }

    /// Returns the part of the header that gave the placement.
    pub fn source(&self) -> PlacementSource {
        self.source
    }

    /// Returns the distance between neighbouring voxels on each axis of the scan [mm].
    pub fn spacing(&self) -> [f64; 3] {
        spacing(&self.affine)
    }

    /// Converts a position in the scan [voxels] to patient coordinates, RAS+ [mm]. Integers are centres of
    /// voxels.
    pub fn patient_at(&self, voxel: [f64; 3]) -> [f64; 3] {
        apply(&self.affine, voxel)
    }

    /// Converts patient coordinates, RAS+ [mm], to a position in the scan [voxels].
    pub fn voxel_at(&self, patient: [f64; 3]) -> [f64; 3] {
        apply(&self.inverse, patient)
    }
}

impl Quaternion {
    /// Returns the affine map that combines rotation, spacing and offset [Cox 2004, method 2].
    fn affine(&self, spacing: [f64; 3]) -> Result<Affine, PlacementProblem> {
        let [mut b, mut c, mut d] = self.imaginary;
        let squared = b * b + c * c + d * d;
        if squared.is_nan() || squared > 1.0 + ROUNDING {
            return Err(PlacementProblem {
                expected: "the imaginary part of a unit quaternion",
                found: format!("{b}, {c}, {d}"),
            });
        }
        let a = if squared < 1.0 {
            (1.0 - squared).sqrt()
        } else {
            let length = squared.sqrt();
            [b, c, d] = [b / length, c / length, d / length];
            0.0
        };
        let rotation = [
            [
                a * a + b * b - c * c - d * d,
                2.0 * (b * c - a * d),
                2.0 * (b * d + a * c),
            ],
            [
                2.0 * (b * c + a * d),
                a * a + c * c - b * b - d * d,
                2.0 * (c * d - a * b),
            ],
            [
                2.0 * (b * d - a * c),
                2.0 * (c * d + a * b),
                a * a + d * d - b * b - c * c,
            ],
        ];
        let [x, y, z] = spacing.map(f64::abs);
        let scale = [x, y, if self.is_left_handed { -z } else { z }];
        Ok([0, 1, 2].map(|row: usize| {
            let turned = |column: usize| rotation[row][column] * scale[column];
            [turned(0), turned(1), turned(2), self.offset[row]]
        }))
    }
}

fn scaling(spacing: [f64; 3]) -> Affine {
    let mut affine = [[0.0; 4]; 3];
    for axis in 0..3 {
        affine[axis][axis] = spacing[axis].abs();
    }
    affine
}

fn check(affine: &Affine) -> Result<(), PlacementProblem> {
    let wrong = |expected, found| Err(PlacementProblem { expected, found });
    if !affine.as_flattened().iter().all(|k| k.is_finite()) {
        return wrong("finite numbers", format!("{affine:?}"));
    }
    let spacing = spacing(affine);
    if !spacing.iter().all(|k| SPACINGS.contains(k)) {
        let expected = "voxels 0.001 to 100 mm apart on each axis";
        return wrong(expected, format!("{spacing:?} mm"));
    }
    let volume = determinant(affine).abs() / spacing.iter().product::<f64>();
    if volume < LEAST_VOLUME {
        let found = format!("{volume:.3} of the volume of a box with the same edges");
        return wrong("three independent axes", found);
    }
    let offset = affine.map(|row| row[3]);
    if !offset.iter().all(|k| k.abs() <= MAX_OFFSET) {
        let expected = "the first voxel within a kilometre of the patient's origin";
        return wrong(expected, format!("{offset:?} mm"));
    }
    Ok(())
}

fn spacing(affine: &Affine) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        let squares = affine.iter().map(|row: &[f64; 4]| row[axis] * row[axis]);
        squares.sum::<f64>().sqrt()
    })
}

fn apply(affine: &Affine, [x, y, z]: [f64; 3]) -> [f64; 3] {
    affine.map(|[a, b, c, offset]| a * x + b * y + c * z + offset)
}

/// Returns the cofactor of a matrix entry: the minor of the two rows and the two columns that follow
/// cyclically. In this cyclic order, the minor already has the sign of the cofactor.
fn minor(affine: &Affine, row: usize, column: usize) -> f64 {
    let ([r, s], [c, d]) = (after(row), after(column));
    affine[r][c] * affine[s][d] - affine[r][d] * affine[s][c]
}

fn after(axis: usize) -> [usize; 2] {
    [(axis + 1) % 3, (axis + 2) % 3]
}

fn determinant(affine: &Affine) -> f64 {
    let products = (0..3).map(|column| affine[0][column] * minor(affine, 0, column));
    products.sum()
}

fn inverse(affine: &Affine) -> Affine {
    let determinant = determinant(affine);
    let mut inverse = [[0.0; 4]; 3];
    for row in 0..3 {
        for column in 0..3 {
            inverse[row][column] = minor(affine, column, row) / determinant;
        }
    }
    let offset = affine.map(|row| row[3]);
    let [x, y, z] = apply(&inverse, offset);
    for (row, moved) in inverse.iter_mut().zip([x, y, z]) {
        row[3] = -moved;
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn voxel_at_inverts_patient_at() {
        let form = PlacementForm::Matrix([
            [0.0, -1.5, 0.2, 90.0],
            [0.7, 0.1, 0.0, -126.0],
            [0.1, 0.0, 2.0, -72.0],
        ]);
        let placement = Placement::of(&form, 1.0).unwrap();
        let voxel = [3.0, -40.5, 17.0];
        let back = placement.voxel_at(placement.patient_at(voxel));
        for axis in 0..3 {
            assert!((back[axis] - voxel[axis]).abs() < 1e-9, "{back:?}");
        }
    }
}
