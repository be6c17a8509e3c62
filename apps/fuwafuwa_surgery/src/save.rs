//! Files of a procedure, saved without overwriting.

use crate::loading::ENDING;
use crate::procedure::Procedure;
use crate::record::Recording;
use crate::report;
use output::Draft;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Largest number in the name of a procedure.
const MOST_NUMBER: u32 = 10_000;

/// Writes a recording, a table and plots into a folder, under an unused name. Returns the path of the
/// recording.
///
/// # Errors
/// A message that names the file and the problem.
pub fn save(folder: &Path, procedure: &Procedure) -> Result<PathBuf, String> {
    let recording = Recording::of(procedure).bytes();
    let table = report::csv(procedure.samples());
    let plots = report::svg(procedure.samples()).map_err(|error| error.to_string())?;
    let files: [(&str, &[u8]); 3] = [
        (ENDING, &recording),
        ("csv", table.as_bytes()),
        ("svg", plots.as_bytes()),
    ];
    save_files(folder, &files)
}

/// Writes files that differ in their endings under the first number of which no file exists. Returns the path
/// of the first one.
fn save_files(folder: &Path, files: &[(&str, &[u8]); 3]) -> Result<PathBuf, String> {
    let [(first, first_bytes), others @ ..] = files;
    let error_at = |path: &Path, error: io::Error| format!("{}: {error}", path.display());
    for number in 1..=MOST_NUMBER {
        let path = path_of(folder, number, first);
        let mut paths = files
            .map(|(ending, _)| path_of(folder, number, ending))
            .into_iter();
        if paths.any(|path| path.symlink_metadata().is_ok()) {
            continue;
        }
        match write_new(&path, first_bytes) {
            // Another program was faster.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
            written => written.map_err(|error| error_at(&path, error))?,
        }
        for (ending, bytes) in others {
            let path = path_of(folder, number, ending);
            write_new(&path, bytes).map_err(|error| error_at(&path, error))?;
        }
        return Ok(path);
    }
    Err(format!(
        "{}: all names up to procedure-{MOST_NUMBER} are taken",
        folder.display()
    ))
}

fn path_of(folder: &Path, number: u32, ending: &str) -> PathBuf {
    folder.join(format!("procedure-{number}.{ending}"))
}

/// Writes a file as a whole and replaces an existing one.
///
/// # Errors
/// A message that names the file and the problem.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    output::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))
}

fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut draft = Draft::begin_new(path)?;
    draft.write_all(bytes)?;
    draft.keep_new()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn saved_files_never_replace_others() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let files: [(&str, &[u8]); 3] = [(ENDING, b"a"), ("csv", b"b"), ("svg", b"c")];
        // A folder and a table of the user have names of the first two procedures.
        fs::create_dir(path_of(folder, 1, ENDING)).unwrap();
        fs::write(path_of(folder, 2, "csv"), "old").unwrap();
        assert_eq!(save_files(folder, &files), Ok(path_of(folder, 3, ENDING)));
        assert_eq!(save_files(folder, &files), Ok(path_of(folder, 4, ENDING)));
        assert_eq!(fs::read(path_of(folder, 2, "csv")).unwrap(), b"old");
        for (ending, bytes) in files {
            assert_eq!(fs::read(path_of(folder, 3, ending)).unwrap(), bytes);
        }
        // Two old ones and two procedures of three files each.
        assert_eq!(fs::read_dir(folder).unwrap().count(), 8);
        let missing = folder.join("missing");
        let error = save_files(&missing, &files).unwrap_err();
        assert!(error.contains("procedure-1."), "{error}");
    }
}
