//! Reports on logbooks that were made up, against the same worked out another way; and what must not go wrong with files.

mod bad;
mod documented;
mod made_up;
mod reference;
mod reruns;

use made_up::{Rows, write};
use std::path::{Path, PathBuf};
use tamaire_report::{Error, Options, Report, report};

/// A report without films and progress.
fn report_on(files: &[PathBuf], out: &Path, options: &Options) -> Result<Report, Error> {
    report(files, out, options, None, &mut |_| {})
}

/// Logbooks in a folder.
fn logbooks(folder: &Path, all: &[Rows]) -> Vec<PathBuf> {
    let path = |k: usize| folder.join(format!("{k}.logbook"));
    for (k, rows) in all.iter().enumerate() {
        write(&path(k), rows);
    }
    (0..all.len()).map(path).collect()
}
