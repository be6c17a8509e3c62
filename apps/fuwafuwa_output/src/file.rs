//! Files that appear whole or not at all.

use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::{NamedTempFile, PersistError};

/// Maximum number of characters of a file name that a temporary name begins with. The temporary name must fit
/// into the 255 bytes of most file systems.
const MOST_CHARS: usize = 50;
/// Maximum number of symbolic links that are followed, as on Linux.
const MAX_LINKS: usize = 40;

/// Writes a file as a whole. If writing fails, an existing file is unchanged.
///
/// # Errors
/// As [`Draft::begin`], [`Draft::complete`] and [`Draft::keep`].
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut draft = Draft::begin(path)?;
    draft.write_all(bytes)?;
    draft.keep()
}

/// Checks that the folder of a file exists, so that a long run does not fail at its end.
///
/// # Errors
/// The error of the system; [`ErrorKind::NotADirectory`] if the folder is a file.
pub fn check_folder(path: &Path) -> io::Result<()> {
    let folder = folder_of(path);
    let found = fs::metadata(folder).map_err(|error| match error.kind() {
        ErrorKind::NotFound => io::Error::new(ErrorKind::NotFound, "the folder does not exist"),
        _ => error,
    })?;
    if !found.is_dir() {
        let reason = format!("{} is a file, not a folder", folder.display());
        return Err(io::Error::new(ErrorKind::NotADirectory, reason));
    }
    Ok(())
}

/// Writes several files that belong together. No file is replaced before all of them are on the disk.
///
/// # Errors
/// The path of the file at fault, and the errors of [`write`](write()).
pub fn write_together(files: &[(&Path, &[u8])]) -> Result<(), (PathBuf, io::Error)> {
    let named = |path: &Path| {
        let path = path.to_path_buf();
        |error| (path, error)
    };
    let mut drafts = Vec::new();
    for (path, bytes) in files {
        let written = Draft::begin(path).and_then(|mut draft| {
            draft.write_all(bytes)?;
            draft.complete()?;
            Ok(draft)
        });
        drafts.push((path, written.map_err(named(path))?));
    }
    for (path, draft) in drafts {
        draft.keep().map_err(named(path))?;
    }
    Ok(())
}

/// File that is written under a temporary name beside its path. [`Draft::keep`] gives the file its name;
/// dropping without it deletes the temporary file.
///
/// The temporary name is the name with six random characters and `.part` behind it. A pipe or a device is
/// written directly; if the reader of a pipe has ended, the rest is dropped without an error.
#[derive(Debug)]
pub struct Draft {
    path: PathBuf,
    target: BufWriter<Target>,
    /// Permissions of the file that is replaced.
    permissions: Option<Permissions>,
}

#[derive(Debug)]
enum Target {
    Temporary(NamedTempFile),
    Device(File),
}

