//! Storage of a stand: the logbook, the best rounds of the day, and clips for the operator.

use super::config::Config;
use super::visit::Visit;
use crate::platform::{Files, Kind as Kept, StandFolder, StorageEvent};
use crate::words::Language;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Instant, SystemTime};
use tamaire_logbook::{
    Entry, Event, Health, Id, Kind, Moment, Options, Recorder, Round, Server, Today,
};
use tamaire_play::Replay;

/// Number of the day's best rounds that are shown while the stand is idle.
const BEST: usize = 5;
/// Interval between two queries to the logbook while the stand is idle [s]. A query returns the figures of
/// the day and the best rounds of one level. The levels take turns.
const ASKED: f32 = 60.0;
/// Interval between two checks whether a query was answered [s]. A check copies the answer with all its
/// rounds, which would be wasteful in each frame.
const LOOKED: f32 = 1.0;
/// Free disk space below which no clips are made [bytes].
const ROOM: u64 = 500 << 20;
/// Maximum number of won rounds that wait until a clip of them is made.
const WAITING: usize = 8;
/// Smallest change of the system clock that is logged [s].
const LEAP: f64 = 60.0;

/// Storage of a stand.
pub struct Memory {
    recorder: Recorder,
    stand: String,
    folder: StandFolder,
    clips: Files,
    /// Won rounds from which clips will be made while the stand is idle.
    waiting: VecDeque<Arc<Replay>>,
    /// Monotonic time and wall-clock time of the same moment. Changes of the system clock are detected from
    /// them.
    began: (Instant, SystemTime),
    /// Last known problem of the recorder.
    trouble: Option<String>,
    best: Vec<Id>,
    /// Number of queries for best rounds so far. The number, modulo the number of levels, selects the level
    /// of the next query.
    turn: usize,
    /// Time since the last query [s].
    asked: f32,
    /// Time since the last check for an answer [s].
    looked: f32,
}

impl Memory {
    /// Opens the logbook and logs the start of the stand.
    pub fn begin(config: &Config) -> Self {
        let folder = StandFolder::of(config.logbook.folder.as_deref());
        let server = config.logbook.server.clone();
        let options = Options {
            keep_days: Some(config.logbook.days),
            server: server.map(|server| Server { address: server.0 }),
            ..Options::default()
        };
        let stand = config.stand.0.clone();
        let memory = Self {
            recorder: Recorder::begin(&folder.logbook(), &stand, options),
            stand,
            clips: folder.files(),
            folder,
            waiting: VecDeque::new(),
            began: (Instant::now(), SystemTime::now()),
            trouble: None,
            best: Vec::new(),
            turn: 0,
            asked: 0.0,
            looked: 0.0,
        };
        memory.note(Kind::Began, env!("CARGO_PKG_VERSION"));
        memory
    }

    /// Logs an event.
    pub fn note(&self, kind: Kind, text: &str) {
        self.recorder.record(Entry::Event(Event {
            id: Id::random(),
            stand: self.stand.clone(),
            at: Moment::now(),
            kind,
            text: text.into(),
        }));
    }

    /// Logs the start of a visit, unless it is already logged. Called at the end of a round, when it is clear
    /// that the visitor is not staff.
    pub fn note_visit(&self, visit: &mut Visit, config: &Config) {
        if std::mem::replace(&mut visit.is_noted, true) {
            return;
        }
        let begun = tamaire_logbook::Visit {
            id: visit.id,
            stand: self.stand.clone(),
            began: visit.began,
            ended: None,
            language: config.language.code().into(),
        };
        self.recorder.record(Entry::VisitBegan(begun));
    }

    /// Logs the end of a visit and the language last used.
    pub fn end_visit(&self, visit: &Visit, spoken: Language) {
        self.recorder.record(Entry::VisitEnded {
            id: visit.id,
            at: Moment::now(),
            language: spoken.code().into(),
        });
    }

    /// Logs a round, and queues a won round for a clip.
    pub fn note_round(&mut self, round: Round, replay: Replay) {
        if round.route.is_some() {
            self.waiting.truncate(WAITING - 1);
            self.waiting.push_front(Arc::new(replay));
        }
        self.recorder.record(Entry::Round(round));
    }

