//! A stand in public: visitors come, play and go, all day, and what they did is written down.
//!
//! The way through: [`config`] what the operator chose → [`presence`] whether somebody is there → [`home`] what a visitor takes
//! home → [`staff`] who may look behind → [`health`] how it runs → the [`Stand`], which leads the game from one visit to the next.

pub mod config;
pub mod health;
pub mod home;
mod memory;
pub mod presence;
pub mod staff;
mod visit;

use crate::game::{Game, Screen};
use crate::platform::{Clock, TextFile};
use crate::records::Records;
use config::{Change, Config, Seconds};
use egui::Context;
use health::FrameTimes;
use jiff::Zoned;
use jiff::civil::Time;
use memory::Memory;
use presence::{Attention, Presence};
use staff::{Answer, Entrance, Page};
use std::sync::Arc;
use std::time::Instant;
use sticks::DeviceId;
use tamaire_logbook::{End, Health, Kind, Today};
use tamaire_play::Level;
use visit::Visit;

/// Side of the corner that is held to get behind the stand [points].
pub const CORNER: f32 = 90.0;
/// What is pressed counts when this has passed since another screen came up [s].
const SETTLED: f32 = 0.4;
/// A code may hide the body that is in: it comes up so much later than the result [s].
const BEAMING: f32 = 2.0;
/// Staff may rest for so long [s].
const STAFF: Seconds = Seconds(120.0);

/// What the stand is at.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Nobody is there, and rounds play by themselves.
    Attract,
    /// A visitor chooses a level.
    Choice,
    /// A visitor plays, or looks at what came of it.
    Visit,
    /// Somebody is asked for the number.
    Door,
    /// Staff looks at this.
    Staff(Page),
    /// It is not open.
    Closed,
}

/// A stand in public.
pub struct Stand {
    /// What the operator chose.
    pub config: Config,
    /// What it is at.
    pub phase: Phase,
    /// Whether somebody is there.
    pub attention: Attention,
    /// What the last round that was won says to a phone.
    home: Option<home::Code>,
    /// The way to what only staff sees.
    pub entrance: Entrance,
    /// How smoothly it runs.
    pub frames: FrameTimes,
    /// Why what staff wished was not done, or what became of it.
    pub answer: Option<String>,
    /// Whether staff ended it.
    pub is_ended: bool,
    /// All levels that come along.
    pub known: Vec<Arc<Level>>,
    /// For how long it has been at what it is at [s].
    since: f32,
    /// For how long a result has been seen [s].
    result_since: f32,
    file: TextFile,
    memory: Memory,
    presence: Presence,
    visit: Option<Visit>,
    /// Runs while the machine's own clock may be set.
    clock: Clock,
    devices: Vec<(DeviceId, String)>,
    /// When the last frame was.
    last: Option<Instant>,
    /// In a test, the time of day.
    told_time: Option<Time>,
}

impl Stand {
    /// A stand as a file says. The file is written where there is none yet.
    ///
    /// # Errors
    /// The file, and what is wrong with it: in which line, and what was expected.
    pub fn open(file: TextFile) -> Result<Self, String> {
        let text = file.read_or(config::USUAL)?;
        let config = Config::read(&text);
        let config = config.map_err(|error| format!("{}: {error}", file.0.display()))?;
        Ok(Self {
            memory: Memory::begin(&config),
            config,
            phase: Phase::Attract,
            attention: Attention::Gone,
            home: None,
            entrance: Entrance::default(),
            frames: FrameTimes::default(),
            answer: None,
            is_ended: false,
            known: Vec::new(),
            since: 0.0,
            result_since: 0.0,
            file,
            presence: Presence::default(),
            visit: None,
            clock: Clock::of_machine(),
            devices: Vec::new(),
            last: None,
            told_time: None,
        })
    }

    /// The same at a time of day that never passes.
    pub fn at(mut self, time: Time) -> Self {
        self.told_time = Some(time);
        self
    }

    /// Makes a game one for the public, as fresh as if nobody had been there.
    pub fn prepare(&mut self, game: &mut Game) {
        game.public.get_or_insert_default();
        self.known = game.levels.clone();
        self.freshen(game);
        self.memory.ask(&self.config);
    }