impl Draft {
    /// Starts a file. A symbolic link at `path` is followed and stays a link; if its target does not exist, the
    /// file is made there. A path in `/dev` or `/proc` is written directly, except in `/dev/shm`.
    ///
    /// # Errors
    /// [`ErrorKind::IsADirectory`] if `path` is a folder; the error of the system if an existing file is
    /// write-protected, or if no file can be created in the folder.
    pub fn begin(path: &Path) -> io::Result<Self> {
        let path = resolved(path)?;
        if is_of_system(&path) {
            let device = Target::Device(open_of_system(&path)?);
            return Ok(Self::new(path, device, None));
        }
        let (target, permissions) = match fs::metadata(&path) {
            Ok(found) if found.is_dir() => {
                let reason = "a folder has this name";
                return Err(io::Error::new(ErrorKind::IsADirectory, reason));
            }
            Ok(found) => {
                let file = File::options().write(true).open(&path)?;
                match found.is_file() {
                    true => (
                        Target::Temporary(temporary(&path)?),
                        Some(found.permissions()),
                    ),
                    false => (Target::Device(file), None),
                }
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {
                (Target::Temporary(temporary(&path)?), None)
            }
            Err(error) => return Err(error),
        };
        Ok(Self::new(path, target, permissions))
    }

    /// Starts a file that does not exist yet, to be completed by [`Draft::keep_new`].
    ///
    /// # Errors
    /// [`ErrorKind::AlreadyExists`] if anything has this name, also a folder or a link without a target; the
    /// error of the system if no file can be created in the folder.
    pub fn begin_new(path: &Path) -> io::Result<Self> {
        if fs::symlink_metadata(path).is_ok() {
            return Err(ErrorKind::AlreadyExists.into());
        }
        let target = Target::Temporary(temporary(path)?);
        Ok(Self::new(path.into(), target, None))
    }

    fn new(path: PathBuf, target: Target, permissions: Option<Permissions>) -> Self {
        let target = BufWriter::new(target);
        Self {
            path,
            target,
            permissions,
        }
    }

    /// Writes everything to the disk, still under the temporary name.
    ///
    /// # Errors
    /// The error of the system, for example of a full disk.
    pub fn complete(&mut self) -> io::Result<()> {
        self.target.flush()?;
        match self.target.get_ref() {
            Target::Temporary(file) => file.as_file().sync_all(),
            // Pipes and most devices cannot be synchronized.
            Target::Device(_) => Ok(()),
        }
    }

    /// Completes the file and gives it its name, replacing an existing file. The permissions of an existing
    /// file are kept.
    ///
    /// # Errors
    /// As [`Draft::complete`], or if the file cannot be renamed.
    pub fn keep(self) -> io::Result<()> {
        self.keep_by(|file, path| file.persist(path))
    }

    /// As [`Draft::keep`], but never replaces an existing file.
    ///
    /// # Errors
    /// As [`Draft::keep`]; [`ErrorKind::AlreadyExists`] if the file exists.
    pub fn keep_new(self) -> io::Result<()> {
        self.keep_by(|file, path| file.persist_noclobber(path))
    }

    fn keep_by(
        mut self,
        rename: fn(NamedTempFile, &Path) -> Result<File, PersistError>,
    ) -> io::Result<()> {
        self.complete()?;
        let (target, _) = self.target.into_parts();
        let Target::Temporary(file) = target else {
            return Ok(());
        };
        if let Some(permissions) = self.permissions {
            file.as_file().set_permissions(permissions)?;
        }
        rename(file, &self.path).map_err(|failed| failed.error)?;
        Ok(())
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.target.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.target.flush()
    }
}

impl Write for Target {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Temporary(file) => file.write(bytes),
            Self::Device(file) => match file.write(bytes) {
                // The reader of the pipe, for example `head`, has read enough.
                Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(bytes.len()),
                written => written,
            },
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Temporary(file) => file.flush(),
            Self::Device(file) => file.flush(),
        }
    }
}

fn temporary(path: &Path) -> io::Result<NamedTempFile> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut prefix: String = name.chars().take(MOST_CHARS).collect();
    prefix.push('.');
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The mode of an ordinary new file. By default, temporary files are readable by their owner only.
        builder.permissions(Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder_of(path))
}

/// Follows symbolic links to the path of the file itself, which need not exist. Links of the system, such as
/// `/dev/stdout`, are not followed.
fn resolved(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_path_buf();
    for _ in 0..MAX_LINKS {
        let is_link = fs::symlink_metadata(&path).is_ok_and(|found| found.is_symlink());
        if !is_link || is_of_system(&path) {
            return Ok(path);
        }
        path = folder_of(&path).join(fs::read_link(&path)?);
    }
    let reason = format!("more than {MAX_LINKS} symbolic links follow each other");
    Err(io::Error::other(reason))
}

/// Returns whether a path belongs to the devices and processes of the system. `/dev/shm` holds ordinary files.
fn is_of_system(path: &Path) -> bool {
    let is_device = path.starts_with("/dev") && !path.starts_with("/dev/shm");
    is_device || path.starts_with("/proc")
}

/// Opens a path of the system for writing. Standard output and standard error are not opened anew: opening a
/// pipe waits for a reader, and opening a file begins at its start.
fn open_of_system(path: &Path) -> io::Result<File> {
    #[cfg(unix)]
    {
        use std::os::fd::AsFd;
        let stream = match path.to_str() {
            Some("/dev/stdout") => Some(io::stdout().as_fd().try_clone_to_owned()?),
            Some("/dev/stderr") => Some(io::stderr().as_fd().try_clone_to_owned()?),
            _ => None,
        };
        if let Some(stream) = stream {
            return Ok(File::from(stream));
        }
    }
    File::options().append(true).open(path)
}

