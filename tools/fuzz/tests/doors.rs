//! Tests of every door with valid bytes, with earlier failures, and with noise.

use fuzz_targets::noise::Noise;
use fuzz_targets::{DOORS, Door};
use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::thread;
use std::time::Instant;

/// Number of noisy inputs per door. `INPUTS=1000000` and `DOOR=link` in the environment change the number and choose a
/// door; `cargo xtask fuzz` tries millions that reach new code.
const INPUTS: usize = 5000;

fn found() -> BTreeMap<String, Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("found");
    let files = fs::read_dir(folder)
        .expect("the folder `found` exists")
        .flatten();
    let files = files.map(|file| {
        let name = file.file_name().to_string_lossy().into_owned();
        (name, fs::read(file.path()).expect("a readable file"))
    });
    files.collect()
}

/// Passes bytes through a door. If the door panics, saves the bytes and names the file.
fn enter(door: &Door, bytes: &[u8]) -> bool {
    let entered = catch_unwind(AssertUnwindSafe(|| (door.enter)(bytes)));
    entered.unwrap_or_else(|_| {
        let place = std::env::temp_dir().join(format!("{}-found", door.name));
        fs::write(&place, bytes).expect("the temporary folder is writable");
        panic!("{}: {} causes a panic", door.name, place.display());
    })
}

#[test]
fn every_door_accepts_its_seeds() {
    for door in DOORS {
        let seeds = (door.seeds)();
        assert!(!seeds.is_empty());
        for (number, seed) in seeds.iter().enumerate() {
            let text = String::from_utf8_lossy(seed);
            assert!(enter(door, seed), "{} {number}: {text}", door.name);
        }
    }
}

/// Passes the files of the folder `found` through their doors. A file name begins with the name of the door,
/// for example `settings-one-bad-value-of-thousands`.
#[test]
fn earlier_failures_are_handled_quickly() {
    for (name, bytes) in found() {
        let door = name.split('-').next().and_then(Door::named);
        let door = door.unwrap_or_else(|| panic!("the name of {name} does not begin with a door"));
        let start = Instant::now();
        enter(door, &bytes);
        let seconds = start.elapsed().as_secs_f32();
        // Allows much time, because debug builds are slow and other tests run in parallel.
        assert!(seconds < 20.0, "{name}: {seconds} s");
    }
}

#[test]
fn noise_causes_no_panic() {
    let inputs =
        env::var("INPUTS").map_or(INPUTS, |text| text.parse().expect("INPUTS is a number"));
    let chosen = env::var("DOOR").ok();
    let is_chosen = |door: &&Door| chosen.as_ref().is_none_or(|name| door.name == name);
    let doors: Vec<&Door> = DOORS.iter().filter(is_chosen).collect();
    assert!(!doors.is_empty(), "no door has the name {chosen:?}");
    let check = |door: &Door| {
        let mut noise = Noise::of((door.seeds)(), 1);
        let mut longest = 0.0f32;
        let taken = (0..inputs).filter(|_| {
            let (bytes, start) = (noise.bytes(), Instant::now());
            let is_taken = enter(door, &bytes);
            longest = longest.max(start.elapsed().as_secs_f32());
            is_taken
        });
        let taken = taken.count();
        println!(
            "{}: {taken} of {inputs} accepted, at most {longest:.3} s",
            door.name
        );
        // Requires enough accepted inputs: rejected inputs do not reach the code behind the first check.
        assert!(
            taken > inputs / 200,
            "{}: only {taken} inputs were accepted",
            door.name
        );
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for first in 0..threads {
            let doors = doors.iter().copied();
            scope.spawn(move || doors.skip(first).step_by(threads).for_each(check));
        }
    });
}
