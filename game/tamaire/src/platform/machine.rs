//! Computer of a stand: memory, folders, and the configuration file.

use super::files::{Files, data_folder};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tamaire_logbook::Moment;

/// Memory used by the program [bytes]. `None` if the system does not tell.
pub fn memory() -> Option<u64> {
    memory_stats::memory_stats().map(|stats| stats.physical_mem as u64)
}

/// Data folder of a stand: the folder chosen by the operator, or a subfolder of the game's data folder.
#[derive(Clone, Debug, PartialEq)]
pub struct StandFolder(pub PathBuf);

impl StandFolder {
    /// Returns the chosen folder, or the default one.
    pub fn of(chosen: Option<&str>) -> Self {
        // If the system has no data folder, the current directory is used.
        let usual = || data_folder().unwrap_or_else(|| ".".into()).join("exhibit");
        Self(chosen.map_or_else(usual, PathBuf::from))
    }

    /// Path of the logbook.
    pub fn logbook(&self) -> PathBuf {
        self.0.join("visits.sqlite")
    }

    /// Path of a copy of the logbook, with the time of the copy in its name.
    pub fn copy(&self, at: Moment) -> PathBuf {
        self.0.join(format!("visits-{}.sqlite", digits(at)))
    }

    /// Storage of the game in this folder: clips, and settings with the calibrations of sticks.
    pub fn files(&self) -> Files {
        Files::in_folder(&self.0)
    }

    /// Free disk space [bytes]. `None` if the system does not tell.
    pub fn room(&self) -> Option<u64> {
        fs4::available_space(&self.0).ok()
    }
}

/// Formats a moment for use in a file name.
pub fn digits(at: Moment) -> String {
    let text = at.to_string();
    text.chars().filter(char::is_ascii_alphanumeric).collect()
}

/// Text file that the operator edits and the program changes occasionally.
#[derive(Clone, Debug, PartialEq)]
pub struct TextFile(pub PathBuf);

impl TextFile {
    /// Reads the file. If it does not exist, writes and returns `usual`.
    ///
    /// # Errors
    /// The path and the error of the system.
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

    /// Replaces the file atomically.
    ///
    /// # Errors
    /// The path and the error of the system.
    pub fn write(&self, text: &str) -> Result<(), String> {
        let folder = self.0.parent().filter(|folder| *folder != Path::new(""));
        let folder = folder.unwrap_or(Path::new("."));
        let written = fs::create_dir_all(folder).and_then(|()| {
            let mut draft = tempfile::NamedTempFile::new_in(folder)?;
            draft.write_all(text.as_bytes())?;
            draft.as_file().sync_all()?;
            if let Ok(old) = fs::metadata(&self.0) {
                // Keeps the permissions, because other users may have to read the file.
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
    fn missing_text_file_is_created_with_default() {
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