    /// Requests the figures of the day and the best rounds of the next level in turn.
    pub fn ask(&mut self, config: &Config) {
        self.asked = 0.0;
        let midnight = Moment::now().midnight();
        self.recorder.ask_today(midnight);
        let levels = &config.levels.0;
        let level = &levels[self.turn % levels.len()];
        self.turn += 1;
        let hash = Some(level.hash());
        self.recorder.ask_best(midnight, &level.id, hash, BEST);
    }

    /// Returns the best rounds of the day if they changed since the last call.
    pub fn take_best(&mut self) -> Option<Vec<Arc<Replay>>> {
        if self.looked < LOOKED {
            return None;
        }
        self.looked = 0.0;
        let best = self.recorder.best()?;
        let ids: Vec<Id> = best.iter().map(|round| round.id).collect();
        if ids == self.best {
            return None;
        }
        self.best = ids;
        let replays = best.iter();
        let replays = replays.filter_map(|round| Replay::of_fragment(&round.replay).ok());
        let mut replays: Vec<Replay> = replays.collect();
        // The times in the logbook include the time before the first push.
        replays.sort_by_key(Replay::clock_ticks);
        Some(replays.into_iter().map(Arc::new).collect())
    }

    /// Advances by a frame of `seconds` [s]: handles storage events, repeats the queries to the logbook, and
    /// checks the clock and the recorder. Makes clips of replays while the stand is idle.
    pub fn pass(&mut self, config: &Config, is_idle: bool, seconds: f32) {
        for news in self.clips.pass(seconds) {
            match news {
                StorageEvent::Saved(_) => self.clips.thin_out(Kept::Clip, config.take_home.clips),
                StorageEvent::Failed(reason) => self.note(Kind::Other("no_clip".into()), &reason),
                StorageEvent::Full => self.note(Kind::FullDisk, "a clip was not kept"),
                StorageEvent::Level(_) | StorageEvent::Damaged(_) => {}
            }
        }
        if is_idle && !self.clips.is_busy() {
            self.make_clip(config);
        }
        self.asked += seconds;
        self.looked += seconds;
        if is_idle && self.asked > ASKED {
            self.ask(config);
        }
        self.look_at_clock();
        let trouble = self.recorder.health().problem;
        if trouble != self.trouble {
            // Prints the problem only to the terminal: the recorder itself logs important problems as soon as
            // it can write.
            if let Some(trouble) = &trouble {
                output::warn(format_args!(
                    "tamaire: visits are not being logged: {trouble}"
                ));
            }
            self.trouble = trouble;
        }
    }

    fn make_clip(&mut self, config: &Config) {
        let Some(replay) = self.waiting.pop_back() else {
            return;
        };
        if config.take_home.clips > 0 && self.room().is_none_or(|room| room > ROOM) {
            self.clips.save_picture(Kept::Clip, replay);
        }
    }

    /// Logs changes of the system clock.
    fn look_at_clock(&mut self) {
        let (instant, wall) = self.began;
        let now = SystemTime::now();
        let ahead = match now.duration_since(wall + instant.elapsed()) {
            Ok(ahead) => ahead.as_secs_f64(),
            Err(behind) => -behind.duration().as_secs_f64(),
        };
        if ahead.abs() > LEAP {
            self.began = (Instant::now(), now);
            self.note(Kind::ClockChanged, &format!("{ahead:+.0} s"));
        }
    }

    /// Figures of the day, as of the last answered query.
    pub fn today(&self) -> Today {
        self.recorder.today().unwrap_or_default()
    }

    /// State of the recorder.
    pub fn health(&self) -> Health {
        self.recorder.health()
    }

    /// Free disk space [bytes]. `None` if unknown.
    pub fn room(&self) -> Option<u64> {
        self.folder.room()
    }

    /// Requests a copy of the logbook in its folder, named after the date.
    pub fn export(&self) {
        self.recorder.ask_export(self.folder.copy(Moment::now()));
    }

    /// Returns the result of [`Self::export`] once: the path, or the error.
    pub fn take_exported(&self) -> Option<Result<String, String>> {
        let exported = self.recorder.exported()?;
        Some(exported.map(|path| path.display().to_string()))
    }
}
