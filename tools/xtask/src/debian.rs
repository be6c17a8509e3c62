//! Rust for other systems. rustup's toolchain can build for one after `rustup target add`. Where it has not been told to, or cannot
//! reach its server, Debian's packages do: a compiler, and the sources of its standard library, which cargo then builds too.

use crate::packages::Lack;
use crate::shell::output_of;
use std::env;
use std::path::{Path, PathBuf};

/// Where Debian puts its compiler. The one on the path is usually another.
const RUSTC: &str = "/usr/bin/rustc";
/// Stable compilers refuse `-Z` without the second.
pub const ENVIRONMENT: [(&str, &str); 2] = [("RUSTC", RUSTC), ("RUSTC_BOOTSTRAP", "1")];
/// The oldest Rust that this workspace promises to build with.
pub const OLDEST: &str = env!("CARGO_PKG_RUST_VERSION");

/// Debian's compiler.
pub struct Found {
    /// The number of its LLVM, which linkers bear too.
    pub llvm: String,
    /// Where its standard library is in source.
    pub sources: Result<PathBuf, Lack>,
}

/// Whether the toolchain in use has the standard library for this target.
pub fn toolchain_has(target: &str) -> bool {
    let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".to_string());
    let library = output_of(&rustc, &["--print", "target-libdir", "--target", target]);
    library.is_some_and(|path| Path::new(path.trim()).is_dir())
}

/// What Debian's compiler says about itself, where there is one.
pub fn description() -> Option<String> {
    output_of(RUSTC, &["--version", "--verbose"])
}

/// Debian's compiler, from what it says about itself, to build for this target.
pub fn find(
    target: &str,
    description: Option<&str>,
    exists: impl Fn(&Path) -> bool,
) -> Result<Found, Lack> {
    let field = |name| {
        let mut lines = description.unwrap_or_default().lines();
        lines.find_map(|line| line.strip_prefix(name)?.strip_prefix(": "))
    };
    let (Some(release), Some(llvm)) = (field("release"), field("LLVM version")) else {
        let what = format!("the Rust toolchain cannot build for {target}, and there is no {RUSTC}");
        return Err(Lack::new(what, "rustc-web"));
    };
    if !is_new_enough(release) {
        let what = format!("{RUSTC} is Rust {release}, this workspace needs {OLDEST}");
        return Err(Lack::new(what, "rustc-web"));
    }
    let sources = PathBuf::from(format!("/usr/src/rustc-{release}/library"));
    let sources = match exists(&sources.join("std")) {
        true => Ok(sources),
        false => {
            let what = format!("there are no sources in {}", sources.display());
            Err(Lack::new(what, "rust-web-src"))
        }
    };
    Ok(Found {
        llvm: llvm.split('.').next().unwrap_or(llvm).to_string(),
        sources,
    })
}

/// Whether a release of Rust, such as `1.96.0`, is one that this workspace promises to build with.
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
