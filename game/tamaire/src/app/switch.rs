//! Play with a single switch: the space key, Enter, or the first button of a stick or pad.

use super::presses::Presses;
use crate::game::{Game, Screen};
use crate::input::{Action, InputSource, ScanAction};
use egui::{Context, Key};
use sticks::{Control, PadButton};

/// Scanning for players with a single switch: offers the possible actions one after the other.
#[derive(Debug, Default)]
pub(super) struct Switch {
    /// Time for which the focused widget of a menu has been offered, in units of the scanning step.
    offered_for: f32,
}

impl Switch {
    /// Keys that act as the switch.
    pub(super) const KEYS: [Key; 2] = [Key::Space, Key::Enter];

    /// Whether a button of a stick or pad acts as the switch.
    pub(super) fn is(control: Control) -> bool {
        matches!(control, Control::Pad(PadButton::South) | Control::Button(0))
    }

    /// Advances scanning by `seconds` [s]: offers the next action in a round, or focuses the next widget in a
    /// menu. Does nothing if scanning is off.
    pub(super) fn pass(&mut self, game: &mut Game, presses: &Presses, ctx: &Context, seconds: f32) {
        game.controls.devices.taken = None;
        let step = game.settings.scanning.step();
        let Some(step) = step.filter(|_| !game.is_away) else {
            return;
        };
        let (steps, is_pressed) = (seconds / step, is_pressed(game, ctx));
        if game.screen() != Screen::Play {
            game.controls.scan.start();
            let before = if is_pressed { 0.0 } else { self.offered_for };
            self.offered_for = before + steps;
            if self.offered_for >= 1.0 && game.controls.rebinding.is_none() {
                self.offered_for = 0.0;
                presses.waiting().keys.push(Key::Tab);
            }
            return;
        }
        let (others, stays) = (game.scan_actions(), game.settings.toggle_keys);
        let (is_played, controls) = (game.bout.session.is_played(), &mut game.controls);
        controls.scan.pass(is_pressed, stays, steps, &others);
        let taken = controls.scan.taken(&others);
        // While a replay is shown, every press of the switch opens the pause screen, since nothing else is
        // possible.
        match controls.scan.just_taken(&others) {
            _ if !is_played && taken.is_some() => game.act(Action::Pause, InputSource::Keys),
            Some(ScanAction::Pause) => game.act(Action::Pause, InputSource::Keys),
            Some(ScanAction::Tool) => {
                controls.scan.end();
                game.bout.toys.is_latched ^= true;
            }
            _ => controls.devices.taken = taken,
        }
    }
}

fn is_pressed(game: &Game, ctx: &Context) -> bool {
    let by_key = ctx.input(|input| {
        let mut keys = Switch::KEYS.iter();
        keys.any(|key| input.keys_down.contains(key))
    });
    let devices = &game.controls.devices.sticks.devices;
    let mut buttons = devices.iter().flat_map(|device| device.controls());
    by_key || buttons.any(|(control, button)| Switch::is(control) && button.down)
}
