//! Damaged, truncated and malicious files give an error within a short time.

mod phantom;

use flate2::Compression;
use flate2::write::GzEncoder;
use fuwafuwa_scan::{Options, Organ, Scan, Segmentation};
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
            "magic at byte 344: expected \"n+1\\x00\", header and voxels in one file, found \"ni1\\x00\"",
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
            with(72, &whole(8)),
            "bitpix at byte 72: expected 16, the bits of that datatype, found 8",
        ),
        (
            with(108, &real(347.0)),
            "vox_offset at byte 108: expected a whole number from 348 to 67108864, found 347",
        ),
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
        (
            with(280, &real(f32::NAN)),
            "srow at byte 280: expected finite numbers",
        ),
        (
            with(292, &real(f32::INFINITY)),
            "srow at byte 280: expected finite numbers",
        ),
        (with(292, &real(1e30)), "the first voxel within a kilometre"),
        (with(280, &real(0.0)), "voxels 0.001 to 100 mm apart"),
        (with(280, &real(1e9)), "voxels 0.001 to 100 mm apart"),
        // Matrix with the second axis parallel to the first.
        (
            with(
                280,
                &[real(1.0), real(1.0), real(0.0), real(0.0), [0; 4], [0; 4]].concat(),
            ),
            "three independent axes",
        ),
    ] {
        let found = error(&bytes).to_string();
        assert!(
            found.contains(expect),
            "{found:?} does not contain {expect:?}"
        );
    }
    // Rotation by a quaternion with an imaginary part longer than 1.
    let mut bytes = with(252, &[whole(1), whole(0)].concat());
    bytes[256..260].copy_from_slice(&real(1.1));
    let found = error(&bytes).to_string();
    assert!(
        found.contains("quatern at byte 256: expected the imaginary part"),
        "{found}"
    );
    bytes[256..260].copy_from_slice(&real(f32::NAN));
    assert!(error(&bytes).to_string().contains("quatern"));
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
            assert_eq!((what, limit), ("bytes behind the last voxel", 1 << 20));
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
