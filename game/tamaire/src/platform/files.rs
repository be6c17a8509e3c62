//! What is kept between two evenings: settings, records, replays. All is written on a thread of its own, and pictures are made on another.

pub use super::keeping::Damage;
use super::keeping::{
    RECORDS, is_aside, keep_best, merge_records, name_of_best, put_aside, read_level, save,
    save_replay, stem_of,
};
use super::pictures::Pictures;
use super::storage::{Entry, Kind, Nowhere, Storage};
use super::writer::Writer;
use crate::records::Records;
use crate::settings::Settings;
use crate::words::Language;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use tamaire_play::{Level, Replay, ReplayError};

/// Most levels that are read at the start: those that were kept last.
const MOST_LEVELS: usize = 100;

const SETTINGS: &str = "settings";
/// Settings are written when they were not changed for so long [s]: a slider that is dragged changes them in each frame.
const REST: f32 = 1.0;

/// What is kept, and where.
pub struct Files {
    storage: Arc<dyn Storage>,
    writer: Writer<Done>,
    /// Photos and clips take seconds, for which nothing else has to wait.
    darkroom: Writer<Done>,
    /// What settings are where none were kept.
    usual: Settings,
    /// Settings that are still to be written, and in how long [s].
    resting: Option<(String, f32)>,
    /// How much of the picture that is being made is done [%].
    developed: Option<Arc<AtomicU32>>,
    pictures: Pictures,
    /// Whether it was told that something failed, and nothing was written since.
    is_failing: bool,
}

/// The folder that the system means for what the game keeps, if it names one.
#[cfg(not(target_family = "wasm"))]
pub fn data_folder() -> Option<std::path::PathBuf> {
    let folders = directories::ProjectDirs::from("", "", "tamaire")?;
    Some(folders.data_dir().into())
}

/// What became of something that was to be written.
enum Done {
    Note(io::Result<()>),
    Level(io::Result<Result<Arc<Level>, Damage>>),
    Replay(io::Result<String>),
    Picture(io::Result<String>),
}

/// What there is to tell of what was written.
#[derive(Clone, Debug, PartialEq)]
pub enum News {
    /// A level was kept, and here it is.
    Level(Arc<Level>),
    /// Of what was kept something cannot be used.
    Damaged(Damage),
    /// A replay is kept, here.
    Saved(String),
    /// What was to be kept could not be written. Of settings and records this is told once.
    Failed(String),
    /// The same, because there is no room.
    Full,
}

impl Files {
    /// The folder that the system means for this.
    #[cfg(not(target_family = "wasm"))]
    pub fn usual() -> Self {
        let files = match data_folder() {
            Some(folder) => Self::in_folder(folder),
            None => Self::on(Nowhere {
                reason: Some("the system names no folder to keep things in"),
            }),
        };
        files.speaking(&sys_locale::get_locale().unwrap_or_default())
    }

    /// What the browser keeps for this page, and nothing where it refuses to.
    #[cfg(target_family = "wasm")]
    pub fn usual() -> Self {
        let host = super::here::host();
        let files = match host.refusal() {
            None => Self::on(super::here::Kept::default()),
            Some(_) => Self::on(Nowhere {
                reason: Some("the browser keeps nothing for this page"),
            }),
        };
        files.speaking(&host.language())
    }

    /// A folder of one's own.
    #[cfg(not(target_family = "wasm"))]
    pub fn in_folder(folder: impl Into<std::path::PathBuf>) -> Self {
        Self::on(super::folder::Folder(folder.into()))
    }

    /// Nothing is kept, by choice.
    pub fn nowhere() -> Self {
        Self::on(Nowhere { reason: None })
    }

    /// All is kept there.
    pub fn on(storage: impl Storage + 'static) -> Self {
        Self {
            storage: Arc::new(storage),
            writer: Writer::new(),
            darkroom: Writer::new(),
            usual: Settings::default(),
            resting: None,
            developed: None,
            pictures: Pictures::default(),
            is_failing: false,
        }
    }

    /// The same; who has no settings yet is spoken to as the system speaks, which is named as in `ja-JP`.
    pub fn speaking(mut self, locale: &str) -> Self {
        self.usual.language = Language::of_locale(locale);
        self
    }

    /// The settings that were kept, the usual for what cannot be used of them.
    pub fn settings(&mut self) -> (Settings, Option<Damage>) {
        // Nobody knows how strong forces were to be.
        let lost = Settings {
            haptics: 0.0,
            ..self.usual.clone()
        };
        self.read(SETTINGS, Settings::read, self.usual.clone(), lost)
    }

