//! Command line of `cargo xtask`: its help text, and the parsing of its arguments.

use crate::bevy::Bevy;
use crate::package::Package;
use crate::packages::IfMissing;
use crate::python::Python;
use crate::release::{self, ReleaseParts};
use crate::version::Version;
use crate::web::Web;

pub const USAGE: &str = "\
usage: cargo xtask <task>

tasks:
  play [-- ARGS]   build and run the game with these arguments
  test             run all tests in debug mode, then the engine's unit tests and golden scenes in
                   release mode, with one to eight threads
  check            check formatting, lints and documentation, then run all of `test`
  wasm             run the golden scenes on wasm32 under Node; compare bits and speed with native
  web              build the game for a browser, as a folder for any web server;
                   --address https://…/ sets the address that previews of the page refer to
  web --serve      build it and serve it on this machine
  web --test       build it and test it in Chromium and Firefox
  arm              compare the bits of the golden scenes and of 20 rounds of bots with 64-bit ARM,
                   in QEMU
  windows          compare the same with Windows, in Wine
  release [PART …] build packages and data to verify them in target/packages; parts: linux, deb,
                   tar, windows, web, sbom, deny, sums; parts built from this commit are kept, and
                   failed parts are listed at the end
  version X.Y.Z    set this version everywhere, and start a new section in the changelog
  kernel           test force feedback against a real Linux kernel, in QEMU
  soak [MINUTES [LEVEL …]]
                   play every level with two random hands; 10 minutes by default
  stand            run a public stand that is killed and stopped during play, for some 10 minutes
  fuzz [MINUTES [DOOR …]]
                   fuzz the readers of scenes, levels, pictures, replays, settings and other input
                   with libFuzzer; 9 minutes by default
  scans            download MNI152 scans of a brain and their licences to target/scans
  package          check contents and size of the packages of all published crates
  package --build  check them, and build each from its package with the minimum supported Rust
  rapier           check that tools/against_rapier, a separate workspace, compiles
  bevy             check plugins/bevy_fuwafuwa, a separate workspace: formatting, lints, tests
                   without a window, documentation
  bevy --pictures  lint its examples, and render pictures of their scene on a virtual display
  python           check plugins/python, a separate workspace: formatting, lints, a wheel, its size,
                   and the tests with the wheel in a clean virtual environment
  python --wheels  build its wheels for any Linux and for Windows in target/python/wheels
  help             print this text, as --help does after any task; help of the game:
                   play -- --help

`wasm`, `web`, `arm`, `windows`, `release`, `kernel`, `stand`, `bevy --pictures` and `python`
accept --install, which installs missing packages of Debian (for `kernel` also of Ubuntu), and for
`release` also cargo-deny from crates.io. In `release --install [PART …]`, it must precede
the parts.

On Debian and Ubuntu, `play`, `test` and `check` install missing system packages as root or through
sudo; if there is a terminal, they ask first. With --no-install they only list them.

exit status: 0 passed, 1 failed, 2 invalid command line, 3 this machine lacks something that `wasm`,
`web`, `arm`, `windows`, `release`, `kernel`, `scans`, `package --build` or `python` needs;
`play` returns the exit status of the game";

#[derive(Debug, PartialEq)]
pub enum Task {
    /// Runs the game with these arguments.
    Play(IfMissing, Vec<String>),
    Test(IfMissing),
    Check(IfMissing),
    Wasm(IfMissing),
    Web(Web, IfMissing),
    Arm(IfMissing),
    Windows(IfMissing),
    Release(ReleaseParts, IfMissing),
    Version(Version),
    Kernel(IfMissing),
    /// Runs the soak test with these arguments: the duration and the levels.
    Soak(Vec<String>),
    Stand(IfMissing),
    /// Runs the fuzzer with these arguments: the duration and the doors.
    Fuzz(Vec<String>),
    Scans,
    Package(Package),
    Rapier,
    Bevy(Bevy, IfMissing),
    Python(Python, IfMissing),
    Help,
}

