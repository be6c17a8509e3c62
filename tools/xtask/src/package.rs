//! Packages of the crates that can be published.

use crate::shell::{Failure, cargo, execute, output_of, root, target};
use std::path::Path;
use std::process::Command;

/// Task for the packages.
#[derive(Debug, PartialEq)]
pub enum Package {
    /// Packs all crates, and checks the contents and sizes of their packages.
    List,
    /// Builds all crates from their packages with the minimum supported Rust version (MSRV).
    Build,
}

/// Published crates, each with the folders in its package. Crates of the game and crates that only tests use
/// are marked `publish = false`.
const CRATES: [(&str, &[&str]); 10] = [
    ("engine/fuwafuwa", &["src", "guide", "examples"]),
    ("engine/fuwafuwa_scenes", &["src", "scenes"]),
    ("engine/fuwafuwa_render", &["src"]),
    ("engine/fuwafuwa_painter", &["src"]),
    ("engine/fuwafuwa_scan", &["src"]),
    ("apps/fuwafuwa_cli", &["src"]),
    ("apps/fuwafuwa_manual", &["src"]),
    ("apps/fuwafuwa_output", &["src"]),
    ("devices/force_feedback", &["src"]),
    ("devices/sticks", &["src", "examples"]),
];

/// Published crate in a separate workspace, with the folders in its package. Cargo can pack this crate only
/// once the crates of the main workspace are on a registry. Until then, only the contents of its package are
/// checked.
const BEVY: (&str, &[&str]) = ("plugins/bevy_fuwafuwa", &["src"]);

/// Returns the name of the crate in a folder.
fn name_of(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

/// Files that a package may contain outside of its folders. Cargo writes the first four.
const FILES: [&str; 7] = [
    ".cargo_vcs_info.json",
    "Cargo.lock",
    "Cargo.toml",
    "Cargo.toml.orig",
    "README.md",
    "LICENSE-APACHE",
    "LICENSE-MIT",
];

/// Maximum size of a compressed package [bytes], a tenth of the limit of crates.io.
const MOST_BYTES: u64 = 1 << 20;

pub fn run(package: Package) -> Result<(), Failure> {
    for (path, folders) in CRATES.into_iter().chain([BEVY]) {
        check_list(path, folders)?;
    }
    match package {
        Package::List => {
            pack(&["--no-verify"], &[])?;
            CRATES
                .iter()
                .try_for_each(|(path, _)| check_size(name_of(path)))
        }
        Package::Build => {
            let oldest = field("rust-version")?;
            let toolchain = toolchain_of(&oldest).ok_or_else(|| Failure::cannot(format!(
                    "Rust {oldest}, the minimum supported version, is neither active nor installed by \
                     rustup: run `rustup toolchain install {oldest} --profile minimal`"
                )))?;
            pack(&[], &toolchain)
        }
    }
}

/// Returns the rustup argument that selects a Rust version, such as `+1.96`. The result is empty if that
/// version is active, because cargo without rustup accepts no such argument.
fn toolchain_of(version: &str) -> Option<Vec<String>> {
    let candidates = [
        Vec::new(),
        vec![format!("+{version}")],
        vec![format!("+{version}.0")],
    ];
    let is_it = |words: &Vec<String>| {
        let words = words.iter().map(String::as_str).chain(["--version"]);
        let answer = output_of("rustc", &words.collect::<Vec<_>>());
        answer.is_some_and(|answer| answer.starts_with(&format!("rustc {version}.")))
    };
    candidates.into_iter().find(is_it)
}

/// Packs all crates in one command, so that they find each other although none is published.
fn pack(words: &[&str], toolchain: &[String]) -> Result<(), Failure> {
    let mut command = match toolchain {
        [] => cargo(),
        // Uses the `cargo` of rustup, which can select a version. The running cargo is another version.
        _ => Command::new("cargo"),
    };
    command.args(toolchain);
    command
        .args(["package", "--quiet", "--allow-dirty"])
        .args(words);
    for (path, _) in CRATES {
        command.args(["--package", name_of(path)]);
    }
    execute(
        &mut command,
        "a crate needs a file outside of its package, or an unavailable version, see above",
    )
}

/// Checks that a package contains exactly the intended files.
fn check_list(path: &str, folders: &[&str]) -> Result<(), Failure> {
    let name = name_of(path);
    let manifest = root().join(path).join("Cargo.toml");
    let manifest = manifest.display().to_string();
    let words = ["--list", "--quiet", "--allow-dirty", "--manifest-path"];
    let program = cargo().get_program().to_string_lossy().into_owned();
    let words = [&["package"], &words[..], &[&manifest]].concat();
    let list = output_of(&program, &words).ok_or_else(|| Failure::failed(format!(
        "the contents of package {name} cannot be listed: run `cargo package --list --manifest-path {manifest}`"
    )))?;
    let wrong = complaints(&list, folders);
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(Failure::failed(format!(
            "package {name} {}",
            wrong.join("; ")
        ))),
    }
}

