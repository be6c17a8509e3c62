//! Files that appear in a folder only when all of them are complete.

use crate::Error;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Temporary files in a folder. [`Drafts::keep`] renames them to their final names; dropping without it
/// deletes them.
#[derive(Debug)]
pub struct Drafts {
    folder: PathBuf,
    is_new: bool,
    all: Vec<(PathBuf, NamedTempFile)>,
}

/// A file being written.
#[derive(Debug)]
pub struct Draft {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
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
        draft_in(&drafts.folder)?;
        Ok(drafts)
    }

    /// Starts a file that will have the name `name` in the folder.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn begin(&self, name: &str) -> Result<Draft, Error> {
        let path = self.folder.join(name);
        if path.is_dir() {
            return Err(Error::unwritable(&path, "a folder has this name"));
        }
        let file = BufWriter::new(draft_in(&self.folder)?);
        Ok(Draft { path, file })
    }

    /// Adds a complete file.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn add(&mut self, draft: Draft) -> Result<(), Error> {
        let Draft { path, file } = draft;
        let file = file.into_inner();
        let file = file.map_err(|error| Error::unwritable(&path, error.into_error()))?;
        let synced = file.as_file().sync_all();
        synced.map_err(|error| Error::unwritable(&path, error))?;
        self.all.push((path, file));
        Ok(())
    }

    /// Gives all files their names, replacing existing files. Returns their paths.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn keep(mut self) -> Result<Vec<PathBuf>, Error> {
        self.is_new = false;
        let mut kept = Vec::new();
        for (path, file) in std::mem::take(&mut self.all) {
            let named = file.persist(&path);
            named.map_err(|error| Error::unwritable(&path, error.error))?;
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

fn draft_in(folder: &Path) -> Result<NamedTempFile, Error> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".draft-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The mode of an ordinary new file, so that other users can read the report.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let file = builder.tempfile_in(folder);
    file.map_err(|error| Error::unwritable(folder, error))
}
