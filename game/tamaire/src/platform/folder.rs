//! Storage in a folder: one file for each entry. Photos, clips, replays and packs can be in folders of the user instead.

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
pub struct Folder {
    /// Folder of the game.
    own: PathBuf,
    user: UserFolders,
}

/// Folders in which the user looks for photos, clips, replays and packs. An entry whose folder is `None`, or cannot be
/// made, is stored in the folder of the game.
#[derive(Clone, Debug, Default)]
pub struct UserFolders {
    /// Folder of photos.
    pub pictures: Option<PathBuf>,
    /// Folder of clips.
    pub videos: Option<PathBuf>,
    /// Folder of replays and packs.
    pub documents: Option<PathBuf>,
}

impl UserFolders {
    /// Returns the folder `Tamaire` in each of the system's folders for pictures, videos and documents.
    pub fn of_system() -> Self {
        let Some(system) = directories::UserDirs::new() else {
            return Self::default();
        };
        let inside = |folder: Option<&Path>| folder.map(|folder| folder.join("Tamaire"));
        Self {
            pictures: inside(system.picture_dir()),
            videos: inside(system.video_dir()),
            documents: inside(system.document_dir()),
        }
    }

    /// Returns the folder of a kind.
    fn of(&self, kind: Kind) -> Option<&PathBuf> {
        match kind {
            Kind::Photo => self.pictures.as_ref(),
            Kind::Clip => self.videos.as_ref(),
            Kind::Replay | Kind::Pack => self.documents.as_ref(),
            Kind::Note | Kind::Level | Kind::Best => None,
        }
    }
}

impl Folder {
    /// Creates a storage in the folder `own`, with photos, clips and replays in the folders `user`.
    pub fn new(own: PathBuf, user: UserFolders) -> Self {
        Self { own, user }
    }

    /// Returns the subfolder and the file extension of a kind in the folder of the game.
    fn of(&self, kind: Kind) -> (PathBuf, &'static str) {
        match kind {
            Kind::Note => (self.own.clone(), "toml"),
            Kind::Level => (self.own.join("levels"), "toml"),
            Kind::Replay => (self.own.join("replays"), "tamaire"),
            Kind::Best => (self.own.join("best"), "tamaire"),
            Kind::Pack => (self.own.join("replays"), "zip"),
            Kind::Photo => (self.own.join("pictures"), "png"),
            Kind::Clip => (self.own.join("pictures"), "gif"),
        }
    }

    /// Returns the folders that may hold entries of a kind. The first one is the folder of the user, if there is
    /// one. The folder of the game follows, since earlier versions stored all entries there.
    fn folders(&self, kind: Kind) -> Vec<PathBuf> {
        let user = self.user.of(kind).cloned();
        user.into_iter().chain([self.of(kind).0]).collect()
    }

    /// Returns the path of an entry: where it exists, otherwise in the first folder of its kind.
    fn path(&self, kind: Kind, name: &str) -> io::Result<PathBuf> {
        let file = self.file_name(kind, name)?;
        let mut places: Vec<PathBuf> = { self.folders(kind).into_iter() }
            .map(|folder| folder.join(&file))
            .collect();
        let known = places.iter().position(|place| place.exists());
        Ok(places.swap_remove(known.unwrap_or(0)))
    }

    /// Returns the path at which an entry can be written, and makes its folder.
    fn path_to_write(&self, kind: Kind, name: &str) -> io::Result<PathBuf> {
        let path = self.path(kind, name)?;
        match path.parent().map_or(Ok(()), fs::create_dir_all) {
            Ok(()) => Ok(path),
            Err(error) if self.user.of(kind).is_none() => Err(error),
            // The folder of the user cannot be made, for example in a sandbox.
            Err(_) => self.own_path_to_write(kind, name),
        }
    }

    /// Returns the path of an entry in the folder of the game, and makes its folder.
    fn own_path_to_write(&self, kind: Kind, name: &str) -> io::Result<PathBuf> {
        let (folder, _) = self.of(kind);
        fs::create_dir_all(&folder)?;
        Ok(folder.join(self.file_name(kind, name)?))
    }

    /// Returns the name of the file of an entry.
    fn file_name(&self, kind: Kind, name: &str) -> io::Result<String> {
        let parts = if cfg!(windows) { "/\\:" } else { "/" };
        let leads_away = |letter: char| letter.is_control() || parts.contains(letter);
        if name.is_empty() || name.starts_with('.') || name.contains(leads_away) {
            let reason = "expected a plain name without path separators";
            return Err(io::Error::new(ErrorKind::InvalidInput, reason));
        }
        let (_, ending) = self.of(kind);
        Ok(format!("{name}.{ending}"))
    }

