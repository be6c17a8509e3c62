//! Stored data: settings, records, levels, replays and pictures. One thread writes all data, another thread
//! makes the pictures.

pub use super::keeping::Damage;
use super::keeping::{
    RECORDS, is_aside, keep_best, keep_text, kept_text, merge_records, name_of_best, put_aside,
    read_level, save, save_packs, save_replay, stem_of,
};
use super::pictures::Pictures;
use super::storage::{Entry, Kind, Nowhere, Storage};
use super::writer::Writer;
use crate::records::Records;
use crate::settings::Settings;
use crate::words::Language;
use std::collections::VecDeque;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use tamaire_play::{Level, Replay, ReplayError};

/// Maximum number of stored levels read at the start. If there are more, only the newest are read.
pub const MOST_LEVELS: usize = 100;

const SETTINGS: &str = "settings";
/// Time without changes after which settings are written [s]. A dragged slider changes them in each frame.
const REST: f32 = 1.0;

/// Stored data and its storage.
pub struct Files {
    storage: Arc<dyn Storage>,
    writer: Writer<JobResult>,
    /// Makes photos and clips on a separate thread, because each takes seconds.
    darkroom: Writer<JobResult>,
    /// Settings used if none are stored.
    usual: Settings,
    /// Text of the settings to be written, and the remaining time until it is written [s].
    resting: Option<(String, f32)>,
    /// Queue of photos and clips. The first one is being made.
    picture_queue: VecDeque<(Kind, Arc<Replay>)>,
    /// Progress of the picture that is being made [%].
    developed: Arc<AtomicU32>,
    pictures: Pictures,
    /// Whether a failure was reported and no write has succeeded since.
    is_failing: bool,
}

/// Data folder of the game according to the system, if any.
#[cfg(not(target_family = "wasm"))]
pub fn data_folder() -> Option<PathBuf> {
    let folders = directories::ProjectDirs::from("", "", "tamaire")?;
    Some(folders.data_dir().into())
}

/// Returns a key that sorts names by their letters, without regard to case, and then by the number at their end: `level-2`
/// comes before `level-10`.
fn natural(name: &str) -> (String, u64, String) {
    let digits = name.chars().rev().take_while(char::is_ascii_digit).count();
    let (stem, number) = name.split_at(name.len() - digits);
    (
        stem.to_lowercase(),
        number.parse().unwrap_or(0),
        name.to_string(),
    )
}

/// Result of a job.
enum JobResult {
    Note(io::Result<()>),
    Level(io::Result<Result<Arc<Level>, Damage>>),
    Replay(io::Result<PathBuf>),
    Picture(io::Result<PathBuf>),
}

/// Message about stored data.
#[derive(Clone, Debug, PartialEq)]
pub enum StorageEvent {
    /// A level was read.
    Level(Arc<Level>),
    /// Stored data could not be used.
    Damaged(Damage),
    /// A replay or picture was saved at this location.
    Saved(PathBuf),
    /// Writing failed. For settings, records and levels this is reported once, until a write succeeds.
    Failed(String),
    /// Writing failed because the storage is full.
    Full,
}

impl Files {
    /// Opens the storage in the system's data folder for the game, with photos, clips and replays in the system's
    /// folders for pictures, videos and documents.
    #[cfg(not(target_family = "wasm"))]
    pub fn usual() -> Self {
        let files = match data_folder() {
            Some(folder) => {
                let user = super::folder::UserFolders::of_system();
                Self::on(super::folder::Folder::new(folder, user))
            }
            None => Self::on(Nowhere {
                reason: Some("the system has no data folder for the game"),
            }),
        };
        files.speaking(&sys_locale::get_locale().unwrap_or_default())
    }

    /// Opens the browser's storage for this page. If the browser refuses, nothing is stored.
    #[cfg(target_family = "wasm")]
    pub fn usual() -> Self {
        let host = super::here::host();
        let files = match host.refusal() {
            None => Self::on(super::here::BrowserStorage::default()),
            Some(_) => Self::on(Nowhere {
                reason: Some("the browser keeps nothing for this page"),
            }),
        };
        files.speaking(&host.language())
    }

    /// Stores all data in the given folder.
    #[cfg(not(target_family = "wasm"))]
    pub fn in_folder(folder: impl Into<PathBuf>) -> Self {
        let user = super::folder::UserFolders::default();
        Self::on(super::folder::Folder::new(folder.into(), user))
    }

    /// Stores nothing, by choice.
    pub fn nowhere() -> Self {
        Self::on(Nowhere { reason: None })
    }

    /// Stores data in `storage`.
    pub fn on(storage: impl Storage + 'static) -> Self {
        Self {
            storage: Arc::new(storage),
            writer: Writer::new(),
            darkroom: Writer::new(),
            usual: Settings::default(),
            resting: None,
            picture_queue: VecDeque::new(),
            developed: Arc::default(),
            pictures: Pictures::default(),
            is_failing: false,
        }
    }

