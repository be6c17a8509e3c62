//! The tools of a playground.

use super::{Game, Screen};
use crate::input::Action;
use tamaire_play::AnyRound;
use tamaire_play::playground::{Change, ChangeError, Stuff, Tool};

/// Choices of the player in a playground.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Toys {
    /// Material of the bodies that are added.
    pub stuff: Stuff,
    /// Tool of the hand.
    pub tool: Tool,
    /// Gravity [m/s²].
    pub gravity: f32,
    /// Drag of the air [1/s].
    pub air: f32,
    /// Radius of the hand in cm.
    pub hand: f32,
    /// Whether the sliders are shown.
    pub has_sliders: bool,
    /// Whether the mouse or a finger presses the tool.
    pub is_pointer_down: bool,
    /// Whether the tool was pressed in the last frame.
    is_pressed: bool,
}

impl Toys {
    /// Returns the choices at the start of a round.
    pub(super) fn of(round: &AnyRound) -> Self {
        let mut toys = Self {
            stuff: Stuff::Jelly,
            tool: Tool::Push,
            gravity: 0.0,
            air: 0.0,
            hand: 0.0,
            has_sliders: false,
            is_pointer_down: false,
            is_pressed: false,
        };
        toys.follow(round);
        toys
    }

    /// Takes over what is the case in a round, for example after time ran back.
    pub(super) fn follow(&mut self, round: &AnyRound) {
        (self.tool, self.is_pressed) = round.tool();
        [self.gravity, self.air] = round.gravity_and_air();
        self.hand = 100.0 * round.hands()[0].radius;
    }
}

impl Game {
    /// Whether people play a round in a playground, which has no basket.
    pub fn is_in_playground(&self) -> bool {
        self.bout.session.is_played() && !self.bout.round().has_basket()
    }

    /// Makes a change of the playground, and tells the player if it is refused.
    pub fn change_playground(&mut self, change: Change) {
        if matches!(
            change,
            Change::Tool(_) | Change::HandSize(_) | Change::Clear
        ) {
            // These let go what is held. If the player still presses, the tool is pressed again.
            self.bout.toys.is_pressed = false;
        }
        if self
            .bout
            .session
            .change(change)
            .is_err_and(|error| error != ChangeError::NoPlayground)
        {
            self.notify(self.words().room_is_full.to_string());
        }
    }

    /// Tells the round when the player presses the tool or lets it go.
    pub(super) fn press_tool(&mut self) {
        let devices = &self.controls.devices;
        let is_held = devices.is_held(&self.settings.bindings, Action::Tool);
        let toys = &mut self.bout.toys;
        let is_pressed = (is_held || toys.is_pointer_down) && toys.tool != Tool::Push;
        let is_on = self.screen() == Screen::Play && self.is_in_playground();
        if is_on && is_pressed != self.bout.toys.is_pressed {
            self.bout.toys.is_pressed = is_pressed;
            self.change_playground(Change::Press(is_pressed));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::platform::{Files, Sound};
    use app_shell::Pads;
    use fuwafuwa::Vec3;
    use fuwafuwa_scenes::scene::Form;

    #[test]
    fn pressing_is_told_once_and_a_full_room_is_told() {
        let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
        let place = game.levels.iter().position(|level| level.id == "sandbox");
        game.start(place.unwrap());
        assert!(game.is_in_playground());
        game.change_playground(Change::Tool(Tool::Knife));
        game.bout.toys.tool = Tool::Knife;
        game.bout.toys.is_pointer_down = true;
        (0..5).for_each(|_| game.update(0.02));
        game.bout.toys.is_pointer_down = false;
        (0..5).for_each(|_| game.update(0.02));
        let pressed = game.bout.round().changes().iter();
        let pressed: Vec<Change> = pressed.map(|change| change.change).collect();
        let expected = [
            Change::Tool(Tool::Knife),
            Change::Press(true),
            Change::Press(false),
        ];
        assert_eq!(pressed, expected);
        for _ in 0..40 {
            game.change_playground(Change::add(Form::Box, Stuff::Clay, Vec3::ZERO));
        }
        let said = game.words().room_is_full;
        assert!(game.notices.iter().any(|notice| notice.text == said));
        game.retry();
        assert_eq!(game.bout.toys.tool, Tool::Push);
    }
}
