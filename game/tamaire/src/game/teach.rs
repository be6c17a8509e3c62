//! Hints for players who do not know the controls yet, or who are stuck.

use super::lesson::Seen;
use super::{Game, Screen};
use crate::input::{Action, InputMethod};
use fuwafuwa::Vec3;

impl Game {
    /// Returns the hints about moving the hand, raising it and turning the camera, each with whether to show
    /// it. A hint disappears when its action was done, and returns when the player is stuck. The texts suit
    /// the input method used last. There are no hints in 2D and outside of a round. With scanning on, the only
    /// hint explains the switch.
    pub fn lesson(&self) -> Vec<(String, bool)> {
        if self.settings.scanning.is_on() {
            let is_played = self.screen() == Screen::Play && self.bout.session.is_played();
            let told = self.words().how_by_switch.to_string();
            return Vec::from_iter(is_played.then_some((told, !self.controls.scan.is_known())));
        }
        // In the element view the mouse wheel cuts bodies open instead of raising the hand, so the hints
        // would be wrong.
        if !self.is_played_in_space() || self.bout.elements.is_some() {
            return Vec::new();
        }
        let on_stick = self.controls.means == InputMethod::Stick;
        let names = [
            &[Action::Up, Action::Left, Action::Down, Action::Right][..],
            &[Action::Raise, Action::Lower],
            &[Action::TurnLeft, Action::TurnRight],
        ];
        let bindings = &self.settings.bindings;
        let names = names.map(|actions| bindings.first_names(actions, on_stick));
        let lines = (self.words().how_in_space)(self.controls.means, &names);
        lines.into_iter().zip(self.bout.lesson.missing()).collect()
    }

    /// Updates the tutorial with the movements of this frame.
    pub(super) fn learn(&mut self, seconds: f32) {
        if self.screen() != Screen::Play || !self.bout.session.is_played() {
            return;
        }
        let round = self.bout.round();
        let gone = match self.controls.players.wanted(0) {
            Some(wanted) => wanted - round.start(0),
            None => Vec3::ZERO,
        };
        let progress = round.progress();
        let is_open = round.has_basket() && progress.outcome.is_none();
        let [right, up] = self.bout.camera.orbit_angles();
        let is_stuck = self.bout.lesson.see(Seen {
            gone,
            turned: right.abs().max(up.abs()),
            within: is_open.then_some(progress.within),
            has_begun: round.clock_ticks() > 0,
            seconds,
        });
        if is_stuck {
            self.bout.effects.remind();
        }
    }

    fn is_played_in_space(&self) -> bool {
        self.screen() == Screen::Play && self.bout.is_played_in_space()
    }
}
