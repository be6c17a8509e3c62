//! Files and archives that come out the same each time: in the order of their names, of nobody, with the time of the commit.

use super::kit::Kit;
use crate::shell::{FAILED, Failure, is_on_path, lacking, root, told};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Reads a file of the repository.
pub fn text_of(path: &str) -> Result<String, Failure> {
    let path = root().join(path);
    fs::read_to_string(&path).map_err(|error| told(&path, &error))
}

/// Copies a file to where it belongs, with the folders above it.
pub fn put(from: &Path, to: &Path) -> Result<(), Failure> {
    make_room(to)?;
    fs::copy(from, to).map_err(|error| told(from, &error))?;
    Ok(())
}

/// Writes a file to where it belongs, with the folders above it.
pub fn put_text(text: &str, to: &Path) -> Result<(), Failure> {
    make_room(to)?;
    fs::write(to, text).map_err(|error| told(to, &error))
}

fn make_room(path: &Path) -> Result<(), Failure> {
    let folder = path.parent().unwrap_or(path);
    fs::create_dir_all(folder).map_err(|error| told(folder, &error))
}

/// Compresses files, as manual pages and changelogs are on Debian.
pub fn compress(files: &[PathBuf]) -> Result<(), Failure> {
    let mut gzip = Command::new("gzip");
    gzip.args(["--no-name", "--best", "--force"]).args(files);
    run(&mut gzip, "gzip failed; Debian: gzip")
}

/// Gives all files below a folder the time of the commit and the usual rights; those in `bin` can be run.
pub fn settle(kit: &Kit, folder: &Path) -> Result<(), Failure> {
    let script = r#"
        cd "$1" &&
        find . -type d -exec chmod 755 {} + &&
        find . -type f ! -path '*/bin/*' ! -name '*.exe' -exec chmod 644 {} + &&
        find . -type f \( -path '*/bin/*' -o -name '*.exe' \) -exec chmod 755 {} + &&
        find . -exec touch --no-dereference --date="@$2" {} +
    "#;
    let mut shell = Command::new("sh");
    shell
        .args(["-c", script, "settle"])
        .arg(folder)
        .arg(&kit.epoch);
    run(
        &mut shell,
        "times and rights could not be set: it needs the usual programs of Linux",
    )
}

/// A .tar.gz of a folder in the stage.
pub fn tar(kit: &mut Kit, stage: &Path, name: &str) -> Result<(), Failure> {
    settle(kit, &stage.join(name))?;
    let archive = kit.folder().join(format!("{name}.tar.gz"));
    let script = r#"
        tar --create --sort=name --format=gnu --owner=0 --group=0 --numeric-owner --mtime="@$1" --file "$2.part" "$3" &&
        gzip --no-name --best --stdout "$2.part" > "$2" && rm "$2.part"
    "#;
    let mut shell = Command::new("sh");
    shell
        .args(["-c", script, "tar", &kit.epoch])
        .arg(&archive)
        .arg(name);
    execute_in(&mut shell, stage, "it needs GNU's tar")?;
    kit.add(archive);
    Ok(())
}

/// A .zip of a folder in the stage.
pub fn zip(kit: &mut Kit, stage: &Path, name: &str) -> Result<(), Failure> {
    if !is_on_path("zip") {
        return Err(lacking("zip", "Debian: zip"));
    }
    settle(kit, &stage.join(name))?;
    let archive = kit.folder().join(format!("{name}.zip"));
    // It would be added to.
    let _removed = fs::remove_file(&archive);
    // An archive has local times in it, and two numbers of the user unless it is told not to.
    let script = r#"find "$2" -type f | LC_ALL=C sort | TZ=UTC zip -X -9 -q -@ "$1""#;
    let mut shell = Command::new("sh");
    shell.args(["-c", script, "zip"]).arg(&archive).arg(name);
    execute_in(&mut shell, stage, "zip failed")?;
    kit.add(archive);
    Ok(())
}

/// Runs a script in a folder.
fn execute_in(shell: &mut Command, folder: &Path, hint: &str) -> Result<(), Failure> {
    run(shell.current_dir(folder), hint)
}

/// Runs what nobody wants to read.
fn run(command: &mut Command, hint: &str) -> Result<(), Failure> {
    let program = Path::new(command.get_program()).to_path_buf();
    let status = command.status().map_err(|error| told(&program, &error))?;
    match status.success() {
        true => Ok(()),
        false => Err(Failure {
            message: format!("{hint} ({status})"),
            code: FAILED,
        }),
    }
}
