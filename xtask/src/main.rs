//! The chores of this repository, run as `cargo xtask <task>`. Plain std, so that it builds in a moment.

mod wasm;

use std::env;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

const USAGE: &str = "\
usage: cargo xtask <task>

tasks:
  check   formatting, lints, tests and documentation: what a change must pass
  test    all tests in debug, then the engine's tests once more in release
  wasm    the golden scenes on wasm32 under Node; exit status 3 where that cannot be tried
  help    this text";

/// Exit status where a task cannot be tried on this machine.
const CANNOT: u8 = 3;

/// Exit status for a command line that makes no sense, as shells and most tools use it.
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
        Task::Check => run_all(CHECK),
        Task::Test => find_c_compiler().and_then(|()| run_all(TEST)),
        Task::Wasm => wasm::run(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("xtask: {}", failure.message);
            ExitCode::from(failure.code)
        }
    }
}

#[derive(Debug, PartialEq)]
enum Task {
    Check,
    Test,
    Wasm,
    Help,
}

impl Task {
    fn parse(arguments: &[String]) -> Result<Task, String> {
        let (name, rest) = arguments.split_first().ok_or("no task given")?;
        if let Some(extra) = rest.first() {
            return Err(format!("`{name}` takes no arguments, but got `{extra}`"));
        }
        match name.as_str() {
            "check" => Ok(Task::Check),
            "test" => Ok(Task::Test),
            "wasm" => Ok(Task::Wasm),
            "help" | "--help" | "-h" => Ok(Task::Help),
            _ => Err(format!("there is no task `{name}`")),
        }
    }
}

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
            "--",
            "-D",
            "warnings",
        ],
        environment: &[],
        hint: "mend the warnings above; if cargo has no clippy, `rustup component add clippy`",
    },
    Step {
        arguments: &["test", "--workspace"],
        environment: &[],
        hint: "a test failed or did not compile, see above",
    },
    Step {
        arguments: &["doc", "--workspace", "--no-deps"],
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
            "--package",
            "fuwafuwa",
            "--release",
            "--features",
            "serde,parallel",
        ],
        environment: &[],
        hint: "passes in debug but not in release: look for work done inside a debug_assert!",
    },
];

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
    let line = format!("cargo {}", step.arguments.join(" "));
    eprintln!("xtask: {line}");
    let status = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(step.arguments)
        .envs(step.environment.iter().copied())
        .current_dir(root())
        .status()
        .map_err(|error| Failure {
            message: format!("`{line}` could not be started: {error}"),
            code: 1,
        })?;
    if status.success() {
        return Ok(());
    }
    Err(Failure {
        message: format!("`{line}` failed ({status})\n       {}", step.hint),
        code: exit_code(status.code()),
    })
}

/// The root of the workspace.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("xtask lies one folder below the root of the workspace")
}

/// The status to hand on for a step that failed; 1 where it was killed or has a number that does not fit.
fn exit_code(code: Option<i32>) -> u8 {
    code.and_then(|code| u8::try_from(code).ok())
        .filter(|&code| code != 0)
        .unwrap_or(1)
}

/// rustc links through the C compiler: better to hear that it is missing from us than from the linker.
fn find_c_compiler() -> Result<(), Failure> {
    // Windows with the MSVC toolchain finds its own linker, which need not be on the path.
    if cfg!(target_env = "msvc") {
        return Ok(());
    }
    let chosen = env::var("CC").ok().filter(|name| !name.is_empty());
    let candidates = match &chosen {
        Some(name) => vec![name.as_str()],
        None => vec!["cc", "gcc", "clang"],
    };
    if candidates.iter().any(|name| answers(name)) {
        return Ok(());
    }
    Err(Failure {
        message: format!(
            "no C compiler found (tried {}); install one, such as gcc or clang, or name it in CC",
            candidates.join(", ")
        ),
        code: 1,
    })
}

/// Whether the program runs at all. The name may carry arguments, as in `CC="ccache gcc"`.
fn answers(command_line: &str) -> bool {
    let mut words = command_line.split_whitespace();
    let Some(program) = words.next() else {
        return false;
    };
    Command::new(program)
        .args(words)
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(arguments: &[&str], expect: Result<Task, &str>) {
        let arguments: Vec<String> = arguments.iter().map(ToString::to_string).collect();
        assert_eq!(
            Task::parse(&arguments),
            expect.map_err(str::to_string),
            "{arguments:?}"
        );
    }

    #[test]
    fn one_known_task_and_nothing_else_is_a_command_line() {
        check(&["check"], Ok(Task::Check));
        check(&["test"], Ok(Task::Test));
        check(&["wasm"], Ok(Task::Wasm));
        check(&["--help"], Ok(Task::Help));
        check(&[], Err("no task given"));
        check(&["chekc"], Err("there is no task `chekc`"));
        check(
            &["test", "fast"],
            Err("`test` takes no arguments, but got `fast`"),
        );
    }

    #[test]
    fn a_failure_never_turns_into_success() {
        assert_eq!(exit_code(Some(101)), 101);
        assert_eq!(exit_code(Some(0)), 1);
        assert_eq!(exit_code(Some(256)), 1);
        assert_eq!(exit_code(None), 1);
    }
}