    /// Sets the language of players without stored settings, from a locale such as `ja-JP`.
    pub fn speaking(mut self, locale: &str) -> Self {
        self.usual.language = Language::of_locale(locale);
        self
    }

    /// Reads the settings, with default values for those that cannot be used.
    pub fn settings(&mut self) -> (Settings, Option<Damage>) {
        // If the settings are unreadable, the chosen force is unknown, so force feedback starts at zero.
        let lost = Settings {
            haptics: 0.0,
            ..self.usual.clone()
        };
        self.read(SETTINGS, Settings::read, self.usual.clone(), lost)
    }

    /// Reads the records.
    pub fn records(&mut self) -> (Records, Option<Damage>) {
        let none = Records::default();
        self.read(RECORDS, Records::read, none.clone(), none)
    }

    /// Reads settings or records by their name. Returns `usual` if they do not exist, and `lost` if they
    /// cannot be read.
    fn read<T>(
        &mut self,
        name: &str,
        of: fn(&str) -> (T, Vec<String>),
        usual: T,
        lost: T,
    ) -> (T, Option<Damage>) {
        let bytes = match self.storage.read(Kind::Note, name) {
            Ok(Some(bytes)) => bytes,
            Ok(None) => return (usual, None),
            Err(error) => {
                let location = self.storage.location(Kind::Note, name);
                let refused = vec![format!("{} ({error})", location.display())];
                let aside = None;
                let is_told = std::mem::replace(&mut self.is_failing, true);
                let damage = (!is_told).then_some(Damage { refused, aside });
                let was_kept = error.kind() != io::ErrorKind::NotFound;
                return (if was_kept { lost } else { usual }, damage);
            }
        };
        let text = String::from_utf8_lossy(&bytes);
        let (value, refused) = of(&text);
        if refused.is_empty() {
            return (value, None);
        }
        let aside = put_aside(&*self.storage, Kind::Note, name, &bytes).ok();
        (value, Some(Damage { refused, aside }))
    }

    /// Schedules settings to be written after `REST` without changes, or at the end of the program.
    pub fn keep_settings(&mut self, settings: &Settings) {
        self.resting = Some((settings.text(), REST));
    }

    /// Writes records and merges those that another program wrote in the meantime.
    pub fn keep_records(&mut self, records: &Records, levels: &[Arc<Level>]) {
        let (storage, records) = (self.storage.clone(), records.clone());
        let levels = levels.to_vec();
        self.writer.write(
            move || merge_records(&*storage, &records, &levels),
            JobResult::Note,
        );
    }

    /// Reads the stored levels. They arrive one by one as [`StorageEvent::Level`], in the order of their
    /// names.
    pub fn read_levels(&mut self) {
        let mut found = self.storage.list(Kind::Level).unwrap_or_default();
        found.retain(|entry| !is_aside(&entry.name));
        found.sort_by(|a, b| a.written.cmp(&b.written).then(a.name.cmp(&b.name)));
        let older = found.len().saturating_sub(MOST_LEVELS);
        let mut newest = found.split_off(older);
        // A changed level keeps its place in the list.
        newest.sort_by_cached_key(|entry| natural(&entry.name));
        for Entry { name, .. } in newest {
            let storage = self.storage.clone();
            self.writer
                .write(move || Ok(read_level(&*storage, &name)), JobResult::Level);
        }
    }

    /// Waits until the stored levels are read, and returns the results of the finished jobs. A browser does not allow
    /// waiting, and reads all levels in the first frames.
    pub fn await_levels(&mut self) -> Vec<StorageEvent> {
        let done = match cfg!(target_family = "wasm") {
            true => self.writer.results(),
            false => self.writer.finish(),
        };
        self.news(done)
    }

    /// Stores a level and replaces one with the same id.
    pub fn keep_level(&mut self, level: Arc<Level>) {
        let storage = self.storage.clone();
        let job = move || {
            let text = level.text_to_keep().map_err(io::Error::other)?;
            keep_text(&*storage, &level.id, &text)
        };
        self.writer.write(job, JobResult::Note);
    }

    /// Stores the text of a level under its id, and replaces one with the same id.
    pub fn keep_level_text(&mut self, id: &str, text: String) {
        let (storage, id) = (self.storage.clone(), id.to_string());
        let job = move || keep_text(&*storage, &id, &text);
        self.writer.write(job, JobResult::Note);
    }

    /// Returns the text of a stored level, as it was written.
    pub fn level_text(&self, id: &str) -> Option<String> {
        kept_text(&*self.storage, id)
    }

