//! The tools of a playground.

use super::{Game, Screen};
use crate::input::{Action, ScanAction};
use fuwafuwa::Vec3;
use fuwafuwa_scenes::scene::Form;
use tamaire_play::playground::{Change, ChangeError, Stuff, Tool};
use tamaire_play::{AnyRound, Assist};

/// Distance of an added body from the upper end of the room [m].
const BELOW_TOP: f32 = 0.35;

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
    /// Whether a player with one switch has pressed the tool.
    pub is_latched: bool,
    /// Whether the mouse or a finger presses the tool.
    pub is_pointer_down: bool,
    /// Whether the key or button of the tool was up since the round is shown.
    is_armed: bool,
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
            is_latched: false,
            is_pointer_down: false,
            is_armed: false,
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
        self.is_latched = false;
    }
}

impl Game {
    /// Whether people play a round in a playground, which has no basket.
    pub fn is_in_playground(&self) -> bool {
        self.bout.session.is_played() && !self.bout.round().has_basket()
    }

    /// Makes a change of the playground, and tells the player if it is refused. Returns whether it is made.
    pub fn change_playground(&mut self, change: Change) -> bool {
        if matches!(
            change,
            Change::Tool(_) | Change::HandSize(_) | Change::Clear
        ) {
            // These let go what is held. If the player still presses, the tool is pressed again.
            self.bout.toys.is_pressed = false;
        }
        let said = self.words();
        let refused = match self.bout.session.change(change) {
            Ok(()) => return true,
            Err(ChangeError::NoPlayground) => return false,
            Err(ChangeError::Full) => said.room_is_full.to_string(),
            Err(ChangeError::TooManyPins) => said.too_many_pins.to_string(),
            Err(ChangeError::TooMany) => said.too_many_changes.to_string(),
            Err(ChangeError::Invalid(reason)) => reason,
        };
        self.notify(refused);
        false
    }

    /// Chooses a tool of the hand.
    pub fn choose_tool(&mut self, tool: Tool) {
        self.bout.toys.tool = tool;
        self.bout.toys.is_latched = false;
        self.change_playground(Change::Tool(tool));
    }

    /// Sets gravity, air and the size of the hand as in `chosen`.
    pub fn set_room(&mut self, chosen: Toys) {
        let before = self.bout.toys;
        let unit = |value: f32, step: f32| (value / step).round() as u8;
        let gravity = Change::Gravity(unit(chosen.gravity, 0.5));
        if before.gravity != chosen.gravity && self.change_playground(gravity) {
            self.bout.toys.gravity = chosen.gravity;
        }
        let air = Change::Air(unit(chosen.air, 0.1));
        if before.air != chosen.air && self.change_playground(air) {
            self.bout.toys.air = chosen.air;
        }
        let hand = Change::HandSize(unit(chosen.hand, 1.0));
        if before.hand != chosen.hand && self.change_playground(hand) {
            self.bout.toys.hand = chosen.hand;
        }
    }

    /// Returns the tools of a playground. In a level in which nothing tears there is no knife.
    pub fn tools(&self) -> impl Iterator<Item = Tool> + use<> {
        let assists = &self.bout.round().level().game().assists;
        let can_cut = !assists.contains(&Assist::Unbreakable);
        let tools = [Tool::Push, Tool::Grab, Tool::Knife, Tool::Pin];
        let tools = tools.into_iter();
        tools.filter(move |&tool| can_cut || tool != Tool::Knife)
    }

    /// Adds a body of the chosen material below the upper end of the room, on the side away from the hand.
    pub fn add_body(&mut self, form: Form) {
        let at = self.place_to_add();
        self.change_playground(Change::add(form, self.bout.toys.stuff, at));
    }

    fn place_to_add(&self) -> Vec3 {
        let round = self.bout.round();
        let [low, high] = round.level().arena();
        let middle = 0.5 * (low + high);
        let side = if round.hands()[0].position.x < middle.x {
            0.25
        } else {
            -0.25
        };
        // Bodies that are added one after the other lie a little apart.
        let apart = 0.03 * (round.changes().len() % 7) as f32;
        let x = middle.x + side * (high.x - low.x) + apart;
        Vec3::new(x, high.y - BELOW_TOP, middle.z)
    }

    /// Returns the actions that a player with one switch is offered after the directions.
    pub fn scan_actions(&self) -> Vec<ScanAction> {
        let in_space = self.bout.turn().is_some();
        let has_tool = self.is_in_playground() && self.bout.toys.tool != Tool::Push;
        let heights = [ScanAction::Raise, ScanAction::Lower];
        let heights = heights.into_iter().filter(|_| in_space);
        let tool = has_tool.then_some(ScanAction::Tool);
        let usual = [ScanAction::Rewind, ScanAction::Pause];
        heights.chain(tool).chain(usual).collect()
    }

    /// Tells the round when the player presses the tool or lets it go.
    pub(super) fn press_tool(&mut self) {
        let devices = &self.controls.devices;
        let is_held = devices.is_held(&self.settings.bindings, Action::Tool);
        let (is_on, scans) = (
            self.screen() == Screen::Play && self.is_in_playground(),
            self.settings.scanning.is_on(),
        );
        let toys = &mut self.bout.toys;
        // A button that is still down from a menu, and the switch of a player with one switch, press no tool.
        toys.is_armed = is_on && (toys.is_armed || !is_held);
        toys.is_latched &= scans;
        let is_pressed = is_held && toys.is_armed && !scans;
        let is_pressed = is_pressed || toys.is_pointer_down || toys.is_latched;
        let is_pressed = is_pressed && toys.tool != Tool::Push;
        // One press of a pin is one pin.
        toys.is_latched &= toys.tool != Tool::Pin;
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
