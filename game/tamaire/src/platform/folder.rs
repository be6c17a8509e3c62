//! Storage in a folder: one file for each entry.

use super::storage::{Entry, Kind, Storage, UpdateEntry};
use fuwafuwa_scenes::disk::read_bytes;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

/// Maximum time to wait for the lock of another program, which usually holds it for a few milliseconds.
const PATIENCE: Duration = Duration::from_secs(5);

/// Prefix of draft files. A draft replaces the real file once it is complete. Names of entries never begin
/// with a dot, so that they cannot be mistaken for drafts.
const DRAFT: &str = ".draft-";

/// Age after which a draft counts as abandoned.
const FORGOTTEN: Duration = Duration::from_secs(600);

/// Storage in a folder.
pub struct Folder(pub PathBuf);

impl Folder {
    /// Returns the subfolder and the file extension of a kind.
    fn of(&self, kind: Kind) -> (PathBuf, &'static str) {
        match kind {
            Kind::Note => (self.0.clone(), "toml"),
            Kind::Level => (self.0.join("levels"), "toml"),
            Kind::Replay => (self.0.join("replays"), "tamaire"),
            Kind::Best => (self.0.join("best"), "tamaire"),
            Kind::Photo => (self.0.join("pictures"), "png"),
            Kind::Clip => (self.0.join("pictures"), "gif"),
        }
    }

    fn path(&self, kind: Kind, name: &str) -> io::Result<PathBuf> {
        let parts = if cfg!(windows) { "/\\:" } else { "/" };
        let leads_away = |letter: char| letter.is_control() || parts.contains(letter);
        if name.is_empty() || name.starts_with('.') || name.contains(leads_away) {
            let reason = "expected a plain name without path separators";
            return Err(io::Error::new(ErrorKind::InvalidInput, reason));
        }
        let (folder, ending) = self.of(kind);
        Ok(folder.join(format!("{name}.{ending}")))
    }

    /// Locks the folder against changes by other programs until the lock is dropped. The system releases the
    /// lock of a killed program.
    fn lock(&self) -> io::Result<File> {
        let mut options = File::options();
        let options = options.write(true).create(true).truncate(false);
        let lock = options.open(self.0.join("lock"))?;
        let start = Instant::now();
        loop {
            match lock.try_lock() {
                Ok(()) => return Ok(lock),
                Err(TryLockError::WouldBlock) if start.elapsed() < PATIENCE => {
                    thread::sleep(Duration::from_millis(10));
                }
                Err(TryLockError::WouldBlock) => {
                    let reason = format!("{}: in use by another program", self.0.display());
                    return Err(io::Error::new(ErrorKind::WouldBlock, reason));
                }
                // Some file systems have no locks. The change then goes on without a lock, because usually
                // only one game runs.
                Err(TryLockError::Error(_)) => return Ok(lock),
            }
        }
    }
}

impl Storage for Folder {
    fn list(&self, kind: Kind) -> io::Result<Vec<Entry>> {
        let (folder, ending) = self.of(kind);
        let files = match fs::read_dir(&folder) {
            Err(error) if is_missing(&error) => return Ok(Vec::new()),
            files => files?,
        };
        let entry = |file: fs::DirEntry| {
            let path = file.path();
            let is_ours = path.extension().is_some_and(|found| found == ending);
            let data = path.metadata().ok().filter(|data| data.is_file())?;
            let name = path.file_stem()?.to_str()?.to_string();
            let written = data.modified().ok()?;
            self.path(kind, &name).ok()?;
            is_ours.then_some(Entry { name, written })
        };
        Ok(files.flatten().filter_map(entry).collect())
    }

    fn read(&self, kind: Kind, name: &str) -> io::Result<Option<Vec<u8>>> {
        match read_bytes(&self.path(kind, name)?, kind.most_bytes()) {
            Err(error) if is_missing(&error) => Ok(None),
            read => read.map(Some),
        }
    }

    fn change(&self, kind: Kind, name: &str, change: &mut UpdateEntry) -> io::Result<()> {
        let path = self.path(kind, name)?;
        let (folder, _) = self.of(kind);
        fs::create_dir_all(&folder)?;
        let _lock = self.lock()?;
        let before = self.read(kind, name)?;
        match change(before.as_deref()) {
            Some(after) if before.as_ref() != Some(&after) => write_whole(&folder, &path, &after),
            _ => Ok(()),
        }
    }

