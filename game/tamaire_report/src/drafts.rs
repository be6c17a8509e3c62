//! Files that appear in a folder only when all of them are complete.

use crate::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Files in a folder that are still written under temporary names. [`Drafts::keep`] gives them their final
/// names; dropping without it deletes them.
#[derive(Debug)]
pub struct Drafts {
    folder: PathBuf,
    is_new: bool,
    all: Vec<Draft>,
}

/// A file being written.
#[derive(Debug)]
pub struct Draft {
    path: PathBuf,
    file: output::Draft,
}

impl Drafts {
    /// Prepares a folder for new files. Creates the folder if it does not exist.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn new(folder: &Path) -> Result<Self, Error> {
        let is_new = !folder.exists();
        let made = std::fs::create_dir_all(folder);
        made.map_err(|error| Error::unwritable(folder, error))?;
        let all = Vec::new();
        let folder = folder.into();
        let drafts = Self {
            folder,
            is_new,
            all,
        };
        // Creates a file now, so that an unwritable folder is reported before the work of an hour.
        drafts.begin("index.html")?;
        Ok(drafts)
    }

    /// Starts a file that will have the name `name` in the folder.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn begin(&self, name: &str) -> Result<Draft, Error> {
        let path = self.folder.join(name);
        let file = output::Draft::begin(&path);
        let file = file.map_err(|error| Error::unwritable(&path, error))?;
        Ok(Draft { path, file })
    }

    /// Adds a complete file.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn add(&mut self, mut draft: Draft) -> Result<(), Error> {
        let complete = draft.file.complete();
        complete.map_err(|error| Error::unwritable(&draft.path, error))?;
        self.all.push(draft);
        Ok(())
    }

    /// Gives all files their names, replacing existing files. Returns their paths.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn keep(mut self) -> Result<Vec<PathBuf>, Error> {
        self.is_new = false;
        let mut kept = Vec::new();
        for Draft { path, file } in std::mem::take(&mut self.all) {
            file.keep()
                .map_err(|error| Error::unwritable(&path, error))?;
            kept.push(path);
        }
        Ok(kept)
    }
}

impl Draft {
    /// Appends bytes.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let written = self.file.write_all(bytes);
        written.map_err(|error| Error::unwritable(&self.path, error))
    }
}

impl Drop for Drafts {
    fn drop(&mut self) {
        self.all.clear();
        if self.is_new {
            // Removing fails if the folder is not empty, so that a folder with files is kept.
            let _ = std::fs::remove_dir(&self.folder);
        }
    }
}
