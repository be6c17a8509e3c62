//! Files that are there when all of them are whole, and not before.

use crate::Error;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Files on their way into a folder. What was not kept by [`Drafts::keep`] goes when this does.
#[derive(Debug)]
pub struct Drafts {
    folder: PathBuf,
    is_new: bool,
    all: Vec<(PathBuf, NamedTempFile)>,
}

/// A file that is written.
#[derive(Debug)]
pub struct Draft {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
}

impl Drafts {
    /// In a folder, which is made where there is none.
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
        // Better known now than after an hour.
        draft_in(&drafts.folder)?;
        Ok(drafts)
    }

    /// Begins a file.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn begin(&self, name: &str) -> Result<Draft, Error> {
        let path = self.folder.join(name);
        if path.is_dir() {
            return Err(Error::unwritable(&path, "it is a folder"));
        }
        let file = BufWriter::new(draft_in(&self.folder)?);
        Ok(Draft { path, file })
    }

    /// Takes a file that is whole.
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

    /// Gives all of them their names, in place of what had them.
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
    /// Writes what comes next.
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
            // It stays where something is in it.
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
        // As any new file: others may read the report.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let file = builder.tempfile_in(folder);
    file.map_err(|error| Error::unwritable(folder, error))
}
