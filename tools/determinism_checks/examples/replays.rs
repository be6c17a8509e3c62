//! Records replays to be verified on other platforms, and verifies replays recorded there.
//!
//! `cargo run --release -p determinism_checks --example replays -- record FOLDER` plays a series of rounds and
//! writes their replays into a folder. `… -- verify FOLDER` plays the replays of a folder; it fails if one
//! differs from its recorded hashes or if the folder has none.

use determinism_checks::rounds::{record, series, verify};
use std::env;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["record", folder] => record_all(Path::new(folder)),
        ["verify", folder] => verify_all(Path::new(folder)),
        _ => Err("expected `record FOLDER` or `verify FOLDER`".into()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("replays: {error}");
            ExitCode::FAILURE
        }
    }
}

fn record_all(folder: &Path) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(folder).map_err(|error| told(folder, error))?;
    for game in series(0) {
        let file = folder.join(format!("{game}.tamaire"));
        let text = record(&game).map_err(|error| told(&file, error))?;
        fs::write(&file, text).map_err(|error| told(&file, error))?;
    }
    Ok(())
}

fn verify_all(folder: &Path) -> Result<(), Box<dyn Error>> {
    let entries = fs::read_dir(folder).map_err(|error| told(folder, error))?;
    let files: Result<Vec<PathBuf>, _> = entries.map(|entry| Ok(entry?.path())).collect();
    let mut files = files.map_err(|error: std::io::Error| told(folder, error))?;
    files.retain(|file| file.extension().is_some_and(|name| name == "tamaire"));
    files.sort();
    if files.is_empty() {
        return Err(told(folder, "the folder has no replay (*.tamaire)").into());
    }
    for file in &files {
        let bytes = fs::read(file).map_err(|error| told(file, error))?;
        verify(&bytes).map_err(|error| told(file, error))?;
    }
    println!("native: {} replays verified", files.len());
    Ok(())
}

fn told(path: &Path, error: impl ToString) -> String {
    format!("{}: {}", path.display(), error.to_string())
}
