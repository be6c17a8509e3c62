//! The committed validation report against new measurements.

use std::path::Path;
use std::process::Command;

#[test]
fn validation_report_is_up_to_date() {
    let report = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/validation.md");
    let checks = Command::new(env!("CARGO_BIN_EXE_fuwafuwa"))
        .args(["check", "quick", "--compare", "--report"])
        .arg(report)
        .output()
        .unwrap();
    let [table, differences] =
        [&checks.stdout, &checks.stderr].map(|text| String::from_utf8_lossy(text));
    let failed: Vec<&str> = table.lines().filter(|line| line.contains("FAIL")).collect();
    assert!(
        checks.status.success(),
        "run `cargo run --release --package fuwafuwa_cli -- check all --report docs/validation.md` and look at the changes\n{}\n{differences}",
        failed.join("\n")
    );
}
