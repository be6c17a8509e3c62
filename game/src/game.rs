//! The state of the game between two frames, and what can happen to it. Everything that a screen
//! shows is worked out from here.

use crate::attract::attract;
use crate::input::{Action, Devices, Manner, Players, Seat};
use crate::look::{Camera, Effects, Theme, View};
use crate::platform::{Files, Pads, Sound};
use crate::records::Records;
use crate::session::Session;
use crate::settings::Settings;
use crate::words::Words;
use fuwafuwa::{Event, With};
use fuwafuwa_render::frame::ElementColour;
use std::path::Path;
use std::sync::Arc;
use tamaire_play::level::NAMED;
use tamaire_play::{InputFrame, Level, Outcome, Playback, Replay, ReplayError};
use tamaire_sound::{Cue, Hush, Menu, Press, Soundscape};

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
    /// Rounds that were kept.
    Replays,
}

/// After a win the round goes on for so long before the result is shown [s].
const CHEER: f32 = 1.4;
/// Slow motion is this share of the usual speed.
const SLOW: f32 = 0.2;
/// How long a notice stays [s].
const NOTICE: f32 = 6.0;

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
    /// What flies about.
    pub effects: Effects,
    /// From where it is seen.
    pub camera: Camera,
    /// What it saw in the last frame.
    pub view: Option<View>,
    /// What the colours of elements tell, when they are seen instead of the skin.
    pub elements: Option<ElementColour>,
    /// Whether time goes slowly.
    pub slow: bool,
    /// Whether time stands still, but for single steps.
    pub stepping: bool,
    /// The last win: how, and whether it was the best by its route.
    pub won: Option<(Outcome, bool)>,
    /// The round that was just won, to be kept or raced.
    pub last: Option<Arc<Replay>>,
    /// What the player should know, and for how long [s].
    pub notices: Vec<(String, f32)>,
    /// Seconds since the game began.
    pub time: f32,
    /// An action whose key or button the next one pressed becomes.
    pub rebinding: Option<Action>,
    /// The sticks and pads that are listened to.
    pub pads: Pads,
    sound: Sound,
    cheered: f32,
}

impl Game {
    /// The game at its start, with what is kept in `files`.
    pub fn new(files: Files, sound: Sound, pads: Pads) -> Self {
        let (settings, settings_aside) = files.read::<Settings>("settings.toml");
        let (records, records_aside) = files.read::<Records>("records.toml");
        let open = |(id, _): &(&str, &str)| Level::open(id);
        let levels = NAMED
            .iter()
            .map(open)
            .map(|level| Arc::new(level.expect("the tests open it")));
        let levels: Vec<Arc<Level>> = levels.collect();
        let mut game = Self {
            screen: Screen::Title,
            settings: settings.in_range(),
            records,
            files,
            session: attract(0),
            levels,
            chosen: 0,
            players: Players::default(),
            devices: Devices::default(),
            effects: Effects::default(),
            camera: Camera::default(),
            view: None,
            elements: None,
            slow: false,
            stepping: false,
            won: None,
            last: None,
            notices: Vec::new(),
            time: 0.0,
            rebinding: None,
            sound,
            pads,
            cheered: 0.0,
        };
        for aside in [settings_aside, records_aside].into_iter().flatten() {
            let kept = game.words().settings_kept;
            game.notify(format!("{kept} {}", aside.display()));
        }
        if let Some(trouble) = game.sound.trouble() {
            let no_sound = game.words().no_sound;
            game.notify(format!("{no_sound} ({trouble})"));
        }
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
        self.notices.retain(|(known, _)| *known != text);
        self.notices.push((text, NOTICE));
    }

    /// A sound of the menus.
    pub fn blip(&self, menu: Menu) {
        self.sound.play(Cue::Menu(menu));
    }

    /// Shows another screen.
    pub fn go(&mut self, screen: Screen) {
        if screen == Screen::Title && self.session.is_played() {
            self.session = attract(self.time as usize);
        }
        self.stepping = false;
        self.screen = screen;
    }

    /// Begins a level.
    pub fn start(&mut self, level: usize) {
        let level = level.min(self.levels.len() - 1);
        self.session = Session::of_people(self.levels[level].clone());
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
        let id = &self.session.round().level().id;
        let known = self.levels.iter().position(|level| level.id == *id);
        self.chosen = known.unwrap_or(self.chosen);
        self.players.start();
        self.effects = Effects::default();
        self.won = None;
        self.cheered = 0.0;
        self.go(Screen::Play);
    }

