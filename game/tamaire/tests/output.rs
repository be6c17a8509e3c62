//! Output of every command to closed pipes and full disks.
#![cfg(target_os = "linux")]

#[path = "../../../apps/fuwafuwa_output/tests/programs/mod.rs"]
mod programs;

use programs::{check_files, check_output};
use std::path::Path;
use tamaire_logbook::{Entry, Id, Logbook, Moment, Visit};

const PROGRAM: &str = env!("CARGO_BIN_EXE_tamaire");
const SHORT: &str = "--headless --bot idle --seconds 1";

/// Writes `visits.sqlite`, a logbook with one visit.
fn write_logbook(folder: &Path) {
    let (mut book, _) = Logbook::open(&folder.join("visits.sqlite"), "hall 2").unwrap();
    let began = Moment {
        utc_ms: 1_795_420_800_000,
        offset_s: 3600,
    };
    let visit = Visit {
        id: Id::random(),
        stand: "hall 2".into(),
        began,
        ended: None,
        language: "en".into(),
    };
    book.write(&Entry::VisitBegan(visit)).unwrap();
}

#[test]
fn every_command_survives_closed_pipes_and_tells_of_full_disks() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_logbook(folder);
    let save = format!("{SHORT} --save it.tamaire --force-log forces.csv");
    let json = format!("{SHORT} --json");
    for arguments in [
        "--help",
        "--version",
        "report --help",
        "--list",
        "--licences",
        &save,
        &json,
        SHORT,
        "--headless it.tamaire",
        "--headless --replay it.tamaire --json",
        "report visits.sqlite --no-clips",
    ] {
        check_output(PROGRAM, folder, arguments);
    }
    let beside = ["visits.sqlite-wal", "visits.sqlite-shm"];
    assert!(beside.iter().all(|name| !folder.join(name).exists()));
}

#[test]
fn files_stay_intact_on_full_disks() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (option, name) in [
        ("save", "it.tamaire"),
        ("film", "it.gif"),
        ("film", "film.png"),
        ("photo", "it.png"),
        ("force-log", "forces.csv"),
    ] {
        let arguments = format!("{SHORT} --{option} {name}");
        check_files(PROGRAM, folder, &arguments, &[name]);
    }
}
