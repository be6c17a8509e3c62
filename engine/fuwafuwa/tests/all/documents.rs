//! Checks of the documents in the repository against its files.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the Rust files in a folder and its subfolders, except build output.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("target") {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

#[test]
fn documents_name_existing_paths() {
    for document in [
        "ARCHITECTURE.md",
        "README.md",
        "CONTRIBUTING.md",
        "GLOSSARY.md",
    ] {
        let text = fs::read_to_string(root().join(document)).unwrap();
        let quoted = text.split('`').skip(1).step_by(2);
        let paths = quoted.filter(|word| {
            let is_plain = !word.contains([' ', '*', ':', '<', '(']);
            let is_ours = [
                "engine/", "game/", "devices/", "apps/", "plugins/", "tools/", "docs/",
            ]
            .iter()
            .any(|folder| word.starts_with(folder));
            is_plain && (is_ours || word.ends_with(".md"))
        });
        for path in paths {
            assert!(
                root().join(path).exists(),
                "{document} names `{path}`, but the path does not exist"
            );
        }
    }
}

/// In a browser there are no files or paths. The game therefore opens and saves data only through its module
/// `platform`, which identifies data by kind and name. The libraries below the game receive bytes.
#[test]
fn files_are_used_only_in_platform_and_command_line_modules() {
    let edges = [
        (
            "game/tamaire/src",
            &["platform", "headless", "desktop", "main"][..],
        ),
        ("game/tamaire_play/src", &[]),
        ("apps/app_shell/src", &[]),
        ("engine/fuwafuwa_scenes/src", &["disk"]),
    ];
    let inside = edges.into_iter().flat_map(|(folder, edges)| {
        let folder = root().join(folder);
        let files = sources(&folder);
        let is_inside = move |path: &PathBuf| {
            let inner = path.strip_prefix(&folder).unwrap();
            let first = inner.iter().next().unwrap().to_str().unwrap();
            !edges.contains(&first.trim_end_matches(".rs"))
        };
        files.into_iter().filter(is_inside)
    });
    let mut seen = 0;
    for path in inside {
        seen += 1;
        let text = fs::read_to_string(&path).unwrap();
        let tests = text.find("#[cfg(test)]").unwrap_or(text.len());
        for word in ["std::fs", "std::path", "PathBuf", "Path::", "File::"] {
            let is_named = text[..tests].contains(word);
            assert!(!is_named, "{} uses {word}", path.display());
        }
    }
    assert!(seen > 60, "expected more than 60 files, found {seen}");
}