    /// A file was dropped onto the window or named on the command line: a level, a picture or a replay.
    pub fn open(&mut self, path: &Path) {
        let ending = path
            .extension()
            .and_then(|ending| ending.to_str())
            .unwrap_or("");
        let outcome = match ending {
            "tamaire" => Files::replay(path)
                .and_then(|replay| self.watch(Arc::new(replay)))
                .map_err(|error| format!("{}: {error}", path.display())),
            _ => Level::open(&path.to_string_lossy())
                .map(|level| self.offer(level))
                .map_err(|error| error.to_string()),
        };
        if let Err(reason) = outcome {
            self.notify(reason);
        }
    }

    fn offer(&mut self, level: Level) {
        if level.scene().dim != 2 {
            let id = level.id;
            self.notify(format!("{id}: expected dim = 2, found 3"));
            return;
        }
        self.levels.retain(|known| known.id != level.id);
        self.levels.push(Arc::new(level));
        self.start(self.levels.len() - 1);
    }

    /// Keeps the settings; what cannot be written is said and lost only at the end of the game.
    pub fn keep_settings(&mut self) {
        let written = self.files.write("settings.toml", &self.settings);
        self.report(written);
    }

    /// Keeps the round that was just won.
    pub fn keep_replay(&mut self) {
        if let Some(replay) = self.last.clone() {
            match self.files.save_replay(&replay) {
                Ok(path) => self.notify(format!("{} {}", self.words().saved, path.display())),
                Err(error) => self.report(Err(error)),
            }
        }
    }

    fn report(&mut self, written: std::io::Result<()>) {
        if let Err(error) = written {
            self.notify(format!("{} {error}", self.words().not_written));
        }
    }

    /// Something was asked for with a key or button.
    pub fn act(&mut self, action: Action, seat: Seat) {
        match (&self.screen, action) {
            (Screen::Play | Screen::Paused | Screen::Result, Action::Retry) => self.retry(),
            (Screen::Play, Action::Pause) => {
                self.go(Screen::Paused);
                self.blip(Menu::Back);
            }
            (Screen::Paused, Action::Pause) => self.go(Screen::Play),
            (Screen::Play | Screen::Title, Action::Elements) => {
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
                self.pass_ticks(fuwafuwa::world::TICK);
            }
            (Screen::Play, Action::Join) => self.players.join(seat),
            _ => {}
        }
    }

