//! Reproducible files and archives. Entries are sorted by name, have no owner, and carry the time of the
//! commit.

use super::kit::ReleaseBuild;
use crate::shell::{Failure, file_error, is_on_path, lacking, root};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Reads a file of the repository.
pub fn text_of(path: &str) -> Result<String, Failure> {
    let path = root().join(path);
    fs::read_to_string(&path).map_err(|error| file_error(&path, &error))
}

/// Copies a file, and creates the folders of the target path.
pub fn put(from: &Path, to: &Path) -> Result<(), Failure> {
    make_room(to)?;
    fs::copy(from, to).map_err(|error| file_error(from, &error))?;
    Ok(())
}

/// Writes a text to a file, and creates its folders.
pub fn put_text(text: &str, to: &Path) -> Result<(), Failure> {
    make_room(to)?;
    fs::write(to, text).map_err(|error| file_error(to, &error))
}

fn make_room(path: &Path) -> Result<(), Failure> {
    let folder = path.parent().unwrap_or(path);
    fs::create_dir_all(folder).map_err(|error| file_error(folder, &error))
}

/// Compresses files with gzip, as Debian does with manual pages and changelogs.
pub fn compress(files: &[PathBuf]) -> Result<(), Failure> {
    let mut gzip = Command::new("gzip");
    gzip.args(["--no-name", "--best", "--force"]).args(files);
    run(&mut gzip, "gzip failed; Debian: gzip")
}

/// Sets time and permissions of all files below a folder. The time is that of the commit; programs become
/// executable.
pub fn settle(kit: &ReleaseBuild, folder: &Path) -> Result<(), Failure> {
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
        "times and permissions could not be set: this requires the usual command-line tools of Linux",
    )
}

/// Packs the folder `name` inside `stage` as .tar.gz.
pub fn tar(kit: &mut ReleaseBuild, stage: &Path, name: &str) -> Result<(), Failure> {
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
    execute_in(&mut shell, stage, "GNU tar failed or is missing")?;
    kit.add(archive);
    Ok(())
}

/// Packs the folder `name` inside `stage` as .zip.
pub fn zip(kit: &mut ReleaseBuild, stage: &Path, name: &str) -> Result<(), Failure> {
    if !is_on_path("zip") {
        return Err(lacking("zip", "Debian: zip"));
    }
    settle(kit, &stage.join(name))?;
    let archive = kit.folder().join(format!("{name}.zip"));
    // Removes an existing archive, to which zip would add files.
    let _removed = fs::remove_file(&archive);
    // Uses UTC and leaves out user ids (`-X`), because otherwise archives would differ between machines.
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

/// Runs a command without printing it.
fn run(command: &mut Command, hint: &str) -> Result<(), Failure> {
    let program = Path::new(command.get_program()).to_path_buf();
    let status = command
        .status()
        .map_err(|error| file_error(&program, &error))?;
    match status.success() {
        true => Ok(()),
        false => Err(Failure::failed(format!("{hint} ({status})"))),
    }
}