    fn remove(&self, kind: Kind, name: &str) -> io::Result<()> {
        fs::remove_file(self.path(kind, name)?)
    }

    fn location(&self, kind: Kind, name: &str) -> String {
        let path = self.path(kind, name);
        path.map_or_else(|_| name.into(), |path| path.display().to_string())
    }
}

fn is_missing(error: &io::Error) -> bool {
    [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&error.kind())
}

/// Replaces a file atomically: writes a draft and renames it.
fn write_whole(folder: &Path, path: &Path, bytes: &[u8]) -> io::Result<()> {
    // Removes abandoned drafts of games that were killed while writing.
    for file in fs::read_dir(folder)?.flatten() {
        let is_draft = file.file_name().to_string_lossy().starts_with(DRAFT);
        if is_draft && is_forgotten(&file).unwrap_or(false) {
            // A draft that cannot be removed does no harm.
            let _removed = fs::remove_file(file.path());
        }
    }
    let mut draft = tempfile::Builder::new().prefix(DRAFT).tempfile_in(folder)?;
    draft.write_all(bytes)?;
    draft.as_file().sync_all()?;
    draft.persist(path).map_err(|failed| failed.error)?;
    Ok(())
}

fn is_forgotten(file: &fs::DirEntry) -> io::Result<bool> {
    let age = file.metadata()?.modified()?.elapsed();
    Ok(age.is_ok_and(|age| age > FORGOTTEN))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    #[test]
    fn concurrent_changes_are_not_lost() {
        let folder = tempfile::tempdir().unwrap();
        // Two storages use the same folder, as in two programs.
        let counts = [0, 1].map(|_| {
            let storage = Arc::new(Folder(folder.path().join("new")));
            thread::spawn(move || {
                for _ in 0..40 {
                    let mut one_more = |found: Option<&[u8]>| {
                        let mut bytes = found.unwrap_or_default().to_vec();
                        bytes.push(b'.');
                        Some(bytes)
                    };
                    let changed = storage.change(Kind::Note, "count", &mut one_more);
                    changed.unwrap();
                }
            })
        });
        for count in counts {
            count.join().unwrap();
        }
        let storage = Folder(folder.path().join("new"));
        let count = storage.read(Kind::Note, "count").unwrap().unwrap();
        assert_eq!(count.len(), 80);
        let names = fs::read_dir(&storage.0).unwrap().flatten();
        let names: Vec<_> = names.map(|file| file.file_name()).collect();
        assert_eq!(names.len(), 2, "the count and the lock: {names:?}");
    }

    #[test]
    fn abandoned_draft_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let (left, open) = (".draft-1a2b", ".draft-3c4d");
        for draft in [left, open] {
            fs::write(folder.path().join(draft), "half").unwrap();
        }
        let draft = File::options().write(true).open(folder.path().join(left));
        let before = std::time::SystemTime::now() - 2 * FORGOTTEN;
        draft.unwrap().set_modified(before).unwrap();
        let storage = Folder(folder.path().into());
        let whole = |_: Option<&[u8]>| Some(b"whole".to_vec());
        storage.change(Kind::Note, "it", &mut { whole }).unwrap();
        let names = fs::read_dir(folder.path()).unwrap();
        let names = names.map(|file| file.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        assert_eq!(
            names,
            [open, "it.toml", "lock"],
            "a recent draft may belong to another game"
        );
    }

    #[test]
    fn invalid_name_is_rejected() {
        let folder = tempfile::tempdir().unwrap();
        let storage = Folder(folder.path().join("inside"));
        for name in ["", "..", "../out", "/etc/hosts", "a/b", ".draft-1"] {
            let read = storage.read(Kind::Note, name).unwrap_err();
            let changed = storage.change(Kind::Note, name, &mut |_| Some(Vec::new()));
            for error in [read, changed.unwrap_err()] {
                assert_eq!(error.kind(), ErrorKind::InvalidInput, "{name:?}");
            }
        }
    }

    #[cfg(unix)]
    #[test]
    fn pipe_and_too_long_file_are_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("settings.toml");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let storage = Folder(folder.path().into());
        let error = storage.read(Kind::Note, "settings").unwrap_err();
        assert!(error.to_string().contains("a pipe"), "{error}");
        fs::write(folder.path().join("long.toml"), vec![b' '; 1 + (1 << 20)]).unwrap();
        let error = storage.read(Kind::Note, "long").unwrap_err();
        assert!(
            error.to_string().contains("expected at most 1048576 bytes"),
            "{error}"
        );
    }
}
