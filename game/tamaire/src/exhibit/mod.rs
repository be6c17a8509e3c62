//! A public stand: visitors come, play and leave all day, and the stand logs visits and rounds.
//!
//! [`Stand`] leads the game from one visit to the next. Each module uses only those listed above it:
//!
//! - [`config`]: configuration by the operator
//! - [`presence`]: detection of visitors
//! - [`staff`]: staff access
//! - [`health`]: frame times
//! - `visit`: a visit and its rounds
//! - [`memory`]: logbook, best rounds and clips

pub mod config;
pub mod health;
pub mod memory;
pub mod presence;
pub mod staff;
mod visit;

use crate::game::{Game, Screen};
use crate::platform::TextFile;
use crate::qr::Code;
use crate::records::Records;
use app_shell::Clock;
use config::{Config, ConfigChange, Seconds, Times};
use egui::Context;
use health::FrameTimes;
use jiff::Zoned;
use jiff::civil::Time;
use memory::Memory;
use presence::{Attention, Presence};
use staff::{Entrance, PinResult, StaffPage};
use std::sync::Arc;
use std::time::Instant;
use sticks::DeviceId;
use tamaire_logbook::{Kind, RoundEnd};
use tamaire_play::Level;
use visit::Visit;

/// Side of the hidden square in the upper right corner of the window [points]. Holding it opens the staff
/// entrance.
pub const CORNER: f32 = 90.0;
/// Time in which presses are ignored after the screen has changed or the result has appeared [s]. A visitor
/// needs about this time to see a new screen.
const SETTLED: f32 = 0.7;
/// Factor by which the times without input are longer while a QR code is shown, because a visitor first has to
/// take out a phone.
const UNHURRIED: f32 = 2.0;
/// Delay between the appearance of the result of a round and of its QR code [s]. The code may cover the
/// basket, so visitors first see the body in the basket.
const BEAMING: f32 = 2.0;
/// Minimum time without input on staff pages before the countdown begins [s].
const STAFF: Seconds = Seconds(120.0);

/// State of a stand.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Idle: recorded rounds are shown to attract visitors.
    Attract,
    /// A visitor chooses a level.
    Choice,
    /// A visitor plays or looks at the result.
    Visit,
    /// The stand waits for the PIN of the staff.
    PinEntry,
    /// A staff page is shown.
    Staff(StaffPage),
    /// Closed by its opening hours.
    Closed,
}

/// A public stand.
pub struct Stand {
    /// Configuration by the operator.
    pub config: Config,
    /// Current state of the stand.
    pub phase: Phase,
    /// Attention of the visitor, detected from the input.
    pub attention: Attention,
    /// QR code of the last round, if it was won.
    home: Option<Code>,
    /// Hidden entrance to the staff pages.
    pub entrance: Entrance,
    /// Frame times.
    pub frames: FrameTimes,
    /// Message for staff: the error of the last change, or the result of an export.
    pub answer: Option<String>,
    /// Whether staff requested the end of the program.
    pub is_ended: bool,
    /// All built-in levels.
    pub known: Vec<Arc<Level>>,
    /// Length of the countdown that applies now [s].
    countdown: f32,
    /// State of the stand after the last frame.
    before: Phase,
    /// Time since the stand changed its state [s].
    since: f32,
    /// Time for which the result has been shown [s].
    result_since: f32,
    /// Whether nothing has been held since the current screen settled. Presses that began earlier are
    /// ignored.
    is_released: bool,
    file: TextFile,
    /// Logbook and other storage.
    pub memory: Memory,
    presence: Presence,
    visit: Option<Visit>,
    /// Clock that is not affected by changes of the system clock.
    clock: Clock,
    devices: Vec<(DeviceId, String)>,
    /// Time of the last frame.
    last: Option<Instant>,
    /// Fixed time of day for tests. `None` = the time of the system clock.
    told_time: Option<Time>,
}

impl Stand {
    /// Opens a stand with the configuration in `file`, which is created with default values if it does not
    /// exist.
    ///
    /// # Errors
    /// The error text names the file, the problem and its line, and the expected value.
    pub fn open(file: TextFile) -> Result<Self, String> {
        let text = file.read_or(config::DEFAULT_CONFIG)?;
        let config = Config::read(&text);
        let config = config.map_err(|error| format!("{}: {error}", file.0.display()))?;
        Ok(Self {
            memory: Memory::begin(&config),
            countdown: config.times.countdown.0,
            config,
            phase: Phase::Attract,
            attention: Attention::Gone,
            home: None,
            entrance: Entrance::default(),
            frames: FrameTimes::default(),
            answer: None,
            is_ended: false,
            known: Vec::new(),
            before: Phase::Attract,
            since: 0.0,
            result_since: 0.0,
            is_released: false,
            file,
            presence: Presence::default(),
            visit: None,
            clock: Clock::of_machine(),
            devices: Vec::new(),
            last: None,
            told_time: None,
        })
    }

