//! The position of the patient in the scanner and the encoding of the file do not change the organ.

mod phantom;

use fuwafuwa::{Material, SoftBody};
use fuwafuwa_scan::{Organ, PlacementSource, Scan};
use phantom::{Axes, File, Form, HALF, MARKS, RAS, ball, ellipsoid, label, labels, organ};

/// Returns the mean position of the voxels with chosen materials [mm], on the engine's axes, relative to the
/// low corner of the grid.
fn middle(organ: &Organ, is_meant: impl Fn(u8) -> bool) -> [f64; 3] {
    let grid = &organ.grid;
    let meant = grid
        .voxels()
        .filter(|&voxel| is_meant(grid.material(voxel)));
    let meant: Vec<_> = meant.collect();
    [0, 1, 2].map(|axis: usize| {
        let places = meant.iter().map(|voxel| f64::from(voxel[axis]) + 0.5);
        1000.0 * f64::from(grid.voxel_size()) * places.sum::<f64>() / meant.len() as f64
    })
}

/// Checks that an organ has the orientation, the size and the marks of the phantom.
fn check(organ: &Organ) -> Result<(), String> {
    let near = |what: &str, found: f64, expected: f64, tolerance: f64| {
        let good = (found - expected).abs() <= tolerance;
        let wrong = format!("{what}: expected {expected:.2}, found {found:.2}");
        good.then_some(()).ok_or(wrong)
    };
    let [right, front, up] = HALF.map(|half| 2.0 * half);
    for (side, expected) in organ.sides().into_iter().zip([right, up, front]) {
        // Caps at the ends of the ellipsoid that are thinner than a voxel of the scan are lost, so the
        // tolerance is 5 mm.
        near("side [mm]", side, expected, 5.0)?;
    }
    // The centre of the whole organ, marks included, is the origin of the expected positions.
    let whole = middle(organ, |material| material != 0);
    for (number, [right, front, up], radius) in MARKS {
        let found = middle(organ, |material| i32::from(material) == number);
        for (axis, expected) in [right, up, -front].into_iter().enumerate() {
            let what = format!("mark {number} on axis {axis} [mm]");
            // The tolerance of 1 mm is less than the voxel spacing of the scans.
            near(&what, found[axis] - whole[axis], expected, 1.0)?;
        }
        let volume = organ.millilitres(number as u8);
        near("a mark [ml]", volume, ball(radius), 0.15 * ball(radius))?;
    }
    let all: f64 = (1..=4).map(|material| organ.millilitres(material)).sum();
    near(
        "whole organ [ml]",
        all,
        ellipsoid(HALF),
        0.03 * ellipsoid(HALF),
    )
}

fn check_file(what: &str, file: &File) {
    let organ = organ(&file.scan(), &labels(), 64);
    check(&organ).unwrap_or_else(|wrong| panic!("{what}: {wrong}"));
}