    /// The records that were kept.
    pub fn records(&mut self) -> (Records, Option<Damage>) {
        let none = Records::default();
        self.read(RECORDS, Records::read, none.clone(), none)
    }

    /// What was kept under a name, `usual` where nothing was, and `lost` where that cannot be read at all.
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
                let refused = vec![format!("{location} ({error})")];
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

    /// Keeps these settings, once they rest and at the end of the program.
    pub fn keep_settings(&mut self, settings: &Settings) {
        self.resting = Some((settings.text(), REST));
    }

    /// Keeps these records of these levels, and those that another program wrote in the meantime.
    pub fn keep_records(&mut self, records: &Records, levels: &[Arc<Level>]) {
        let (storage, records) = (self.storage.clone(), records.clone());
        let levels = levels.to_vec();
        self.writer.write(
            move || merge_records(&*storage, &records, &levels),
            Done::Note,
        );
    }

    /// Reads the levels that were kept. They come one by one as [`News::Level`], those that were kept first first.
    pub fn read_levels(&mut self) {
        let mut found = self.storage.list(Kind::Level).unwrap_or_default();
        found.retain(|entry| !is_aside(&entry.name));
        found.sort_by(|a, b| a.written.cmp(&b.written).then(a.name.cmp(&b.name)));
        let older = found.len().saturating_sub(MOST_LEVELS);
        for Entry { name, .. } in found.split_off(older) {
            let storage = self.storage.clone();
            self.writer
                .write(move || Ok(read_level(&*storage, &name)), Done::Level);
        }
    }

    /// Keeps a level, in place of one with the same name.
    pub fn keep_level(&mut self, level: Arc<Level>) {
        let storage = self.storage.clone();
        let job = move || {
            let text = level.text_to_keep().map_err(io::Error::other)?;
            let mut change = |_: Option<&[u8]>| Some(text.clone().into_bytes());
            storage.change(Kind::Level, &level.id, &mut change)
        };
        self.writer.write(job, Done::Note);
    }