    /// Fixes the time of day, for tests.
    pub fn at(mut self, time: Time) -> Self {
        self.told_time = Some(time);
        self
    }

    /// Puts a game into public mode and resets its settings and records.
    pub fn prepare(&mut self, game: &mut Game) {
        game.public.get_or_insert_default();
        self.known = game.levels.clone();
        self.freshen(game);
        self.memory.ask(&self.config);
    }

    /// Advances the stand by a frame of `seconds` [s]: detects visitors and changes the state of the stand.
    pub fn pass(&mut self, game: &mut Game, ctx: &Context, seconds: f32) {
        let now = Instant::now();
        let last = self.last.replace(now);
        self.frames
            .note(last.map_or(seconds, |last| (now - last).as_secs_f32()));
        let sticks = &game.controls.devices.sticks;
        // A stick that the game itself moves does not count as touched.
        let is_touched = self.presence.is_touched(ctx, sticks, game.is_calling());
        self.collect(game, RoundEnd::Retried);
        self.memory
            .pass(&self.config, self.phase == Phase::Attract, seconds);
        self.note_devices(game);
        if let (Some(public), Some(best)) = (&mut game.public, self.memory.take_best()) {
            public.attractions = best;
        }
        self.knock(game, ctx, seconds);
        let times = self.times(game);
        self.countdown = times.countdown.0;
        let attention = self.presence.pass(seconds, is_touched, &times);
        self.attention = match self.phase {
            Phase::Choice | Phase::Visit | Phase::PinEntry | Phase::Staff(_) => attention,
            Phase::Attract | Phase::Closed => Attention::Gone,
        };
        match (self.phase, self.attention) {
            (Phase::Attract, _) if !self.is_open() => {
                // Shows a screen without a round behind it, so that no round runs while the stand is closed.
                game.go(Screen::Settings);
                self.phase = Phase::Closed;
            }
            (Phase::Closed, _) if self.is_open() => {
                game.go(Screen::Title);
                self.memory.ask(&self.config);
                self.phase = Phase::Attract;
            }
            (Phase::Attract, _) if is_touched => self.welcome(game),
            (Phase::Choice | Phase::Visit | Phase::PinEntry | Phase::Staff(_), Attention::Gone) => {
                self.end_and_reset(game);
            }
            (Phase::Visit, _) => self.lead_back(game, seconds),
            _ => {}
        }
        // The screens change the phase, too, between two calls of this function.
        self.since = match self.before == self.phase {
            true => self.since + seconds,
            false => 0.0,
        };
        self.before = self.phase;
        self.note_release(game, ctx);
        game.calls = self.config.force.calls && self.phase == Phase::Attract;
        let public = game.public.get_or_insert_default();
        public.is_left = matches!(self.attention, Attention::Leaving(_));
        public.takes_two = self.config.two_players;
        public.is_rewind_off = !self.config.rewind;
        if std::mem::take(&mut public.asks_for_language) && self.config.other_languages {
            game.settings.language = game.settings.language.other();
        }
    }

    /// Returns the times without input that apply now.
    fn times(&self, game: &Game) -> Times {
        let mut times = self.config.times;
        if matches!(self.phase, Phase::Staff(_)) {
            // The countdown begins later on staff pages, because staff may read the figures for a long time
            // without any input.
            times.rest = times.rest.max(STAFF);
        }
        if self.is_code_due(game) {
            times.rest.0 *= UNHURRIED;
            times.countdown.0 *= UNHURRIED;
        }
        times
    }

    /// Whether the result with a QR code is on the screen, or its code is about to appear.
    fn is_code_due(&self, game: &Game) -> bool {
        self.phase == Phase::Visit && game.screen() == Screen::Result && self.home.is_some()
    }

    /// Notes whether nothing has been held since the current screen settled.
    fn note_release(&mut self, game: &Game, ctx: &Context) {
        let is_result = self.phase == Phase::Visit && game.screen() == Screen::Result;
        let since = if is_result {
            self.result_since
        } else {
            self.since
        };
        let is_held = ctx.input(|input| {
            let keys = [egui::Key::Enter, egui::Key::Space];
            let is_key = keys.into_iter().any(|key| input.key_down(key));
            // A release in this frame may be the end of an earlier press.
            is_key || input.pointer.any_down() || input.pointer.any_released()
        });
        self.is_released = since > SETTLED && (self.is_released || !is_held);
    }

    /// Length of the countdown that applies now [s].
    pub fn countdown(&self) -> f32 {
        self.countdown
    }

    /// QR code of the won round. `None` for the first seconds of the result, so that the code does not cover
    /// the body in the basket.
    pub fn to_take_home(&self) -> Option<&Code> {
        self.home.as_ref().filter(|_| self.result_since > BEAMING)
    }

    /// QR code of the won round, also before it appears.
    pub fn coming_code(&self) -> Option<&Code> {
        self.home.as_ref()
    }

