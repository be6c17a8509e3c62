//! Archive for Windows with self-contained programs.

use super::files::{put, put_text, zip};
use super::kit::ReleaseBuild;
use super::programs;
use crate::cross::{WINDOWS, Wanted};
use crate::shell::{Failure, file_error, lacking, output_of, root};
use std::fs;
use std::path::Path;

/// Names of compiler libraries that are not part of Windows. A program for players must not require them.
const NOT_THERE: [&str; 4] = ["libgcc", "libstdc++", "libwinpthread", "libssp"];

/// Builds and packs both programs.
pub fn archive(kit: &mut ReleaseBuild) -> Result<(), Failure> {
    let compiler = WINDOWS.compiler(
        Wanted::Build,
        kit.if_missing,
        "nothing was built for Windows",
    )?;
    let built = programs::build(kit, Some(&compiler))?;
    let stage = kit.stage("windows")?;
    let name = format!("tamaire-{}-windows-x86_64", kit.version);
    let folder = stage.join(&name);
    for program in ["tamaire.exe", "fuwafuwa.exe"] {
        let path = built.join(program);
        check_imports(&path)?;
        programs::put_stripped(
            kit,
            &path,
            &folder.join(program),
            "x86_64-w64-mingw32-strip",
        )?;
    }
    put(
        &programs::licences(kit, WINDOWS.triple)?,
        &folder.join("licences.txt"),
    )?;
    for (from, to) in [
        ("packaging/windows/README.txt", "README.txt"),
        ("LICENSE-MIT", "LICENSE-MIT.txt"),
        ("LICENSE-APACHE", "LICENSE-APACHE.txt"),
    ] {
        let path = root().join(from);
        let text = fs::read_to_string(&path).map_err(|error| file_error(&path, &error))?;
        let text = text.replace("\r\n", "\n").replace('\n', "\r\n");
        put_text(&text, &folder.join(to))?;
    }
    zip(kit, &stage, &name)
}

/// Refuses a program that requires a library that Windows lacks.
fn check_imports(program: &Path) -> Result<(), Failure> {
    let path = program.display().to_string();
    let Some(text) = output_of("x86_64-w64-mingw32-objdump", &["-p", &path]) else {
        return Err(lacking(
            "x86_64-w64-mingw32-objdump",
            "Debian: binutils-mingw-w64-x86-64",
        ));
    };
    let foreign =
        imports(&text).filter(|name| NOT_THERE.iter().any(|other| name.starts_with(other)));
    let foreign: Vec<&str> = foreign.collect();
    match foreign[..] {
        [] => Ok(()),
        _ => Err(Failure::failed(format!(
            "{path} requires {}, which is not part of Windows",
            foreign.join(", ")
        ))),
    }
}

/// Returns the libraries in the output of objdump.
fn imports(text: &str) -> impl Iterator<Item = &str> {
    text.lines()
        .filter_map(|line| line.trim().strip_prefix("DLL Name: "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imports_are_found_in_objdump_output() {
        let text = "\tDLL Name: KERNEL32.dll\n\tvma: x\n\n\tDLL Name: libgcc_s_seh-1.dll\n";
        assert_eq!(
            imports(text).collect::<Vec<_>>(),
            ["KERNEL32.dll", "libgcc_s_seh-1.dll"]
        );
    }
}
