//! Neutral names for local folders in release builds, so that no local path leaks and builds are reproducible
//! elsewhere.

use crate::shell::{root, target};
use std::env;
use std::path::{Path, PathBuf};

/// Returns local folders with their neutral names. If a path is in several of the folders, the last one
/// replaces it.
pub fn names() -> Vec<(String, &'static str)> {
    let home = env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(env::home_dir()?.join(".cargo")));
    let mut names = Vec::new();
    let mut name = |path: &Path, short| names.push((path.display().to_string(), short));
    if let Some(home) = home {
        name(&home, "/cargo");
    }
    name(root(), "/tamaire");
    name(&root().join(target()), "/target");
    names
}

/// Returns rustc flags in the format of the variable `CARGO_ENCODED_RUSTFLAGS`. `names` are local folders and
/// the neutral names that replace them. The separator of the flags is U+001F, which does not occur in paths.
pub fn encoded<'a>(flags: impl IntoIterator<Item = &'a str>, names: &[(String, &str)]) -> String {
    let flags = flags.into_iter().map(str::to_string);
    let names = names
        .iter()
        .map(|(from, to)| format!("--remap-path-prefix={from}={to}"));
    flags.chain(names).collect::<Vec<_>>().join("\u{1f}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encoded_keeps_folder_with_space_in_one_flag() {
        let names = [("/my home".to_string(), "/cargo")];
        let flags = encoded(["-Ctarget-feature=+simd128"], &names);
        assert_eq!(
            flags.split('\u{1f}').collect::<Vec<_>>(),
            [
                "-Ctarget-feature=+simd128",
                "--remap-path-prefix=/my home=/cargo"
            ]
        );
    }

    /// The target folder may be inside the root, so its name must come later.
    #[test]
    fn names_list_inner_folder_after_outer() {
        let names = names();
        let place = |short| names.iter().position(|(_, name)| *name == short);
        assert!(place("/tamaire") < place("/target"));
    }
}
