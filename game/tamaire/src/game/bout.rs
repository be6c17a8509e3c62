//! The round that is on the screen, behind whatever menu: who plays it, and how it is seen.

use super::lesson::Lesson;
use crate::look::{CameraRig, Effects, Opening, View};
use crate::session::Session;
use fuwafuwa_render::frame::ElementColour;
use tamaire_play::{AnyRound, Outcome};

/// After a win the round goes on for so long before the result is shown [s].
const CHEER: f32 = 1.4;

/// The round that is on the screen.
pub struct Bout {
    /// It in time.
    pub session: Session,
    /// Whether the ghost beside it, if any, is one that the player chose.
    pub(super) is_ghost_chosen: bool,
    /// What flies about.
    pub effects: Effects,
    /// From where it is seen.
    pub camera: CameraRig,
    /// What that saw in the last frame.
    pub view: Option<View>,
    /// What the colours of elements tell, when they are seen instead of the skin.
    pub elements: Option<ElementColour>,
    /// How far bodies in space are opened for that.
    pub opening: Opening,
    /// Whether time goes slowly.
    pub slow: bool,
    /// Whether time stands still, but for single steps.
    pub stepping: bool,
    /// The win: how, and whether it was the best by its route.
    pub won: Option<(Outcome, bool)>,
    pub(super) lesson: Lesson,
    /// Whether it was collected by whoever collects rounds.
    pub(super) is_noted: bool,
    /// Whether it was told that this machine cannot bear it at its speed.
    pub(super) is_known_slow: bool,
    /// How long it has been over [s].
    pub(super) cheered: f32,
}

impl Bout {
    /// A round that nobody has looked at.
    pub(super) fn new(session: Session) -> Self {
        Self {
            session,
            is_ghost_chosen: false,
            effects: Effects::default(),
            camera: CameraRig::default(),
            view: None,
            elements: None,
            opening: Opening::default(),
            slow: false,
            stepping: false,
            won: None,
            lesson: Lesson::default(),
            is_noted: false,
            is_known_slow: false,
            cheered: 0.0,
        }
    }

    /// Another round, seen from where the last one was seen; the game is so old [s].
    pub(super) fn begin(&mut self, session: Session, time: f64) {
        self.session = session;
        self.is_ghost_chosen = false;
        self.opening = Opening::begin(time);
        self.effects = Effects::default();
        self.lesson.begin();
        // It means places of the round before.
        self.view = None;
        self.won = None;
        self.is_noted = false;
        self.is_known_slow = false;
        self.cheered = 0.0;
    }

    /// The round as it is now.
    pub fn round(&self) -> &AnyRound {
        self.session.round()
    }

    /// Whether people play it, in space.
    pub fn is_played_in_space(&self) -> bool {
        self.session.is_played() && self.turn().is_some()
    }

    /// Whether a second player can come in.
    pub fn takes_two(&self) -> bool {
        self.session.is_played() && self.round().level().scene().hand.len() > 1
    }

    /// In space by how much the camera went around to the right [rad].
    pub fn turn(&self) -> Option<f32> {
        let is_space = matches!(self.round(), AnyRound::Space(_));
        is_space.then(|| self.camera.turn())
    }

    /// Whether a body that is in has beamed for long enough.
    pub fn has_cheered(&self) -> bool {
        self.cheered >= CHEER
    }

    /// Shows elements instead of the skin, then what strains them, then the skin again; the game is so old [s].
    pub(super) fn show_elements(&mut self, time: f64) {
        if self.elements.is_none() {
            self.opening = Opening::begin(time);
        }
        self.elements = match self.elements {
            None => Some(ElementColour::Level),
            Some(ElementColour::Level) => Some(ElementColour::Strain),
            Some(ElementColour::Strain) => None,
        };
    }
}
