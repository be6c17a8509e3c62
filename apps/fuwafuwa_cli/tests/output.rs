//! Output of every command to closed pipes and full disks.
#![cfg(target_os = "linux")]

#[path = "../../fuwafuwa_output/tests/programs/mod.rs"]
mod programs;
mod sample;

use programs::{check_files, check_output};
use std::fs;
use std::path::Path;
use std::process::Command;

const PROGRAM: &str = env!("CARGO_BIN_EXE_fuwafuwa");

/// Writes `cube.nii`, a scan of a cube, and `curve.csv`, a measured curve.
fn write_inputs(folder: &Path) {
    fs::write(folder.join("cube.nii"), sample::cube()).unwrap();
    let curve = "strain,stress_kpa\n0.1,3\n0.2,5\n0.4,9\n0.8,15\n";
    fs::write(folder.join("curve.csv"), curve).unwrap();
}

#[test]
fn every_command_survives_closed_pipes_and_tells_of_full_disks() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_inputs(folder);
    let record = "run drop --frames 2 --set body.n=8 --record drop.rec";
    let run = Command::new(PROGRAM)
        .current_dir(folder)
        .args(record.split(' '))
        .output()
        .unwrap();
    assert!(run.status.success(), "{run:?}");
    for arguments in [
        "--help",
        "--version",
        "help scan",
        "count --n 8",
        "count --n 8 --json",
        "figure 2 --out figures",
        "check momentum",
        "check momentum --json",
        "run drop --frames 2 --set body.n=8",
        "run drop --frames 2 --set body.n=8 --json --film drop.gif --svg",
        "replay drop.rec",
        "replay drop.rec --json",
        "scan cube.nii --resolution 11",
        "scan cube.nii --resolution 11 --json --out cube.toml",
        "material fit curve.csv",
        "material fit curve.csv --json --plot curve.svg",
        "bench --n 8",
        "bench --n 8 --json",
    ] {
        check_output(PROGRAM, folder, arguments);
    }
}

#[test]
fn files_stay_intact_on_full_disks() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_inputs(folder);
    fs::create_dir(folder.join("figures")).unwrap();
    for (arguments, files) in [
        (
            "run drop --frames 2 --set body.n=8 --film drop.gif",
            &["drop.gif"][..],
        ),
        (
            "run drop --frames 2 --set body.n=8 --film drop.png",
            &["drop.png"],
        ),
        ("run drop --frames 2 --set body.n=8 --svg", &["drop.svg"]),
        (
            "run drop --frames 90 --set body.n=8 --record drop.rec",
            &["drop.rec"],
        ),
        (
            "scan cube.nii --resolution 11 --out cube.toml",
            &["cube.toml", "cube.vox"],
        ),
        ("material fit curve.csv --plot curve.svg", &["curve.svg"]),
        (
            "figure 2 --out figures",
            &["figures/figure_2.png", "figures/figure_2.svg"],
        ),
    ] {
        check_files(PROGRAM, folder, arguments, files);
    }
    let manual = Command::new("sh")
        .current_dir(folder)
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f 1; exec \"$0\" manual here",
            PROGRAM,
        ])
        .output()
        .unwrap();
    assert_eq!(manual.status.code(), Some(2), "{manual:?}");
}
