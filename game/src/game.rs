//! The state of the game between two frames, and what can happen to it. Everything that a screen
//! shows is worked out from here.

mod feel;
mod heard;
mod keep;
mod lesson;
mod teach;
mod time;
pub mod trial;

use crate::attract::attract;
use crate::input::{Action, Devices, Means, Players, Seat};
use crate::look::{Camera, Effects, Opening, Theme, View};
use crate::platform::{Clock, Damage, Entry, Files, Forces, Given, Pads, Sound};
use crate::records::Records;
use crate::session::Session;
use crate::settings::Settings;
use crate::words::Words;
use fuwafuwa::world::TICK;
use fuwafuwa_render::frame::ElementColour;
use lesson::Lesson;
use std::sync::Arc;
use tamaire_play::level::{NAMED, NAMED_3D};
use tamaire_play::{AnyRound, Level, Outcome, Playback, Replay, ReplayError, shortened};
use tamaire_sound::{Cue, Menu};
use trial::Trial;

/// What there is to see.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Screen {
    /// The name of the game, and a body that plays by itself.
    Title,
    /// Which level?
    Levels,
    /// The round.
    Play,
    /// The round, standing still.
    Paused,
    /// How it went.
    Result,
    /// What players choose, and from where they came.
    Settings(Box<Screen>),
    /// What sticks and pads can do and what they are made to do, and from where the player came.
    Forces(Box<Screen>),
    /// Rounds that were kept.
    Replays,
}

/// How long a notice stays at least [s].
const NOTICE: f32 = 6.0;
/// How fast it can be read, at leisure [letters/s].
const READING: f32 = 15.0;

/// Most letters of a notice: what it quotes may be as long as a file.
const LETTERS: usize = 600;

/// The state of the game.
pub struct Game {
    /// What is seen.
    pub screen: Screen,
    /// What players chose.
    pub settings: Settings,
    /// What they reached.
    pub records: Records,
    /// Where that is kept.
    pub files: Files,
    /// The levels on offer.
    pub levels: Vec<Arc<Level>>,
    /// Which of them is played.
    pub chosen: usize,
    /// The round that is seen, behind whatever screen.
    pub session: Session,
    /// Who plays.
    pub players: Players,
    /// What their devices say.
    pub devices: Devices,
    /// With what something was done last.
    pub means: Means,
    /// What flies about.
    pub effects: Effects,
    /// From where it is seen.
    pub camera: Camera,
    /// What it saw in the last frame.
    pub view: Option<View>,
    /// What the colours of elements tell, when they are seen instead of the skin.
    pub elements: Option<ElementColour>,
    /// How far bodies in space are opened for that.
    pub opening: Opening,
    /// Whether time goes slowly.
    pub slow: bool,
    /// Whether time stands still, but for single steps.
    pub stepping: bool,
    /// The last win: how, and whether it was the best by its route.
    pub won: Option<(Outcome, bool)>,
    /// The rounds that were kept, as they were when their screen came up.
    pub replays: Vec<Entry>,
    /// What the player should know, and for how long [s].
    pub notices: Vec<(String, f32)>,
    /// Seconds since the game began.
    pub time: f64,
    /// Tells how long ticks take.
    pub clock: Clock,
    /// An action whose key or button the next one pressed becomes.
    pub rebinding: Option<Action>,
    /// Whether the window has lost the focus.
    pub is_away: bool,
    /// The sticks and pads that are listened to.
    pub pads: Pads,
    /// What they are made to do.
    pub forces: Forces,
    /// The one that is tried or measured.
    pub trial: Option<Trial>,
    lesson: Lesson,
    sound: Sound,
    /// Why nothing is heard, as the player was told last.
    trouble: Option<String>,
    cheered: f32,
    /// How many recorded rounds the title has shown.
    attracted: usize,
}