    /// Lets a frame pass that took so long [s]: who is there, and what is to come of it?
    pub fn pass(&mut self, game: &mut Game, ctx: &Context, seconds: f32) {
        let phase = self.phase;
        let now = Instant::now();
        let last = self.last.replace(now);
        self.frames
            .note(last.map_or(seconds, |last| (now - last).as_secs_f32()));
        let sticks = &game.controls.devices.sticks;
        // What stirs by itself was not touched.
        let is_touched = self.presence.is_touched(ctx, sticks, game.is_calling());
        self.collect(game, End::Retried);
        self.memory
            .pass(&self.config, self.phase == Phase::Attract, seconds);
        self.note_devices(game);
        if let (Some(public), Some(best)) = (&mut game.public, self.memory.take_best()) {
            public.attractions = best;
        }
        self.knock(game, ctx, seconds);
        let mut times = self.config.times;
        if matches!(self.phase, Phase::Staff(_)) {
            // Who reads figures moves nothing.
            times.rest = times.rest.max(STAFF);
        }
        let attention = self.presence.pass(seconds, is_touched, &times);
        self.attention = match self.phase {
            Phase::Choice | Phase::Visit | Phase::Door | Phase::Staff(_) => attention,
            Phase::Attract | Phase::Closed => Attention::Gone,
        };
        match (self.phase, self.attention) {
            (Phase::Attract, _) if !self.is_open() => {
                // Behind these nothing plays.
                game.go(Screen::Settings);
                self.phase = Phase::Closed;
            }
            (Phase::Closed, _) if self.is_open() => {
                game.go(Screen::Title);
                self.memory.ask(&self.config);
                self.phase = Phase::Attract;
            }
            (Phase::Attract, _) if is_touched => self.welcome(game),
            (Phase::Choice | Phase::Visit | Phase::Door | Phase::Staff(_), Attention::Gone) => {
                self.part(game);
            }
            (Phase::Visit, _) => self.lead_back(game, seconds),
            _ => {}
        }
        self.since = if phase == self.phase {
            self.since + seconds
        } else {
            0.0
        };
        game.calls = self.config.force.calls && self.phase == Phase::Attract;
        let public = game.public.get_or_insert_default();
        public.is_left = matches!(self.attention, Attention::Leaving(_));
        public.takes_two = self.config.two_players;
        if std::mem::take(&mut public.asks_for_language) && self.config.other_languages {
            game.settings.language = game.settings.language.other();
        }
    }

    /// Whether a result has been seen for long enough to be answered.
    pub fn is_result_settled(&self) -> bool {
        self.result_since > SETTLED
    }

    /// What there is to take home, once the body was seen that is in.
    pub fn to_take_home(&self) -> Option<&home::Code> {
        self.home.as_ref().filter(|_| self.result_since > BEAMING)
    }

    /// Whether what is pressed is meant for what is seen now: the press that called it up is not.
    pub fn is_settled(&self) -> bool {
        self.since > SETTLED
    }

    /// Whether the mouse is where somebody left it.
    pub fn is_pointer_left(&self) -> bool {
        self.presence.is_pointer_left(&self.config.times)
    }

    /// Somebody has come.
    fn welcome(&mut self, game: &mut Game) {
        self.presence.begin();
        self.attention = Attention::There;
        self.freshen(game);
        self.visit = Some(Visit::begin());
        match self.config.levels.0.len() {
            1 => self.choose(game, 0),
            _ => self.phase = Phase::Choice,
        }
    }

    /// Begins a level of those to choose from.
    pub fn choose(&mut self, game: &mut Game, index: usize) {
        self.phase = Phase::Visit;
        self.home = None;
        self.dare(None);
        game.start(index);
    }

    /// Begins the level again; `route` is how it is to be won this time, if that was suggested.
    pub fn try_again(&mut self, game: &mut Game, route: Option<tamaire_play::Route>) {
        self.home = None;
        game.retry();
        self.collect(game, End::Retried);
        self.dare(route);
    }

    /// Goes back to the levels to choose from.
    pub fn choose_again(&mut self, game: &mut Game) {
        game.go(Screen::Title);
        self.phase = Phase::Choice;
    }

    /// Whoever was there has gone: the next one finds it as if nobody had been there.
    fn part(&mut self, game: &mut Game) {
        self.end_visit(game, End::Left);
        self.freshen(game);
        self.phase = Phase::Attract;
        self.memory.ask(&self.config);
    }

    fn end_visit(&mut self, game: &mut Game, end: End) {
        game.go(Screen::Title);
        self.collect(game, end);
        if let Some(visit) = self.visit.take().filter(|visit| visit.is_noted) {
            self.memory.end_visit(&visit, game.settings.language);
        }
    }

    fn freshen(&mut self, game: &mut Game) {
        let calibrations = std::mem::take(&mut game.settings.calibrations);
        game.settings = self.config.settings();
        game.settings.calibrations = calibrations;
        game.records = Records::default();
        game.levels = self.config.levels.0.clone();
        game.chosen = 0;
        game.controls.players = Default::default();
        game.bout.elements = None;
        if game.forces.is_cut() {
            game.forces.restore();
            self.memory.note(Kind::Other("forces_were_cut".into()), "");
        }
        game.notices.clear();
        game.go(Screen::Title);
        self.home = None;
        self.answer = None;
    }

    /// From whatever else, a visitor is led back to the round.
    fn lead_back(&mut self, game: &mut Game, seconds: f32) {
        self.result_since = match game.screen() {
            Screen::Result => self.result_since + seconds,
            _ => 0.0,
        };
        if !matches!(game.screen(), Screen::Play | Screen::Result) {
            game.go(Screen::Play);
        }
        if game.bout.won.is_none() {
            self.home = None;
        }
        game.notices.clear();
    }

