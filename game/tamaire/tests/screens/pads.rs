//! Play with a pad or a stick alone.

use crate::window::*;
use app_shell::Pads;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use force_feedback::{Ability, Recording};
use sticks::{Device, DeviceId, DeviceInfo, Pad, PadButton, Snapshot};
use tamaire::game::Screen;
use tamaire::input::{Action, InputSource};
use tamaire::platform::Files;

/// Window with simulated devices.
pub struct Table {
    pub window: Window,
    pub devices: Vec<Device>,
    rumbles: Recording,
}

impl Table {
    pub fn with(devices: Vec<Device>) -> Self {
        let window = window(Files::nowhere());
        let rumbles = Recording::new(Ability::Rumble);
        let mut table = Self {
            window,
            devices,
            rumbles,
        };
        table.frames(2);
        table
    }

    pub fn frames(&mut self, count: usize) {
        let devices = self.devices.clone();
        let notes = devices
            .iter()
            .map(|device| (device.id, self.rumbles.clone()));
        let notes = notes.collect();
        game(&mut self.window).controls.pads = Pads::of(Snapshot { devices }).noting(notes);
        frames(&mut self.window, count);
    }

    /// Presses a button of the last pad for two frames, then releases the button for two frames.
    pub fn tap(&mut self, button: PadButton) {
        self.button(button).press();
        self.frames(2);
        self.button(button).down = false;
        self.frames(2);
    }

    fn button(&mut self, button: PadButton) -> &mut sticks::Button {
        let last = self.devices.len() - 1;
        self.pad(last).button_mut(button)
    }

    /// Returns the state of the pad with index `place` in `devices`.
    pub fn pad(&mut self, place: usize) -> &mut Pad {
        let pad = self.devices[place].pad.as_mut();
        pad.expect("the device is a pad")
    }

    /// Presses a button of the d-pad until the widget with this name has the focus, at most `most` times.
    fn tap_until(&mut self, button: PadButton, name: &str, most: usize) {
        for _ in 0..most {
            if !self.has_focus(name) {
                self.tap(button);
            }
        }
    }

    fn screen(&self) -> Screen {
        screen(&self.window)
    }

    fn has_focus(&self, name: &str) -> bool {
        button(&self.window, name).is_focused()
    }
}

pub fn about(name: &str) -> DeviceInfo {
    DeviceInfo {
        name: name.into(),
        guid: name.into(),
        ..DeviceInfo::default()
    }
}

pub fn pad(id: u32) -> Device {
    let mut device = Device::at_rest(DeviceId(id), about("Pad"), 6, 0, 0);
    device.pad = Some(Pad::default());
    device
}

#[test]
fn pad_alone_reaches_all_screens() {
    use PadButton::*;
    let mut table = Table::with(vec![pad(1)]);
    assert!(table.has_focus("Play"));
    table.tap(South);
    assert_eq!(table.screen(), Screen::Levels);
    assert!(table.has_focus("Classic"));
    table.tap(Right);
    assert!(!table.has_focus("Classic"));
    table.tap(Left);
    table.tap(South);
    assert_eq!(table.screen(), Screen::Play);

    let hand = |table: &Table| hand_targets(&table.window)[0];
    let before = hand(&table);
    table.pad(0).left = [0.0, 1.0];
    table.frames(15);
    table.pad(0).left = [0.0; 2];
    table.button(Right).press();
    table.frames(15);
    table.button(Right).down = false;
    let after = hand(&table);
    assert!(
        after.x > before.x + 0.2 && after.y > before.y + 0.2,
        "{before:?} {after:?}"
    );

    table.tap(Start);
    assert_eq!(table.screen(), Screen::Paused);
    assert!(table.has_focus("Resume"));
    table.tap(Down);
    assert!(table.has_focus("Restart"));
    table.tap(Down);
    assert!(table.has_focus("Save replay"));
    table.tap(Down);
    assert!(table.has_focus("Link to this level"));
    table.tap(Down);
    table.tap(South);
    assert!(matches!(table.screen(), Screen::Settings));
    assert!(table.has_focus("Back"));
    let slider = |table: &Table, name| {
        let slider = table.window.get_by_role_and_label(Role::Slider, name);
        slider.is_focused()
    };
    for _ in 0..4 {
        if !slider(&table, "Volume") {
            table.tap(Down);
        }
    }
    assert!(slider(&table, "Volume"));
    let before = game(&mut table.window).settings.volume;
    table.tap(Left);
    table.tap(Left);
    let after = game(&mut table.window).settings.volume;
    assert!((before - after - 0.1).abs() < 1e-3, "{before} {after}");

    // Moves the focus down to the end of the page, where the focused button must be visible.
    table.tap_until(Down, "Restore default settings", 60);
    assert!(table.has_focus("Restore default settings"));
    let (seen, room) = (
        button(&table.window, "Restore default settings").rect(),
        table.window.ctx.content_rect(),
    );
    assert!(room.contains_rect(seen), "{seen:?} in {room:?}");
    table.tap(Up);
    table.tap(South);
    let last = Action::ALL[Action::ALL.len() - 1];
    assert_eq!(game(&mut table.window).controls.rebinding, Some(last));
    table.tap(Down);
    let bindings = &game(&mut table.window).settings.bindings;
    let down = sticks::Control::Pad(Down);
    assert_eq!(bindings.of_button(down), Some(last));
    table.tap(East);
    assert_eq!(table.screen(), Screen::Paused);
    table.tap(East);
    assert_eq!(table.screen(), Screen::Play);
    table.tap(North);
    assert!(ticks(&table.window) < 6, "the round restarts");
}

