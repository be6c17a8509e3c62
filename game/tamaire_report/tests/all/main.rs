//! Reports on synthetic logbooks, compared with a reference implementation, and tests with invalid files.

mod bad;
mod documented;
mod made_up;
mod reference;
mod reruns;

use made_up::{Rows, write};
use std::path::{Path, PathBuf};
use tamaire_report::{Error, Options, Report, report};

/// Options for all files, without running rounds again.
fn all_files() -> Options {
    Options {
        csv: true,
        json: true,
        ..Options::default()
    }
}

/// Makes a report without clips and progress.
fn report_on(files: &[PathBuf], out: &Path, options: &Options) -> Result<Report, Error> {
    report(files, out, options, None, &mut |_| {})
}

/// Writes logbooks into a folder.
fn logbooks(folder: &Path, all: &[Rows]) -> Vec<PathBuf> {
    let path = |k: usize| folder.join(format!("{k}.logbook"));
    for (k, rows) in all.iter().enumerate() {
        write(&path(k), rows);
    }
    (0..all.len()).map(path).collect()
}
