//! Files of a procedure, saved without overwriting.

use crate::loading::ENDING;
use crate::procedure::Procedure;
use crate::record::Recording;
use crate::report;
use output::Draft;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Writes a recording, a table and plots into a folder, under an unused name. Returns the path of the
/// recording.
///
/// # Errors
/// A message that names the file and the problem.
pub fn save(folder: &Path, procedure: &Procedure) -> Result<PathBuf, String> {
    let recording = Recording::of(procedure).bytes();
    let table = report::csv(procedure.samples());
    let plots = report::svg(procedure.samples()).map_err(|error| error.to_string())?;
    let mut number = 1;
    let path = loop {
        let path = folder.join(format!("procedure-{number}.{ENDING}"));
        match write_new(&path, &recording) {
            Ok(()) => break path,
            Err(error) if error.kind() == ErrorKind::AlreadyExists && number < 10_000 => {
                number += 1
            }
            Err(error) => return Err(format!("{}: {error}", path.display())),
        }
    };
    for (ending, bytes) in [("csv", table), ("svg", plots)] {
        write(&path.with_extension(ending), bytes.as_bytes())?;
    }
    Ok(path)
}

/// Writes a file as a whole and replaces an existing one.
///
/// # Errors
/// A message that names the file and the problem.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    output::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))
}

fn write_new(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut draft = Draft::begin(path)?;
    draft.write_all(bytes)?;
    draft.keep_new()
}