fn phantom(axes: Axes, spacing: [f64; 3]) -> File {
    File::of(axes, spacing, |patient| f64::from(label(patient)))
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn minus(axis: [f64; 3]) -> [f64; 3] {
    axis.map(|k| -k)
}

/// Axes rotated by 30 degrees about the patient's long axis.
fn oblique() -> Axes {
    let (sin, cos) = (0.5, 0.75_f64.sqrt());
    [[cos, sin, 0.0], [-sin, cos, 0.0], Z]
}

#[test]
fn organ_is_independent_of_scan_axes() {
    let isotropic = [2.0; 3];
    for (what, axes, spacing) in [
        ("RAS", RAS, isotropic),
        ("LAS", [minus(X), Y, Z], isotropic),
        ("LPI", [minus(X), minus(Y), minus(Z)], isotropic),
        ("PIR", [minus(Y), minus(Z), X], isotropic),
        ("SRA", [Z, X, Y], isotropic),
        ("oblique", oblique(), isotropic),
        ("thick slices", RAS, [1.0, 1.0, 4.0]),
        (
            "thick slices, PIR",
            [minus(Y), minus(Z), X],
            [1.0, 2.5, 2.0],
        ),
        ("thick slices, oblique", oblique(), [1.0, 1.5, 3.0]),
    ] {
        check_file(what, &phantom(axes, spacing));
    }
}

#[test]
fn placement_uses_qform_without_sform() {
    let mut file = phantom(RAS, [1.0, 2.0, 2.5]);
    file.form = Form::Qform([0.0; 3], false);
    check_file("RAS", &file);
    // 30 degrees about the patient's long axis; a quaternion contains the sine and cosine of half the angle.
    let mut file = phantom(oblique(), [2.0; 3]);
    file.form = Form::Qform([0.0, 0.0, 0.5 * (2.0 - 3.0_f64.sqrt()).sqrt()], false);
    assert_eq!(file.scan().placement().source(), PlacementSource::Rotation);
    check_file("oblique", &file);
    // Half a turn about the second axis, with the third axis reversed: only left and right are exchanged.
    let mut file = phantom([minus(X), Y, Z], [1.0, 2.0, 2.5]);
    file.form = Form::Qform([0.0, 1.0, 0.0], true);
    check_file("LAS", &file);
}

#[test]
fn check_detects_mirrored_organ() {
    for axis in 0..3 {
        let mut file = phantom(RAS, [2.0; 3]);
        let [_, _, _, offset] = file.affine[axis];
        file.affine[axis] = file.affine[axis].map(|k| -k);
        file.affine[axis][3] = -offset;
        let organ = organ(&file.scan(), &labels(), 64);
        let wrong = check(&organ).expect_err("one axis is mirrored");
        assert!(wrong.starts_with("mark"), "{wrong}");
    }
    // Exchanging two axes of the scan changes the side lengths of the organ, so the check fails.
    let mut file = phantom(RAS, [2.0; 3]);
    file.affine.swap(0, 1);
    assert!(check(&organ(&file.scan(), &labels(), 64)).is_err());
}

#[test]
fn voxel_at_finds_marks_of_patient() {
    for axes in [RAS, [minus(Y), minus(Z), X], oblique()] {
        let organ = organ(&phantom(axes, [2.0; 3]).scan(), &labels(), 48);
        for (number, middle, _) in MARKS {
            let voxel = organ.voxel_at(middle);
            assert_eq!(i32::from(organ.grid.material(voxel)), number);
            let edge = f64::from(organ.grid.voxel_size());
            let back = organ.patient_at(voxel.map(|k| (f64::from(k) + 0.5) * edge));
            for axis in 0..3 {
                assert!((back[axis] - middle[axis]).abs() <= 500.0 * edge * 1.001);
            }
        }
        let body = SoftBody::new(organ.grid, &[Material::default(); 4]).unwrap();
        assert!(body.mesh().element_count() > 1000);
    }
}

#[test]
fn placement_uses_spacing_without_forms() {
    let mut file = phantom(RAS, [1.0, 2.0, 4.0]);
    file.form = Form::Spacing;
    let scan = file.scan();
    assert_eq!(scan.placement().source(), PlacementSource::Spacing);
    assert_eq!(scan.placement().spacing(), [1.0, 2.0, 4.0]);
    check(&organ(&scan, &labels(), 64)).unwrap();
}

#[test]
fn decode_gives_same_values_for_each_encoding() {
    // The values are multiples of the scaling step, so that every number format stores them exactly.
    let values: Vec<f64> = (0..24).map(|k| f64::from(k * 5 % 24)).collect();
    let plain = File::small([4, 3, 2], &values);
    let numbers = |scan: &Scan| -> Vec<f32> {
        let at = |k: usize| [k % 4, k / 4 % 3, k / 12].map(|k| k as f64);
        (0..24).map(|k| scan.nearest(at(k))).collect()
    };
    let expected: Vec<f32> = values.iter().map(|&k| k as f32).collect();
    for version in [1, 2] {
        for is_big_endian in [false, true] {
            for datatype in [2, 4, 8, 16, 64, 256, 512, 768, 1024, 1280] {
                for scale in [[1.0, 0.0], [0.5, -2.0], [0.0, 9.0], [f64::NAN, 9.0]] {
                    let mut file = plain.clone();
                    file.version = version;
                    file.is_big_endian = is_big_endian;
                    file.datatype = datatype;
                    file.scale = scale;
                    let bytes = file.bytes();
                    let scan = Scan::decode("test.nii", &bytes, |_| {}).unwrap();
                    assert_eq!(scan.size(), [4, 3, 2]);
                    assert_eq!(numbers(&scan), expected, "{version} {datatype} {scale:?}");
                }
            }
        }
    }
}

#[test]
fn decode_converts_units_of_length() {
    for (unit, factor) in [(0, 1.0), (1, 0.001), (2, 1.0), (3, 1000.0)] {
        let mut file = phantom(RAS, [2.0; 3]);
        file.unit = unit;
        file.affine = file.affine.map(|row| row.map(|k| k * factor));
        check_file(&format!("unit {unit}"), &file);
    }
}
