//! What a stand remembers: the logbook, the best rounds of the day, and clips for the operator.

use super::config::Config;
use super::visit::Visit;
use crate::platform::{Files, Kind as Kept, News, StandFolder};
use crate::words::Language;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Instant, SystemTime};
use tamaire_logbook::{
    Entry, Event, Health, Id, Kind, Moment, Options, Recorder, Round, Server, Today,
};
use tamaire_play::Replay;

/// So many of the best rounds of a day are shown while nobody is there.
const BEST: usize = 5;
/// So often it is asked what came of the day [s]: it may be another one, and another level's best are shown.
const ASKED: f32 = 60.0;
/// So often it is looked whether there is an answer [s]: it is some rounds, whole.
const LOOKED: f32 = 1.0;
/// Clips are made while so much room is left on the disk [bytes].
const ROOM: u64 = 500 << 20;
/// So many rounds wait for their clip at most.
const WAITING: usize = 8;
/// A clock that is set by less is not told [s].
const LEAP: f64 = 60.0;

/// What a stand remembers.
pub struct Memory {
    recorder: Recorder,
    stand: String,
    folder: StandFolder,
    clips: Files,
    /// Rounds of which a clip is to be made when nobody is there.
    waiting: VecDeque<Arc<Replay>>,
    /// When it began, by the clock that is never set, and by the one on the wall.
    began: (Instant, SystemTime),
    /// What was known to be wrong.
    trouble: Option<String>,
    best: Vec<Id>,
    /// How often it was asked for them.
    turn: usize,
    /// How long ago it was asked what came of the day [s].
    asked: f32,
    /// How long ago it was looked for the best rounds of the day [s].
    looked: f32,
}

impl Memory {
    /// Begins to write down what happens.
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

    /// Notes that something happened.
    pub fn note(&self, kind: Kind, text: &str) {
        self.recorder.record(Entry::Event(Event {
            id: Id::random(),
            stand: self.stand.clone(),
            at: Moment::now(),
            kind,
            text: text.into(),
        }));
    }

    /// Notes that somebody came, once it is known that this was no staff.
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

    /// Notes that whoever was there has gone, and in what they were spoken to last.
    pub fn end_visit(&self, visit: &Visit, spoken: Language) {
        self.recorder.record(Entry::VisitEnded {
            id: visit.id,
            at: Moment::now(),
            language: spoken.code().into(),
        });
    }

    /// Notes a round, and keeps one that was won in mind for a clip.
    pub fn note_round(&mut self, round: Round, replay: Replay) {
        if round.route.is_some() {
            self.waiting.truncate(WAITING - 1);
            self.waiting.push_front(Arc::new(replay));
        }
        self.recorder.record(Entry::Round(round));
    }

    /// Asks for the figures of the day, and for its best rounds of one level after the other.
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

    /// The best rounds of the day, where others are now.
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
        Some(replays.map(Arc::new).collect())
    }

    /// Lets time pass [s]: looks for trouble, and makes clips while nobody is there.
    pub fn pass(&mut self, config: &Config, is_idle: bool, seconds: f32) {
        for news in self.clips.pass(seconds) {
            match news {
                News::Saved(_) => self.clips.thin_out(Kept::Clip, config.take_home.clips),
                News::Failed(reason) => self.note(Kind::Other("no_clip".into()), &reason),
                News::Full => self.note(Kind::FullDisk, "a clip was not kept"),
                News::Level(_) | News::Damaged(_) => {}
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
        let trouble = self.recorder.health().trouble;
        if trouble != self.trouble {
            // The recorder notes what is worth noting once it can.
            if let Some(trouble) = &trouble {
                eprintln!("tamaire: visits are not written down: {trouble}");
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

    /// Notes when somebody set the clock.
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

    /// What visitors did today, as far as it is known.
    pub fn today(&self) -> Today {
        self.recorder.today().unwrap_or_default()
    }

    /// How writing it down goes.
    pub fn health(&self) -> Health {
        self.recorder.health()
    }

    /// How much room is left [bytes].
    pub fn room(&self) -> Option<u64> {
        self.folder.room()
    }

    /// Puts a copy of the logbook beside it, named by the date.
    pub fn export(&self) {
        self.recorder.ask_export(self.folder.copy(Moment::now()));
    }

    /// What became of that, once.
    pub fn take_exported(&self) -> Option<Result<String, String>> {
        let exported = self.recorder.exported()?;
        Some(exported.map(|path| path.display().to_string()))
    }
}