/// Returns a complaint for each unexpected and each missing file of a package.
fn complaints(list: &str, folders: &[&str]) -> Vec<String> {
    let is_meant = |file: &str| match file.split_once(['/', '\\']) {
        Some((folder, _)) => folders.contains(&folder),
        None => FILES.contains(&file),
    };
    let strange = list.lines().filter(|file| !is_meant(file));
    let strange = strange.map(|file| format!("has the unexpected file {file}"));
    let needed = FILES
        .iter()
        .skip(2)
        .filter(|file| **file != "Cargo.toml.orig");
    let missing = needed.filter(|file| !list.lines().any(|line| line == **file));
    let missing = missing.map(|file| format!("lacks {file}"));
    strange.chain(missing).collect()
}

fn check_size(name: &str) -> Result<(), Failure> {
    let version = field("version")?;
    let file = root()
        .join(target())
        .join("package")
        .join(format!("{name}-{version}.crate"));
    let bytes = size(&file)?;
    println!("{name} {version}: {} KiB", bytes.div_ceil(1024));
    match bytes <= MOST_BYTES {
        true => Ok(()),
        false => Err(Failure::failed(format!(
            "package {name} has {bytes} bytes, more than the limit of {MOST_BYTES}: check its contents"
        ))),
    }
}

fn size(file: &Path) -> Result<u64, Failure> {
    let found = std::fs::metadata(file).map(|file| file.len());
    found.map_err(|error| {
        Failure::failed(format!("{}: cannot read its size: {error}", file.display()))
    })
}

/// Returns the value of a field of `[workspace.package]` in the manifest of the workspace.
fn field(name: &str) -> Result<String, Failure> {
    let manifest = root().join("Cargo.toml");
    let text = std::fs::read_to_string(&manifest);
    let text = text.map_err(|error| Failure::failed(format!("{}: {error}", manifest.display())))?;
    value_of(&text, name)
        .ok_or_else(|| Failure::failed(format!("Cargo.toml: missing field {name}")))
}

/// Returns the quoted value of a field.
fn value_of(text: &str, name: &str) -> Option<String> {
    let mut lines = text.lines().filter_map(|line| line.split_once(" = "));
    let (_, value) = lines.find(|(own, _)| *own == name)?;
    Some(value.trim().trim_matches('"').to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn complaints_list_unexpected_and_missing_files() {
        let good = "Cargo.lock\nCargo.toml\nCargo.toml.orig\nLICENSE-APACHE\nLICENSE-MIT\nREADME.md\nsrc/lib.rs";
        assert_eq!(complaints(good, &["src"]), [] as [String; 0]);
        let bad = good.replace("README.md\n", "tests/tidy.rs\nnotes.txt\n");
        assert_eq!(
            complaints(&bad, &["src"]),
            [
                "has the unexpected file tests/tidy.rs",
                "has the unexpected file notes.txt",
                "lacks README.md"
            ]
        );
    }

    #[test]
    fn crates_are_packed_or_private() {
        let mut seen = 0;
        let groups = ["engine", "game", "devices", "apps", "plugins", "tools"];
        let folders = groups.map(|group| fs::read_dir(root().join(group)).unwrap());
        for folder in folders.into_iter().flatten() {
            let folder = folder.unwrap().path();
            let name = folder.strip_prefix(root()).unwrap().to_str().unwrap();
            let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
            let is_private = manifest.contains("\npublish = false\n");
            let is_packed = CRATES.iter().chain([&BEVY]).any(|(own, _)| *own == name);
            assert!(
                is_private != is_packed,
                "{name}: either add it to CRATES or set publish = false"
            );
            seen += 1;
        }
        assert!(seen > CRATES.len());
    }

    #[test]
    fn documents_name_the_same_msrv() {
        let oldest =
            field("rust-version").unwrap_or_else(|_| panic!("Cargo.toml has no rust-version"));
        let says = format!("Rust {oldest}");
        let packed = CRATES.iter().map(|(path, _)| format!("{path}/README.md"));
        let documents = [
            "README.md",
            "CONTRIBUTING.md",
            "plugins/bevy_fuwafuwa/README.md",
        ];
        for document in documents.map(str::to_string).into_iter().chain(packed) {
            let text = fs::read_to_string(root().join(&document)).unwrap();
            assert!(text.contains(&says), "{document} does not say {says}");
        }
        let bevy = fs::read_to_string(root().join("plugins/bevy_fuwafuwa/Cargo.toml")).unwrap();
        assert_eq!(value_of(&bevy, "rust-version"), Some(oldest));
    }
}
