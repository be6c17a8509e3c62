//! Runs libFuzzer on one door of `fuzz_targets`. The environment variable `DOOR` selects the door, for
//! example `DOOR=level`. With `SEEDS=folder` the program instead writes valid seed inputs and a dictionary of
//! their tokens for each door into the folder.

use fuzz_targets::{Door, noise};
use std::path::Path;
use std::sync::LazyLock;
use std::{env, fs, io, process};

static DOOR: LazyLock<&Door> = LazyLock::new(|| {
    let name = env::var("DOOR").unwrap_or_default();
    Door::named(&name).unwrap_or_else(|| {
        let names: Vec<&str> = fuzz_targets::DOORS.iter().map(|door| door.name).collect();
        eprintln!(
            "unknown DOOR {name:?}, expected one of: {}",
            names.join(", ")
        );
        process::exit(2);
    })
});

libfuzzer_sys::fuzz_target!(
    init: {
        if let Some(folder) = env::var_os("SEEDS") {
            for door in fuzz_targets::DOORS {
                write_seeds(door, Path::new(&folder)).expect("cannot write to SEEDS");
            }
            process::exit(0);
        }
    },
    |bytes: &[u8]| {
        (DOOR.enter)(bytes);
    }
);

fn write_seeds(door: &Door, folder: &Path) -> io::Result<()> {
    let seeds = (door.seeds)();
    let folder = folder.join(door.name);
    fs::create_dir_all(&folder)?;
    for (number, seed) in seeds.iter().enumerate() {
        fs::write(folder.join(format!("seed-{number}")), seed)?;
    }
    let quoted = |byte: &u8| format!("\\x{byte:02x}");
    let lines = noise::words(&seeds).into_iter().map(|word| {
        let bytes: String = word.iter().map(quoted).collect();
        format!("\"{bytes}\"\n")
    });
    fs::write(folder.with_extension("words"), lines.collect::<String>())
}
