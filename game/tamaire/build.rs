//! What the program brings along: the licences of all that is inside, and for Windows its icon and its version.

use std::env;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Names the file of licences that goes inside.
const LICENCES: &str = "TAMAIRE_LICENCES";

fn main() -> Result<(), Box<dyn Error>> {
    let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let root = here
        .ancestors()
        .nth(2)
        .ok_or("the game lies in no workspace")?;
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed={LICENCES}");
    let given = env::var_os(LICENCES).map(PathBuf::from);
    let licences = given.unwrap_or_else(|| root.join("THIRD-PARTY.md"));
    println!("cargo::rustc-env={LICENCES}={}", licences.display());
    let is_for = |name: &str, value| env::var(name).is_ok_and(|found| found == value);
    if is_for("CARGO_CFG_TARGET_OS", "windows") && is_for("CARGO_CFG_TARGET_ENV", "gnu") {
        link_resources(&root.join("packaging/windows"))?;
    }
    Ok(())
}

/// Compiles the resources, and links them into the program. Where nothing compiles them it has neither icon nor version.
fn link_resources(folder: &Path) -> Result<(), Box<dyn Error>> {
    let source = folder.join("tamaire.rc");
    for file in [&source, &folder.join("tamaire.ico")] {
        println!("cargo::rerun-if-changed={}", file.display());
    }
    let version = env::var("CARGO_PKG_VERSION")?;
    let part = |name: &str| env::var(format!("CARGO_PKG_VERSION_{name}"));
    let numbers = [part("MAJOR")?, part("MINOR")?, part("PATCH")?].join(",");
    let text = fs::read_to_string(&source)?;
    let text = text.replace("@NUMBERS@", &format!("{numbers},0"));
    let text = text.replace("@VERSION@", &version);
    let out = PathBuf::from(env::var("OUT_DIR")?);
    let (filled, object) = (out.join("tamaire.rc"), out.join("resources.o"));
    fs::write(&filled, text)?;
    let compiled = ["x86_64-w64-mingw32-windres", "windres"]
        .into_iter()
        .find_map(|program| {
            let mut command = Command::new(program);
            command.arg("--input").arg(&filled);
            command.arg("--output").arg(&object);
            command.current_dir(folder).status().ok()
        });
    match compiled {
        Some(status) if status.success() => {
            println!("cargo::rustc-link-arg-bins={}", object.display());
        }
        Some(status) => return Err(format!("windres: {status}").into()),
        None => println!("cargo::warning=there is no windres: no icon, no version"),
    }
    Ok(())
}
