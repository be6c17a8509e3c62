//! Golden scenes on wasm32 under Node. Their bits and durations are compared with those of the native build.
//!
//! rustup's toolchain builds for wasm32 after `rustup target add wasm32-unknown-unknown`. Without it,
//! Debian's packages are used: a compiler, a linker, and the sources of the standard library, which cargo
//! then builds.

use crate::debian;
use crate::folders;
use crate::packages::{IfMissing, MissingItem, apt_get, install_arguments, list_lacks};
use crate::shell::{Failure, answers, cargo, execute, root, target};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

pub const TARGET: &str = "wasm32-unknown-unknown";
/// Enables 128-bit SIMD. All current browsers have it; a module could not test for it at run time.
const LANES: &str = "-Ctarget-feature=+simd128";

/// Builds and runs the golden scenes; fails if the bits of a result differ.
pub fn run(if_missing: IfMissing) -> Result<(), Failure> {
    let compiler = compiler(if_missing, "the golden scenes were NOT run on wasm32")?;
    let module = compile_checks(&compiler)?;
    let native_times = native_times()?;
    execute(
        Command::new("node")
            .arg("tools/xtask/golden.mjs")
            .arg(module)
            .args(native_times),
        "the result of a scene differs in its bits on wasm32: look for arithmetic beyond + - * / and sqrt, for \
         usize, which has 32 bits there, and for SIMD lanes that are summed in another order",
    )
}

/// Returns the compiler for wasm32 if the compiler and Node are installed. Otherwise the error begins with
/// `undone`, which names the task that needed them.
pub fn compiler(if_missing: IfMissing, undone: &str) -> Result<Compiler, Failure> {
    let mut found = find_compiler();
    if if_missing == IfMissing::Install && found.is_err() {
        // Updates the package lists, which are old or missing on fresh machines. If the update fails, the old
        // lists may still suffice.
        apt_get(&["update", "--quiet"]);
        // Searches and installs twice, because the matching linker is known only once the compiler is
        // installed.
        for _ in 0..2 {
            match &found {
                Err(lacks) if install(lacks) => found = find_compiler(),
                _ => break,
            }
        }
    }
    found.map_err(|lacks| cannot(undone, &lacks, if_missing))
}

/// Toolchain for wasm32.
#[derive(Debug, PartialEq)]
pub enum Compiler {
    /// The toolchain in use, which has the standard library for wasm32.
    Ready,
    /// Debian's toolchain, with the linker at this path.
    Debian { linker: String },
}

/// Returns the compiler for wasm32, or all items that are missing.
fn find_compiler() -> Result<Compiler, Vec<MissingItem>> {
    let mut lacks = Vec::new();
    if !answers("node") {
        lacks.push(MissingItem::new("Node not found on the path", "nodejs"));
    }
    let compiler = if debian::toolchain_has(TARGET) {
        Ok(Compiler::Ready)
    } else {
        find_debian(debian::description().as_deref(), Path::exists, answers)
    };
    match compiler {
        Ok(compiler) if lacks.is_empty() => Ok(compiler),
        Ok(_) => Err(lacks),
        Err(more) => {
            lacks.extend(more);
            Err(lacks)
        }
    }
}

/// Returns Debian's compiler, found from its version output, or all items that are missing for it.
fn find_debian(
    description: Option<&str>,
    exists: impl Fn(&Path) -> bool,
    answers: impl Fn(&str) -> bool,
) -> Result<Compiler, Vec<MissingItem>> {
    let found = debian::find(TARGET, description, exists).map_err(|lack| vec![lack])?;
    let mut lacks = Vec::from_iter(found.sources.err());
    let linker = format!("wasm-ld-{}", found.llvm);
    if !answers(&linker) {
        let what = format!("linker {linker} not found");
        lacks.push(MissingItem::new(what, format!("lld-{}", found.llvm)));
    }
    if lacks.is_empty() {
        Ok(Compiler::Debian { linker })
    } else {
        Err(lacks)
    }
}

/// Installs the missing items; returns whether that succeeded.
fn install(lacks: &[MissingItem]) -> bool {
    // Installs with arguments that forbid removal. rustc-web conflicts with Debian's rustc and rustup, which
    // must stay.
    let names = lacks.iter().map(|lack| lack.package.as_str());
    apt_get(&install_arguments(names))
}

