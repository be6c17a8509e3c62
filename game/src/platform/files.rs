//! What is kept between two evenings: settings, records, replays.

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use tamaire_play::{Replay, ReplayError};

/// Most bytes of a replay that are read.
const MAX_REPLAY_BYTES: u64 = 1 << 25;

/// The folder in which everything is kept.
#[derive(Clone, Debug)]
pub struct Files {
    /// Nothing where the system names no place to keep things: then the game forgets.
    folder: Option<PathBuf>,
}

/// A replay in the folder.
#[derive(Clone, Debug)]
pub struct SavedReplay {
    /// Its file.
    pub path: PathBuf,
    /// When it was written.
    pub written: SystemTime,
}

impl Files {
    /// The folder that the system means for this.
    #[cfg(not(target_family = "wasm"))]
    pub fn usual() -> Self {
        let folders = directories::ProjectDirs::from("", "", "tamaire");
        let folder = folders.map(|folders| folders.data_dir().to_path_buf());
        Self { folder }
    }

    /// A folder of one's own.
    pub fn in_folder(folder: impl Into<PathBuf>) -> Self {
        let folder = Some(folder.into());
        Self { folder }
    }

    /// Nothing is kept.
    pub fn nowhere() -> Self {
        Self { folder: None }
    }

    /// What was kept under a name; the usual where there is nothing. What cannot be read is put
    /// aside, and the second value says where.
    pub fn read<T: DeserializeOwned + Default>(&self, name: &str) -> (T, Option<PathBuf>) {
        let Some(path) = self.folder.as_ref().map(|folder| folder.join(name)) else {
            return (T::default(), None);
        };
        if !path.exists() {
            return (T::default(), None);
        }
        let text = fs::read_to_string(&path).unwrap_or_default();
        if let (false, Ok(value)) = (text.is_empty(), toml::from_str(&text)) {
            return (value, None);
        }
        let free = (1..).map(|number| path.with_extension(format!("broken-{number}.toml")));
        let aside = free.into_iter().find(|aside| !aside.exists());
        let aside = aside.expect("some number is free");
        let moved = fs::rename(&path, &aside);
        (T::default(), Some(if moved.is_ok() { aside } else { path }))
    }

    /// Keeps something under a name.
    ///
    /// # Errors
    /// What the system says when it cannot be written.
    pub fn write<T: Serialize>(&self, name: &str, value: &T) -> io::Result<()> {
        let Some(folder) = &self.folder else {
            return Ok(());
        };
        let text = toml::to_string(value).map_err(io::Error::other)?;
        write_whole(&folder.join(name), &text)
    }

    /// Keeps a replay; says in which file.
    ///
    /// # Errors
    /// What the system says when it cannot be written.
    pub fn save_replay(&self, replay: &Replay) -> io::Result<PathBuf> {
        let missing = || io::Error::new(io::ErrorKind::NotFound, "no folder for files");
        let folder = self.folder.as_ref().ok_or_else(missing)?.join("replays");
        let is_plain = |letter: char| letter.is_alphanumeric() || letter == '-';
        let stem = Path::new(&replay.level).file_stem().unwrap_or_default();
        let name: String = stem
            .to_string_lossy()
            .chars()
            .filter(|&k| is_plain(k))
            .collect();
        let free = (1..).map(|number| folder.join(format!("{name}-{number}.tamaire")));
        let path = free.into_iter().find(|path| !path.exists());
        let path = path.expect("some number is free");
        write_whole(&path, &replay.text())?;
        Ok(path)
    }

    /// The replays in the folder, the newest first.
    pub fn replays(&self) -> Vec<SavedReplay> {
        let Some(folder) = &self.folder else {
            return Vec::new();
        };
        let entries = fs::read_dir(folder.join("replays"))
            .into_iter()
            .flatten()
            .flatten();
        let mut found: Vec<SavedReplay> = entries
            .filter(|entry| {
                entry
                    .path()
                    .extension()
                    .is_some_and(|ending| ending == "tamaire")
            })
            .filter_map(|entry| {
                let written = entry.metadata().and_then(|data| data.modified()).ok()?;
                let path = entry.path();
                Some(SavedReplay { path, written })
            })
            .collect();
        found.sort_by(|a, b| b.written.cmp(&a.written).then(a.path.cmp(&b.path)));
        found
    }

    /// The replay in a file.
    ///
    /// # Errors
    /// [`ReplayError`] when it cannot be read or is none.
    pub fn replay(path: &Path) -> Result<Replay, ReplayError> {
        let unreadable = |error: io::Error| ReplayError::Text(error.to_string());
        let length = fs::metadata(path).map_err(unreadable)?.len();
        if length > MAX_REPLAY_BYTES {
            let reason = format!("longer than {MAX_REPLAY_BYTES} bytes, the most that are read");
            return Err(ReplayError::Text(reason));
        }
        Replay::read(&fs::read_to_string(path).map_err(unreadable)?)
    }

    /// Deletes a replay.
    ///
    /// # Errors
    /// What the system says when it cannot.
    pub fn delete(&self, replay: &SavedReplay) -> io::Result<()> {
        fs::remove_file(&replay.path)
    }
}

/// Writes a file so that it is never half there.
fn write_whole(path: &Path, text: &str) -> io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let draft = path.with_extension("draft");
    let mut file = File::create(&draft)?;
    file.write_all(text.as_bytes())?;
    file.sync_all()?;
    fs::rename(&draft, path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("tamaire-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        folder
    }

    #[test]
    fn what_was_written_is_read_again_and_what_is_broken_is_put_aside() {
        let folder = folder("files");
        let files = Files::in_folder(&folder);
        let settings = Settings {
            speed: 0.75,
            ..Settings::default()
        };
        files.write("settings.toml", &settings).unwrap();
        assert_eq!(files.read("settings.toml"), (settings, None));
        fs::write(folder.join("settings.toml"), "speed = \"fast\"").unwrap();
        let (read, aside) = files.read::<Settings>("settings.toml");
        assert_eq!(read, Settings::default());
        let kept = fs::read_to_string(aside.unwrap()).unwrap();
        assert_eq!(kept, "speed = \"fast\"");
        fs::remove_dir_all(folder).unwrap();
    }
}
