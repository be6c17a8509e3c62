//! Wine, in a folder of its own so that the files of whoever works here are left alone.

use crate::shell::{FAILED, Failure, execute, root, target, told};
use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// What Rust's programs ask for, and an old wine does not have.
const LIBRARY: &str = "bcryptprimitives.dll";

/// What wine takes for the disk of a Windows.
fn prefix() -> PathBuf {
    root().join(target()).join("wine")
}

/// Keeps a program that wine runs to its own folder.
pub fn shield(command: &mut Command) {
    command.env("WINEPREFIX", prefix()).env("WINEDEBUG", "-all");
    // It would ask for .NET and for a browser, which nothing here needs.
    command.env("WINEDLLOVERRIDES", "mscoree,mshtml=");
    // Else it cannot read names of files that are not plain.
    let is_utf8 = |name| env::var(name).is_ok_and(|value: String| value.ends_with("UTF-8"));
    if !is_utf8("LC_ALL") {
        command.env("LC_ALL", "C.UTF-8");
    }
}

/// Sees to it that Rust's programs can start, with a library that `compiler` makes where wine has none. It is for wine alone, and in no
/// package.
pub fn prepare(compiler: &str) -> Result<(), Failure> {
    let mut boot = Command::new("wine");
    boot.args(["wineboot", "--init"]);
    shield(&mut boot);
    execute(&mut boot, "wine could not set up its folder")?;
    let system = prefix().join("drive_c/windows/system32");
    let library = system.join(LIBRARY);
    if library.exists() {
        return Ok(());
    }
    if !system.is_dir() {
        return Err(Failure {
            message: format!("wine has set up no {}", system.display()),
            code: FAILED,
        });
    }
    // Whoever interrupts this leaves no half of it.
    let part = system.join("bcryptprimitives.part");
    let mut compile = Command::new(compiler);
    compile.args(["-O2", "-shared", "-o"]).arg(&part);
    compile.arg(root().join("tools/xtask/wine/bcryptprimitives.c"));
    compile.arg("-ladvapi32");
    execute(&mut compile, "what wine lacks could not be compiled")?;
    fs::rename(&part, &library).map_err(|error| told(&library, &error))
}
