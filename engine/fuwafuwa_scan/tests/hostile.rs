//! Damaged, truncated and malicious files give an error within a short time.

mod phantom;

use flate2::Compression;
use flate2::write::GzEncoder;
use fuwafuwa_scan::{Options, Organ, PlacementSource, Scan, Segmentation, warnings};
use fuwafuwa_scenes::import::{FilePosition, ImportError, Problem};
use phantom::File;
use std::io::Write;
use std::time::Instant;

fn zipped(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn decode(bytes: &[u8]) -> Result<Scan, ImportError> {
    Scan::decode("test.nii", bytes, |_| {})
}

fn error(bytes: &[u8]) -> ImportError {
    decode(bytes).expect_err("the file must be rejected")
}

fn small(version: usize) -> File {
    let values: Vec<f64> = (0..60).map(f64::from).collect();
    let mut file = File::small([5, 4, 3], &values);
    file.version = version;
    file
}

#[test]
fn decode_rejects_truncated_file_at_every_length() {
    for version in [1, 2] {
        let whole = small(version).bytes();
        decode(&whole).unwrap();
        for length in 0..whole.len() {
            let found = error(&whole[..length]).to_string();
            assert!(found.starts_with("test.nii"), "{found}");
            error(&zipped(&whole[..length]));
        }
        let whole = zipped(&whole);
        decode(&whole).unwrap();
        for length in 0..whole.len() {
            error(&whole[..length]);
        }
    }
}

/// Returns a file with some bytes of the header replaced.
fn with(at: usize, bytes: &[u8]) -> Vec<u8> {
    let mut file = small(1).bytes();
    file[at..at + bytes.len()].copy_from_slice(bytes);
    file
}

#[test]
fn error_names_field_expectation_and_value() {
    let whole = |number: i16| number.to_le_bytes();
    let real = |number: f32| number.to_le_bytes();
    for (bytes, expect) in [
        (
            with(0, &999_i32.to_le_bytes()),
            "sizeof_hdr at byte 0: expected the length of a header, 348 or 540, found 999",
        ),
        (
            with(344, b"ni1\0"),
            "magic at byte 344: expected \"n+1\\x00\", header and voxels in one file, found \"ni1\\x00\", the header of a pair",
        ),
        (
            with(40, &whole(2)),
            "dim at byte 40: expected 3 axes, or more with one voxel on each, found 2",
        ),
        (with(40, &whole(-1)), "dim at byte 40"),
        (
            with(42, &whole(-3)),
            "dim at byte 42: expected at least one voxel, found -3",
        ),
        (with(46, &whole(0)), "dim at byte 46: expected at least one"),
        (
            with(42, &[0xff, 0x7f].repeat(3)),
            "dim at byte 44: 1073676289 voxels are too many, the limit is 134217728",
        ),
        (
            with(
                40,
                &[whole(4), whole(5), whole(4), whole(3), whole(2)].concat(),
            ),
            "dim at byte 48: expected 1 (only one volume is supported), found 2",
        ),
        (with(70, &whole(128)), "datatype at byte 70"),
        (
            with(108, &real(350.0)),
            "vox_offset at byte 108: expected voxels after the header of 348 bytes and its 4 bytes for extensions, at byte \
             352 or later, found 350",
        ),
        (with(108, &real(349.0)), "at byte 352 or later, found 349"),
        (with(108, &real(351.0)), "at byte 352 or later, found 351"),
        (with(108, &real(347.0)), "at byte 352 or later, found 347"),
        (with(108, &real(1.0)), "at byte 352 or later, found 1"),
        (with(108, &real(352.5)), "vox_offset"),
        (with(108, &real(f32::NAN)), "vox_offset"),
        (with(108, &real(-1e30)), "vox_offset"),
        (
            with(108, &real(4096.0)),
            "expected 4216 bytes up to the last voxel, found at most 472",
        ),
        (
            with(116, &real(f32::NAN)),
            "scl_inter at byte 116: expected a finite number",
        ),
        (with(123, &[4]), "xyzt_units at byte 123"),
    ] {
        let found = error(&bytes).to_string();
        assert!(
            found.contains(expect),
            "{found:?} does not contain {expect:?}"
        );
    }
}

/// Returns a file with some bytes of the header replaced, and with valid qform (mirrored in x) and pixdim.
fn with_forms(changes: &[(usize, Vec<u8>)]) -> Vec<u8> {
    let mut file = small(1).bytes();
    let code = 1_i16.to_le_bytes();
    // The quaternion (0, 0, 1) is half a turn about the third axis.
    let mut put = |at: usize, bytes: &[u8]| file[at..at + bytes.len()].copy_from_slice(bytes);
    put(252, &code);
    put(254, &code);
    put(264, &1_f32.to_le_bytes());
    for (at, bytes) in changes {
        put(*at, bytes);
    }
    file
}

#[test]
fn placement_falls_back_to_the_next_valid_form_and_tells_why() {
    let real = |number: f32| number.to_le_bytes().to_vec();
    let zeros = vec![0; 48];
    // Matrix with the second axis parallel to the first.
    let flat = [
        1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0_f32,
    ];
    let flat: Vec<u8> = flat.into_iter().flat_map(f32::to_le_bytes).collect();
    for (sform, reason) in [
        ((280, zeros.clone()), "voxels 0.001 to 100 mm apart"),
        ((280, flat), "three independent axes"),
        ((280, real(f32::NAN)), "finite numbers"),
        ((292, real(f32::INFINITY)), "finite numbers"),
        ((292, real(1e30)), "the first voxel within a kilometre"),
        ((280, real(1e9)), "voxels 0.001 to 100 mm apart"),
    ] {
        let scan = decode(&with_forms(std::slice::from_ref(&sform))).unwrap();
        assert_eq!(scan.placement().source(), PlacementSource::Rotation);
        assert_eq!(scan.placement().patient_at([1.0; 3]), [-1.0, -1.0, 1.0]);
        let [note] = scan.notes() else {
            panic!("{:?}", scan.notes());
        };
        assert!(note.starts_with("the sform is invalid"), "{note}");
        assert!(note.contains(reason), "{note}");
        assert!(note.ends_with("the qform was used"), "{note}");

        // Imaginary part of a quaternion that is longer than 1, or no number.
        for quaternion in [1.1, f32::NAN] {
            let both = [sform.clone(), (256, real(quaternion))];
            let scan = decode(&with_forms(&both)).unwrap();
            assert_eq!(scan.placement().source(), PlacementSource::Spacing);
            assert_eq!(scan.placement().patient_at([1.0; 3]), [1.0; 3]);
            assert_eq!(scan.notes().len(), 2, "{:?}", scan.notes());
            assert!(scan.notes()[1].starts_with("the qform is invalid"));
        }
    }
    let bad = [(280, zeros), (256, real(f32::NAN)), (80, real(0.0))];
    let found = error(&with_forms(&bad)).to_string();
    for word in ["srow at byte 280", "nor is the qform", "nor is the pixdim"] {
        assert!(found.contains(word), "{found}");
    }
    assert!(decode(&with_forms(&[])).unwrap().notes().is_empty());
}

#[test]
fn datatype_decides_over_bitpix() {
    let scan = decode(&with(72, &8_i16.to_le_bytes())).unwrap();
    assert_eq!(scan.range(), [0.0, 59.0]);
    let expected = "bitpix: expected 16, the bits of datatype 4, found 8; the datatype was used";
    assert_eq!(scan.notes(), [expected]);
}

#[test]
fn offset_without_extension_bytes_is_read_with_a_note() {
    // The voxels are 0, 1, … 59 in 16 bits. From byte 348 on, the four bytes for extensions count as two zeros.
    for (offset, range, expected) in [
        (
            0.0_f32,
            [0.0, 59.0],
            "vox_offset: expected 352 or more, found 0; 352 was used",
        ),
        (
            348.0,
            [0.0, 57.0],
            "vox_offset: expected 352 or more, found 348; the voxels were read right after the header",
        ),
    ] {
        let scan = decode(&with(108, &offset.to_le_bytes())).unwrap();
        assert_eq!(scan.range(), range);
        assert_eq!(scan.notes(), [expected]);
    }
    let mut second = small(2).bytes();
    for (offset, range) in [(0_i64, [0.0, 59.0]), (540, [0.0, 57.0])] {
        second[168..176].copy_from_slice(&offset.to_le_bytes());
        let scan = decode(&second).unwrap();
        assert_eq!((scan.range(), scan.notes().len()), (range, 1));
    }
    second[168..176].copy_from_slice(&541_i64.to_le_bytes());
    let found = error(&second).to_string();
    assert!(found.contains("at byte 544 or later, found 541"), "{found}");
}

#[test]
fn other_files_are_named() {
    let at = |offset: usize, text: &[u8]| [&vec![0; offset], text, &[0; 400]].concat();
    let lfs = b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 12345\n";
    let mgh = [1_i32, 256, 256, 256, 1, 0].map(i32::to_be_bytes).concat();
    for (bytes, name) in [
        (lfs.to_vec(), "a Git LFS pointer, not the file itself"),
        (b"<!DOCTYPE html><title>404</title>".to_vec(), "a web page"),
        (b"PK\x03\x04\x14\0".to_vec(), "a ZIP archive"),
        (at(257, b"ustar"), "an archive"),
        (mgh, "a FreeSurfer scan"),
        (b"NRRD0004\ntype: short\n".to_vec(), "an NRRD scan"),
        (at(128, b"DICM"), "a DICOM file"),
        (at(0, &348_i32.to_le_bytes()), "an Analyze header"),
        (Vec::new(), "an empty file"),
    ] {
        for bytes in [bytes.clone(), zipped(&bytes)] {
            let found = error(&bytes).to_string();
            assert!(found.starts_with("test.nii"), "{found}");
            assert!(found.contains(name), "{found}");
        }
    }
}

#[test]
fn padding_and_members_of_gzip_are_read() {
    let whole = small(1).bytes();
    let range = decode(&whole).unwrap().range();
    let zeros = vec![0; 1000];
    let parts = [zipped(&whole[..400]), zipped(&whole[400..])];
    for padded in [
        [&zipped(&whole)[..], &zeros].concat(),
        parts.concat(),
        [&parts[0][..], &zeros, &parts[1], &zeros].concat(),
    ] {
        let scan = decode(&padded).unwrap();
        assert_eq!((scan.range(), scan.notes().len()), (range, 0));
    }
    // The first eight zeros are padding; the other bytes are not.
    for noise in [&b"\x1f\x8b"[..], b"\0\0\0\0\0\0\0\0more", b"\xff"] {
        let scan = decode(&[&zipped(&whole), noise].concat()).unwrap();
        assert_eq!(scan.range(), range);
        let count = noise.iter().skip_while(|byte| **byte == 0).count();
        let start = format!("{count} bytes after the gzip data");
        assert!(scan.notes()[0].starts_with(&start), "{:?}", scan.notes());
    }
    // The second member is cut short, so that voxels are missing.
    let cut = parts[1].len() / 2;
    error(&[&parts[0][..], &parts[1][..cut]].concat());
}

#[test]
fn integers_of_64_bits_are_read_if_single_precision_holds_them() {
    for is_big_endian in [false, true] {
        for (datatype, values) in [
            (1024, [-16_777_216.0, 14_175.0, 1_099_511_627_776.0]),
            (
                1280,
                [0.0, 16_777_216.0, 18_446_744_073_709_551_616.0 / 2.0],
            ),
        ] {
            let mut file = File::small([3, 1, 1], &values);
            (file.datatype, file.is_big_endian) = (datatype, is_big_endian);
            let scan = file.scan();
            assert_eq!(scan.range(), [values[0] as f32, values[2] as f32]);
            file.values[1] = 16_777_217.0;
            let found = error(&file.bytes()).to_string();
            let expected = "byte 360: expected 64-bit integers that single precision holds exactly, \
                            as all up to 16777216, found 16777217";
            assert!(found.contains(expected), "{found}");
        }
    }
    let mut file = File::small([3, 1, 1], &[0.0, 16_777_217.0, 33_554_435.0]);
    file.datatype = 8;
    let scan = file.scan();
    assert!(
        scan.notes()[0].starts_with("2 of 3 values"),
        "{:?}",
        scan.notes()
    );
}

#[test]
fn labels_that_are_lost_are_told() {
    let labels = File::small([2, 2, 2], &[0.0, 1.0, 2.0, 3.0, 7.0, 7.0, 0.0, 4.0]).scan();
    let told =
        |scan: &Scan, segmentation: &Segmentation| warnings(&[("it.nii", scan)], segmentation);
    let lost = told(&labels, &Segmentation::Maps);
    assert_eq!(lost.len(), 1, "{lost:?}");
    for word in ["it.nii: ", "below 3.5", "(1, 2, 3)", "--label"] {
        assert!(lost[0].contains(word), "{lost:?}");
    }
    let absent = told(&labels, &Segmentation::labels(&[(7, 1), (17, 2)]));
    assert!(
        absent[0].contains("no voxel has the label 17"),
        "{absent:?}"
    );
    assert!(absent[0].contains("1, 2, 3, 4, 7"), "{absent:?}");
    assert!(told(&labels, &Segmentation::labels(&[(7, 1)])).is_empty());
    assert!(told(&labels, &Segmentation::thresholds(&[(1.0..=2.0, 1)])).is_empty());
    let mask = File::small([2, 1, 1], &[0.0, 255.0]).scan();
    assert!(told(&mask, &Segmentation::Maps).is_empty());
    let both = warnings(&[("a.nii", &mask), ("b.nii", &labels)], &Segmentation::Maps);
    assert_eq!(both.len(), 1, "{both:?}");
    assert!(both[0].starts_with("b.nii: the values look like labels (1, 2, 3, 4, 7)"));
    assert!(both[0].contains("material 2"), "{both:?}");
}

#[test]
fn decode_rejects_size_beyond_file_length_at_once() {
    let start = Instant::now();
    for version in [1, 2] {
        let mut file = small(version);
        file.size = [512; 3];
        file.datatype = 64;
        for bytes in [file.bytes(), zipped(&file.bytes())] {
            let found = error(&bytes);
            assert_eq!(found.position, FilePosition::File, "{found}");
            assert!(
                found.to_string().contains("up to the last voxel"),
                "{found}"
            );
        }
    }
    let mut file = small(2);
    file.size = [1 << 40, 1 << 40, 1];
    assert!(matches!(
        error(&file.bytes()).problem,
        Problem::TooLarge { .. }
    ));
    assert!(start.elapsed().as_secs() < 5);
}

#[test]
fn decode_stops_at_limit_for_gzip_bomb() {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(&small(1).bytes()).unwrap();
    let zeros = vec![0; 1 << 20];
    for _ in 0..64 {
        encoder.write_all(&zeros).unwrap();
    }
    let mut bomb = encoder.finish().unwrap();
    assert!(bomb.len() < 100_000);
    // Makes the checksum wrong: a decoder that read to the end would report the checksum instead of the
    // limit.
    let end = bomb.len() - 8;
    bomb[end..].fill(0xaa);
    match error(&bomb).problem {
        Problem::TooLarge { what, limit, .. } => {
            assert_eq!((what, limit), ("bytes after the last voxel", 1 << 20));
        }
        other => panic!("{other}"),
    }
}

#[test]
fn decode_rejects_wrong_gzip_checksum() {
    let mut bytes = zipped(&small(1).bytes());
    let checksum = bytes.len() - 8;
    bytes[checksum] ^= 1;
    assert!(error(&bytes).to_string().contains("gzip"));
}

#[test]
fn decode_survives_any_header_byte() {
    let tissue = Segmentation::thresholds(&[(10.0..=50.0, 1)]);
    let options = Options {
        resolution: 8,
        ..Options::default()
    };
    let mut taken = 0;
    for version in [1, 2] {
        let good = small(version).bytes();
        for at in 0..good.len().min(544) {
            for value in [0x00, 0x01, 0x7f, 0x80, 0xff] {
                let mut bytes = good.clone();
                bytes[at] = value;
                match decode(&bytes) {
                    Ok(scan) => {
                        taken += 1;
                        let [low, high] = scan.range();
                        assert!(low.is_finite() && high.is_finite());
                        if let Ok(organ) = Organ::of(&[&scan], &tissue, &options, |_| {}) {
                            assert!(organ.grid.solid_count() > 0);
                        }
                    }
                    Err(error) => assert!(error.to_string().starts_with("test.nii"), "{error}"),
                }
            }
        }
    }
    assert!(taken > 100);
}

#[test]
fn scan_replaces_non_finite_values_by_lowest() {
    let mut file = File::small([2, 2, 1], &[f64::NAN, 5.0, f64::INFINITY, -3.0]);
    file.datatype = 16;
    let scan = file.scan();
    assert_eq!(scan.range(), [-3.0, 5.0]);
    assert_eq!(scan.nearest([0.0; 3]), -3.0);
    assert_eq!(scan.interpolate([0.0, 1.0, 0.0]), -3.0);
    assert_eq!(scan.interpolate([0.5, 0.0, 0.0]), 1.0);
    assert_eq!(scan.interpolate([f64::NAN; 3]), -3.0);
    file.values = vec![f64::NAN; 4];
    assert_eq!(file.scan().range(), [0.0; 2]);
}
