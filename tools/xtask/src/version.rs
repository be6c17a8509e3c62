//! One command for the number that stands in many places. It changes files, and commits nothing.

use crate::shell::{FAILED, Failure, cargo, execute, output_of, root};
use std::fmt;
use std::fs;

/// The manifest that most crates take their version from.
const MAIN: &str = "Cargo.toml";
/// Those of the workspaces beside it, which have no part in that.
const OTHERS: [&str; 3] = [
    "tools/against_rapier/Cargo.toml",
    "plugins/bevy_fuwafuwa/Cargo.toml",
    "plugins/bevy_fuwafuwa/examples/Cargo.toml",
];
const CHANGELOG: &str = "CHANGELOG.md";
/// Said until something is.
const NOT_YET: &str = " Nothing has been released yet.";
const UNRELEASED: &str = "## [Unreleased]\n";

/// The number of a release.
#[derive(Debug, PartialEq, PartialOrd, Clone, Copy)]
pub struct Version([u32; 3]);

impl Version {
    pub fn parse(text: &str) -> Result<Self, String> {
        let parts: Vec<Option<u32>> = text.split('.').map(number).collect();
        match parts[..] {
            [Some(major), Some(minor), Some(patch)] => Ok(Self([major, minor, patch])),
            _ => Err(format!(
                "a version is three numbers, such as 0.2.0, not `{text}`"
            )),
        }
    }
}

/// A number as versions have it: without zeros before it.
fn number(text: &str) -> Option<u32> {
    let number: u32 = text.parse().ok()?;
    (number.to_string() == text).then_some(number)
}

impl fmt::Display for Version {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [major, minor, patch] = self.0;
        write!(formatter, "{major}.{minor}.{patch}")
    }
}

/// Gives all manifests and locks this version, and cuts the changelog.
pub fn raise(version: &Version) -> Result<(), Failure> {
    let date = output_of("date", &["--utc", "+%Y-%m-%d"]).unwrap_or_default();
    let read = |path: &str| fs::read_to_string(root().join(path));
    let files = manifests()
        .and_then(|manifests| changed(version, date.trim(), &manifests, read))
        .map_err(|message| Failure {
            message,
            code: FAILED,
        })?;
    for (path, text) in files {
        let written = fs::write(root().join(&path), text);
        written.map_err(|error| Failure {
            message: format!("{path}: {error}"),
            code: FAILED,
        })?;
        eprintln!("xtask: {path}");
    }
    for manifest in [MAIN, OTHERS[0], OTHERS[1], OTHERS[3]] {
        let mut lock = cargo();
        lock.args([
            "update",
            "--workspace",
            "--offline",
            "--manifest-path",
            manifest,
        ]);
        execute(
            &mut lock,
            "its lock file still has the old version: run that where there is a network, without `--offline`",
        )?;
    }
    eprintln!(
        "xtask: this is {version} now. Read the changelog, run .ci/run, commit, and tag the commit: git tag v{version}"
    );
    Ok(())
}

/// All manifests, those of other workspaces too.
fn manifests() -> Result<Vec<String>, String> {
    let at = root().display().to_string();
    let listed = output_of("git", &["-C", &at, "ls-files", "--", "*Cargo.toml"]);
    let listed = listed.ok_or("git is asked which manifests there are, and says nothing")?;
    Ok(listed.lines().map(str::to_string).collect())
}

/// Crates of this repository ask for each other by version, so that they can be published.
fn ask_for(version: &Version, old: &Version, manifest: &str) -> String {
    let [version, old] = [version, old].map(|version| format!("version = \"{version}\""));
    let lines = manifest.split_inclusive('\n');
    let lines = lines.map(|line| match line.contains("path = \"../") {
        true => line.replace(&old, &version),
        false => line.to_string(),
    });
    lines.collect()
}

