//! What is handed out: packages for those who play, and what lets others check them. Each part is made by itself; one that
//! this machine cannot make is named, and the others go on.

mod files;
mod kit;
mod linux;
mod programs;
mod trust;
mod windows;

use crate::packages::Purpose::{Build, Listing, Packing, Paging, Zipping};
use crate::packages::{self, IfMissing, Purpose};
use crate::shell::{CANNOT, FAILED, Failure, execute};
use crate::web;
use files::zip;
use kit::{Kit, size};
use std::fmt::Write;
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

/// What one downloads is a few seconds of a home's line.
const MOST_BYTES: u64 = 12_000_000;

/// Which parts of a release to make.
#[derive(Debug, PartialEq)]
pub struct Wish {
    /// By their names; none stands for all.
    pub parts: Vec<String>,
}

/// A part of a release.
struct Part {
    name: &'static str,
    /// What comes out of it.
    what: &'static str,
    /// What the packages are for that it needs, beside those of a compiler.
    needs: &'static [Purpose],
    make: fn(&mut Kit) -> Result<(), Failure>,
}

#[rustfmt::skip]
const PARTS: &[Part] = &[
    Part { name: "linux", what: "the programs for this Linux, their manual pages and completions", needs: &[Build, Listing], make: linux::programs },
    Part { name: "deb", what: "a package for Debian and Ubuntu", needs: &[Packing], make: linux::deb },
    Part { name: "tar", what: "an archive for any Linux", needs: &[], make: linux::tar },
    Part { name: "windows", what: "an archive for Windows", needs: &[Listing, Zipping], make: windows::archive },
    Part { name: "web", what: "an archive for a web server", needs: &[Paging, Zipping], make: web_archive },
    Part { name: "sbom", what: "bills of materials", needs: &[Listing], make: trust::bills },
    Part { name: "deny", what: "a look at licences, advisories and doubles", needs: &[], make: trust::deny },
    Part { name: "sums", what: "SHA-256 sums of all that", needs: &[], make: trust::sums },
];

/// The names of all parts.
pub fn names() -> impl Iterator<Item = &'static str> {
    PARTS.iter().map(|part| part.name)
}

/// How a part went.
enum Went {
    Made,
    /// It was there, made from the same commit.
    There,
    Not(Failure),
}

/// Makes the parts, and says at the end what there is and what is missing.
pub fn run(wish: &Wish, if_missing: IfMissing) -> Result<(), Failure> {
    let mut kit = Kit::open(if_missing)?;
    let is_wanted =
        |part: &&Part| wish.parts.is_empty() || wish.parts.iter().any(|name| name == part.name);
    let wanted: Vec<&Part> = PARTS.iter().filter(is_wanted).collect();
    if kit.is_dirty() {
        eprintln!(
            "xtask: there are changes that are not committed: no part is taken as made before"
        );
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
            Went::Made => format!("made in {}:{:02} min", took / 60, took % 60),
            Went::There => "there already".to_string(),
            Went::Not(failure) => format!("MISSING: {}", failure.message),
        };
        let _written = writeln!(table, "  {:8} {how}", part.name);
        if let Went::Not(failure) = went {
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
            message: "the release is not whole, see above".to_string(),
            code,
        }),
    }
}

fn make(part: &Part, kit: &mut Kit) -> Went {
    if kit.has(part.name) {
        return Went::There;
    }
    packages::provide(part.needs, kit.if_missing);
    kit.begin(part.name);
    let made = (part.make)(kit)
        .and_then(|()| too_large(kit))
        .and_then(|()| kit.finish());
    match made {
        Ok(()) => Went::Made,
        Err(failure) => {
            kit.discard();
            Went::Not(for_lack(failure, &packages::lacking(part.needs)))
        }
    }
}

/// A failure where packages are missing is theirs, and this machine's.
fn for_lack(failure: Failure, lacks: &[&str]) -> Failure {
    match lacks {
        [] => failure,
        _ => Failure {
            message: format!(
                "{}\n           not installed: {}",
                failure.message,
                lacks.join(", ")
            ),
            code: CANNOT,
        },
    }
}

/// Refuses a package that is larger than it may be. What is for those without packages may be a little larger.
fn too_large(kit: &Kit) -> Result<(), Failure> {
    let is_package = |file: &&PathBuf| {
        file.extension()
            .is_some_and(|name| name == "deb" || name == "zip")
    };
    for file in kit.made().iter().filter(is_package) {
        let bytes = size(file)?;
        if bytes > MOST_BYTES {
            let name = file.display();
            let message = format!(
                "{name} has {bytes} bytes, and {MOST_BYTES} are the most: see profile.dist in Cargo.toml"
            );
            return Err(Failure {
                message,
                code: FAILED,
            });
        }
    }
    Ok(())
}

/// The folder of the page, as it is handed out.
fn web_archive(kit: &mut Kit) -> Result<(), Failure> {
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
    fn what_fails_where_packages_are_missing_names_them_and_is_no_fault() {
        let failure = || Failure {
            message: "it could not be built".to_string(),
            code: FAILED,
        };
        assert_eq!(for_lack(failure(), &[]).code, FAILED);
        let named = for_lack(failure(), &["cmake", "zip"]);
        assert_eq!(named.code, CANNOT);
        assert!(named.message.contains("could not be built"));
        assert!(named.message.ends_with("not installed: cmake, zip"));
    }
}
