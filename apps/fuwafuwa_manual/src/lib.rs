//! Manual pages and shell completions for a command-line program, generated from its `clap` description.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

use clap::{Args, Command};
use clap_complete::{Shell, generate_to};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Write manual pages and shell completions into a folder
#[derive(Args)]
pub struct Options {
    /// Target folder; receives the subfolders man and completions
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
}

/// Exit status for a folder or file that cannot be written.
const NOT_WRITTEN: u8 = 2;

/// Writes the manual pages and completions of a program into the folder, and reports errors on standard
/// error. Returns the exit status of the program.
pub fn run(command: Command, options: &Options) -> ExitCode {
    let name = command.get_name().to_string();
    match write(command, &options.folder) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            output::warn(format_args!(
                "{name}: {}: {error}",
                options.folder.display()
            ));
            ExitCode::from(NOT_WRITTEN)
        }
    }
}

/// Writes the manual pages and completions of a program into a folder, which is created if missing.
///
/// # Errors
/// If a file cannot be written.
pub fn write(mut command: Command, folder: &Path) -> io::Result<()> {
    let drafts = tempfile::tempdir()?;
    let [pages, completions] = ["man", "completions"].map(|name| drafts.path().join(name));
    fs::create_dir(&pages)?;
    fs::create_dir(&completions)?;
    let name = command.get_name().to_string();
    // Without this, each subcommand would get another page for `help SUBCOMMAND`, with the same text.
    clap_mangen::generate_to(command.clone().disable_help_subcommand(true), &pages)?;
    for shell in [Shell::Bash, Shell::Fish, Shell::Zsh, Shell::PowerShell] {
        generate_to(shell, &mut command, &name, &completions)?;
    }
    for drafts in [pages, completions] {
        let kind = drafts.file_name().unwrap_or_default();
        copy_files(&drafts, &folder.join(kind))?;
    }
    Ok(())
}

/// Copies the files of a folder, each as a whole.
fn copy_files(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        output::write(&to.join(entry.file_name()), &fs::read(entry.path())?)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{Arg, Subcommand};

    fn program() -> Command {
        let sweep = Command::new("sweep").about("Sweep the floor");
        let broom = Arg::new("broom").long("broom").help("With this");
        let secret = Command::new("secret").hide(true);
        let program = Command::new("broomer").version("1.2.3").about("Brooms");
        program.subcommands([sweep.arg(broom), secret])
    }

    #[test]
    fn write_covers_shells_and_visible_subcommands() {
        let folder = tempfile::tempdir().unwrap();
        write(program(), folder.path()).unwrap();
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
        for file in ["broomer.bash", "broomer.fish", "_broomer", "_broomer.ps1"] {
            assert!(read(&format!("completions/{file}")).contains("sweep"));
        }
        assert!(read("man/broomer.1").contains("1.2.3"));
        assert!(read("man/broomer-sweep.1").contains("With this"));
        for page in ["broomer-secret.1", "broomer-help.1"] {
            assert!(!folder.path().join("man").join(page).exists(), "{page}");
        }
    }

    #[test]
    fn write_fails_if_folder_cannot_be_created() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "").unwrap();
        assert!(write(program(), &file).is_err());
    }

    #[test]
    fn options_parse_as_subcommand() {
        #[derive(Subcommand)]
        enum Chore {
            Manual(Options),
        }
        let program = Chore::augment_subcommands(Command::new("broomer"));
        let found = program.try_get_matches_from(["broomer", "manual", "here"]);
        assert_eq!(found.unwrap().subcommand_name(), Some("manual"));
    }
}
