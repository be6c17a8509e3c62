//! The chores of this repository, run as `cargo xtask <task>`. Plain std, so that it builds in a moment.

mod kernel;
mod packages;
mod task;
mod wasm;

use packages::{IfMissing, Purpose, has_display};
use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use task::{Task, USAGE};

/// Exit status where a step failed.
const FAILED: u8 = 1;

/// Exit status for a command line that makes no sense, as shells and most tools use it.
const BAD_USAGE: u8 = 2;

/// Exit status where a task cannot be tried on this machine.
const CANNOT: u8 = 3;

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
            run_all(CHECK).and_then(|()| run_all(TEST))
        }
        Task::Wasm(if_missing) => wasm::run(if_missing),
        Task::Kernel(if_missing) => kernel::run(if_missing),
        Task::Soak(words) => soak(&words),
        Task::Rapier => run_all(RAPIER),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("xtask: {}", failure.message);
            ExitCode::from(failure.code)
        }
    }
}

/// Builds and runs the game; its exit status. In the folder of the caller, so that the files it is
/// told to open are found.
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

/// The exit status to hand on. A program that was killed has none.
fn exit_code(code: Option<i32>) -> ExitCode {
    let code = code.and_then(|code| u8::try_from(code).ok());
    ExitCode::from(code.unwrap_or(FAILED))
}

/// Plays levels for long, as the words say.
fn soak(words: &[String]) -> Result<(), Failure> {
    let mut command = cargo();
    command.args(["run", "--release", "--package", "tamaire_play"]);
    command.args(["--example", "soak", "--"]).args(words);
    execute(
        &mut command,
        "a round that nobody meant broke something, see above; its level and tick are named",
    )
}

/// Tests draw into images, and open no window.
const FOR_TESTS: &[Purpose] = &[Purpose::Build, Purpose::Drawing];

/// One call of cargo.
struct Step {
    arguments: &'static [&'static str],
    environment: &'static [(&'static str, &'static str)],
    /// What to do when it fails.
    hint: &'static str,
}

const CHECK: &[Step] = &[
    Step {
        arguments: &["fmt", "--all", "--check"],
        environment: &[],
        hint: "run `cargo fmt --all`; if cargo has no fmt, `rustup component add rustfmt`",
    },
    Step {
        arguments: &[
            "clippy",
            "--workspace",
            "--all-targets",
            "--all-features",
            "--",
            "-D",
            "warnings",
        ],
        environment: &[],
        hint: "mend the warnings above; if cargo has no clippy, `rustup component add clippy`",
    },
    Step {
        arguments: &[
            "check",
            "--package",
            "tamaire",
            "--no-default-features",
            "--all-targets",
        ],
        environment: &[],
        hint: "something needs force feedback, which may be left out",
    },
    Step {
        arguments: &["doc", "--workspace", "--all-features", "--no-deps"],
        environment: &[("RUSTDOCFLAGS", "-Dwarnings")],
        hint: "mend the documentation warnings above; most are links to names that moved",
    },
];

const TEST: &[Step] = &[
    Step {
        arguments: &["test", "--workspace"],
        environment: &[],
        hint: "a test failed or did not compile, see above",
    },
    Step {
        arguments: &[
            "test",
            "--release",
            // The examples were built in debug.
            "--tests",
            "--package",
            "fuwafuwa",
            "--package",
            "fuwafuwa_golden",
            "--features",
            "fuwafuwa/serde,fuwafuwa_golden/parallel",
        ],
        environment: &[],
        hint: "passes in debug but not in release: look for work done inside a debug_assert!, \
               and for sums whose order depends on the threads",
    },
];

const RAPIER: &[Step] = &[Step {
    arguments: &[
        "check",
        "--all-targets",
        "--manifest-path",
        "crates/against_rapier/Cargo.toml",
    ],
    environment: &[],
    hint: "the comparison does not follow the engine or Rapier any more, see above",
}];

/// Why a task stopped, and the exit status to hand on.
struct Failure {
    message: String,
    code: u8,
}

/// Runs the steps in order, at the root of the workspace, up to the first that fails.
fn run_all(steps: &[Step]) -> Result<(), Failure> {
    steps.iter().try_for_each(run)
}

fn run(step: &Step) -> Result<(), Failure> {
    let mut command = cargo();
    command.args(step.arguments);
    command.envs(step.environment.iter().copied());
    execute(&mut command, step.hint)
}

fn cargo() -> Command {
    Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Shows the command, and runs it at the root of the workspace. The hint says what to do when it fails.
fn execute(command: &mut Command, hint: &str) -> Result<(), Failure> {
    let line = show(command);
    eprintln!("xtask: {line}");
    let failure = |how: String| Failure {
        message: format!("`{line}` {how}\n       {hint}"),
        // Never the status of the command, which could be taken for `CANNOT`.
        code: FAILED,
    };
    match command.current_dir(root()).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(failure(format!("failed ({status})"))),
        Err(error) => Err(failure(format!("could not be started: {error}"))),
    }
}

/// The command as one would type it, without the folder of the program.
fn show(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_name().unwrap_or(program.as_os_str());
    let words = std::iter::once(name).chain(command.get_args());
    let words: Vec<_> = words.map(|word| word.to_string_lossy()).collect();
    words.join(" ")
}

/// The root of the workspace.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("xtask lies one folder below the root of the workspace")
}

/// Where everything is built; below the root, unless it is absolute.
fn target() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from)
}

/// What a program writes, if it runs and succeeds.
fn output_of(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    output.status.success().then_some(text)
}

/// Whether the program runs at all.
fn answers(program: &str) -> bool {
    Command::new(program)
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_of_the_game_is_handed_on_where_it_has_one() {
        for (code, expect) in [
            (Some(0), 0),
            (Some(101), 101),
            (Some(-1), FAILED),
            (None, FAILED),
        ] {
            assert_eq!(exit_code(code), ExitCode::from(expect), "{code:?}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_failure_is_never_taken_for_a_task_that_cannot_be_tried() {
        let mut command = Command::new("sh");
        command.args(["-c", "exit 3"]);
        let failure = execute(&mut command, "a hint").unwrap_err();
        assert_eq!(failure.code, FAILED);
        assert!(failure.message.contains("a hint"), "{}", failure.message);
    }
}