impl Game {
    /// The game at its start, with what is kept in `files`.
    pub fn new(mut files: Files, sound: Sound, pads: Pads) -> Self {
        let (settings, settings_damage) = files.settings();
        let (records, records_damage) = files.records();
        let open = |(id, _): &(&str, &str)| Level::open(id);
        let levels = NAMED
            .iter()
            .chain(&NAMED_3D)
            .map(open)
            .map(|level| Arc::new(level.expect("the tests open it")));
        let levels: Vec<Arc<Level>> = levels.collect();
        let mut game = Self {
            screen: Screen::Title,
            records: records.by_name(levels.iter().map(Arc::as_ref)),
            settings,
            files,
            session: attract(0),
            levels,
            chosen: 0,
            players: Players::default(),
            devices: Devices::default(),
            means: Means::default(),
            effects: Effects::default(),
            camera: Camera::default(),
            view: None,
            elements: None,
            opening: Opening::default(),
            slow: false,
            stepping: false,
            won: None,
            replays: Vec::new(),
            notices: Vec::new(),
            time: 0.0,
            clock: Clock::of_machine(),
            rebinding: None,
            is_away: false,
            lesson: Lesson::default(),
            trouble: None,
            sound,
            pads,
            forces: Forces::default(),
            trial: None,
            cheered: 0.0,
            attracted: 0,
        };
        if settings_damage.is_some() && game.settings.haptics == 0.0 {
            game.notify(game.words().forces_zero.to_string());
        }
        let is_aside = |damage: &Option<Damage>| {
            { damage.as_ref() }.is_some_and(|damage| damage.aside.is_some())
        };
        if is_aside(&settings_damage) {
            // It is told once.
            game.keep_settings();
        }
        if is_aside(&records_damage) {
            game.files.keep_records(&game.records, &game.levels);
        }
        for damage in [settings_damage, records_damage].into_iter().flatten() {
            game.tell_of(damage);
        }
        game.files.read_levels();
        if game.pads.complaint().is_some() {
            game.notify(game.words().no_sticks.to_string());
        }
        game
    }

