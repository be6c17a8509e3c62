//! The committed reports of checks and experiments against new measurements.

use std::path::Path;
use std::process::Command;

/// Compares the quick part of a report with new measurements.
fn check_report(command: &str, report: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(report);
    let found = Command::new(env!("CARGO_BIN_EXE_fuwafuwa"))
        .args([command, "quick", "--compare", "--report"])
        .arg(path)
        .output()
        .unwrap();
    let [table, differences] =
        [&found.stdout, &found.stderr].map(|text| String::from_utf8_lossy(text));
    let failed: Vec<&str> = table.lines().filter(|line| line.contains("FAIL")).collect();
    assert!(
        found.status.success(),
        "run `cargo run --release --package fuwafuwa_cli -- {command} all --report {report}` and look at the changes\n{}\n{differences}",
        failed.join("\n")
    );
}

#[test]
fn validation_report_is_up_to_date() {
    check_report("check", "docs/validation.md");
}

#[test]
fn report_of_experiments_is_up_to_date() {
    check_report("experiment", "docs/experiments.md");
}
