//! Options for drawing a round.

use super::Effects;
use app_shell::{CameraRig, Theme, View};
use egui::Rect;
use fuwafuwa_render::frame::ElementColour;
use tamaire_play::{AnyRound, Level};

/// Options for drawing a round.
#[derive(Copy, Clone, Debug)]
pub struct DrawOptions<'a> {
    /// Camera and part of the screen.
    pub view: View,
    /// Colours.
    pub theme: &'a Theme,
    /// Colouring of the element view; `None` shows the skin.
    pub elements: Option<ElementColour>,
    /// Element view in 3D: share of a body that is not cut away, 0 to 1.
    pub cut_share: f32,
    /// Particles, confetti and feelings.
    pub effects: &'a Effects,
    /// Time since the start of the game [s], for blinking.
    pub time: f64,
    /// Earlier round of the same level, drawn as a ghost.
    pub ghost: Option<&'a AnyRound>,
    /// Hint that is shown until the hand moves.
    pub hint: Hint,
    /// Whether drawn faces stay happy.
    pub calm: bool,
    /// Reduced motion.
    pub reduced_motion: bool,
    /// Resolution of the drawn world, relative to the screen.
    pub resolution: f32,
}

/// Hint for a player who has not moved the hand yet.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Hint {
    /// No hint.
    None,
    /// Marks the player's hand.
    Hand,
    /// Marks the player's hand and shows how to push the body into the basket.
    Way,
}

/// Returns the view in which the arena of `level` fits into `rect`.
pub(crate) fn view_of_level(camera: &CameraRig, rect: Rect, level: &Level) -> View {
    match level.scene().dim {
        2 => camera.view_of_plane(rect, level.arena()),
        _ => camera.view_of_space(rect, level.arena()),
    }
}