/// Compiles a package, the first of `words`, as for a browser; returns the path of the module.
pub fn compile(compiler: &Compiler, words: &[&str]) -> Result<PathBuf, Failure> {
    let mut command = cargo();
    command
        .args(["rustc", "--profile", "web", "--target", TARGET, "--package"])
        .args(words)
        .env("CARGO_TARGET_DIR", root().join(folder()))
        // Replaces flags for the native build, such as a target-cpu, which do not apply here.
        .env(
            "CARGO_ENCODED_RUSTFLAGS",
            folders::encoded([LANES], &folders::names()),
        );
    if let Compiler::Debian { linker } = compiler {
        command
            .arg("-Zbuild-std=std,panic_abort")
            // Builds the standard library without features. Browsers show backtraces of their own, and the
            // crates for backtraces are among the largest.
            .arg("-Zbuild-std-features=")
            .envs(debian::ENVIRONMENT)
            .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker);
    }
    execute(
        &mut command,
        "code that differs in a browser belongs into game/tamaire/src/platform, or behind features of the crates",
    )?;
    let modules = root().join(folder()).join(TARGET).join("web");
    Ok(modules.join(words[0]).with_extension("wasm"))
}

/// Compiles the golden scenes and other checks for browsers; returns the path of the module.
pub fn compile_checks(compiler: &Compiler) -> Result<PathBuf, Failure> {
    compile(compiler, &["determinism_checks", "--crate-type", "cdylib"])
}

/// Native durations of the scenes on one thread \[ms\], in order.
fn native_times() -> Result<Vec<String>, Failure> {
    // Builds with the packages and features of the tests in release mode, to reuse their build.
    let mut build = cargo();
    build.args(["build", "--release", "--all-features"]);
    build.args(["--package", "fuwafuwa", "--package", "determinism_checks"]);
    build.args(["--example", "times"]);
    execute(
        &mut build,
        "the golden scenes could not be built natively, see above",
    )?;
    let output = Command::new(root().join(target()).join("release/examples/times"))
        .env("RAYON_NUM_THREADS", "1")
        .stderr(Stdio::inherit())
        .output();
    let Some(output) = output.ok().filter(|output| output.status.success()) else {
        return Err(Failure::failed(
            "the native durations of the golden scenes could not be measured",
        ));
    };
    let times = String::from_utf8_lossy(&output.stdout);
    Ok(times.split_whitespace().map(str::to_string).collect())
}

/// Target folder for wasm32, beside the native one.
fn folder() -> PathBuf {
    target().join("wasm")
}

fn cannot(undone: &str, lacks: &[MissingItem], if_missing: IfMissing) -> Failure {
    let advice = match if_missing {
        IfMissing::Say => "On Debian, add `--install` to install the packages.",
        IfMissing::Install => "Debian's packages are not sufficient, see above.",
    };
    Failure::cannot(format!(
        "{undone}:\n{}\n{advice}\n\
             Elsewhere, run `rustup target add {TARGET}`, and put Node on the path.",
        list_lacks(lacks)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DESCRIPTION: &str = "rustc 1.96.0\nrelease: 1.96.0\nLLVM version: 22.1.8\n";

    fn check(description: Option<&str>, has: &[&str], expect: Result<&str, &[&str]>) {
        let found = find_debian(
            description,
            |path| has.iter().any(|there| path == Path::new(there)),
            |program| has.contains(&program),
        );
        let found = match &found {
            Ok(Compiler::Debian { linker }) => Ok(linker.as_str()),
            Ok(Compiler::Ready) => Ok("ready"),
            Err(lacks) => Err(lacks.iter().map(|lack| lack.package.as_str()).collect()),
        };
        assert_eq!(
            found,
            expect.map_err(<[&str]>::to_vec),
            "{description:?}, {has:?}"
        );
    }

    #[test]
    fn find_debian_names_missing_packages() {
        let sources = "/usr/src/rustc-1.96.0/library/std";
        let other_sources = "/usr/src/rustc-1.85.0/library/std";
        let old = DESCRIPTION.replace("1.96", "1.85");
        check(None, &[], Err(&["rustc-web"]));
        check(Some(&old), &[sources, "wasm-ld-22"], Err(&["rustc-web"]));
        check(Some(DESCRIPTION), &[sources], Err(&["lld-22"]));
        check(
            Some(DESCRIPTION),
            &[other_sources, "wasm-ld-19"],
            Err(&["rust-web-src", "lld-22"]),
        );
        check(
            Some(DESCRIPTION),
            &[sources, "wasm-ld-22"],
            Ok("wasm-ld-22"),
        );
    }

    #[test]
    fn old_compiler_is_refused_with_both_versions() {
        let old = DESCRIPTION.replace("1.96", "1.85");
        let lacks = find_debian(Some(&old), |_| true, |_| true).unwrap_err();
        let failure = cannot("", &lacks, IfMissing::Say);
        let said = |word| failure.message.contains(word);
        assert!(
            said("1.85.0") && said(debian::OLDEST),
            "{}",
            failure.message
        );
        assert_eq!(failure.code, crate::shell::CANNOT);
    }
}
