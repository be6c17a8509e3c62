//! Agreement of the documents with the code.

mod imports;

use imports::{imports, tangle};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn architecture() -> String {
    fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap()
}

/// Returns the rank of each module of the engine, read from the lines with arrows in ARCHITECTURE.md.
fn ranks() -> BTreeMap<String, usize> {
    let text = architecture();
    let start = text
        .find("The order is")
        .expect("ARCHITECTURE.md must contain \"The order is\"");
    let lines = text[start..]
        .lines()
        .skip_while(|line| !line.starts_with("    "));
    let order: String = lines.take_while(|line| line.starts_with("    ")).collect();
    let groups = order.split('→').enumerate();
    groups
        .flat_map(|(rank, group)| {
            group
                .split(',')
                .map(move |name| (name.trim().to_string(), rank))
        })
        .collect()
}

/// Returns the source files of a folder and its subfolders, except for build outputs.
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

/// Returns the modules that a source names after `crate::`, tests excluded.
fn used(source: &str) -> Vec<String> {
    let end = source
        .find("#[cfg(test)]\nmod tests")
        .unwrap_or(source.len());
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let code = source[..end]
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    code.flat_map(|line| line.split("crate::").skip(1))
        .map(|rest| rest.chars().take_while(|&c| is_word(c)).collect())
        .inspect(|name: &String| assert!(!name.is_empty(), "crate:: without module: {source}"))
        .collect()
}

#[test]
fn module_uses_only_modules_before_it() {
    let ranks = ranks();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut seen = 0;
    for path in sources(&folder) {
        let inner = path.strip_prefix(&folder).unwrap();
        let module = inner.iter().next().unwrap().to_str().unwrap();
        let module = module.trim_end_matches(".rs");
        if module == "lib" {
            continue;
        }
        let rank = ranks.get(module);
        let rank =
            rank.unwrap_or_else(|| panic!("ARCHITECTURE.md has no rank for module `{module}`"));
        seen += 1;
        for other in used(&fs::read_to_string(&path).unwrap()) {
            if let Some(above) = ranks.get(&other) {
                let allowed = above < rank || other == module;
                assert!(
                    allowed,
                    "{} uses `{other}`, which does not come before it in ARCHITECTURE.md",
                    inner.display()
                );
            }
        }
    }
    assert!(
        seen >= ranks.len(),
        "found {seen} module files, expected at least {}",
        ranks.len()
    );
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
            let is_ours = ["crates/", "game/", "xtask/", "docs/"]
                .iter()
                .any(|folder| word.starts_with(folder));
            is_plain && (is_ours || word.ends_with(".md"))
        });
        for path in paths {
            assert!(
                root().join(path).exists(),
                "{document} names `{path}`, which does not exist"
            );
        }
    }
}

/// Returns the folders of all crates, including those outside `crates`.
fn crates() -> Vec<PathBuf> {
    let listed = fs::read_dir(root().join("crates")).unwrap();
    let listed = listed.map(|entry| entry.unwrap().path());
    let others = ["game", "xtask"].map(|name| root().join(name));
    listed.chain(others).collect()
}

#[test]
fn source_files_have_no_import_cycles() {
    let mut count = 0;
    for folder in crates() {
        let folder = folder.join("src");
        let files = sources(&folder).into_iter().map(|path| {
            let name = path.strip_prefix(&folder).unwrap().to_str().unwrap();
            (name.replace('\\', "/"), fs::read_to_string(&path).unwrap())
        });
        let imports = imports(&files.collect::<Vec<_>>());
        count += imports.values().flatten().count();
        let tangled = tangle(imports);
        assert!(
            tangled.is_empty(),
            "import cycle in {}: {tangled:#?}",
            folder.display()
        );
    }
    assert!(count > 500, "only {count} imports were found");
}

/// A browser has neither paths nor files. The game opens and saves through `platform`, by kind and name, and
/// the libraries below it read only bytes.
#[test]
fn file_access_is_limited_to_platform_and_command_line() {
    let edges = [
        ("game/src", &["platform", "headless", "desktop", "main"][..]),
        ("crates/tamaire_play/src", &[]),
        ("crates/fuwafuwa_scenes/src", &["disk"]),
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
            assert!(!is_named, "{} must not use {word}", path.display());
        }
    }
    assert!(seen > 60, "only {seen} files were found");
}

#[test]
fn source_files_have_at_most_500_lines() {
    const MOST_LINES: usize = 500;
    for path in crates().iter().flat_map(|folder| sources(folder)) {
        let lines = fs::read_to_string(&path).unwrap().lines().count();
        assert!(
            lines <= MOST_LINES,
            "{} has {lines} lines, expected at most {MOST_LINES}",
            path.display()
        );
    }
}