    /// What the game says.
    pub fn words(&self) -> &'static Words {
        self.settings.language.words()
    }

    /// Its colours.
    pub fn theme(&self) -> Theme {
        Theme::of(self.settings.colour_safe)
    }

    /// Tells the player something; what is still to be read is not said twice.
    pub fn notify(&mut self, text: String) {
        let text = shortened(&text, LETTERS);
        self.notices.retain(|(known, _)| *known != text);
        let reading = text.chars().count() as f32 / READING;
        self.notices.push((text, reading.max(NOTICE)));
    }

    /// A sound of the menus.
    pub fn blip(&self, menu: Menu) {
        self.sound.play(Cue::Menu(menu));
    }

    /// Plays the next recorded round.
    fn attract(&mut self) {
        self.attracted += 1;
        self.session = attract(self.attracted);
    }

    /// Shows another screen.
    pub fn go(&mut self, screen: Screen) {
        if screen == Screen::Title {
            self.slow = false;
            if self.session.is_played() {
                self.attract();
            }
        }
        if screen == Screen::Replays {
            self.replays = self.files.replays();
        }
        self.stepping = false;
        self.rebinding = None;
        self.trial = None;
        self.screen = screen;
    }

    /// Begins a level.
    pub fn start(&mut self, level: usize) {
        let level = level.min(self.levels.len() - 1);
        self.session = Session::of_people(self.levels[level].clone());
        self.camera.face_front();
        self.begin();
    }

    /// Begins the level again, against a round that somebody played in it.
    pub fn race(&mut self, replay: Arc<Replay>) -> Result<(), ReplayError> {
        let ghost = Playback::new(replay)?;
        let level = ghost.round().level().clone();
        self.session = Session::of_people(level).against(ghost);
        self.begin();
        Ok(())
    }

    /// Shows a round that somebody played.
    pub fn watch(&mut self, replay: Arc<Replay>) -> Result<(), ReplayError> {
        self.session = Session::of_replay(replay)?;
        self.begin();
        Ok(())
    }

    /// The same again from its start.
    pub fn retry(&mut self) {
        self.session = self.session.again();
        self.begin();
    }

    fn begin(&mut self) {
        self.opening = Opening::begin(self.time);
        let level = self.session.round().level();
        let known = self.levels.iter().position(|known| known == level);
        self.chosen = known.unwrap_or(self.chosen);
        self.players.start();
        self.effects = Effects::default();
        self.lesson.begin();
        // They mean places of the round before.
        (self.devices.pointer, self.devices.lift, self.view) = (None, 0.0, None);
        self.won = None;
        self.cheered = 0.0;
        self.go(Screen::Play);
    }

    /// Plays what was dropped onto the window or named on the command line: a level, a picture, a model or a replay.
    pub fn open(&mut self, given: Given) {
        match given {
            Given::Level(Ok(level)) => self.offer(*level),
            Given::Level(Err(error)) => self.notify((self.words().level_error)(&error)),
            Given::Replay(place, replay) => {
                let outcome = replay.and_then(|replay| self.watch(Arc::from(replay)));
                if let Err(error) = outcome {
                    self.tell_of_replay(&place, &error);
                }
            }
        }
    }

    /// Does something with a replay that is kept.
    pub fn open_kept(
        &mut self,
        name: &str,
        act: fn(&mut Self, Arc<Replay>) -> Result<(), ReplayError>,
    ) {
        let replay = self.files.replay(name);
        let outcome = replay.and_then(|replay| act(self, Arc::new(replay)));
        if let Err(error) = outcome {
            self.tell_of_replay(&self.files.place(name), &error);
        }
    }

    fn tell_of_replay(&mut self, place: &str, error: &ReplayError) {
        let reason = (self.words().replay_error)(error);
        self.notify(format!("{place}: {reason}"));
    }

    fn offer(&mut self, level: Level) {
        let known = self.levels.iter().position(|known| **known == level);
        let place = known.unwrap_or_else(|| {
            self.levels.retain(|known| known.id != level.id);
            self.levels.push(Arc::new(level));
            self.levels.len() - 1
        });
        if self.is_own(place) {
            self.files.keep_level(self.levels[place].clone());
        }
        self.start(place);
    }

    /// Whether a level does not come along.
    pub fn is_own(&self, place: usize) -> bool {
        place >= NAMED.len() + NAMED_3D.len()
    }

    /// Something was asked for with a key or button.
    pub fn act(&mut self, action: Action, seat: Seat) {
        match (&self.screen, action) {
            (_, Action::CutForces) => {
                self.forces.cut();
                self.notify(self.words().cut_now.to_string());
            }
            (Screen::Play | Screen::Paused | Screen::Result, Action::Retry) => self.retry(),
            (Screen::Play, Action::Pause) => {
                self.go(Screen::Paused);
                self.blip(Menu::Back);
            }
            (Screen::Paused, Action::Pause) => self.go(Screen::Play),
            (Screen::Play | Screen::Title, Action::Elements) => {
                if self.elements.is_none() {
                    self.opening = Opening::begin(self.time);
                }
                self.elements = match self.elements {
                    None => Some(ElementColour::Level),
                    Some(ElementColour::Level) => Some(ElementColour::Strain),
                    Some(ElementColour::Strain) => None,
                }
            }
            // Whoever takes single steps goes on with this.
            (Screen::Play, Action::Slow) if self.stepping => self.stepping = false,
            (Screen::Play, Action::Slow) => self.slow = !self.slow,
            (Screen::Play, Action::Step) => {
                self.stepping = true;
                self.session.forget_time();
                self.pass_ticks(TICK);
                self.effects.pass(TICK);
            }
            (Screen::Play, Action::Join) if self.takes_two() => self.players.join(seat),
            _ => {}
        }
    }

    /// In space by how much the camera went around to the right [rad].
    pub fn turn(&self) -> Option<f32> {
        let is_space = matches!(self.session.round(), AnyRound::Space(_));
        is_space.then(|| self.camera.turn())
    }

    /// Takes back that all forces were cut.
    pub fn restore_forces(&mut self) {
        self.forces.restore();
        let cut = self.words().cut_now;
        self.notices.retain(|(text, _)| text != cut);
        self.notify(self.words().restored.to_string());
    }

    /// Whether a second player can come in.
    fn takes_two(&self) -> bool {
        let level = self.session.round().level();
        self.session.is_played() && level.scene().hand.len() > 1
    }

    /// Takes in what sticks and pads say; gives back what was pressed since. When one is unplugged
    /// the round waits.
    pub fn hear_sticks(&mut self) -> Vec<sticks::Change> {
        let now = self.pads.snapshot();
        let changes = now.since(&self.devices.sticks);
        self.devices.sticks = now;
        let has_left = |change: &sticks::Change| matches!(change, sticks::Change::Disconnected(_));
        if changes.iter().any(has_left) {
            self.rest();
        }
        changes
    }

    /// Something was done with a stick or pad.
    pub fn note_stick(&mut self, id: sticks::DeviceId) {
        let device = self.devices.sticks.device(id);
        self.means = match device.is_some_and(|device| device.pad.is_some()) {
            true => Means::Pad,
            false => Means::Stick,
        };
    }

    /// Whether the round is seen, if dimly: what is not goes on neither in time nor in sound.
    pub fn is_seen(&self) -> bool {
        !matches!(
            self.screen,
            Screen::Levels | Screen::Replays | Screen::Settings(_) | Screen::Forces(_)
        )
    }

    /// Whether people are in the middle of a round.
    pub fn is_in_round(&self) -> bool {
        let mut below = &self.screen;
        while let Screen::Settings(from) | Screen::Forces(from) = below {
            below = from;
        }
        let is_on = matches!(below, Screen::Play | Screen::Paused);
        is_on && self.session.is_played() && !self.session.is_over()
    }

    /// Lets a round that people play stand still.
    pub fn rest(&mut self) {
        if self.screen == Screen::Play && self.session.is_played() {
            self.go(Screen::Paused);
        }
    }
}
