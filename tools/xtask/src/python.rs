//! Tasks of the Python package, `plugins/python`: a separate workspace with its own target folder.

use crate::cross::{WINDOWS, Wanted};
use crate::folders;
use crate::packages::{IfMissing, Purpose, provide};
use crate::shell::{Failure, cargo_in, execute, execute_in, file_error, output_of, root, target};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Task for the package.
#[derive(Debug, PartialEq)]
pub enum Python {
    /// Checks format and lints, builds a wheel, installs it into a clean virtual environment, and runs the
    /// tests with it.
    Check,
    /// Builds wheels for other machines.
    Wheels,
}

const PACKAGE: &str = "plugins/python";
const MANIFEST: &str = "plugins/python/Cargo.toml";
/// Maximum size of a wheel for Linux [bytes], which the documentation promises.
const MOST_BYTES: u64 = 6_000_000;
/// Maximum size of the wheel for Windows [bytes], whose library is larger by a half.
const MOST_BYTES_WINDOWS: u64 = 9_000_000;
const LINUX: &str = "x86_64-unknown-linux-gnu";
/// Oldest glibc on which the wheel for Linux runs: 2.17, of 2012. Rust supports no older one.
const GLIBC: &str = "manylinux_2_17";
/// File in the folder of the package while a wheel is built. `license-files` in pyproject.toml matches its name.
const LICENCES: &str = "LICENSE-DEPENDENCIES";
/// Python program that fails if Python is too old for the package, or cannot make virtual environments.
const IS_USABLE: &str = "import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 10))";

pub fn run(python: Python, if_missing: IfMissing) -> Result<(), Failure> {
    let is_usable = || output_of("python3", &["-c", IS_USABLE]).is_some();
    if !is_usable() {
        provide(&[Purpose::Python], if_missing);
    }
    if !is_usable() {
        return Err(Failure::cannot(
            "the Python package was NOT built: expected python3 on the path, 3.10 or newer, with the modules \
             venv and ensurepip (Debian: python3-venv; `--install` installs it)",
        ));
    }
    match python {
        Python::Check => check(),
        Python::Wheels => wheels(if_missing),
    }
}

fn check() -> Result<(), Failure> {
    for (words, hint) in [
        (
            "fmt --all --check",
            "run `cargo fmt --all` in plugins/python",
        ),
        (
            "clippy --all-targets --all-features --locked -- -D warnings",
            "fix the warnings above",
        ),
    ] {
        execute(&mut in_workspace(words), hint)?;
    }
    // Builds as `pip install .` does, with the tools that pyproject.toml names.
    let clean = Environment::new("clean")?;
    let folder = empty_folder("wheel")?;
    let mut build = clean.command("pip");
    build.args(["wheel", "--no-deps", "--wheel-dir"]);
    build.arg(&folder).arg(root().join(PACKAGE));
    build.env("CARGO_TARGET_DIR", target_folder());
    build.env("MATURIN_PEP517_ARGS", "--locked");
    execute(&mut build, "the wheel could not be built, see above")?;
    let wheel = wheel_in(&folder, MOST_BYTES)?;
    // Installs without a compiler: only from wheels, and without programs outside of the environment.
    let mut install = clean.command("pip");
    install.args(["install", "--quiet", "--only-binary=:all:"]);
    install.arg(format!("{}[test]", wheel.display()));
    install.env("PATH", clean.programs());
    execute(
        &mut install,
        "the wheel or the packages for its tests cannot be installed without a compiler: is there a network?",
    )?;
    // Runs in an empty folder, so that nothing is imported from the sources.
    let mut tests = clean.command("pytest");
    tests.args(["--quiet", "-rs", "--durations=10", "-p", "no:cacheprovider"]);
    tests.arg(root().join(PACKAGE).join("tests"));
    execute_in(
        &empty_folder("run")?,
        &mut tests,
        "a test of the Python package failed, see above",
    )
}

/// Builds the wheels for Linux, which zig links with an old glibc, and for Windows.
fn wheels(if_missing: IfMissing) -> Result<(), Failure> {
    provide(&[Purpose::Listing], if_missing);
    let tools = Environment::new("tools")?;
    let mut install = tools.command("pip");
    install.args(["install", "--quiet", "maturin[zig]>=1.9,<2", "auditwheel"]);
    execute(&mut install, "is there a network?")?;
    let linux = wheel_for(LINUX, MOST_BYTES, &tools, |build| {
        build.args(["--zig", "--compatibility", GLIBC]);
    })?;
    let mut audit = tools.command("auditwheel");
    audit.arg("show").arg(linux);
    execute(&mut audit, "auditwheel refuses the wheel")?;
    let undone = "the wheel for Windows was NOT built";
    let compiler = WINDOWS.compiler(Wanted::Build, if_missing, undone)?;
    wheel_for(WINDOWS.triple, MOST_BYTES_WINDOWS, &tools, |build| {
        compiler.set_variables(build);
        if compiler.sources.is_some() {
            build.arg("-Zbuild-std=std,panic_unwind");
        }
    })?;
    Ok(())
}

