//! Data to verify a release: checksums, bills of materials, and known vulnerabilities.

use super::kit::ReleaseBuild;
use super::programs;
use crate::cross::WINDOWS;
use crate::packages::IfMissing;
use crate::shell::{Failure, answers, cargo, execute, file_error, is_on_path, lacking, output_of};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Writes a bill of materials for each system.
pub fn bills(kit: &mut ReleaseBuild) -> Result<(), Failure> {
    if !answers("node") {
        return Err(lacking("Node", "Debian: nodejs"));
    }
    let game = &programs::PACKAGES[..];
    let web = &["tamaire"][..];
    for (system, triple, programs) in [
        ("linux", "x86_64-unknown-linux-gnu", game),
        ("windows", WINDOWS.triple, game),
        ("web", crate::wasm::TARGET, web),
    ] {
        let file = kit
            .folder()
            .join(format!("tamaire-{}-{system}.cdx.json", kit.version));
        let mut node = Command::new("node");
        node.arg("tools/xtask/web/sbom.mjs")
            .arg(&file)
            .arg(triple)
            .args(programs);
        execute(&mut node, "the bill of materials could not be written")?;
        kit.add(file);
    }
    Ok(())
}

/// Checks the rules of `deny.toml`: licences, sources, duplicates, and advisories if their database is
/// available.
pub fn deny(kit: &mut ReleaseBuild) -> Result<(), Failure> {
    let is_there = || output_of("cargo", &["deny", "--version"]).is_some();
    if !is_there() && kit.if_missing == IfMissing::Install {
        let mut install = cargo();
        install.args(["install", "--locked", "cargo-deny"]);
        execute(&mut install, "cargo-deny could not be installed")?;
    }
    if !is_there() {
        return Err(lacking("cargo-deny", "`cargo install --locked cargo-deny`"));
    }
    let mut check = cargo();
    check.args(["deny", "--all-features", "check"]);
    check.args(["licenses", "bans", "sources"]);
    execute(
        &mut check,
        "see deny.toml for the permitted contents and the reasons",
    )?;
    // Downloads the database of advisories first. A failed download counts as a limitation of this machine,
    // a failed check of the advisories as an error.
    let mut fetch = cargo();
    fetch.args(["deny", "fetch", "db"]);
    if execute(&mut fetch, "").is_err() {
        return Err(Failure::cannot(
            "the database of advisories could not be downloaded: known vulnerabilities were NOT checked",
        ));
    }
    let mut check = cargo();
    check.args(["deny", "--all-features", "check", "advisories"]);
    execute(&mut check, "a known vulnerability affects a dependency")
}

/// Writes the checksums for `sha256sum --check SHA256SUMS`.
pub fn sums(kit: &mut ReleaseBuild) -> Result<(), Failure> {
    let packages = kit.packages()?;
    if packages.is_empty() {
        return Err(Failure::cannot("no packages found for the checksums"));
    }
    if !is_on_path("sha256sum") {
        return Err(lacking("sha256sum", "Debian: coreutils"));
    }
    let names = packages
        .iter()
        .map(|path| path.file_name().unwrap_or_default());
    let mut sum = Command::new("sha256sum");
    sum.args(names).current_dir(kit.folder());
    let output = sum
        .output()
        .map_err(|error| file_error(Path::new("sha256sum"), &error))?;
    let file = kit.folder().join("SHA256SUMS");
    fs::write(&file, &output.stdout).map_err(|error| file_error(&file, &error))?;
    eprint!("{}", String::from_utf8_lossy(&output.stdout));
    kit.add(file);
    Ok(())
}