impl Task {
    pub fn parse(arguments: &[String]) -> Result<Task, String> {
        let own = arguments
            .split(|word| word == "--")
            .next()
            .unwrap_or_default();
        let words: Vec<&str> = own.iter().map(String::as_str).collect();
        let has_separator = own.len() < arguments.len();
        let for_game = arguments.iter().skip(own.len() + 1).cloned().collect();
        if words.iter().any(|word| matches!(*word, "--help" | "-h")) {
            return Ok(Task::Help);
        }
        let task = match words[..] {
            [] => return Err("no task given".to_string()),
            ["play"] => return Ok(Task::Play(IfMissing::Install, for_game)),
            ["play", "--no-install"] => return Ok(Task::Play(IfMissing::Say, for_game)),
            ["play", ..] => {
                return Err(format!(
                    "arguments for the game belong after `--`: cargo xtask play -- {}",
                    words[1..].join(" ")
                ));
            }
            ["test"] => Task::Test(IfMissing::Install),
            ["test", "--no-install"] => Task::Test(IfMissing::Say),
            ["check"] => Task::Check(IfMissing::Install),
            ["check", "--no-install"] => Task::Check(IfMissing::Say),
            ["wasm"] => Task::Wasm(IfMissing::Say),
            ["wasm", "--install"] => Task::Wasm(IfMissing::Install),
            ["web", ..] => web(&words[1..])?,
            ["arm"] => Task::Arm(IfMissing::Say),
            ["arm", "--install"] => Task::Arm(IfMissing::Install),
            ["windows"] => Task::Windows(IfMissing::Say),
            ["windows", "--install"] => Task::Windows(IfMissing::Install),
            ["release", ..] => parts(&words[1..])?,
            ["version", version] => Task::Version(Version::parse(version)?),
            ["kernel"] => Task::Kernel(IfMissing::Say),
            ["kernel", "--install"] => Task::Kernel(IfMissing::Install),
            ["soak", ..] => Task::Soak(own[1..].to_vec()),
            ["stand"] => Task::Stand(IfMissing::Say),
            ["stand", "--install"] => Task::Stand(IfMissing::Install),
            ["fuzz", ..] => Task::Fuzz(own[1..].to_vec()),
            ["scans"] => Task::Scans,
            ["package"] => Task::Package(Package::List),
            ["package", "--build"] => Task::Package(Package::Build),
            ["rapier"] => Task::Rapier,
            ["bevy"] => Task::Bevy(Bevy::Check, IfMissing::Say),
            ["bevy", "--pictures"] => Task::Bevy(Bevy::Pictures, IfMissing::Say),
            ["bevy", "--pictures", "--install"] => Task::Bevy(Bevy::Pictures, IfMissing::Install),
            ["python"] => Task::Python(Python::Check, IfMissing::Say),
            ["python", "--install"] => Task::Python(Python::Check, IfMissing::Install),
            ["python", "--wheels"] => Task::Python(Python::Wheels, IfMissing::Say),
            ["python", "--wheels", "--install"] => Task::Python(Python::Wheels, IfMissing::Install),
            ["help"] => Task::Help,
            _ => return Err(format!("unknown task `{}`", arguments.join(" "))),
        };
        if has_separator {
            return Err(format!(
                "only `play` accepts arguments after `--`, not `{}`",
                words[0]
            ));
        }
        Ok(task)
    }
}

/// Parses the arguments of `web`.
fn web(words: &[&str]) -> Result<Task, String> {
    let (web, rest) = match words {
        ["--serve", rest @ ..] => (Web::Serve, rest),
        ["--test", rest @ ..] => (Web::Test, rest),
        ["--address", address, rest @ ..] => (Web::Build(Some(address_of_page(address)?)), rest),
        rest => (Web::Build(None), rest),
    };
    match rest {
        [] => Ok(Task::Web(web, IfMissing::Say)),
        ["--install"] => Ok(Task::Web(web, IfMissing::Install)),
        _ => Err(format!("unknown task `web {}`", words.join(" "))),
    }
}

/// Parses the arguments of `release`.
fn parts(words: &[&str]) -> Result<Task, String> {
    let (if_missing, parts) = match words {
        ["--install", parts @ ..] => (IfMissing::Install, parts),
        parts => (IfMissing::Say, parts),
    };
    match parts
        .iter()
        .find(|part| !release::names().any(|name| name == **part))
    {
        Some(part) => Err(format!("unknown part `{part}` of a release")),
        None => {
            let parts = parts.iter().map(ToString::to_string).collect();
            Ok(Task::Release(ReleaseParts { parts }, if_missing))
        }
    }
}

