//! The golden scenes on wasm32, under Node.
//!
//! A toolchain with the target builds them as it is. Where it has none and cannot fetch one, Debian
//! and Ubuntu have a compiler with the sources of its library, `rustc-web` and `rust-web-src`, and
//! a linker; the library is then built along.

use crate::{CANNOT, Failure, answers, exit_code, root};
use std::path::Path;
use std::process::Command;

/// Where Debian puts the compiler, and the sources of its library.
const WEB_COMPILER: &str = "/usr/bin/rustc";
const WEB_SOURCES: &str = "/usr/lib/rustlib/src/rust/library/std";
const TARGET: &str = "wasm32-unknown-unknown";

/// Builds the golden scenes, runs them, and fails when one comes out differently.
pub fn run() -> Result<(), Failure> {
    if !answers("node") {
        return Err(cannot("no Node found; install nodejs"));
    }
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    let folder = root().join("target").join("wasm");
    cargo.current_dir(root()).env("CARGO_TARGET_DIR", &folder);
    cargo.args(["build", "--release", "--ignore-rust-version"]);
    cargo.args(["--package", "fuwafuwa_golden", "--target", TARGET]);
    if !has_target() {
        let linker = prepare()?;
        cargo.arg("-Zbuild-std=std,panic_abort");
        cargo.env("RUSTC", WEB_COMPILER).env("RUSTC_BOOTSTRAP", "1");
        cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker);
    }
    start(&mut cargo)?;
    let module = folder.join(TARGET).join("release/fuwafuwa_golden.wasm");
    start(
        Command::new("node")
            .arg(root().join("xtask/golden.mjs"))
            .arg(module),
    )
}

/// Whether the compiler in use can build for wasm32.
fn has_target() -> bool {
    let output = Command::new("rustc").args(["--print", "sysroot"]).output();
    output.is_ok_and(|output| {
        let sysroot = String::from_utf8_lossy(&output.stdout).trim().to_string();
        Path::new(&sysroot)
            .join("lib/rustlib")
            .join(TARGET)
            .exists()
    })
}

/// Installs what is missing, and names the linker.
fn prepare() -> Result<String, Failure> {
    if !(Path::new(WEB_SOURCES).exists() && find_linker().is_some()) {
        let linkers = (14..=40).rev().map(|version| format!("lld-{version}"));
        let linker = linkers.into_iter().find(|package| has_package(package));
        let (Some(linker), true) = (linker, has_package("rustc-web")) else {
            return Err(cannot(
                "the toolchain has no wasm32 target (`rustup target add wasm32-unknown-unknown`), \
                 and there are no Debian packages rustc-web and lld to be had",
            ));
        };
        eprintln!("xtask: installing rustc-web, rust-web-src and {linker}");
        let installed = Command::new("apt-get")
            .args(["install", "-y", "--no-install-recommends"])
            .args(["rustc-web", "rust-web-src", &linker])
            .env("DEBIAN_FRONTEND", "noninteractive")
            .status();
        if !installed.is_ok_and(|status| status.success()) {
            return Err(cannot("the packages could not be installed; are you root?"));
        }
    }
    find_linker().ok_or_else(|| cannot("no wasm-ld found"))
}

/// The newest linker for wasm there is.
fn find_linker() -> Option<String> {
    let numbered = (14..=40).rev().map(|version| format!("wasm-ld-{version}"));
    let mut names = numbered.chain(["wasm-ld".to_string()]);
    names.find(|name| answers(name))
}

fn has_package(name: &str) -> bool {
    let output = Command::new("apt-cache").args(["policy", name]).output();
    output.is_ok_and(|output| {
        let text = String::from_utf8_lossy(&output.stdout);
        text.contains("Candidate:") && !text.contains("Candidate: (none)")
    })
}

fn start(command: &mut Command) -> Result<(), Failure> {
    let line = format!("{command:?}");
    let status = command.status().map_err(|error| Failure {
        message: format!("{line} could not be started: {error}"),
        code: 1,
    })?;
    if status.success() {
        return Ok(());
    }
    Err(Failure {
        message: format!("{line} failed ({status})"),
        code: exit_code(status.code()),
    })
}

fn cannot(reason: &str) -> Failure {
    Failure {
        message: format!("the golden scenes were not run on wasm32: {reason}"),
        code: CANNOT,
    }
}
