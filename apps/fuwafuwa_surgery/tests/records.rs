//! Recordings from untrusted files are read, or rejected with a reason.

use fuwafuwa::inspect::Hash;
use fuwafuwa_surgery::phantom;
use fuwafuwa_surgery::procedure::{Input, Procedure};
use fuwafuwa_surgery::record::{MOST_BYTES, Playback, RecordError, Recording};
use std::sync::Arc;

fn recording() -> Recording {
    let mut procedure = Procedure::new(Arc::new(phantom::case(8).unwrap())).unwrap();
    for _ in 0..3 {
        procedure.step(Input::default()).unwrap();
    }
    Recording::of(&procedure)
}

/// Returns the bytes of a recording with a valid checksum.
fn signed(mut bytes: Vec<u8>) -> Vec<u8> {
    let sum = Hash::of(&bytes[20..]).to_le_bytes();
    bytes[12..20].copy_from_slice(&sum);
    bytes
}

#[test]
fn read_rejects_truncated_and_changed_bytes() {
    let bytes = recording().bytes();
    assert!(Recording::read(&bytes).is_ok());
    for length in 0..bytes.len() {
        assert!(Recording::read(&bytes[..length]).is_err(), "{length} bytes");
    }
    for at in 0..bytes.len() {
        let mut bytes = bytes.clone();
        bytes[at] ^= 0x10;
        assert!(Recording::read(&bytes).is_err(), "byte {at}");
    }
}

#[test]
fn read_errors_name_the_problem() {
    let bytes = recording().bytes();
    let said = |bytes: &[u8]| Recording::read(bytes).unwrap_err().to_string();
    assert!(said(b"GIF89a").contains("not a recording"));
    let mut other = bytes.clone();
    other[8] = 9;
    assert!(said(&other).contains("format 9"), "{}", said(&other));
    let mut long = bytes.clone();
    long[20..24].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(said(&signed(long)).contains("bytes inside: expected at most 33554432"));
    let mut short = bytes.clone();
    short[20] -= 1;
    assert!(said(&signed(short)).contains("do not inflate"));
    let mut torn = bytes.clone();
    let last = torn.len() - 8;
    torn.truncate(last);
    assert!(said(&signed(torn)).contains("do not inflate"));
    let huge = vec![0; MOST_BYTES + 1];
    assert!(matches!(
        Recording::read(&huge),
        Err(RecordError::TooLarge { .. })
    ));
}

#[test]
fn invalid_values_are_rejected_before_the_replay() {
    let good = recording();
    let bad = |change: fn(&mut Recording)| {
        let mut other = good.clone();
        change(&mut other);
        let read = Recording::read(&other.bytes());
        read.and_then(|read| Playback::new(Arc::new(read)))
            .err()
            .expect("an invalid recording is rejected")
            .to_string()
    };
    let name = bad(|one| Arc::make_mut(&mut one.case).name = "z".repeat(300));
    assert!(
        name.contains("name: expected at most 200 letters, found 300"),
        "{name}"
    );
    let names = bad(|one| Arc::make_mut(&mut one.case).names[3] = "z".repeat(201));
    assert!(
        names.contains("names: expected at most 200 letters, found 201"),
        "{names}"
    );
    let corner = bad(|one| Arc::make_mut(&mut one.case).corner[1] = f64::NAN);
    assert!(corner.contains("corner"), "{corner}");
    let material = bad(|one| Arc::make_mut(&mut one.case).tissues[0].density = -1.0);
    assert!(
        material.contains("material 1: density must be positive and finite, given -1"),
        "{material}"
    );
    let missing = bad(|one| Arc::make_mut(&mut one.case).tissues.clear());
    assert!(missing.contains("material"), "{missing}");
    let hashes = bad(|one| one.hashes.clear());
    assert!(hashes.contains("hashes"), "{hashes}");
}

#[test]
fn random_contents_neither_panic_nor_hang() {
    let inside = recording().inside();
    assert!(Recording::read_inside(&inside).is_ok());
    let mut random = fastrand::Rng::with_seed(7);
    let mut taken = 0;
    for _ in 0..3000 {
        let mut bytes = inside.clone();
        for _ in 0..random.usize(1..4) {
            let at = random.usize(..bytes.len());
            match random.u8(..3) {
                0 => bytes[at] = random.u8(..),
                1 => bytes.truncate(at.max(1)),
                _ => bytes.insert(at, random.u8(..)),
            }
        }
        let Ok(read) = Recording::read_inside(&bytes) else {
            continue;
        };
        if let Ok(mut playback) = Playback::new(Arc::new(read)) {
            taken += 1;
            // Ignores the result: an input may pass or be reported as a difference, but must not panic.
            let _ = playback.step();
            let organ = playback.procedure().organ();
            organ
                .mesh()
                .validate(organ.grid(), organ.connectivity())
                .unwrap();
        }
    }
    assert!(taken > 100, "only {taken} changed recordings were accepted");
}