    /// Lets `seconds` pass.
    pub fn pass(&mut self, seconds: f32) {
        self.time += seconds;
        for notice in &mut self.notices {
            notice.1 -= seconds;
        }
        self.notices.retain(|notice| notice.1 > 0.0);
        let runs = !matches!(self.screen, Screen::Paused | Screen::Settings(_)) && !self.stepping;
        let pace = if self.slow { SLOW } else { 1.0 } * self.settings.speed;
        if runs {
            self.pass_ticks(seconds * pace);
            self.effects.pass(seconds * pace);
        }
        if let Some(complaint) = self.session.take_complaint() {
            self.notify(complaint.to_string());
            if !self.session.is_played() {
                self.session = attract(0);
                if self.screen == Screen::Play {
                    self.go(Screen::Replays);
                }
            }
        }
        self.celebrate(seconds);
        if self.screen == Screen::Title && self.session.is_over() {
            self.cheered += seconds;
            if self.cheered > 4.0 {
                self.cheered = 0.0;
                self.session = attract(self.time as usize);
            }
        }
        let arena = self.session.round().level().arena();
        let hand = self.session.round().world().manipulators()[0].position();
        self.camera
            .follow(hand, arena, seconds, self.settings.reduced_motion);
        self.sound
            .update(&self.soundscape(), &self.settings.volumes());
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

    /// Lets a round that people play stand still.
    pub fn rest(&mut self) {
        if self.screen == Screen::Play && self.session.is_played() {
            self.go(Screen::Paused);
        }
    }

    fn pass_ticks(&mut self, seconds: f32) {
        let manner = Manner {
            sensitivity: self.settings.sensitivity,
            stick_places: self.settings.stick_places,
            arena: self.session.round().level().arena(),
        };
        let still = self.settings.reduced_motion;
        // In menus the same keys and sticks move the focus.
        let in_round = self.screen == Screen::Play;
        let Self {
            session,
            players,
            devices,
            settings,
            effects,
            camera,
            sound,
            ..
        } = self;
        session.advance(
            seconds,
            |round| {
                if !in_round {
                    return InputFrame::default();
                }
                // Who comes in only now begins where the level says.
                let mut hands = round.level().scene().goals(0);
                for (goal, hand) in hands.iter_mut().zip(round.world().manipulators()) {
                    *goal = hand.goal();
                }
                let tick = fuwafuwa::world::TICK;
                players.frame(devices, &settings.bindings, &manner, &hands, tick)
            },
            |round| {
                effects.see(round, camera, still);
                for cue in cues(round) {
                    sound.play(cue);
                }
            },
        );
    }

    /// Notes a win once, lets the body beam for a moment, then shows the result.
    fn celebrate(&mut self, seconds: f32) {
        let Some(outcome) = self.session.round().progress().outcome else {
            return;
        };
        if self.screen != Screen::Play {
            return;
        }
        if self.session.is_played() && self.won.is_none() {
            let level = self.session.round().level().clone();
            let is_best = self.records.note(&level, &outcome);
            self.won = Some((outcome, is_best));
            self.last = Some(Arc::new(Replay::of(self.session.round())));
            self.sound.play(Cue::Won(match outcome.route {
                tamaire_play::Route::Squeeze => tamaire_sound::Route::Squeeze,
                tamaire_play::Route::Shave => tamaire_sound::Route::Shave,
                tamaire_play::Route::Mix => tamaire_sound::Route::Mix,
            }));
            let written = self.files.write("records.toml", &self.records);
            self.report(written);
        }
        self.cheered += seconds;
        if self.cheered >= CHEER && self.won.is_some() {
            self.go(Screen::Result);
        }
    }

    fn soundscape(&self) -> Soundscape {
        let round = self.session.round();
        let hold = round.level().game().hold.max(0.1);
        let mut presses = [Press::default(); 2];
        for (press, hand) in presses.iter_mut().zip(round.world().manipulators()) {
            let force = hand
                .reactions()
                .iter()
                .map(|reaction| length(reaction.contact));
            let count = hand.reactions().len().max(1) as f32;
            *press = Press {
                force: force.sum::<f32>() / count,
                slip: length(hand.velocity()),
                x: self.across(hand.position()[0]),
            };
        }
        Soundscape {
            presses,
            squash: (self.effects.pressure / 1000.0).min(1.0),
            hold: (round.progress().held / hold).min(1.0),
            music: true,
            hush: match self.screen {
                Screen::Paused | Screen::Settings(_) | Screen::Title => Hush::World,
                _ => Hush::Nothing,
            },
        }
    }

    fn across(&self, x: f32) -> f32 {
        across(self.session.round().level().arena(), x)
    }
}

/// What there is to hear of a tick.
fn cues(round: &tamaire_play::Round<fuwafuwa::Dim2>) -> Vec<Cue> {
    let arena = round.level().arena();
    let mut cues = Vec::new();
    let (mut torn, mut at) = (0.0, 0.0);
    for event in round.world().events() {
        match *event {
            Event::Released {
                at: place, energy, ..
            } => {
                torn += energy.max(0.01);
                at = across(arena, place[0]);
            }
            Event::Touched {
                with: With::Obstacle(_),
                impulse,
                at: place,
                ..
            } => {
                cues.push(Cue::Thud {
                    impulse,
                    x: across(arena, place[0]),
                });
            }
            _ => {}
        }
    }
    if torn > 0.0 {
        cues.push(Cue::Tear {
            energy: torn,
            x: at,
        });
    }
    cues
}

/// Where in the arena, from -1 at its left to 1 at its right.
fn across(arena: [fuwafuwa::Vector; 2], x: f32) -> f32 {
    let (low, high) = (arena[0][0], arena[1][0]);
    (2.0 * (x - low) / (high - low) - 1.0).clamp(-1.0, 1.0)
}

fn length(v: fuwafuwa::Vector) -> f32 {
    v.iter().map(|k| k * k).sum::<f32>().sqrt()
}
