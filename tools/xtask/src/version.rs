//! Changes the version in all files that contain it. Does not commit.

use crate::shell::{Failure, cargo, execute, output_of, root};
use std::fmt;
use std::fs;

/// Manifest of the workspace, from which most crates inherit their version.
const MAIN: &str = "Cargo.toml";
/// Manifests of other workspaces, each with its own version.
const OTHERS: [&str; 4] = [
    "tools/against_rapier/Cargo.toml",
    "plugins/bevy_fuwafuwa/Cargo.toml",
    "plugins/bevy_fuwafuwa/examples/Cargo.toml",
    "plugins/python/Cargo.toml",
];
const CHANGELOG: &str = "CHANGELOG.md";
/// Sentence of the changelog that the first release removes.
const NOT_YET: &str = " Nothing has been released yet.";
const UNRELEASED: &str = "## [Unreleased]\n";

/// Version of a release.
#[derive(Debug, PartialEq, PartialOrd, Clone, Copy)]
pub struct Version([u32; 3]);

impl Version {
    pub fn parse(text: &str) -> Result<Self, String> {
        let parts: Vec<Option<u32>> = text.split('.').map(number).collect();
        match parts[..] {
            [Some(major), Some(minor), Some(patch)] => Ok(Self([major, minor, patch])),
            _ => Err(format!(
                "invalid version: expected three numbers such as 0.2.0, found `{text}`"
            )),
        }
    }
}

/// Parses a number without leading zeros.
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

/// Sets the version in all manifests and lock files, and starts a new section in the changelog.
pub fn raise(version: &Version) -> Result<(), Failure> {
    let date = output_of("date", &["--utc", "+%Y-%m-%d"]).unwrap_or_default();
    let read = |path: &str| fs::read_to_string(root().join(path));
    let files = manifests()
        .and_then(|manifests| changed(version, date.trim(), &manifests, read))
        .map_err(Failure::failed)?;
    for (path, text) in files {
        let written = fs::write(root().join(&path), text);
        written.map_err(|error| Failure::failed(format!("{path}: {error}")))?;
        eprintln!("xtask: {path}");
    }
    for manifest in [MAIN, OTHERS[0], OTHERS[1], OTHERS[3]] {
        let mut lock = cargo();
        lock.args(["update", "--workspace", "--offline"]);
        lock.args(["--manifest-path", manifest]);
        execute(
            &mut lock,
            "the lock file still has the old version: run this command with a network and without `--offline`",
        )?;
    }
    eprintln!(
        "xtask: the version is now {version}. Review the changelog, run .ci/run, commit, and tag the commit: git tag v{version}"
    );
    Ok(())
}

/// Returns all manifests, including those of other workspaces.
fn manifests() -> Result<Vec<String>, String> {
    let at = root().display().to_string();
    let listed = output_of("git", &["-C", &at, "ls-files", "--", "*Cargo.toml"]);
    let listed = listed.ok_or("`git ls-files` could not list the manifests")?;
    Ok(listed.lines().map(str::to_string).collect())
}

/// Updates the versions that crates of this repository require of each other.
fn ask_for(version: &Version, old: &Version, manifest: &str) -> String {
    let [version, old] = [version, old].map(|version| format!("version = \"{version}\""));
    let lines = manifest.split_inclusive('\n');
    let lines = lines.map(|line| match line.contains("path = \"../") {
        true => line.replace(&old, &version),
        false => line.to_string(),
    });
    lines.collect()
}

/// Returns the changed files with their new contents, or the reason why nothing can be changed.
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
            "the version is already {old}, and {version} is not newer"
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
                "{path}: found version {old} {count} times, expected {}",
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
        return Err(format!(
            "{CHANGELOG}: missing heading `{}`",
            UNRELEASED.trim()
        ));
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
        return Err(format!("README.md: missing text `{}`", said(&old).trim()));
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

    /// Reads a file of the repository. In the text of the changelog, adds an unreleased change, because the
    /// tests need one and the file has none right after a release.
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
    fn version_is_three_plain_numbers() {
        assert_eq!(version("0.12.3").to_string(), "0.12.3");
        for wrong in [
            "", "1", "1.2", "1.2.3.4", "1.2.x", "1.02.3", "v1.2.3", "+1.2.3", "1.2.3-rc",
        ] {
            assert!(Version::parse(wrong).is_err(), "{wrong}");
        }
        assert!(version("0.10.0") > version("0.9.9"));
    }

    /// Uses the files of the repository, so that a changed format is noticed before a release.
    #[test]
    fn changed_updates_all_files_with_the_version() {
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
        // Crates must require the new version of each other, because an older one cannot be built.
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
