//! Tasks of this repository, run as `cargo xtask <task>`. Depends on std only, so that it builds quickly.

#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [s]

mod bevy;
mod cross;
mod debian;
mod documents;
mod folders;
mod fuzz;
mod kernel;
mod package;
mod packages;
mod python;
mod release;
mod scans;
mod shell;
mod task;
mod version;
mod wasm;
mod web;
mod wine;

use documents::check_documents;
use packages::{IfMissing, Purpose, has_display};
use shell::{FAILED, Failure, cargo, execute, show};
use std::env;
use std::process::ExitCode;
use task::{Task, USAGE};

/// Exit status for an invalid command line, as in shells and most tools.
const BAD_USAGE: u8 = 2;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let task = match Task::parse(&arguments) {
        Ok(task) => task,
        Err(complaint) => {
            eprintln!("xtask: {complaint}\n\n{USAGE}");
            return ExitCode::from(BAD_USAGE);
        }
    };
    let outcome = match task {
        Task::Help => {
            println!("{USAGE}");
            Ok(())
        }
        Task::Play(if_missing, words) => return play(if_missing, &words),
        Task::Test(if_missing) => {
            packages::provide(FOR_TESTS, if_missing);
            run_all(TEST)
        }
        Task::Check(if_missing) => {
            packages::provide(FOR_TESTS, if_missing);
            run_all(CHECK)
                .and_then(|()| check_documents())
                .and_then(|()| run_all(TEST))
        }
        Task::Wasm(if_missing) => wasm::run(if_missing),
        Task::Web(web, if_missing) => web::run(web, if_missing),
        Task::Arm(if_missing) => cross::check(&cross::ARM, if_missing),
        Task::Windows(if_missing) => cross::check(&cross::WINDOWS, if_missing),
        Task::Release(wish, if_missing) => release::run(&wish, if_missing),
        Task::Version(version) => version::raise(&version),
        Task::Kernel(if_missing) => kernel::run(if_missing),
        Task::Soak(words) => soak(&words),
        Task::Stand(if_missing) => {
            use Purpose::{Build, Drawing, Staging, Window};
            packages::provide(&[Build, Window, Drawing, Staging], if_missing);
            run_all(STAND)
        }
        Task::Fuzz(words) => fuzz::run(&words),
        Task::Scans => scans::run(),
        Task::Package(wish) => package::run(wish),
        Task::Rapier => run_all(RAPIER),
        Task::Bevy(wish, if_missing) => bevy::run(wish, if_missing),
        Task::Python(wish, if_missing) => python::run(wish, if_missing),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("xtask: {}", failure.message);
            ExitCode::from(failure.code)
        }
    }
}

/// Builds and runs the game in the caller's folder, so that relative paths work; returns its exit status.
fn play(if_missing: IfMissing, words: &[String]) -> ExitCode {
    let mut purposes = vec![Purpose::Build];
    if has_display() {
        purposes.push(Purpose::Window);
    }
    packages::provide(&purposes, if_missing);
    let mut command = cargo();
    command.args(["run", "--release", "--package", "tamaire", "--"]);
    command.args(words);
    eprintln!("xtask: {}", show(&command));
    match command.status() {
        Ok(status) => exit_code(status.code()),
        Err(error) => {
            eprintln!("xtask: cargo could not be started: {error}");
            ExitCode::from(FAILED)
        }
    }
}

/// Converts the exit status of a program, which is `None` for a killed program.
fn exit_code(code: Option<i32>) -> ExitCode {
    let code = code.and_then(|code| u8::try_from(code).ok());
    ExitCode::from(code.unwrap_or(FAILED))
}

/// Runs the soak test of levels with the given arguments.
fn soak(words: &[String]) -> Result<(), Failure> {
    let mut command = cargo();
    command.args(["run", "--release", "--package", "tamaire_play"]);
    command.args(["--example", "soak", "--"]).args(words);
    execute(
        &mut command,
        "a random round caused a fault, see above for its level and tick",
    )
}

/// Purposes of packages for tests: tests draw into images and open no window; one of them starts a database
/// server.
const FOR_TESTS: &[Purpose] = &[Purpose::Build, Purpose::Drawing, Purpose::Serving];

/// Arguments of a cargo command, and advice if it fails.
type Step = (&'static str, &'static str);

const CHECK: &[Step] = &[
    (
        "fmt --all --check",
        "run `cargo fmt --all`; if cargo has no fmt, `rustup component add rustfmt`",
    ),
    (
        "clippy --workspace --all-targets --all-features -- -D warnings",
        "fix the warnings above; if cargo has no clippy, `rustup component add clippy`",
    ),
    (
        "check --package tamaire --no-default-features --all-targets",
        "the game must compile without the feature for force feedback",
    ),
];

// Enables all features, as `CHECK` does, because other features would recompile everything. The examples are
// missing here because `CHECK` compiles them.
const TEST: &[Step] = &[
    (
        "test --workspace --all-features --tests",
        "a test failed or did not compile, see above",
    ),
    (
        "test --workspace --all-features --test images --test space -- --ignored",
        "the renderer failed, or there is no graphics adapter, such as that of mesa-vulkan-drivers; see above",
    ),
    (
        "test --workspace --all-features --lib -- --ignored film::studio",
        "the studio failed, or there is no graphics adapter, such as that of mesa-vulkan-drivers; see above",
    ),
    (
        "test --workspace --all-features --doc",
        "an example in the documentation failed or did not compile, see above",
    ),
    (
        "test --release --test native --test checks --package fuwafuwa --package determinism_checks --all-features",
        "passes in debug but not in release: look for side effects inside a debug_assert!, \
         and for sums whose order depends on the number of threads",
    ),
];

const STAND: &[Step] = &[(
    "test --release --package tamaire --test stand -- --ignored --nocapture",
    "the stand did not restart, or lost a completed round, see above",
)];

const RAPIER: &[Step] = &[(
    "check --all-targets --manifest-path tools/against_rapier/Cargo.toml",
    "the comparison does not compile with the current engine or Rapier, see above",
)];

/// Runs the steps in order at the root of the workspace, up to the first failure.
fn run_all(steps: &[Step]) -> Result<(), Failure> {
    steps.iter().try_for_each(run)
}

fn run((arguments, hint): &Step) -> Result<(), Failure> {
    let mut command = cargo();
    command.args(arguments.split(' '));
    execute(&mut command, hint)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exit_code_is_forwarded_if_valid() {
        for (code, expect) in [
            (Some(0), 0),
            (Some(101), 101),
            (Some(-1), FAILED),
            (None, FAILED),
        ] {
            assert_eq!(exit_code(code), ExitCode::from(expect), "{code:?}");
        }
    }
}
