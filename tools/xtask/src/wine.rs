//! Wine with a separate prefix, so that it does not touch the user's files.

use crate::shell::{Failure, execute, file_error, root, target};
use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// Library that Rust programs require and that old versions of Wine lack.
const LIBRARY: &str = "bcryptprimitives.dll";

/// Wine prefix, which contains the virtual disk of Windows.
fn prefix() -> PathBuf {
    root().join(target()).join("wine")
}

/// Confines a program under Wine to the separate prefix.
pub fn shield(command: &mut Command) {
    command.env("WINEPREFIX", prefix()).env("WINEDEBUG", "-all");
    // Prevents Wine from installing .NET and a browser engine.
    command.env("WINEDLLOVERRIDES", "mscoree,mshtml=");
    // Sets a UTF-8 locale if there is none, because without it Wine cannot read non-ASCII file names.
    let is_utf8 = |name| env::var(name).is_ok_and(|value: String| value.ends_with("UTF-8"));
    if !is_utf8("LC_ALL") {
        command.env("LC_ALL", "C.UTF-8");
    }
}

/// Prepares the Wine prefix, and compiles the missing library with `compiler` if needed. The library is used
/// only under Wine and is not part of any release package.
pub fn prepare(compiler: &str) -> Result<(), Failure> {
    let mut boot = Command::new("wine");
    boot.args(["wineboot", "--init"]);
    shield(&mut boot);
    execute(&mut boot, "Wine could not create its prefix")?;
    let system = prefix().join("drive_c/windows/system32");
    let library = system.join(LIBRARY);
    if library.exists() {
        return Ok(());
    }
    if !system.is_dir() {
        return Err(Failure::failed(format!(
            "Wine did not create {}",
            system.display()
        )));
    }
    // Compiles the library to a temporary name, so that an interruption leaves no incomplete library.
    let part = system.join("bcryptprimitives.part");
    let mut compile = Command::new(compiler);
    compile.args(["-O2", "-shared", "-o"]).arg(&part);
    compile.arg(root().join("tools/xtask/wine/bcryptprimitives.c"));
    compile.arg("-ladvapi32");
    execute(
        &mut compile,
        "the library that Wine lacks could not be compiled",
    )?;
    fs::rename(&part, &library).map_err(|error| file_error(&library, &error))
}