/// The files that change, with what stands in them then; all, or a reason to change none.
fn changed(
    version: &Version,
    date: &str,
    manifests: &[String],
    read: impl Fn(&str) -> std::io::Result<String>,
) -> Result<Vec<(String, String)>, String> {
    let read = |path: &str| read(path).map_err(|error| format!("{path}: {error}"));
    let main = read(MAIN)?;
    let old = main
        .lines()
        .find_map(|line| line.strip_prefix("version = \"")?.strip_suffix('"'));
    let old = Version::parse(old.ok_or(format!("{MAIN} has no version"))?)?;
    if *version <= old {
        return Err(format!(
            "this is {old} already, and {version} is not above it"
        ));
    }
    let mut files = Vec::new();
    for path in manifests {
        let line = |version: &Version| format!("\nversion = \"{version}\"\n");
        let text = read(path)?;
        let count = text.matches(&line(&old)).count();
        let has_one = path == MAIN || OTHERS.contains(&path.as_str());
        if count != usize::from(has_one) {
            return Err(format!(
                "{path} names version {old} {count} times, not {}",
                usize::from(has_one)
            ));
        }
        let raised = ask_for(version, &old, &text.replace(&line(&old), &line(version)));
        if raised != text {
            files.push((path.clone(), raised));
        }
    }
    let text = read(CHANGELOG)?;
    let Some((head, rest)) = text.split_once(UNRELEASED) else {
        return Err(format!("{CHANGELOG} has no `{}`", UNRELEASED.trim()));
    };
    let changes = rest.split("\n## [").next().unwrap_or_default();
    if !changes.contains("\n- ") {
        return Err(format!(
            "{CHANGELOG} has nothing under `{}`",
            UNRELEASED.trim()
        ));
    }
    let cut = format!(
        "{}{UNRELEASED}\n## [{version}] - {date}\n{rest}",
        head.replace(NOT_YET, "")
    );
    files.push((CHANGELOG.to_string(), cut));
    let text = read("README.md")?;
    let said = |version: &Version| format!("Version {version} ");
    if !text.contains(&said(&old)) {
        return Err(format!("README.md does not say `{}`", said(&old).trim()));
    }
    files.push((
        "README.md".to_string(),
        text.replace(&said(&old), &said(version)),
    ));
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The files as they are, and a change that was not released: right after a release there is none.
    fn read(path: &str) -> std::io::Result<String> {
        let text = fs::read_to_string(root().join(path))?;
        let news = format!("{UNRELEASED}\n### Added\n\n- Something.\n");
        match path {
            CHANGELOG => Ok(text.replace(UNRELEASED, &news)),
            _ => Ok(text),
        }
    }

    fn version(text: &str) -> Version {
        Version::parse(text).unwrap()
    }

    #[test]
    fn a_version_is_three_plain_numbers() {
        assert_eq!(version("0.12.3").to_string(), "0.12.3");
        for wrong in [
            "", "1", "1.2", "1.2.3.4", "1.2.x", "1.02.3", "v1.2.3", "+1.2.3", "1.2.3-rc",
        ] {
            assert!(Version::parse(wrong).is_err(), "{wrong}");
        }
        assert!(version("0.10.0") > version("0.9.9"));
    }

    /// With the files as they are, so that one that takes another shape is found before a release is.
    #[test]
    fn all_files_that_name_the_version_take_another() {
        let next = version("1000.0.0");
        let manifests = manifests().unwrap();
        let files = changed(&next, "2030-01-02", &manifests, read).unwrap();
        let of = |path: &str| {
            let file = files.iter().find(|(found, _)| *found == path);
            file.map(|(_, text)| text.clone())
        };
        for path in [MAIN, CHANGELOG, "README.md"].iter().chain(&OTHERS) {
            assert!(of(path).is_some(), "{path}");
        }
        for (path, text) in &files {
            assert!(text.contains("1000.0.0"), "{path}");
        }
        // A crate that asks for the older one beside it cannot be built.
        for path in &manifests {
            let text = of(path).unwrap_or_else(|| read(path).unwrap());
            let beside = text.lines().filter(|line| line.contains("path = \"../"));
            for line in beside.filter(|line| line.contains("version = ")) {
                assert!(line.contains("version = \"1000.0.0\""), "{path}: {line}");
            }
        }
        let text = |wanted: &str| &files.iter().find(|(path, _)| *path == wanted).unwrap().1;
        let changelog = text(CHANGELOG);
        assert!(changelog.contains("## [Unreleased]\n\n## [1000.0.0] - 2030-01-02\n\n### "));
        assert!(!changelog.contains(NOT_YET));
        let again = |version: &str| {
            changed(&Version::parse(version).unwrap(), "", &manifests, |path| {
                of(path).map_or_else(|| read(path), Ok)
            })
        };
        assert!(again("1000.0.0").unwrap_err().contains("already"));
        assert!(
            again("1000.0.1").unwrap_err().contains("nothing under"),
            "nothing changed since"
        );
    }
}