    /// Notes what ended since the last time, in this way where it was not won.
    fn collect(&mut self, game: &mut Game, end: End) {
        let ended = game.public.as_mut();
        let ended = ended.map(|public| std::mem::take(&mut public.ended));
        for ended in ended.into_iter().flatten() {
            if ended.progress.outcome.is_some() {
                let page = self.config.take_home.page.as_ref();
                self.home = page.and_then(|page| home::Code::of(&page.0, &ended.replay));
            }
            if let Some(visit) = &mut self.visit {
                self.memory.note_visit(visit, &self.config);
                let round = visit.round(&self.config, &ended, end);
                self.memory.note_round(round, ended.replay);
            }
        }
    }

    fn dare(&mut self, route: Option<tamaire_play::Route>) {
        if let Some(visit) = &mut self.visit {
            visit.dare = route;
        }
    }

    fn note_devices(&mut self, game: &Game) {
        let devices = &game.controls.devices.sticks.devices;
        let now: Vec<_> = { devices.iter() }
            .map(|device| (device.id, device.about.name.clone()))
            .collect();
        let lost = self.devices.iter().filter(|known| !now.contains(known));
        let lost = lost.map(|(_, name)| (Kind::DeviceLost, name));
        let found = now.iter().filter(|device| !self.devices.contains(device));
        let found = found.map(|(_, name)| (Kind::DeviceFound, name));
        for (kind, name) in lost.chain(found) {
            self.memory.note(kind, name);
        }
        self.devices = now;
    }

    /// Whether it is open now.
    fn is_open(&self) -> bool {
        let now = || self.told_time.unwrap_or_else(|| Zoned::now().time());
        self.config.hours.is_none_or(|hours| hours.is_open(now()))
    }

    /// Whether the hidden entrance is held; it opens after a while.
    fn knock(&mut self, game: &mut Game, ctx: &Context, seconds: f32) {
        let is_chord = { game.controls.devices.sticks.devices.iter() }.any(staff::is_chord);
        // Visitors press nothing there.
        let edge = ctx.content_rect().right_top() - egui::vec2(CORNER, 0.0);
        let corner = egui::Rect::from_min_size(edge, egui::Vec2::splat(CORNER));
        let is_corner = ctx.input(|input| {
            let places = [input.pointer.press_origin(), input.pointer.latest_pos()];
            let is_in = |at: Option<egui::Pos2>| at.is_some_and(|at| corner.contains(at));
            input.pointer.primary_down() && places.into_iter().all(is_in)
        });
        let may = self.config.staff.pin.is_some() && !matches!(self.phase, Phase::Staff(_));
        if self.entrance.pass(may && (is_chord || is_corner), seconds) {
            game.go(Screen::Title);
            match self.since > 2.0 * staff::HELD {
                true => self.collect(game, End::Left),
                // What was begun by holding it was no round.
                false => game.public.get_or_insert_default().ended.clear(),
            }
            self.presence.begin();
            self.phase = Phase::Door;
        }
    }

    /// A digit was entered at the door.
    pub fn enter(&mut self, game: &mut Game, digit: char) {
        let Some(pin) = &self.config.staff.pin else {
            return;
        };
        match self.entrance.enter(digit, pin, self.clock.now()) {
            Answer::GoesOn | Answer::TooEarly => {}
            Answer::Right => {
                self.end_visit(game, End::Left);
                self.memory.note(Kind::StaffIn, "");
                self.memory.ask(&self.config);
                self.phase = Phase::Staff(Page::default());
            }
            Answer::Wrong => self.memory.note(Kind::StaffRefused, ""),
        }
    }

    /// For how long no number is looked at at the door [s].
    pub fn pause(&self) -> f64 {
        self.entrance.pause(self.clock.now())
    }

    /// Staff, or whoever stood at the door, leaves.
    pub fn leave(&mut self, game: &mut Game) {
        self.part(game);
    }

    /// Staff changes what the stand is like, here and in its file.
    pub fn change(&mut self, game: &mut Game, change: &Change) {
        let changed = self.file.read_or(config::USUAL);
        let changed = changed.and_then(|text| change.in_text(&text));
        let changed = changed.and_then(|text| {
            let config = Config::read(&text)?;
            self.file.write(&text).map(|()| config)
        });
        match changed {
            Ok(config) => {
                self.memory
                    .note(Kind::SettingsChanged, &format!("{change:?}"));
                self.config = config;
                self.freshen(game);
            }
            Err(error) => self.answer = Some(error),
        }
    }

    /// Puts a copy of the logbook beside it.
    pub fn export(&mut self) {
        self.memory.export();
    }

    /// What became of that, told once.
    pub fn take_exported(&mut self) -> Option<Result<String, String>> {
        self.memory.take_exported()
    }

    /// What visitors did today, as far as it is known.
    pub fn today(&self) -> Today {
        self.memory.today()
    }

    /// How writing it down goes.
    pub fn logbook(&self) -> Health {
        self.memory.health()
    }

    /// How much room is left where it is kept [bytes].
    pub fn room(&self) -> Option<u64> {
        self.memory.room()
    }

    /// The program ends, as staff wished or not. What is still to be written is written when this is dropped.
    pub fn close(&mut self, game: &mut Game) {
        self.end_visit(game, End::Cut);
        if self.is_ended {
            self.memory.note(Kind::Ended, "");
        }
    }
}