/// Checks that a word is a web address to which file names can be appended.
fn address_of_page(word: &str) -> Result<String, String> {
    let is_whole = word.starts_with("https://") || word.starts_with("http://");
    let is_plain = !word.contains(['"', '<', '>', '&', '#', '?']);
    match is_whole && is_plain && word.ends_with('/') {
        true => Ok(word.to_string()),
        false => Err(format!(
            "invalid address: expected https://…/ with a slash at the end, found `{word}`"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(line: &str, expect: Result<Task, &str>) {
        let arguments: Vec<String> = line.split_whitespace().map(str::to_string).collect();
        assert_eq!(
            Task::parse(&arguments),
            expect.map_err(str::to_string),
            "{line}"
        );
    }

    #[test]
    fn parse_accepts_known_tasks_only() {
        check("check", Ok(Task::Check(IfMissing::Install)));
        check("check --no-install", Ok(Task::Check(IfMissing::Say)));
        check("test", Ok(Task::Test(IfMissing::Install)));
        check("test --no-install", Ok(Task::Test(IfMissing::Say)));
        check("wasm", Ok(Task::Wasm(IfMissing::Say)));
        check("wasm --install", Ok(Task::Wasm(IfMissing::Install)));
        check("web", Ok(Task::Web(Web::Build(None), IfMissing::Say)));
        check(
            "web --address https://example.org/tamaire/ --install",
            Ok(Task::Web(
                Web::Build(Some("https://example.org/tamaire/".into())),
                IfMissing::Install,
            )),
        );
        check(
            "web --address example.org",
            Err(
                "invalid address: expected https://…/ with a slash at the end, found `example.org`",
            ),
        );
        check(
            "web --test --install",
            Ok(Task::Web(Web::Test, IfMissing::Install)),
        );
        check("arm", Ok(Task::Arm(IfMissing::Say)));
        check("windows --install", Ok(Task::Windows(IfMissing::Install)));
        let parts = |parts: &[&str]| ReleaseParts {
            parts: parts.iter().map(ToString::to_string).collect(),
        };
        check("release", Ok(Task::Release(parts(&[]), IfMissing::Say)));
        check(
            "release --install deb sums",
            Ok(Task::Release(parts(&["deb", "sums"]), IfMissing::Install)),
        );
        check("release rpm", Err("unknown part `rpm` of a release"));
        check(
            "version 1.2.3",
            Ok(Task::Version(Version::parse("1.2.3").unwrap())),
        );
        check(
            "version 1.2",
            Err("invalid version: expected three numbers such as 0.2.0, found `1.2`"),
        );
        check("web --fast", Err("unknown task `web --fast`"));
        check("kernel", Ok(Task::Kernel(IfMissing::Say)));
        check("kernel --install", Ok(Task::Kernel(IfMissing::Install)));
        check("stand --install", Ok(Task::Stand(IfMissing::Install)));
        check("soak", Ok(Task::Soak(Vec::new())));
        check(
            "soak 2 hoop",
            Ok(Task::Soak(vec!["2".into(), "hoop".into()])),
        );
        check("scans", Ok(Task::Scans));
        check("package", Ok(Task::Package(Package::List)));
        check("package --build", Ok(Task::Package(Package::Build)));
        check("scans twice", Err("unknown task `scans twice`"));
        check("bevy", Ok(Task::Bevy(Bevy::Check, IfMissing::Say)));
        check(
            "bevy --pictures --install",
            Ok(Task::Bevy(Bevy::Pictures, IfMissing::Install)),
        );
        check("bevy --install", Err("unknown task `bevy --install`"));
        check("python", Ok(Task::Python(Python::Check, IfMissing::Say)));
        check(
            "python --wheels --install",
            Ok(Task::Python(Python::Wheels, IfMissing::Install)),
        );
        check("fuzz 1 png", Ok(Task::Fuzz(vec!["1".into(), "png".into()])));
        for line in [
            "help",
            "--help",
            "soak --help",
            "play -h",
            "kernel --help",
            "check --help",
        ] {
            check(line, Ok(Task::Help));
        }
        check("", Err("no task given"));
        check("chekc", Err("unknown task `chekc`"));
        check("test fast", Err("unknown task `test fast`"));
        check("test --install", Err("unknown task `test --install`"));
        check(
            "test -- fast",
            Err("only `play` accepts arguments after `--`, not `test`"),
        );
    }

    #[test]
    fn parse_passes_arguments_after_separator_to_game() {
        let play = |if_missing, words: &[&str]| {
            let words = words.iter().map(ToString::to_string).collect();
            Ok(Task::Play(if_missing, words))
        };
        check("play", play(IfMissing::Install, &[]));
        check("play --", play(IfMissing::Install, &[]));
        check("play --no-install", play(IfMissing::Say, &[]));
        check(
            "play -- --level classic",
            play(IfMissing::Install, &["--level", "classic"]),
        );
        check("play -- --help", play(IfMissing::Install, &["--help"]));
        check(
            "play --no-install -- a.png",
            play(IfMissing::Say, &["a.png"]),
        );
        // After the first `--`, both the flag and a second `--` belong to the game.
        check(
            "play -- --no-install -- x",
            play(IfMissing::Install, &["--no-install", "--", "x"]),
        );
        check(
            "play --level classic",
            Err("arguments for the game belong after `--`: cargo xtask play -- --level classic"),
        );
    }
}
