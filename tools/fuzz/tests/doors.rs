//! Each door, with good bytes, with what once went wrong, and with noise.

use fuzz_targets::noise::Noise;
use fuzz_targets::{DOORS, Door};
use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::Instant;

/// How many inputs with noise a door is tried with. `cargo xtask fuzz` tries millions.
const INPUTS: usize = 5000;

fn found() -> BTreeMap<String, Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("found");
    let files = fs::read_dir(folder).expect("it is there").flatten();
    let files = files.map(|file| {
        let name = file.file_name().to_string_lossy().into_owned();
        (name, fs::read(file.path()).expect("a file"))
    });
    files.collect()
}

/// Brings bytes in; what panics is named and kept.
fn enter(door: &Door, bytes: &[u8]) -> bool {
    let entered = catch_unwind(AssertUnwindSafe(|| (door.enter)(bytes)));
    entered.unwrap_or_else(|_| {
        let place = std::env::temp_dir().join(format!("{}-found", door.name));
        fs::write(&place, bytes).expect("a folder for what is found");
        panic!("{}: {} brings it down", door.name, place.display());
    })
}

#[test]
fn good_bytes_are_taken() {
    for door in DOORS {
        let seeds = (door.seeds)();
        assert!(!seeds.is_empty());
        for (number, seed) in seeds.iter().enumerate() {
            let text = String::from_utf8_lossy(seed);
            assert!(enter(door, seed), "{} {number}: {text}", door.name);
        }
    }
}

/// A file is named after its door: `settings-one-bad-value-of-thousands`.
#[test]
fn what_once_went_wrong_does_so_no_more() {
    for (name, bytes) in found() {
        let door = name.split('-').next().and_then(Door::named);
        let door = door.unwrap_or_else(|| panic!("{name} names no door"));
        let start = Instant::now();
        enter(door, &bytes);
        let seconds = start.elapsed().as_secs_f32();
        // In debug, and while other tests run.
        assert!(seconds < 20.0, "{name}: {seconds} s");
    }
}

#[test]
fn noise_comes_in_by_no_door() {
    for door in DOORS {
        let mut noise = Noise::of((door.seeds)(), 1);
        let taken = (0..INPUTS).filter(|_| enter(door, &noise.bytes())).count();
        // Else it is noise alone, and nothing behind the first check is tried.
        assert!(taken > INPUTS / 200, "{}: {taken} were taken", door.name);
    }
}
