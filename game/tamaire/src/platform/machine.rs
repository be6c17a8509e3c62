//! How the machine is on which a stand runs, and the file that says what the stand is like.

use super::files::{Files, data_folder};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tamaire_logbook::Moment;

/// How much memory the program takes [bytes], where the system tells.
pub fn memory() -> Option<u64> {
    memory_stats::memory_stats().map(|stats| stats.physical_mem as u64)
}

/// Where a stand keeps things: the folder that its operator chose, or one in that of the game.
#[derive(Clone, Debug, PartialEq)]
pub struct StandFolder(pub PathBuf);

impl StandFolder {
    /// The one that was chosen, if any.
    pub fn of(chosen: Option<&str>) -> Self {
        // Where the system names no folder it is the one that the program was started in.
        let usual = || data_folder().unwrap_or_else(|| ".".into()).join("exhibit");
        Self(chosen.map_or_else(usual, PathBuf::from))
    }

    /// Its logbook.
    pub fn logbook(&self) -> PathBuf {
        self.0.join("visits.sqlite")
    }

    /// A copy of that, as of a moment.
    pub fn copy(&self, at: Moment) -> PathBuf {
        self.0.join(format!("visits-{}.sqlite", digits(at)))
    }

    /// What the game itself keeps there: clips, and how sticks are built in.
    pub fn files(&self) -> Files {
        Files::in_folder(&self.0)
    }

    /// How much room is left there [bytes], where the system tells.
    pub fn room(&self) -> Option<u64> {
        fs4::available_space(&self.0).ok()
    }
}

/// A moment in the name of a file.
pub fn digits(at: Moment) -> String {
    let text = at.to_string();
    text.chars().filter(char::is_ascii_alphanumeric).collect()
}

/// A text file that an operator writes, and that is changed now and then.
#[derive(Clone, Debug, PartialEq)]
pub struct TextFile(pub PathBuf);

impl TextFile {
    /// What it says; `usual`, which is written, where there is none yet.
    ///
    /// # Errors
    /// The file, and what the system says.
    pub fn read_or(&self, usual: &str) -> Result<String, String> {
        match fs::read_to_string(&self.0) {
            Ok(text) => Ok(text),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                self.write(usual)?;
                Ok(usual.into())
            }
            Err(error) => Err(self.named(&error)),
        }
    }

    /// Writes it, whole or not at all.
    ///
    /// # Errors
    /// The file, and what the system says.
    pub fn write(&self, text: &str) -> Result<(), String> {
        let folder = self.0.parent().filter(|folder| *folder != Path::new(""));
        let folder = folder.unwrap_or(Path::new("."));
        let written = fs::create_dir_all(folder).and_then(|()| {
            let mut draft = tempfile::NamedTempFile::new_in(folder)?;
            draft.write_all(text.as_bytes())?;
            draft.as_file().sync_all()?;
            if let Ok(old) = fs::metadata(&self.0) {
                // Others may have to read it.
                draft.as_file().set_permissions(old.permissions())?;
            }
            draft.persist(&self.0).map_err(|error| error.error)?;
            Ok(())
        });
        written.map_err(|error| self.named(&error))
    }

    fn named(&self, error: &io::Error) -> String {
        format!("{}: {error}", self.0.display())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_missing_is_written_as_it_usually_is() {
        let folder = tempfile::tempdir().unwrap();
        let file = TextFile(folder.path().join("new/exhibit.toml"));
        assert_eq!(file.read_or("a = 1").unwrap(), "a = 1");
        file.write("a = 2").unwrap();
        assert_eq!(file.read_or("a = 1").unwrap(), "a = 2");
        let taken = TextFile(folder.path().into());
        let error = taken.write("a = 3").unwrap_err();
        assert!(
            error.starts_with(&folder.path().display().to_string()),
            "{error}"
        );
        assert!(memory().is_none_or(|bytes| bytes > 1 << 20));
        let place = StandFolder(folder.path().into());
        assert!(place.room().is_none_or(|bytes| bytes > 0));
    }
}