    /// Locks the folder against changes by other programs until the lock is dropped. The system releases the
    /// lock of a killed program.
    fn lock(&self) -> io::Result<File> {
        let mut options = File::options();
        let options = options.write(true).create(true).truncate(false);
        let lock = options.open(self.own.join("lock"))?;
        let start = Instant::now();
        loop {
            match lock.try_lock() {
                Ok(()) => return Ok(lock),
                Err(TryLockError::WouldBlock) if start.elapsed() < PATIENCE => {
                    thread::sleep(Duration::from_millis(10));
                }
                Err(TryLockError::WouldBlock) => {
                    let reason = format!("{}: in use by another program", self.own.display());
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
        let (_, ending) = self.of(kind);
        let entry = |file: fs::DirEntry| {
            let path = file.path();
            let is_ours = path.extension().is_some_and(|found| found == ending);
            let data = path.metadata().ok().filter(|data| data.is_file())?;
            let name = path.file_stem()?.to_str()?.to_string();
            let written = data.modified().ok()?;
            // Skips a file that reading would not find under this name.
            let is_found = self.path(kind, &name).is_ok_and(|found| found == path);
            (is_ours && is_found).then_some(Entry { name, written })
        };
        let mut found = Vec::new();
        for folder in self.folders(kind) {
            match fs::read_dir(&folder) {
                Err(error) if is_missing(&error) => {}
                // The system does not let the game look into a folder of the user.
                Err(error) if is_denied(&error) && folder != self.of(kind).0 => {}
                files => found.extend(files?.flatten().filter_map(entry)),
            }
        }
        Ok(found)
    }

    fn read(&self, kind: Kind, name: &str) -> io::Result<Option<Vec<u8>>> {
        match read_bytes(&self.path(kind, name)?, kind.most_bytes()) {
            Err(error) if is_missing(&error) => Ok(None),
            read => read.map(Some),
        }
    }

    fn change(&self, kind: Kind, name: &str, change: &mut UpdateEntry) -> io::Result<()> {
        fs::create_dir_all(&self.own)?;
        let path = self.path_to_write(kind, name)?;
        let _lock = self.lock()?;
        let before = self.read(kind, name)?;
        match change(before.as_deref()) {
            Some(after) if before.as_ref() != Some(&after) => match write_whole(&path, &after) {
                // The folder of the user exists, but nothing can be written there.
                Err(error) if is_unwritable(&error) && before.is_none() => {
                    write_whole(&self.own_path_to_write(kind, name)?, &after)
                }
                written => written,
            },
            _ => Ok(()),
        }
    }

    fn remove(&self, kind: Kind, name: &str) -> io::Result<()> {
        fs::remove_file(self.path(kind, name)?)
    }

    fn location(&self, kind: Kind, name: &str) -> PathBuf {
        self.path(kind, name).unwrap_or_else(|_| name.into())
    }

    fn has_folders(&self) -> bool {
        true
    }

    fn open_folder_of(&self, location: &Path) -> io::Result<()> {
        let folder = location.parent();
        let folder = folder.filter(|folder| folder.is_dir()).ok_or_else(|| {
            let location = location.display();
            let reason = format!("{location}: expected a file in a folder that exists");
            io::Error::new(ErrorKind::NotFound, reason)
        })?;
        open::that_detached(folder)
    }
}

fn is_denied(error: &io::Error) -> bool {
    error.kind() == ErrorKind::PermissionDenied
}

fn is_unwritable(error: &io::Error) -> bool {
    is_denied(error) || error.kind() == ErrorKind::ReadOnlyFilesystem
}

fn is_missing(error: &io::Error) -> bool {
    [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&error.kind())
}

/// Replaces a file atomically: writes a draft and renames it.
fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
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

    fn in_own(folder: PathBuf) -> Folder {
        Folder::new(folder, UserFolders::default())
    }

    /// Returns a storage in `folder`, with the three folders of the user beside the folder of the game.
    fn with_user_folders(folder: &Path) -> Folder {
        let user = UserFolders {
            pictures: Some(folder.join("Pictures/Tamaire")),
            videos: Some(folder.join("Videos/Tamaire")),
            documents: Some(folder.join("Documents/Tamaire")),
        };
        Folder::new(folder.join("hidden"), user)
    }

    /// Writes an entry unless one of this name exists; returns whether it was written.
    fn add(storage: &Folder, kind: Kind, name: &str, text: &str) -> io::Result<bool> {
        let mut is_new = false;
        storage.change(kind, name, &mut |found| {
            is_new = found.is_none();
            is_new.then(|| text.as_bytes().to_vec())
        })?;
        Ok(is_new)
    }

    #[test]
    fn photo_clip_and_replay_are_written_into_folders_of_the_user() {
        let folder = tempfile::tempdir().unwrap();
        let storage = with_user_folders(folder.path());
        for (kind, path) in [
            (Kind::Photo, "Pictures/Tamaire/a.png"),
            (Kind::Clip, "Videos/Tamaire/a.gif"),
            (Kind::Replay, "Documents/Tamaire/a.tamaire"),
            (Kind::Best, "hidden/best/a.tamaire"),
            (Kind::Note, "hidden/a.toml"),
        ] {
            assert!(add(&storage, kind, "a", path).unwrap());
            let path = folder.path().join(path);
            assert_eq!(storage.location(kind, "a"), path);
            let text = fs::read_to_string(&path).unwrap();
            assert!(path.ends_with(&text), "{text}");
            assert_eq!(storage.list(kind).unwrap().len(), 1, "{kind:?}");
        }
    }

    #[test]
    fn replay_in_folder_of_game_stays_listed() {
        let folder = tempfile::tempdir().unwrap();
        let old = in_own(folder.path().join("hidden"));
        assert!(add(&old, Kind::Replay, "classic-1", "old").unwrap());
        let storage = with_user_folders(folder.path());
        assert!(
            !add(&storage, Kind::Replay, "classic-1", "new").unwrap(),
            "the name is taken"
        );
        assert!(add(&storage, Kind::Replay, "classic-2", "new").unwrap());
        let names = || {
            let mut names: Vec<String> = { storage.list(Kind::Replay).unwrap().into_iter() }
                .map(|entry| entry.name)
                .collect();
            names.sort();
            names
        };
        assert_eq!(names(), ["classic-1", "classic-2"]);
        let read = |name| storage.read(Kind::Replay, name).unwrap().unwrap();
        assert_eq!(
            (read("classic-1"), read("classic-2")),
            (b"old".to_vec(), b"new".to_vec())
        );
        // A file that the user copied hides the old one of the same name until the copy is deleted.
        let copy = folder.path().join("Documents/Tamaire/classic-1.tamaire");
        fs::write(&copy, "copy").unwrap();
        assert_eq!((names().len(), read("classic-1")), (2, b"copy".to_vec()));
        storage.remove(Kind::Replay, "classic-1").unwrap();
        assert_eq!(read("classic-1"), b"old");
        storage.remove(Kind::Replay, "classic-1").unwrap();
        assert_eq!(names(), ["classic-2"]);
    }

    #[test]
    fn photo_is_written_into_folder_of_game_if_folder_of_user_cannot_be_made() {
        let folder = tempfile::tempdir().unwrap();
        let storage = with_user_folders(folder.path());
        fs::write(folder.path().join("Pictures"), "in the way").unwrap();
        assert!(add(&storage, Kind::Photo, "a", "photo").unwrap());
        let path = folder.path().join("hidden/pictures/a.png");
        assert_eq!(fs::read_to_string(&path).unwrap(), "photo");
        assert_eq!(storage.location(Kind::Photo, "a"), path);
        let error = { storage.open_folder_of(Path::new("nowhere/a.png")) }.unwrap_err();
        assert!(error.to_string().contains("nowhere/a.png"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn photo_is_written_into_folder_of_game_if_folder_of_user_is_read_only() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let storage = with_user_folders(folder.path());
        let pictures = folder.path().join("Pictures/Tamaire");
        fs::create_dir_all(&pictures).unwrap();
        fs::set_permissions(&pictures, fs::Permissions::from_mode(0o555)).unwrap();
        // The administrator may write everywhere.
        let is_allowed = fs::write(pictures.join("probe"), "").is_ok();
        assert!(add(&storage, Kind::Photo, "a", "photo").unwrap());
        let own = folder.path().join("hidden/pictures/a.png");
        let path = if is_allowed {
            pictures.join("a.png")
        } else {
            own
        };
        assert_eq!(fs::read_to_string(&path).unwrap(), "photo");
        assert_eq!(storage.location(Kind::Photo, "a"), path);
        fs::set_permissions(&pictures, fs::Permissions::from_mode(0o755)).unwrap();
    }

    #[test]
    fn concurrent_changes_are_not_lost() {
        let folder = tempfile::tempdir().unwrap();
        // Two storages use the same folder, as in two programs.
        let counts = [0, 1].map(|_| {
            let storage = Arc::new(in_own(folder.path().join("new")));
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
        let storage = in_own(folder.path().join("new"));
        let count = storage.read(Kind::Note, "count").unwrap().unwrap();
        assert_eq!(count.len(), 80);
        let names = fs::read_dir(&storage.own).unwrap().flatten();
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
        let storage = in_own(folder.path().into());
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
        let storage = in_own(folder.path().join("inside"));
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
        let storage = in_own(folder.path().into());
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