    /// Whether the screen accepts presses: the choices have been visible for a moment, and nothing has been held
    /// since before then. A visitor therefore takes no choice unseen that appeared under the pointer.
    pub fn is_settled(&self) -> bool {
        self.is_released
    }

    /// Whether the pointer is hidden because the mouse has not moved for long.
    pub fn is_pointer_left(&self) -> bool {
        self.presence.is_pointer_left(&self.config.times)
    }

    /// Begins a visit.
    fn welcome(&mut self, game: &mut Game) {
        self.presence.begin();
        self.attention = Attention::There;
        self.freshen(game);
        self.visit = Some(Visit::begin());
        game.forget_slow_drawing();
        match self.config.levels.0.len() {
            1 => self.choose(game, 0),
            _ => self.phase = Phase::Choice,
        }
    }

    /// Starts the level with index `index` in the configuration.
    pub fn choose(&mut self, game: &mut Game, index: usize) {
        self.phase = Phase::Visit;
        self.home = None;
        self.dare(None);
        game.start(index);
    }

    /// Restarts the level. `route` is the way to win that was suggested to the visitor, if any.
    pub fn try_again(&mut self, game: &mut Game, route: Option<tamaire_play::Route>) {
        self.home = None;
        game.retry();
        self.collect(game, RoundEnd::Retried);
        self.dare(route);
    }

    /// Returns to the choice of levels.
    pub fn choose_again(&mut self, game: &mut Game) {
        game.go(Screen::Title);
        self.phase = Phase::Choice;
    }

    /// Ends the visit and resets the stand for the next visitor.
    pub fn end_and_reset(&mut self, game: &mut Game) {
        self.end_visit(game, RoundEnd::Left);
        self.freshen(game);
        self.phase = Phase::Attract;
        self.memory.ask(&self.config);
    }

    fn end_visit(&mut self, game: &mut Game, end: RoundEnd) {
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

    /// Goes back to the round if a screen other than the round or its result is open. Measures the time for
    /// which the result has been shown.
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

    /// Logs the rounds that ended since the last call. A round that was not won is logged with `end` as the
    /// reason for its end.
    fn collect(&mut self, game: &mut Game, end: RoundEnd) {
        let ended = game.public.as_mut();
        let ended = ended.map(|public| std::mem::take(&mut public.ended));
        for ended in ended.into_iter().flatten() {
            if ended.progress.outcome.is_some() {
                let page = self.config.take_home.page.as_ref();
                self.home = page.and_then(|page| Code::of_round(&page.0, &ended.replay));
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

    /// Whether the stand is open now.
    fn is_open(&self) -> bool {
        let now = || self.told_time.unwrap_or_else(|| Zoned::now().time());
        self.config.hours.is_none_or(|hours| hours.is_open(now()))
    }

    /// Opens the PIN page if the hidden corner or the button combination ([`staff::is_chord`]) was held for
    /// long enough.
    fn knock(&mut self, game: &mut Game, ctx: &Context, seconds: f32) {
        let is_chord = { game.controls.devices.sticks.devices.iter() }.any(staff::is_chord);
        // Uses the upper right corner, because visitors have nothing to press there.
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
                true => self.collect(game, RoundEnd::Left),
                // Discards a round that the hold itself may have started, because holding the corner or the
                // buttons also counts as input of a visitor.
                false => game.public.get_or_insert_default().ended.clear(),
            }
            self.presence.begin();
            self.phase = Phase::PinEntry;
        }
    }

    /// Enters a digit of the PIN.
    pub fn enter(&mut self, game: &mut Game, digit: char) {
        let Some(pin) = &self.config.staff.pin else {
            return;
        };
        match self.entrance.enter(digit, pin, self.clock.now()) {
            PinResult::GoesOn | PinResult::TooEarly => {}
            PinResult::Right => {
                self.end_visit(game, RoundEnd::Left);
                self.memory.note(Kind::StaffIn, "");
                self.memory.ask(&self.config);
                self.phase = Phase::Staff(StaffPage::default());
            }
            PinResult::Wrong => self.memory.note(Kind::StaffRefused, ""),
        }
    }

    /// Remaining time in which the PIN page ignores input [s].
    pub fn pause(&self) -> f64 {
        self.entrance.pause(self.clock.now())
    }

    /// Applies a change by staff to the stand and to its configuration file.
    pub fn change(&mut self, game: &mut Game, change: &ConfigChange) {
        let changed = self.file.read_or(config::DEFAULT_CONFIG);
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

    /// Ends the current visit, because the program is closing. Logs a regular end if staff requested it.
    /// Dropping `self` later writes the entries that are still pending.
    pub fn close(&mut self, game: &mut Game) {
        self.end_visit(game, RoundEnd::Cut);
        if self.is_ended {
            self.memory.note(Kind::Ended, "");
        }
    }
}
