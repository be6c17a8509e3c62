//! Output of procedures without a window to closed pipes and full disks.
#![cfg(all(target_os = "linux", feature = "window"))]

#[path = "../../fuwafuwa_output/tests/programs/mod.rs"]
mod programs;

use programs::{check_files, check_output};
use std::process::Command;

const PROGRAM: &str = env!("CARGO_BIN_EXE_fuwafuwa_surgery");
const SHORT: &str = "--headless --resolution 12 --seconds 0.1";

#[test]
fn every_command_survives_closed_pipes_and_tells_of_full_disks() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let saving = format!("{SHORT} --save it.fuwacut");
    for arguments in [
        "--help",
        "--version",
        SHORT,
        &saving,
        "--headless it.fuwacut --bench",
    ] {
        check_output(PROGRAM, folder, arguments);
    }
}

#[test]
fn files_stay_intact_on_full_disks() {
    let folder = tempfile::tempdir().unwrap();
    for (option, name) in [
        ("save", "it.fuwacut"),
        ("csv", "it.csv"),
        ("plots", "it.svg"),
    ] {
        let arguments =
            format!("{SHORT} --seconds 1 --{option} {name}").replace("--seconds 0.1 ", "");
        check_files(PROGRAM, folder.path(), &arguments, &[name]);
    }
}

#[test]
fn duration_outside_its_range_is_refused() {
    for seconds in ["-1", "3601", "nan", "long"] {
        let output = Command::new(PROGRAM)
            .args(["--headless", "--seconds", seconds])
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(
            said.contains("--seconds") && said.contains("0 to 3600 seconds"),
            "{said}"
        );
    }
}
