//! Execution of other programs, and errors.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Exit status of a failed step.
pub const FAILED: u8 = 1;

/// Exit status of a task that cannot run on this machine.
pub const CANNOT: u8 = 3;

/// Reason of a failure, and the exit status to return.
pub struct Failure {
    pub message: String,
    pub code: u8,
}

impl Failure {
    /// Creates the failure of a step.
    pub fn failed(message: impl Into<String>) -> Self {
        let message = message.into();
        Self {
            message,
            code: FAILED,
        }
    }

    /// Creates the failure of a task that cannot run on this machine.
    pub fn cannot(message: impl Into<String>) -> Self {
        let message = message.into();
        Self {
            message,
            code: CANNOT,
        }
    }
}

pub fn cargo() -> Command {
    Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Returns a cargo command for another workspace, which has its own target folder.
pub fn cargo_in(manifest: &str, target_folder: &Path, words: &str) -> Command {
    let mut words = words.split(' ');
    let mut command = cargo();
    command
        .args(words.next())
        .args(["--manifest-path", manifest])
        .args(words);
    command.env("CARGO_TARGET_DIR", target_folder);
    command
}

/// Prints the command, and runs it at the root of the workspace. `hint` is the advice that is printed if it
/// fails.
pub fn execute(command: &mut Command, hint: &str) -> Result<(), Failure> {
    execute_in(root(), command, hint)
}

/// Prints the command, and runs it in `folder`. See [`execute`].
pub fn execute_in(folder: &Path, command: &mut Command, hint: &str) -> Result<(), Failure> {
    let line = show(command);
    eprintln!("xtask: {line}");
    // Gives the failure the status [`FAILED`]. The command's own status could equal [`CANNOT`].
    let failure = |how: String| Failure::failed(format!("`{line}` {how}\n       {hint}"));
    match command.current_dir(folder).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(failure(format!("failed ({status})"))),
        Err(error) => Err(failure(format!("could not be started: {error}"))),
    }
}

/// Creates the failure for an error with a file.
pub fn file_error(path: &Path, error: &dyn std::error::Error) -> Failure {
    Failure::failed(format!("{}: {error}", path.display()))
}

/// Returns the failure for a missing program.
pub fn lacking(program: &str, how: &str) -> Failure {
    Failure::cannot(format!("{program} not found: {how}"))
}

/// Formats the command as a user would type it, without the folder of the program.
pub fn show(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_name().unwrap_or(program.as_os_str());
    let words = std::iter::once(name).chain(command.get_args());
    let words: Vec<_> = words.map(|word| word.to_string_lossy()).collect();
    words.join(" ")
}

/// Root of the workspace.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .expect("xtask is two folders below the root of the workspace")
}

/// Cargo's target folder, relative to the root of the workspace unless the path is absolute.
pub fn target() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from)
}

/// Returns the output of a program if it succeeds.
pub fn output_of(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    output.status.success().then_some(text)
}

/// Whether the program is on the search path, for programs that do not know `--version`.
pub fn is_on_path(program: &str) -> bool {
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// Whether `program --version` succeeds.
pub fn answers(program: &str) -> bool {
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

    #[cfg(unix)]
    #[test]
    fn execute_never_returns_the_status_of_the_command() {
        let mut command = Command::new("sh");
        command.args(["-c", "exit 3"]);
        let failure = execute(&mut command, "a hint").unwrap_err();
        assert_eq!(failure.code, FAILED);
        assert!(failure.message.contains("a hint"), "{}", failure.message);
    }
}