#[test]
fn plain_stick_alone_starts_round() {
    let stick = Device::at_rest(DeviceId(7), about("Stick"), 2, 8, 1);
    let mut table = Table::with(vec![stick]);
    let tap = |table: &mut Table, button: usize| {
        table.devices[0].buttons[button].press();
        table.frames(2);
        table.devices[0].buttons[button].down = false;
        table.frames(2);
    };
    // The value of the axis is positive if the stick is tilted towards the player.
    for name in ["Draw", "Two players", "Replays"] {
        table.devices[0].axes[1] = 1.0;
        table.frames(2);
        table.devices[0].axes[1] = 0.0;
        table.frames(2);
        assert!(table.has_focus(name));
    }
    tap(&mut table, 0);
    assert_eq!(table.screen(), Screen::Replays);
    tap(&mut table, 1);
    assert_eq!(table.screen(), Screen::Title);
    tap(&mut table, 0);
    tap(&mut table, 0);
    assert_eq!(table.screen(), Screen::Play);
    tap(&mut table, 2);
    assert_eq!(table.screen(), Screen::Paused);
}

#[test]
fn second_player_joins_leaves_and_is_unplugged() {
    let mut table = Table::with(vec![pad(1), pad(2)]);
    game(&mut table.window).start(0);
    table.frames(2);
    table.tap(PadButton::Back);
    let second = |table: &mut Table| game(&mut table.window).controls.players.second();
    assert_eq!(second(&mut table), Some(InputSource::Stick(DeviceId(2))));
    let before = hand_targets(&table.window);
    assert_eq!(before.len(), 2);
    table.pad(1).left = [1.0, 0.0];
    table.frames(10);
    let after = hand_targets(&table.window);
    assert!(after[1].x > before[1].x + 0.2, "{before:?} {after:?}");
    assert_eq!(after[0], before[0]);
    table.pad(1).left = [0.0; 2];
    table.tap(PadButton::Back);
    assert_eq!(second(&mut table), None);
    table.tap(PadButton::Back);

    table.devices.pop();
    table.frames(2);
    assert_eq!(
        table.screen(),
        Screen::Paused,
        "the round pauses for the unplugged player"
    );
    table.tap(PadButton::South);
    assert_eq!(table.screen(), Screen::Play);
    assert_eq!(second(&mut table), None);
    table.frames(5);
}

#[test]
fn pad_trial_captures_its_stick() {
    use PadButton::*;
    let mut table = Table::with(vec![pad(1)]);
    game(&mut table.window).go(Screen::Settings);
    table.frames(2);
    table.tap_until(Down, "Sticks and pads…", 20);
    table.tap(South);
    assert!(matches!(table.screen(), Screen::Forces));
    // The ability of the pad is known once its thread has reported it.
    table.tap_until(Down, "Try it", 20);
    table.tap(South);
    assert!(game(&mut table.window).trial.is_some());
    assert!(table.has_focus("Stop"));
    table.rumbles.take();
    let strength = game(&mut table.window).settings.haptics;
    for lean in [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]] {
        table.pad(0).left = lean;
        table.frames(20);
    }
    assert!(table.has_focus("Stop"));
    assert_eq!(game(&mut table.window).settings.haptics, strength);
    let played = table.rumbles.take();
    assert!(played.iter().any(|played| !played.output.is_zero()));
    table.tap(South);
    assert!(game(&mut table.window).trial.is_none());

    // The emergency button works on every screen; the forces screen switches forces on again.
    let bindings = &mut game(&mut table.window).settings.bindings;
    bindings.bind_button(Action::CutForces, sticks::Control::Pad(RightStick));
    table.tap(RightStick);
    assert!(game(&mut table.window).forces.is_cut());
    table.tap(Up);
    table.tap_until(Up, "Switch forces on again", 20);
    table.tap(South);
    assert!(!game(&mut table.window).forces.is_cut());
    table.tap(East);
    table.tap(East);
    assert_eq!(table.screen(), Screen::Title);
}
