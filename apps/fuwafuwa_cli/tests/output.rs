//! Output of every command to closed pipes and full disks.
#![cfg(target_os = "linux")]

#[path = "../../fuwafuwa_output/tests/programs/mod.rs"]
mod programs;

use programs::{check_files, check_output};
use std::fs;
use std::path::Path;
use std::process::Command;

const PROGRAM: &str = env!("CARGO_BIN_EXE_fuwafuwa");

/// Writes `cube.nii`, a NIfTI-1 file with a cube of 9³ voxels of 2 mm, surrounded by empty voxels.
fn write_scan(folder: &Path) {
    let mut bytes = vec![0; 352 + 13 * 13 * 13];
    let mut put = |at: usize, bytes_there: &[u8]| {
        bytes[at..at + bytes_there.len()].copy_from_slice(bytes_there);
    };
    put(0, &348_i32.to_le_bytes());
    for (index, number) in [3, 13, 13, 13, 1, 1, 1, 1_i16].into_iter().enumerate() {
        put(40 + 2 * index, &number.to_le_bytes());
    }
    put(70, &2_i16.to_le_bytes());
    put(72, &8_i16.to_le_bytes());
    for axis in 0..3 {
        put(80 + 4 * axis, &2_f32.to_le_bytes());
    }
    put(108, &352_f32.to_le_bytes());
    put(344, b"n+1\0");
    for at in 0..13 * 13 * 13 {
        let is_inside = [at % 13, at / 13 % 13, at / 169]
            .iter()
            .all(|k| (2..11).contains(k));
        bytes[352 + at] = u8::from(is_inside);
    }
    fs::write(folder.join("cube.nii"), bytes).unwrap();
}

#[test]
fn every_command_survives_closed_pipes_and_tells_of_full_disks() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_scan(folder);
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
    write_scan(folder);
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