    /// Stores the text of a level, and tells where. In a browser, the player gets it as a file.
    pub fn save_level(&mut self, id: &str, text: String) {
        let (storage, id) = (self.storage.clone(), id.to_string());
        let job = move || {
            keep_text(&*storage, &id, &text)?;
            if storage.can_export() {
                storage.export(Kind::Level, &id)?;
            }
            Ok(storage.location(Kind::Level, &id))
        };
        self.writer.write(job, JobResult::Replay);
    }

    /// Saves levels as a pack. In a browser, the player gets it as a file.
    pub fn save_pack(&mut self, levels: Vec<Arc<Level>>) {
        let storage = self.storage.clone();
        let job = move || {
            let mut texts = Vec::new();
            for level in levels {
                // A stored text may have remarks of its author.
                let text = match kept_text(&*storage, &level.id) {
                    Some(text) => text,
                    None => level.text_to_keep().map_err(io::Error::other)?,
                };
                texts.push((level.id.clone(), text));
            }
            save_packs(&*storage, &texts)
        };
        self.writer.write(job, JobResult::Replay);
    }

    /// Deletes a stored level. Its records stay.
    pub fn remove_level(&mut self, name: &str) {
        let (storage, name) = (self.storage.clone(), name.to_string());
        let job = move || match storage.remove(Kind::Level, &name) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            removed => removed,
        };
        self.writer.write(job, JobResult::Note);
    }

    /// Saves a replay.
    pub fn save_replay(&mut self, replay: Replay) {
        let storage = self.storage.clone();
        self.writer
            .write(move || save_replay(&*storage, &replay), JobResult::Replay);
    }

    /// Queues a photo or clip of a round to be made and saved, unless the same one is in the queue.
    pub fn save_picture(&mut self, kind: Kind, replay: Arc<Replay>) {
        let picture = (kind, replay);
        if self.picture_queue.contains(&picture) {
            return;
        }
        self.picture_queue.push_back(picture);
        if self.picture_queue.len() == 1 {
            self.make_picture();
        }
    }

    /// Begins to make the first picture of the queue, if there is one.
    fn make_picture(&mut self) {
        let Some((kind, replay)) = self.picture_queue.front().cloned() else {
            return;
        };
        let developed = Arc::new(AtomicU32::new(0));
        self.developed = developed.clone();
        let (storage, pictures) = (self.storage.clone(), self.pictures.clone());
        self.darkroom.develop(move || async move {
            let stem = stem_of(&replay);
            let told = |share: f32| developed.store((100.0 * share) as u32, Ordering::Relaxed);
            let picture = pictures.shoot(kind, replay, told).await;
            let picture = picture.map_err(io::Error::other);
            JobResult::Picture(picture.and_then(|bytes| save(&*storage, kind, &stem, &bytes)))
        });
    }

    /// Deletes the oldest entries of a kind, so that at most `most` remain.
    pub fn thin_out(&mut self, kind: Kind, most: usize) {
        let storage = self.storage.clone();
        let job = move || {
            let mut kept = storage.list(kind)?;
            kept.sort_by_key(|entry| entry.written);
            let older = kept.len().saturating_sub(most);
            let mut older = kept.into_iter().take(older);
            older.try_for_each(|entry| storage.remove(kind, &entry.name))
        };
        self.writer.write(job, JobResult::Note);
    }

    /// Progress of the photo or clip that is being made, 0 to 1. `None` if there is none.
    pub fn picture_progress(&self) -> Option<f32> {
        let share = self.developed.load(Ordering::Relaxed) as f32 / 100.0;
        (!self.picture_queue.is_empty()).then_some(share)
    }

    /// Advances the time by `seconds` [s]. Returns the results of finished jobs.
    pub fn pass(&mut self, seconds: f32) -> Vec<StorageEvent> {
        if let Some((_, left)) = &mut self.resting {
            *left -= seconds;
            if *left <= 0.0 {
                self.write_settings();
            }
        }
        let mut done = self.writer.results();
        done.extend(self.darkroom.results());
        let late = self
            .storage
            .take_failure()
            .map(|error| JobResult::Note(Err(error)));
        done.extend(late);
        self.news(done)
    }

    /// Writes all pending data and waits until it is written. The pictures of the queue are made, too, which can take
    /// some seconds each.
    pub fn finish(&mut self) -> Vec<StorageEvent> {
        self.write_settings();
        let done = self.writer.finish();
        let mut news = self.news(done);
        // The news about a picture starts the next one.
        loop {
            let done = self.darkroom.finish();
            if done.is_empty() {
                return news;
            }
            news.extend(self.news(done));
        }
    }

    /// Writes all pending data at the end of the program.
    pub fn close(&mut self) {
        for news in self.finish() {
            // There is no window any more, so errors go to the terminal.
            let reason = match news {
                StorageEvent::Failed(reason) => reason,
                StorageEvent::Full => "the storage is full".into(),
                _ => continue,
            };
            // Standard error may be closed.
            let _ = writeln!(std::io::stderr(), "tamaire: cannot save data: {reason}");
        }
    }

    /// Whether data is still to be written.
    pub fn is_busy(&self) -> bool {
        self.resting.is_some() || self.writer.is_busy() || self.darkroom.is_busy()
    }

    fn write_settings(&mut self) {
        if let Some((text, _)) = self.resting.take() {
            let storage = self.storage.clone();
            let mut change = move |_: Option<&[u8]>| Some(text.clone().into_bytes());
            self.writer.write(
                move || storage.change(Kind::Note, SETTINGS, &mut change),
                JobResult::Note,
            );
        }
    }

    fn news(&mut self, done: Vec<JobResult>) -> Vec<StorageEvent> {
        let mut news = Vec::new();
        for done in done {
            if let JobResult::Picture(_) = done {
                self.picture_queue.pop_front();
                self.make_picture();
            }
            match done {
                JobResult::Level(Ok(Ok(level))) => news.push(StorageEvent::Level(level)),
                JobResult::Level(Ok(Err(damage))) => news.push(StorageEvent::Damaged(damage)),
                JobResult::Replay(Ok(location)) | JobResult::Picture(Ok(location)) => {
                    news.push(StorageEvent::Saved(location));
                }
                JobResult::Replay(Err(error)) | JobResult::Picture(Err(error)) => {
                    news.push(failed(&error))
                }
                JobResult::Note(Ok(())) => self.is_failing = false,
                JobResult::Note(Err(error)) | JobResult::Level(Err(error)) if !self.is_failing => {
                    self.is_failing = true;
                    news.push(failed(&error));
                }
                JobResult::Note(Err(_)) | JobResult::Level(Err(_)) => {}
            }
        }
        news
    }

    /// Stores a won round as the ghost of its level, unless a faster one is stored.
    pub fn keep_best(&mut self, level: &Level, replay: Replay) {
        let (storage, name) = (self.storage.clone(), name_of_best(level));
        self.writer.write(
            move || keep_best(&*storage, &name, &replay),
            JobResult::Note,
        );
    }

    /// Returns the fastest stored win of a level.
    pub fn best(&self, level: &Level) -> Option<Replay> {
        self.round(Kind::Best, &name_of_best(level)).ok()
    }

    /// Whether replays can be given to the player as files.
    pub fn hands_out(&self) -> bool {
        self.storage.can_export()
    }

    /// Gives a replay to the player as a file.
    ///
    /// # Errors
    /// The error of the system.
    pub fn hand_out(&self, name: &str) -> io::Result<()> {
        self.storage.export(Kind::Replay, name)
    }

    /// Whether saved files are in folders that [`Files::open_folder_of`] can open.
    pub fn has_folders(&self) -> bool {
        self.storage.has_folders()
    }

    /// Opens the folder of a saved file in the system's file manager. `location` comes from
    /// [`StorageEvent::Saved`].
    ///
    /// # Errors
    /// The error of the system.
    pub fn open_folder_of(&self, location: &Path) -> io::Result<()> {
        self.storage.open_folder_of(location)
    }

    /// Returns the saved replays, the newest first.
    pub fn replays(&self) -> Vec<Entry> {
        let mut found = self.storage.list(Kind::Replay).unwrap_or_default();
        found.sort_by(|a, b| b.written.cmp(&a.written).then(a.name.cmp(&b.name)));
        found
    }

    /// Reads a saved replay.
    ///
    /// # Errors
    /// [`ReplayError`] if it cannot be read or is not a replay.
    pub fn replay(&self, name: &str) -> Result<Replay, ReplayError> {
        self.round(Kind::Replay, name)
    }

    /// Reads the replay stored as an entry of `kind`.
    fn round(&self, kind: Kind, name: &str) -> Result<Replay, ReplayError> {
        let unreadable = |reason: String| ReplayError::Unreadable(reason);
        let read = self.storage.read(kind, name);
        let bytes = read.map_err(|error| unreadable(error.to_string()))?;
        let bytes = bytes.ok_or_else(|| unreadable("the file no longer exists".into()))?;
        Replay::of_bytes(&bytes)
    }

    /// Location of a replay, as text for the player.
    pub fn location(&self, name: &str) -> String {
        let location = self.storage.location(Kind::Replay, name);
        location.display().to_string()
    }

    /// Deletes a replay.
    ///
    /// # Errors
    /// The error of the system.
    pub fn delete(&self, name: &str) -> io::Result<()> {
        self.storage.remove(Kind::Replay, name)
    }
}

fn failed(error: &io::Error) -> StorageEvent {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => StorageEvent::Full,
        _ => StorageEvent::Failed(error.to_string()),
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        self.close();
    }
}
