//! The current round, which stays visible behind menus: its session, camera and display state.

use super::Toys;
use super::lesson::Tutorial;
use crate::look::{Cutaway, Effects};
use crate::session::Session;
use app_shell::{CameraRig, View};
use fuwafuwa_render::frame::ElementColour;
use tamaire_play::{AnyRound, Outcome};

/// Time between a win and the result screen [s].
const CHEER: f32 = 1.4;

/// The current round.
pub struct CurrentRound {
    /// The round in real time, played by people or shown from a replay.
    pub session: Session,
    /// Whether the player chose the replay that is the ghost. A retry then keeps this ghost.
    pub(super) is_ghost_chosen: bool,
    /// Particles and other effects.
    pub effects: Effects,
    /// Camera.
    pub camera: CameraRig,
    /// View of the last frame.
    pub view: Option<View>,
    /// Meaning of the element colours. `None` = the skin is shown instead.
    pub elements: Option<ElementColour>,
    /// Depth to which 3D bodies are cut open in the element view.
    pub opening: Cutaway,
    /// Speed at which a replay is watched, relative to real time; 1 at its start.
    pub watch_speed: f32,
    /// Whether slow motion is on.
    pub slow: bool,
    /// Whether the round advances by single steps only.
    pub stepping: bool,
    /// Whether the mouse holds the button on the screen that lets time run back.
    pub is_rewind_pressed: bool,
    /// Choices of the player in a playground.
    pub toys: Toys,
    /// Outcome of a won round, and whether it is the player's best for its route. `None` for replays.
    pub won: Option<(Outcome, bool)>,
    pub(super) lesson: Tutorial,
    /// Whether each switch was pressed after the last tick.
    pub(super) switches: Vec<bool>,
    /// Whether the round has been added to [`PublicMode::ended`](super::PublicMode::ended).
    pub(super) is_noted: bool,
    /// Number of the last look at the pieces in this round, and whether the round was hopeless then.
    pub(crate) hopeless: Option<(u64, bool)>,
    /// Whether the player was told that this machine is too slow for the round.
    pub(super) is_known_slow: bool,
    /// Time since the round was won, or on the title screen since it ended [s].
    pub(super) cheered: f32,
}

impl CurrentRound {
    /// Creates the state of a new round.
    pub(crate) fn new(session: Session) -> Self {
        Self {
            toys: Toys::of(session.round()),
            session,
            is_ghost_chosen: false,
            effects: Effects::default(),
            camera: CameraRig::default(),
            view: None,
            elements: None,
            opening: Cutaway::default(),
            watch_speed: 1.0,
            slow: false,
            stepping: false,
            is_rewind_pressed: false,
            won: None,
            lesson: Tutorial::default(),
            switches: Vec::new(),
            is_noted: false,
            hopeless: None,
            is_known_slow: false,
            cheered: 0.0,
        }
    }

    /// Replaces the round and keeps the camera. `time` is the time since the start of the game [s].
    pub(crate) fn begin(&mut self, session: Session, time: f64) {
        let has_failed = self.is_given_up_for(&session);
        let is_after_way = self.session.shows_way() || session.shows_way();
        self.toys = Toys::of(session.round());
        self.session = session;
        self.is_ghost_chosen = false;
        self.watch_speed = 1.0;
        self.opening = Cutaway::begin(time);
        self.effects = Effects::default();
        if is_after_way {
            self.lesson.begin_after_way();
        } else if self.lesson.begin(has_failed) {
            self.effects.remind();
        }
        self.switches.clear();
        // The view refers to the previous round.
        self.view = None;
        self.won = None;
        self.is_noted = false;
        self.hopeless = None;
        self.is_known_slow = false;
        self.cheered = 0.0;
    }

    /// Shows the room of a level in the editor. The camera and the view stay.
    pub(super) fn show(&mut self, session: Session) {
        let view = self.view;
        self.begin(session, 0.0);
        self.view = view;
    }

    /// Whether the player has pushed but not won, and starts the same level again with `next`.
    fn is_given_up_for(&self, next: &Session) -> bool {
        let (before, after) = (self.round(), next.round());
        let is_same = before.level().is_version_of(after.level());
        let are_played = self.session.is_played() && next.is_played();
        let is_won = before.progress().outcome.is_some();
        are_played && is_same && before.has_basket() && before.clock_ticks() > 0 && !is_won
    }

    /// Returns the round in its current state.
    pub fn round(&self) -> &AnyRound {
        self.session.round()
    }

    /// Whether the round is in 3D and is being played.
    pub fn is_played_in_space(&self) -> bool {
        self.session.is_played() && self.turn().is_some()
    }

    /// Whether people play a round in a level with a single hand.
    pub(super) fn lacks_second_hand(&self) -> bool {
        self.session.is_played() && !self.takes_two()
    }

    /// Whether a second player can join.
    pub fn takes_two(&self) -> bool {
        self.session.is_played() && self.round().level().players() > 1
    }

    /// Rotation of the camera around the vertical axis, to the right [rad]. `None` in 2D.
    pub fn turn(&self) -> Option<f32> {
        let is_space = matches!(self.round(), AnyRound::Space(_));
        is_space.then(|| self.camera.azimuth())
    }

    /// Whether the celebration of a win is over.
    pub fn has_cheered(&self) -> bool {
        self.cheered >= CHEER
    }

    /// Switches from the skin to elements by level, to elements by strain, and back. `time` is the time since
    /// the start of the game [s].
    pub(super) fn show_elements(&mut self, time: f64) {
        if self.elements.is_none() {
            self.opening = Cutaway::begin(time);
        }
        self.elements = match self.elements {
            None => Some(ElementColour::Level),
            Some(ElementColour::Level) => Some(ElementColour::Strain),
            Some(ElementColour::Strain) => None,
        };
    }
}
