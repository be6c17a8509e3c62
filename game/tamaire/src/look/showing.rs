//! How a round is to be shown.

use super::{Effects, Theme, View};
use fuwafuwa_render::frame::ElementColour;
use tamaire_play::AnyRound;

/// How to show a round.
#[derive(Copy, Clone, Debug)]
pub struct Look<'a> {
    /// Where.
    pub view: View,
    /// In which colours.
    pub theme: &'a Theme,
    /// Whether to show the elements instead of the skin.
    pub elements: Option<ElementColour>,
    /// In space, how much is left of a body that is opened for it, 0 to 1.
    pub left: f32,
    /// What flies about.
    pub effects: &'a Effects,
    /// Seconds since the game began, for blinking.
    pub time: f64,
    /// The same level as somebody played it before.
    pub ghost: Option<&'a AnyRound>,
    /// Whether to show what the hand could do, until it moves.
    pub hint: Hint,
    /// With reduced motion.
    pub still: bool,
}

/// What a player is shown before the hand moves.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Hint {
    /// Nothing.
    None,
    /// Which hand is theirs.
    Hand,
    /// And what it could do.
    Way,
}
