//! Rust toolchains for other targets. rustup's toolchain builds for a target after `rustup target add`.
//! Without it, Debian's packages are used: a compiler and the sources of the standard library, which cargo
//! then builds.

use crate::packages::MissingItem;
use crate::shell::output_of;
use std::env;
use std::path::{Path, PathBuf};

/// Debian's compiler. Its absolute path is given, because another compiler usually comes first on the search
/// path.
const RUSTC: &str = "/usr/bin/rustc";
/// Variables that select Debian's compiler and permit `-Z` options, which stable compilers otherwise refuse.
pub const ENVIRONMENT: [(&str, &str); 2] = [("RUSTC", RUSTC), ("RUSTC_BOOTSTRAP", "1")];
/// Minimum supported Rust version (MSRV) of this workspace.
pub const OLDEST: &str = env!("CARGO_PKG_RUST_VERSION");

/// Debian's compiler.
pub struct Found {
    /// Major version of the compiler's LLVM, which also names the matching linker.
    pub llvm: String,
    /// Sources of the compiler's standard library.
    pub sources: Result<PathBuf, MissingItem>,
}

/// Whether the toolchain in use has the standard library for this target.
pub fn toolchain_has(target: &str) -> bool {
    let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".to_string());
    let library = output_of(&rustc, &["--print", "target-libdir", "--target", target]);
    library.is_some_and(|path| Path::new(path.trim()).is_dir())
}

/// Returns the version output of Debian's compiler, if it is installed.
pub fn description() -> Option<String> {
    output_of(RUSTC, &["--version", "--verbose"])
}

/// Finds Debian's compiler for a target from its version output.
pub fn find(
    target: &str,
    description: Option<&str>,
    exists: impl Fn(&Path) -> bool,
) -> Result<Found, MissingItem> {
    let field = |name| {
        let mut lines = description.unwrap_or_default().lines();
        lines.find_map(|line| line.strip_prefix(name)?.strip_prefix(": "))
    };
    let (Some(release), Some(llvm)) = (field("release"), field("LLVM version")) else {
        let what =
            format!("the Rust toolchain cannot build for {target}, and {RUSTC} does not exist");
        return Err(MissingItem::new(what, "rustc-web"));
    };
    if !is_new_enough(release) {
        let what = format!("{RUSTC} is Rust {release}, but this workspace requires {OLDEST}");
        return Err(MissingItem::new(what, "rustc-web"));
    }
    let sources = PathBuf::from(format!("/usr/src/rustc-{release}/library"));
    let sources = match exists(&sources.join("std")) {
        true => Ok(sources),
        false => {
            let what = format!("no sources in {}", sources.display());
            Err(MissingItem::new(what, "rust-web-src"))
        }
    };
    Ok(Found {
        llvm: llvm.split('.').next().unwrap_or(llvm).to_string(),
        sources,
    })
}

/// Whether a Rust release such as `1.96.0` is at least the MSRV.
fn is_new_enough(release: &str) -> bool {
    let numbers = |version: &str| -> Vec<u32> {
        let parts = version.split('.');
        parts.map_while(|part| part.parse().ok()).collect()
    };
    numbers(release) >= numbers(OLDEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_compare_by_number() {
        assert!(is_new_enough("1.100.0"));
        assert!(is_new_enough("2.0.0"));
        assert!(!is_new_enough("1.9.0"));
        assert!(!is_new_enough("unknown"));
    }
}
