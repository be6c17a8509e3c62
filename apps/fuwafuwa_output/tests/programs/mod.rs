//! Checks of a program's output, for the tests of programs.
#![allow(dead_code)] // no test file uses all of it

use std::fs::{self, File};
use std::io::pipe;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn command(program: &str, folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(program);
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    command
        .current_dir(folder)
        .env("XDG_RUNTIME_DIR", folder)
        .args(arguments.split_whitespace());
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Returns the paths of all files and folders below a folder, sorted.
fn listing(folder: &Path) -> Vec<PathBuf> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            paths.extend(listing(&path));
        }
        paths.push(path);
    }
    paths.sort();
    paths
}

/// Checks that a command that prints something ends quietly if its reader has ended, as in `| head -1`, and
/// with an error if standard output is on a full disk.
pub fn check_output(program: &str, folder: &Path, arguments: &str) {
    let closed = || {
        let (reader, writer) = pipe().unwrap();
        drop(reader);
        writer
    };
    let output = command(program, folder, arguments)
        .stdout(closed())
        .output()
        .unwrap();
    let text = said(&output);
    assert_eq!(output.status.code(), Some(0), "{arguments}: {text}");
    for word in ["panicked", "pipe", "error"] {
        assert!(!text.contains(word), "{arguments}: {text}");
    }
    // As in `2>&1 | head -1`.
    let status = command(program, folder, arguments)
        .stdout(closed())
        .stderr(closed())
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(0), "{arguments}");

    let full = File::options().write(true).open("/dev/full").unwrap();
    let output = command(program, folder, arguments)
        .stdout(full)
        .output()
        .unwrap();
    let text = failure(&output, arguments);
    assert!(
        text.contains("standard output: No space left on device"),
        "{arguments}: {text}"
    );
}

/// Checks that a command failed without a panic, and returns its messages.
fn failure(output: &Output, arguments: &str) -> String {
    let text = said(output);
    let code = output.status.code();
    assert!(code.is_some_and(|code| code != 0), "{arguments}: {text}");
    assert!(!text.contains("panicked"), "{arguments}: {text}");
    text
}

/// Checks that a command that writes `files` of more than a kilobyte fails if the disk has no room for the last
/// of them, and leaves existing files as they were.
pub fn check_files(program: &str, folder: &Path, arguments: &str, files: &[&str]) {
    for name in files {
        fs::write(folder.join(name), "old").unwrap();
    }
    let before = listing(folder);
    // A limit on the size of files stands for a full disk. A block has 512 or 1024 bytes, depending on the
    // shell.
    let script = "trap '' XFSZ; ulimit -f 1; exec \"$@\"";
    let inner = command(program, folder, arguments);
    let mut command = command("sh", folder, "");
    let output = command
        .args(["-c", script, "sh", program])
        .args(inner.get_args())
        .output()
        .unwrap();
    let text = failure(&output, arguments);
    let last = files.last().unwrap();
    assert!(
        text.contains(last) && text.contains("File too large"),
        "{arguments}: {text}"
    );
    for name in files {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        assert_eq!(text, "old", "{arguments}: {name}");
    }
    assert_eq!(listing(folder), before, "{arguments}");
    assert!(
        output.stdout.is_empty(),
        "{arguments}: printed before it failed"
    );
}