/// Builds a wheel for a system, with the licences of all its contents and without local paths. `set` adds what
/// only this system requires.
fn wheel_for(
    triple: &str,
    most_bytes: u64,
    tools: &Environment,
    set: impl Fn(&mut Command),
) -> Result<PathBuf, Failure> {
    let licences = root().join(PACKAGE).join(LICENCES);
    let mut node = Command::new("node");
    node.arg("tools/xtask/web/licences.mjs").arg(&licences);
    node.args([triple, "--workspace", PACKAGE, "fuwafuwa_python"]);
    execute(&mut node, "the licences could not be collected")?;
    let folder = empty_folder(&format!("wheels/{triple}"))?;
    let mut build = tools.command("maturin");
    build.args([
        "build",
        "--release",
        "--strip",
        "--locked",
        "--manifest-path",
        MANIFEST,
    ]);
    build.args(["--target", triple, "--out"]).arg(&folder);
    set(&mut build);
    build.env("CARGO_TARGET_DIR", target_folder());
    let flags = folders::encoded([], &folders::names());
    build.env("CARGO_ENCODED_RUSTFLAGS", flags);
    let built = execute(&mut build, "the wheel could not be built, see above");
    // Other wheels have other licences.
    fs::remove_file(&licences).map_err(|error| file_error(&licences, &error))?;
    built.and_then(|()| wheel_in(&folder, most_bytes))
}

/// Virtual environment of Python.
struct Environment(PathBuf);

impl Environment {
    /// Creates an empty environment in the target folder.
    fn new(name: &str) -> Result<Self, Failure> {
        let folder = target_folder().join(name);
        let mut create = Command::new("python3");
        create.args(["-m", "venv", "--clear"]).arg(&folder);
        execute(&mut create, "Debian: python3-venv")?;
        Ok(Self(folder))
    }

    /// Folder of the programs in the environment.
    fn programs(&self) -> PathBuf {
        self.0.join(if cfg!(windows) { "Scripts" } else { "bin" })
    }

    /// Returns a command that runs a program of the environment, which finds the other ones.
    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(self.programs().join(program));
        let path = env::var_os("PATH").unwrap_or_default();
        let folders = std::iter::once(self.programs()).chain(env::split_paths(&path));
        if let Ok(path) = env::join_paths(folders) {
            command.env("PATH", path);
        }
        command
    }
}

/// Returns the only wheel in a folder. Refuses a wheel above the size limit.
fn wheel_in(folder: &Path, most_bytes: u64) -> Result<PathBuf, Failure> {
    let entries = fs::read_dir(folder).map_err(|error| file_error(folder, &error))?;
    let files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    let [wheel] = &files[..] else {
        return Err(Failure::failed(format!(
            "{}: expected one wheel, found {} files",
            folder.display(),
            files.len()
        )));
    };
    let data = fs::metadata(wheel).map_err(|error| file_error(wheel, &error))?;
    let size = format!("{} has {} bytes", wheel.display(), data.len());
    if data.len() > most_bytes {
        let message = format!("{size}, more than the limit of {most_bytes}");
        return Err(Failure::failed(message));
    }
    eprintln!("xtask: {size}");
    Ok(wheel.clone())
}

/// Returns a cargo command for the workspace of the package.
fn in_workspace(words: &str) -> Command {
    cargo_in(MANIFEST, &target_folder(), words)
}

fn target_folder() -> PathBuf {
    root().join(target()).join("python")
}

/// Creates an empty folder in the target folder.
fn empty_folder(name: &str) -> Result<PathBuf, Failure> {
    let folder = target_folder().join(name);
    // Ignores the error if the folder is missing, as in the first run.
    let _removed = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).map_err(|error| file_error(&folder, &error))?;
    Ok(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wheel_above_the_limit_is_refused() {
        let folder = empty_folder("test").unwrap_or_else(|failure| panic!("{}", failure.message));
        let refusal = || wheel_in(&folder, MOST_BYTES).unwrap_err().message;
        assert!(refusal().contains("expected one wheel, found 0 files"));
        let file = fs::File::create(folder.join("a.whl")).unwrap();
        file.set_len(MOST_BYTES).unwrap();
        assert!(wheel_in(&folder, MOST_BYTES).is_ok_and(|wheel| wheel.ends_with("a.whl")));
        file.set_len(MOST_BYTES + 1).unwrap();
        assert!(refusal().contains("more than the limit"), "{}", refusal());
    }
}
