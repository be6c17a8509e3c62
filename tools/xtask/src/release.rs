//! Release files: packages for players, and data to verify the packages. If a part cannot be built on this
//! machine, its failure is reported and the other parts continue.

mod files;
mod kit;
mod linux;
mod programs;
mod trust;
mod windows;

use crate::packages::Purpose::{Build, Listing, Packing, Paging, Zipping};
use crate::packages::{self, IfMissing, Purpose};
use crate::shell::{FAILED, Failure, execute};
use crate::web;
use files::zip;
use kit::{ReleaseBuild, size};
use std::fmt::Write;
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

/// Maximum size of a download for players [bytes]. It takes some seconds on a home connection.
const MOST_BYTES: u64 = 12_000_000;

/// Parts of a release to build.
#[derive(Debug, PartialEq)]
pub struct ReleaseParts {
    /// Names of the parts; empty for all.
    pub parts: Vec<String>,
}

/// Part of a release.
struct Part {
    name: &'static str,
    /// Description of the part's result.
    what: &'static str,
    /// Purposes of the Debian packages that the part needs, besides a compiler.
    needs: &'static [Purpose],
    make: fn(&mut ReleaseBuild) -> Result<(), Failure>,
}

#[rustfmt::skip]
const PARTS: &[Part] = &[
    Part { name: "linux", what: "the programs for this Linux, their manual pages and completions", needs: &[Build, Listing], make: linux::programs },
    Part { name: "deb", what: "a package for Debian and Ubuntu", needs: &[Packing], make: linux::deb },
    Part { name: "tar", what: "an archive for any Linux", needs: &[], make: linux::tar },
    Part { name: "windows", what: "an archive for Windows", needs: &[Listing, Zipping], make: windows::archive },
    Part { name: "web", what: "an archive for a web server", needs: &[Paging, Zipping], make: web_archive },
    Part { name: "sbom", what: "bills of materials", needs: &[Listing], make: trust::bills },
    Part { name: "deny", what: "a check of licences, advisories and duplicates", needs: &[], make: trust::deny },
    Part { name: "sums", what: "SHA-256 sums of all packages", needs: &[], make: trust::sums },
];

/// Names of all parts.
pub fn names() -> impl Iterator<Item = &'static str> {
    PARTS.iter().map(|part| part.name)
}

/// Result of building a part.
enum PartResult {
    Made,
    /// The files of the part exist already, built from the same commit.
    There,
    Not(Failure),
}

/// Builds the parts and reports which exist and which are missing.
pub fn run(wish: &ReleaseParts, if_missing: IfMissing) -> Result<(), Failure> {
    let mut kit = ReleaseBuild::open(if_missing)?;
    let is_wanted =
        |part: &&Part| wish.parts.is_empty() || wish.parts.iter().any(|name| name == part.name);
    let wanted: Vec<&Part> = PARTS.iter().filter(is_wanted).collect();
    if kit.is_dirty() {
        eprintln!("xtask: there are uncommitted changes, so every part is built again");
    }
    let mut table = String::new();
    let mut worst = None;
    for (index, part) in wanted.iter().enumerate() {
        eprintln!(
            "xtask: [{}/{}] {}: {}",
            index + 1,
            wanted.len(),
            part.name,
            part.what
        );
        let began = Instant::now();
        let went = make(part, &mut kit);
        let took = began.elapsed().as_secs();
        let how = match &went {
            PartResult::Made => format!("built in {}:{:02} min", took / 60, took % 60),
            PartResult::There => "exists already".to_string(),
            PartResult::Not(failure) => format!("MISSING: {}", failure.message),
        };
        let _written = writeln!(table, "  {:8} {how}", part.name);
        if let PartResult::Not(failure) = went {
            eprintln!("xtask: {}: {}", part.name, failure.message);
            worst = match worst {
                Some(FAILED) => worst,
                _ => Some(failure.code),
            };
        }
    }
    eprintln!(
        "xtask: {} of {}:\n{table}{}",
        kit.folder().display(),
        kit.commit(),
        kit.contents()?
    );
    match worst {
        None => Ok(()),
        Some(code) => Err(Failure {
            message: "the release is incomplete, see above".to_string(),
            code,
        }),
    }
}

fn make(part: &Part, kit: &mut ReleaseBuild) -> PartResult {
    if kit.has(part.name) {
        return PartResult::There;
    }
    packages::provide(part.needs, kit.if_missing);
    kit.begin(part.name);
    let made = (part.make)(kit)
        .and_then(|()| too_large(kit))
        .and_then(|()| kit.finish());
    match made {
        Ok(()) => PartResult::Made,
        Err(failure) => {
            kit.discard();
            PartResult::Not(for_lack(failure, &packages::lacking(part.needs)))
        }
    }
}

/// Adds the missing packages `lacks` to a failure and marks it as caused by this machine. Without missing
/// packages, the failure is unchanged.
fn for_lack(failure: Failure, lacks: &[&str]) -> Failure {
    match lacks {
        [] => failure,
        _ => Failure::cannot(format!(
            "{}\n           not installed: {}",
            failure.message,
            lacks.join(", ")
        )),
    }
}

/// Refuses a .deb or .zip above the size limit. The .tar.gz for other Linux systems is exempt.
fn too_large(kit: &ReleaseBuild) -> Result<(), Failure> {
    let is_package = |file: &&PathBuf| {
        file.extension()
            .is_some_and(|name| name == "deb" || name == "zip")
    };
    for file in kit.made().iter().filter(is_package) {
        let bytes = size(file)?;
        if bytes > MOST_BYTES {
            let name = file.display();
            let message = format!(
                "{name} has {bytes} bytes, more than the limit of {MOST_BYTES}: see profile.dist in Cargo.toml"
            );
            return Err(Failure::failed(message));
        }
    }
    Ok(())
}

/// Packs the folder of the web page.
fn web_archive(kit: &mut ReleaseBuild) -> Result<(), Failure> {
    web::run(web::Web::Build(None), kit.if_missing)?;
    let site = web::folder().join("site");
    let stage = kit.stage("web")?;
    let name = format!("tamaire-{}-web", kit.version);
    let mut copy = Command::new("cp");
    copy.arg("-r").arg(&site).arg(stage.join(&name));
    execute(&mut copy, "the page could not be copied")?;
    zip(kit, &stage, &name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failure_names_missing_packages() {
        let failure = || Failure::failed("it could not be built");
        assert_eq!(for_lack(failure(), &[]).code, FAILED);
        let named = for_lack(failure(), &["cmake", "zip"]);
        assert_eq!(named.code, crate::shell::CANNOT);
        assert!(named.message.contains("could not be built"));
        assert!(named.message.ends_with("not installed: cmake, zip"));
    }
}