    /// Keeps a level no longer. What was reached in it stays.
    pub fn remove_level(&mut self, name: &str) {
        let (storage, name) = (self.storage.clone(), name.to_string());
        let job = move || match storage.remove(Kind::Level, &name) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            removed => removed,
        };
        self.writer.write(job, Done::Note);
    }

    /// Keeps a replay.
    pub fn save_replay(&mut self, replay: Replay) {
        let storage = self.storage.clone();
        self.writer
            .write(move || save_replay(&*storage, &replay), Done::Replay);
    }

    /// Makes a photo or a clip of a round and keeps it, unless another one is being made.
    pub fn save_picture(&mut self, kind: Kind, replay: Arc<Replay>) {
        if self.developed.is_some() {
            return;
        }
        let developed = Arc::new(AtomicU32::new(0));
        self.developed = Some(developed.clone());
        let (storage, pictures) = (self.storage.clone(), self.pictures.clone());
        self.darkroom.develop(move || async move {
            let stem = stem_of(&replay);
            let told = |share: f32| developed.store((100.0 * share) as u32, Ordering::Relaxed);
            let picture = pictures.shoot(kind, replay, told).await;
            let picture = picture.map_err(io::Error::other);
            Done::Picture(picture.and_then(|bytes| save(&*storage, kind, &stem, &bytes)))
        });
    }

    /// Keeps of a kind only so many, those that were written last.
    pub fn thin_out(&mut self, kind: Kind, most: usize) {
        let storage = self.storage.clone();
        let job = move || {
            let mut kept = storage.list(kind)?;
            kept.sort_by_key(|entry| entry.written);
            let older = kept.len().saturating_sub(most);
            let mut older = kept.into_iter().take(older);
            older.try_for_each(|entry| storage.remove(kind, &entry.name))
        };
        self.writer.write(job, Done::Note);
    }

    /// How much of a photo or clip is done that is being made, 0 to 1.
    pub fn developed(&self) -> Option<f32> {
        let developed = self.developed.as_ref()?;
        Some(developed.load(Ordering::Relaxed) as f32 / 100.0)
    }

    /// Lets `seconds` pass; tells what became of what was to be written.
    pub fn pass(&mut self, seconds: f32) -> Vec<News> {
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
            .map(|error| Done::Note(Err(error)));
        done.extend(late);
        self.news(done)
    }

    /// Writes what is still to be written, and waits until it is.
    pub fn finish(&mut self) -> Vec<News> {
        self.write_settings();
        let mut done = self.writer.finish();
        done.extend(self.darkroom.finish());
        self.news(done)
    }

    /// Writes what is still to be written at the end of the program.
    pub fn close(&mut self) {
        for news in self.finish() {
            // There is no window any more.
            match news {
                News::Failed(reason) => eprintln!("tamaire: this could not be written: {reason}"),
                News::Full => eprintln!("tamaire: there is no room to write what was to be kept"),
                _ => {}
            }
        }
    }

    /// Whether something is still to be written.
    pub fn is_busy(&self) -> bool {
        self.resting.is_some() || self.writer.is_busy() || self.darkroom.is_busy()
    }

    fn write_settings(&mut self) {
        if let Some((text, _)) = self.resting.take() {
            let storage = self.storage.clone();
            let mut change = move |_: Option<&[u8]>| Some(text.clone().into_bytes());
            self.writer.write(
                move || storage.change(Kind::Note, SETTINGS, &mut change),
                Done::Note,
            );
        }
    }

    fn news(&mut self, done: Vec<Done>) -> Vec<News> {
        let mut news = Vec::new();
        for done in done {
            if let Done::Picture(_) = done {
                self.developed = None;
            }
            match done {
                Done::Level(Ok(Ok(level))) => news.push(News::Level(level)),
                Done::Level(Ok(Err(damage))) => news.push(News::Damaged(damage)),
                Done::Replay(Ok(location)) | Done::Picture(Ok(location)) => {
                    news.push(News::Saved(location));
                }
                Done::Replay(Err(error)) | Done::Picture(Err(error)) => news.push(failed(&error)),
                Done::Note(Ok(())) => self.is_failing = false,
                Done::Note(Err(error)) | Done::Level(Err(error)) if !self.is_failing => {
                    self.is_failing = true;
                    news.push(failed(&error));
                }
                Done::Note(Err(_)) | Done::Level(Err(_)) => {}
            }
        }
        news
    }

    /// Keeps a win as the round to race in its level, unless one that was won faster is kept.
    pub fn keep_best(&mut self, level: &Level, replay: Replay) {
        let (storage, name) = (self.storage.clone(), name_of_best(level));
        self.writer
            .write(move || keep_best(&*storage, &name, &replay), Done::Note);
    }

    /// The fastest win that was kept of a level.
    pub fn best(&self, level: &Level) -> Option<Replay> {
        self.round(Kind::Best, &name_of_best(level)).ok()
    }

    /// Whether replays can be handed to the player as files.
    pub fn hands_out(&self) -> bool {
        self.storage.hands_out()
    }

    /// Hands a replay to the player as a file.
    ///
    /// # Errors
    /// What the system says.
    pub fn hand_out(&self, name: &str) -> io::Result<()> {
        self.storage.hand_out(Kind::Replay, name)
    }

    /// The replays that are kept, the newest first.
    pub fn replays(&self) -> Vec<Entry> {
        let mut found = self.storage.list(Kind::Replay).unwrap_or_default();
        found.sort_by(|a, b| b.written.cmp(&a.written).then(a.name.cmp(&b.name)));
        found
    }

    /// The replay of a name.
    ///
    /// # Errors
    /// [`ReplayError`] when it cannot be read or is none.
    pub fn replay(&self, name: &str) -> Result<Replay, ReplayError> {
        self.round(Kind::Replay, name)
    }

    /// The round of a kind and a name.
    fn round(&self, kind: Kind, name: &str) -> Result<Replay, ReplayError> {
        let unreadable = |reason: String| ReplayError::Unreadable(reason);
        let read = self.storage.read(kind, name);
        let bytes = read.map_err(|error| unreadable(error.to_string()))?;
        let bytes = bytes.ok_or_else(|| unreadable("it is no longer there".into()))?;
        Replay::of_bytes(&bytes)
    }

    /// Where a replay is kept, for people to read.
    pub fn location(&self, name: &str) -> String {
        self.storage.location(Kind::Replay, name)
    }

    /// Deletes a replay.
    ///
    /// # Errors
    /// What the system says when it cannot.
    pub fn delete(&self, name: &str) -> io::Result<()> {
        self.storage.remove(Kind::Replay, name)
    }
}

fn failed(error: &io::Error) -> News {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => News::Full,
        _ => News::Failed(error.to_string()),
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        self.close();
    }
}
