//! What can be asked for on the command line.

use crate::bevy::Bevy;
use crate::package::Package;
use crate::packages::IfMissing;
use crate::release::{self, Wish};
use crate::version::Version;
use crate::web::Web;

pub const USAGE: &str = "\
usage: cargo xtask <task>

tasks:
  play [-- WORDS]  builds and opens the game, and hands it the words
  test             all tests in debug, then the engine's in release and on one to eight threads
  check            what a change must pass: formatting, lints, documentation, then all of `test`
  wasm             the golden scenes on wasm32 under Node: the same bits as natively, and how slow?
  wasm --install   the same; what is missing comes from Debian's packages
  web              the game for a browser: a folder that any web server can hand out; where it will
                   stand, --address https://…/ says for those who show a preview of the page
  web --serve      the same, handed out on this machine
  web --test       the same, played in Chromium and Firefox
                   with --install after any of them what is missing comes from Debian's packages
  arm              the golden scenes and 20 rounds of bots on 64-bit ARM, in QEMU: the same bits?
  windows          the same on Windows, in Wine
                   with --install after either what is missing comes from Debian's packages
  release [PART …] packages for those who play, and what lets others check them, in target/packages:
                   linux, deb, tar, windows, web, sbom, deny, sums; what was made from this commit
                   is not made again, and what cannot be made is named at the end
  release --install [PART …]
                   the same; what is missing comes from Debian's packages, and cargo-deny from
                   crates.io
  version X.Y.Z    gives everything this version, and cuts the changelog
  kernel           sticks and their motors against the force feedback of a real kernel, in QEMU
  kernel --install the same; what is missing comes from Debian's or Ubuntu's packages
  soak [MINUTES [LEVEL …]]
                   ten minutes of two hands that do anything, on every level, unless told otherwise
  stand            ten minutes of a stand in public, killed and stopped while it is played
  stand --install  the same; what is missing comes from Debian's packages
  fuzz [MINUTES [DOOR …]]
                   nine minutes of scenes, levels, pictures, replays, settings … that nobody
                   meant, each looking for a way that none before it took
  scans            fetches scans of a brain, MNI152, into target/scans, with the licences beside them
  package          whether the crates that are good for others can be packed, with what they need and
                   no more; and how large that is
  package --build  the same, and builds each from what is packed, with the oldest Rust that it needs
  rapier           whether tools/against_rapier, a workspace of its own, still compiles
  bevy             plugins/bevy_fuwafuwa, a workspace of its own: formatting, lints, tests without a
                   window, documentation, and whether its examples compile
  bevy --pictures  pictures of its scene, taken on a screen that nobody sees
                   with --install what is missing comes from Debian's packages
  help             this text, as does --help after any task; that of the game: play -- --help

On Debian and Ubuntu, `play`, `test` and `check` install the system packages that are missing, as
root or through sudo, after asking if there is a terminal. With --no-install they only name them.

exit status: 0 passed, 1 failed, 2 no such task, 3 this machine lacks what `wasm`, `web`, `arm`,
`windows`, `release`, `kernel`, `scans` or `package --build` needs;
`play` hands on that of the game";

#[derive(Debug, PartialEq)]
pub enum Task {
    /// With what to hand to the game.
    Play(IfMissing, Vec<String>),
    Test(IfMissing),
    Check(IfMissing),
    Wasm(IfMissing),
    Web(Web, IfMissing),
    Arm(IfMissing),
    Windows(IfMissing),
    Release(Wish, IfMissing),
    Version(Version),
    Kernel(IfMissing),
    /// With how long to play, and which levels.
    Soak(Vec<String>),
    Stand(IfMissing),
    /// With how long, and through which doors.
    Fuzz(Vec<String>),
    Scans,
    Package(Package),
    Rapier,
    Bevy(Bevy, IfMissing),
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
                    "what is for the game goes after `--`: cargo xtask play -- {}",
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
            ["help"] => Task::Help,
            _ => return Err(format!("there is no task `{}`", arguments.join(" "))),
        };
        if has_separator {
            return Err(format!(
                "only `play` takes words after `--`, not `{}`",
                words[0]
            ));
        }
        Ok(task)
    }
}

/// `web`, from what stands behind it.
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
        _ => Err(format!("there is no task `web {}`", words.join(" "))),
    }
}

/// `release`, from what stands behind it.
fn parts(words: &[&str]) -> Result<Task, String> {
    let (if_missing, parts) = match words {
        ["--install", parts @ ..] => (IfMissing::Install, parts),
        parts => (IfMissing::Say, parts),
    };
    match parts
        .iter()
        .find(|part| !release::names().any(|name| name == **part))
    {
        Some(part) => Err(format!("a release has no part `{part}`")),
        None => {
            let parts = parts.iter().map(ToString::to_string).collect();
            Ok(Task::Release(Wish { parts }, if_missing))
        }
    }
}

/// An address that names of files can be put behind.
fn address_of_page(word: &str) -> Result<String, String> {
    let is_whole = word.starts_with("https://") || word.starts_with("http://");
    let is_plain = !word.contains(['"', '<', '>', '&', '#', '?']);
    match is_whole && is_plain && word.ends_with('/') {
        true => Ok(word.to_string()),
        false => Err(format!(
            "the address of a page begins with https:// and ends with a slash, not `{word}`"
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
    fn one_known_task_and_nothing_else_is_a_command_line() {
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
                "the address of a page begins with https:// and ends with a slash, not `example.org`",
            ),
        );
        check(
            "web --test --install",
            Ok(Task::Web(Web::Test, IfMissing::Install)),
        );
        check("arm", Ok(Task::Arm(IfMissing::Say)));
        check("windows --install", Ok(Task::Windows(IfMissing::Install)));
        let parts = |parts: &[&str]| Wish {
            parts: parts.iter().map(ToString::to_string).collect(),
        };
        check("release", Ok(Task::Release(parts(&[]), IfMissing::Say)));
        check(
            "release --install deb sums",
            Ok(Task::Release(parts(&["deb", "sums"]), IfMissing::Install)),
        );
        check("release rpm", Err("a release has no part `rpm`"));
        check(
            "version 1.2.3",
            Ok(Task::Version(Version::parse("1.2.3").unwrap())),
        );
        check(
            "version 1.2",
            Err("a version is three numbers, such as 0.2.0, not `1.2`"),
        );
        check("web --fast", Err("there is no task `web --fast`"));
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
        check("scans twice", Err("there is no task `scans twice`"));
        check("bevy", Ok(Task::Bevy(Bevy::Check, IfMissing::Say)));
        check(
            "bevy --pictures --install",
            Ok(Task::Bevy(Bevy::Pictures, IfMissing::Install)),
        );
        check("bevy --install", Err("there is no task `bevy --install`"));
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
        check("chekc", Err("there is no task `chekc`"));
        check("test fast", Err("there is no task `test fast`"));
        check("test --install", Err("there is no task `test --install`"));
        check(
            "test -- fast",
            Err("only `play` takes words after `--`, not `test`"),
        );
    }

    #[test]
    fn the_words_after_the_separator_are_for_the_game() {
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
        // The game's own, both the flag and a further separator.
        check(
            "play -- --no-install -- x",
            play(IfMissing::Install, &["--no-install", "--", "x"]),
        );
        check(
            "play --level classic",
            Err("what is for the game goes after `--`: cargo xtask play -- --level classic"),
        );
    }
}
