//! State of a release: version, time, folder, and the parts that were built from the current commit.

use crate::packages::IfMissing;
use crate::shell::{Failure, file_error, output_of, root, target};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// State of a release.
pub struct ReleaseBuild {
    /// Version of all contents.
    pub version: String,
    /// Time of the commit [s since 1970], used for all files in packages.
    pub epoch: String,
    pub if_missing: IfMissing,
    commit: String,
    is_dirty: bool,
    folder: PathBuf,
    /// Part that is being built.
    part: &'static str,
    /// Files of the part that is being built.
    made: Vec<PathBuf>,
}

impl ReleaseBuild {
    /// Opens the state for the current commit.
    pub fn open(if_missing: IfMissing) -> Result<Self, Failure> {
        let at = root().display().to_string();
        let git = |words: &[&str]| output_of("git", &[&["-C", &at], words].concat());
        let cannot =
            || Failure::cannot("a release is built from a commit, but git finds none here");
        let changes = git(&["status", "--porcelain"]).ok_or_else(cannot)?;
        let line = |words| {
            git(words)
                .map(|text| text.trim().to_string())
                .ok_or_else(cannot)
        };
        let folder = root().join(target()).join("packages");
        fs::create_dir_all(folder.join("parts")).map_err(|error| file_error(&folder, &error))?;
        Ok(Self {
            version: env!("CARGO_PKG_VERSION").to_string(),
            epoch: line(&["log", "-1", "--format=%ct"])?,
            if_missing,
            commit: line(&["rev-parse", "HEAD"])?,
            is_dirty: !changes.trim().is_empty(),
            folder,
            part: "",
            made: Vec::new(),
        })
    }

    /// Folder of the packages.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Hash of the commit, with a note if there are uncommitted changes.
    pub fn commit(&self) -> String {
        let dirty = if self.is_dirty { " with changes" } else { "" };
        format!("{}{dirty}", self.commit)
    }

    pub fn is_dirty(&self) -> bool {
        self.is_dirty
    }

    /// Whether the files of this part exist and were built from this commit.
    pub fn has(&self, part: &str) -> bool {
        // Always rebuilds the checksums (`sums`), which takes less time than checking whether they are
        // current.
        if self.is_dirty || part == "sums" {
            return false;
        }
        fs::read_to_string(self.note(part)).is_ok_and(|note| {
            let mut lines = note.lines();
            lines.next() == Some(&self.commit) && lines.all(|file| Path::new(file).exists())
        })
    }

    /// Begins a part: deletes the record of its earlier build.
    pub fn begin(&mut self, part: &'static str) {
        (self.part, self.made) = (part, Vec::new());
        // Ignores the error if there is no record, because the part was never built.
        let _removed = fs::remove_file(self.note(part));
    }

    /// Adds a file to the current part.
    pub fn add(&mut self, file: PathBuf) {
        self.made.push(file);
    }

    /// Files of the current part.
    pub fn made(&self) -> &[PathBuf] {
        &self.made
    }

    /// Completes the current part: records its files with the commit.
    pub fn finish(&self) -> Result<(), Failure> {
        let mut note = format!("{}\n", self.commit);
        for file in &self.made {
            note += &format!("{}\n", file.display());
        }
        let path = self.note(self.part);
        // Writes no record if there are uncommitted changes: the build belongs to no commit.
        match self.is_dirty {
            true => Ok(()),
            false => fs::write(&path, note).map_err(|error| file_error(&path, &error)),
        }
    }

    /// Deletes the files of a failed part.
    pub fn discard(&self) {
        for file in self.made.iter().filter(|file| file.is_file()) {
            // Ignores the error if the file is gone already.
            let _removed = fs::remove_file(file);
        }
    }

    /// Path of the record of a built part: its commit and its files.
    fn note(&self, part: &str) -> PathBuf {
        self.folder.join("parts").join(part)
    }

    /// Creates an empty folder to assemble a package in.
    pub fn stage(&self, name: &str) -> Result<PathBuf, Failure> {
        let stage = self.folder.join("stage").join(name);
        // Ignores the error if the folder is missing, as in the first build.
        let _removed = fs::remove_dir_all(&stage);
        fs::create_dir_all(&stage).map_err(|error| file_error(&stage, &error))?;
        Ok(stage)
    }

    /// Returns the folder `name`, in which `part` assembled a package.
    pub fn staged(&self, name: &str, part: &str) -> Result<PathBuf, Failure> {
        let stage = self.folder.join("stage").join(name);
        match stage.is_dir() {
            true => Ok(stage),
            false => Err(Failure::cannot(format!(
                "the required part `{part}` has not been built"
            ))),
        }
    }

    /// Packages of this version, sorted by name.
    pub fn packages(&self) -> Result<Vec<PathBuf>, Failure> {
        let entries =
            fs::read_dir(&self.folder).map_err(|error| file_error(&self.folder, &error))?;
        let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        let version = &self.version;
        files.retain(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let is_of_it = ["-", "_"]
                .iter()
                .any(|gap| name.starts_with(&format!("tamaire{gap}{version}")));
            path.is_file() && is_of_it
        });
        files.sort();
        Ok(files)
    }

    /// Lists the packages with their sizes.
    pub fn contents(&self) -> Result<String, Failure> {
        let mut lines = String::new();
        for file in self.packages()? {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            let _written = write!(lines, "\n  {:>11} bytes  {name}", size(&file)?);
        }
        Ok(lines)
    }
}

/// Size of a file [bytes]; an empty file is an error.
pub fn size(file: &Path) -> Result<u64, Failure> {
    let data = fs::metadata(file).map_err(|error| file_error(file, &error))?;
    match data.len() {
        0 => Err(Failure::failed(format!("{} is empty", file.display()))),
        bytes => Ok(bytes),
    }
}