fn folder_of(path: &Path) -> &Path {
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    folder.unwrap_or(Path::new("."))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    #[test]
    fn dropped_draft_leaves_the_existing_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.csv");
        write(&path, b"old").unwrap();
        let mut draft = Draft::begin(&path).unwrap();
        draft.write_all(b"new").unwrap();
        draft.complete().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()).len(), 2);
        drop(draft);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["result.csv"]);
        let draft = Draft::begin(&path).unwrap();
        let error = draft.keep_new().unwrap_err();
        assert_eq!(error.kind(), ErrorKind::AlreadyExists);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        write(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(names(folder.path()), ["result.csv"]);
    }

    #[test]
    fn longest_names_and_folders_are_handled() {
        let folder = tempfile::tempdir().unwrap();
        let name = "脳".repeat(85);
        write(&folder.path().join(&name), b"whole").unwrap();
        assert_eq!(names(folder.path()), std::slice::from_ref(&name));
        let error = write(folder.path(), b"").unwrap_err();
        assert_eq!(error.kind(), ErrorKind::IsADirectory);
        let missing = folder.path().join("no/file");
        let error = write(&missing, b"").unwrap_err();
        assert_eq!(error.kind(), ErrorKind::NotFound);
        let kind_of = |path: &Path| check_folder(path).map_err(|error| error.kind());
        assert_eq!(kind_of(&missing), Err(ErrorKind::NotFound));
        let below = folder.path().join(&name).join("file");
        assert_eq!(kind_of(&below), Err(ErrorKind::NotADirectory));
        assert_eq!(kind_of(Path::new("file")), Ok(()));
    }

    #[test]
    fn files_that_belong_together_are_replaced_together() {
        let folder = tempfile::tempdir().unwrap();
        let [first, second] = ["a.vox", "b.toml"].map(|name| folder.path().join(name));
        fs::write(&first, "old").unwrap();
        fs::create_dir(&second).unwrap();
        let (path, error) = write_together(&[(&first, b"new"), (&second, b"new")]).unwrap_err();
        assert_eq!((path, error.kind()), (second, ErrorKind::IsADirectory));
        assert_eq!(fs::read(&first).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a.vox", "b.toml"]);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_and_links_are_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let [file, link, fresh] = ["file", "link", "fresh"].map(|name| folder.path().join(name));
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        fs::write(&file, "old").unwrap();
        let usual = mode(&file);
        fs::set_permissions(&file, Permissions::from_mode(0o640)).unwrap();
        symlink(&file, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(mode(&file), 0o640);
        write(&fresh, b"new").unwrap();
        assert_eq!(mode(&fresh), usual);
    }

    #[cfg(unix)]
    #[test]
    fn links_without_a_target_are_kept_and_get_one() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        symlink("second", path("first")).unwrap();
        symlink("made", path("second")).unwrap();
        write(&path("first"), b"new").unwrap();
        assert_eq!(names(folder.path()), ["first", "made", "second"]);
        assert!(fs::symlink_metadata(path("first")).unwrap().is_symlink());
        assert!(fs::symlink_metadata(path("second")).unwrap().is_symlink());
        assert!(fs::symlink_metadata(path("made")).unwrap().is_file());
        assert_eq!(fs::read(path("made")).unwrap(), b"new");
        symlink("circle", path("circle")).unwrap();
        let error = write(&path("circle"), b"new").unwrap_err();
        assert!(error.to_string().contains("symbolic links"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn begin_new_refuses_whatever_has_the_name() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("file"), "old").unwrap();
        fs::set_permissions(path("file"), Permissions::from_mode(0o444)).unwrap();
        fs::create_dir(path("folder")).unwrap();
        symlink("nowhere", path("link")).unwrap();
        for name in ["file", "folder", "link"] {
            let error = Draft::begin_new(&path(name)).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::AlreadyExists, "{name}");
        }
        let mut draft = Draft::begin_new(&path("new")).unwrap();
        draft.write_all(b"new").unwrap();
        draft.keep_new().unwrap();
        assert_eq!(fs::read(path("new")).unwrap(), b"new");
        assert_eq!(names(folder.path()), ["file", "folder", "link", "new"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn pipe_whose_reader_has_ended_gives_no_error() {
        use std::os::fd::AsRawFd;
        let (reader, writer) = io::pipe().unwrap();
        let path = format!("/proc/self/fd/{}", writer.as_raw_fd());
        let mut draft = Draft::begin(Path::new(&path)).unwrap();
        drop(reader);
        draft.write_all(b"text").unwrap();
        draft.keep().unwrap();
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn full_device_gives_an_error_and_stays_a_device() {
        let full = Path::new("/dev/full");
        let error = write(full, b"text").unwrap_err();
        assert_eq!(error.kind(), ErrorKind::StorageFull);
        write(Path::new("/dev/null"), b"text").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
