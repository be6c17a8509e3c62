//! Release builds of the programs: stripped, without local paths, and with the licences of all contents.

use super::files::put;
use super::kit::ReleaseBuild;
use crate::cross::Compiler;
use crate::folders;
use crate::shell::{Failure, answers, cargo, execute, file_error, root, target};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Packages of the programs.
pub const PACKAGES: [&str; 2] = ["tamaire", "fuwafuwa_cli"];
const PROFILE: &str = "dist";

/// Builds both programs for this system, or for the system of `compiler`. Returns the folder of the programs.
pub fn build(kit: &ReleaseBuild, compiler: Option<&Compiler>) -> Result<PathBuf, Failure> {
    let triple = match compiler {
        Some(compiler) => compiler.system.triple.to_string(),
        None => host()?,
    };
    let licences = licences(kit, &triple)?;
    let mut words = vec!["build", "--profile", PROFILE, "--locked", "--bins"];
    words.extend(PACKAGES.iter().flat_map(|name| ["--package", name]));
    let mut command = match compiler {
        Some(compiler) => compiler.cargo(&words),
        None => {
            let mut command = cargo();
            command.args(&words);
            command
        }
    };
    let folder = match compiler {
        Some(compiler) => compiler.system.folder().join(PROFILE),
        None => root().join(target()).join(PROFILE),
    };
    let mut names = folders::names();
    if let Some(sources) = compiler.and_then(|compiler| compiler.sources.as_deref()) {
        names.push((sources.display().to_string(), "/rust/library"));
    }
    command.env("CARGO_ENCODED_RUSTFLAGS", folders::encoded([], &names));
    let plain = names
        .iter()
        .filter(|(from, _)| !from.contains(char::is_whitespace));
    let flags: Vec<String> = plain
        .map(|(from, to)| format!("-ffile-prefix-map={from}={to}"))
        .collect();
    for language in ["CFLAGS", "CXXFLAGS"] {
        command.env(language, flags.join(" "));
    }
    // Sets a fixed path of the sources, so that no local path leaks. Players do not have the sources, which
    // only `fuwafuwa bench` with Rapier would use.
    command.env("FUWAFUWA_SOURCES", "/tamaire/apps/fuwafuwa_cli");
    command.env("SOURCE_DATE_EPOCH", &kit.epoch);
    command.env("CARGO_INCREMENTAL", "0");
    command.env("TAMAIRE_LICENCES", &licences);
    execute(&mut command, "the programs could not be built")?;
    Ok(folder)
}

/// Copies a program without its debug symbols, because not every linker omits the symbols. `strip` is the
/// program that removes them.
pub fn put_stripped(
    kit: &ReleaseBuild,
    from: &Path,
    to: &Path,
    strip: &str,
) -> Result<(), Failure> {
    put(from, to)?;
    let mut command = Command::new(strip);
    command.arg("--strip-all").arg(to);
    // Sets the time of linking, which Windows programs contain, to the time of the commit.
    command.env("SOURCE_DATE_EPOCH", &kit.epoch);
    execute(&mut command, "Debian: binutils")
}

/// Target triple of this machine.
pub fn host() -> Result<String, Failure> {
    let mut rustc = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    let output = rustc.args(["--print", "host-tuple"]).output();
    let output = output.map_err(|error| file_error(Path::new("rustc"), &error))?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_string())
}

/// Writes a file with the licences of everything that the programs contain. Without Node, only THIRD-PARTY.md
/// is used.
pub fn licences(kit: &ReleaseBuild, triple: &str) -> Result<PathBuf, Failure> {
    let file = kit
        .folder()
        .join("parts")
        .join(format!("licences-{triple}.txt"));
    let parts = kit.folder().join("parts");
    fs::create_dir_all(&parts).map_err(|error| file_error(&parts, &error))?;
    if !answers("node") {
        eprintln!(
            "xtask: Node not found: the programs will show THIRD-PARTY.md only, and NOT all licence texts"
        );
        return Ok(root().join("THIRD-PARTY.md"));
    }
    let mut node = Command::new("node");
    node.arg("tools/xtask/web/licences.mjs")
        .arg(&file)
        .arg(triple)
        .args(PACKAGES);
    execute(&mut node, "the licences could not be collected")?;
    Ok(file)
}
