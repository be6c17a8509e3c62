//! Key and button bindings.

use super::{Action, KeyboardPart};
use egui::Key;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use sticks::{Control, Direction, Labels, PadButton};

/// Keys and buttons by action. Each key and button is bound to at most one action.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Bindings {
    /// Keyboard keys.
    pub keys: BTreeMap<Action, Vec<Key>>,
    /// Buttons of pads and sticks.
    pub buttons: BTreeMap<Action, Vec<PadKey>>,
}

/// Button in the notation of the settings file: `south` for a pad, `3` for another stick (counted from 1), or
/// `hat up`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct PadKey(pub String);

impl PadKey {
    /// Returns the name of a control.
    pub fn of(control: Control) -> Self {
        Self(match control {
            Control::Button(index) => (index + 1).to_string(),
            Control::Hat(_, direction) => format!("hat {direction:?}").to_lowercase(),
            Control::Pad(button) => format!("{button:?}").to_lowercase(),
        })
    }

    /// Display name: the label printed on a pad of this kind if known, otherwise the name in words, such as
    /// `left shoulder` for `leftshoulder`.
    fn in_words(&self, labels: Labels) -> String {
        let mut all = PadButton::ALL.into_iter();
        let button = all.find(|&button| *self == Self::of(Control::Pad(button)));
        if let Some(label) = button.and_then(|button| button.label(labels)) {
            return label.into();
        }
        let mut sides = ["left", "right"].into_iter();
        let part = sides.find_map(|side| Some((side, self.0.strip_prefix(side)?)));
        match part {
            Some((side, rest)) if !rest.is_empty() => format!("{side} {rest}"),
            _ => self.0.clone(),
        }
    }

    /// Whether the button is on a stick without a pad layout.
    fn is_of_stick(&self) -> bool {
        self.0.starts_with("hat ") || self.0.parse::<u8>().is_ok()
    }
}

impl Default for Bindings {
    fn default() -> Self {
        let keys = [
            (Action::Up, vec![Key::ArrowUp, Key::W]),
            (Action::Down, vec![Key::ArrowDown, Key::S]),
            (Action::Left, vec![Key::ArrowLeft, Key::A]),
            (Action::Right, vec![Key::ArrowRight, Key::D]),
            (Action::Retry, vec![Key::R, Key::Backspace]),
            (Action::Rewind, vec![Key::B]),
            (Action::Pause, vec![Key::Escape, Key::P]),
            (Action::Elements, vec![Key::E, Key::Tab]),
            (Action::Slow, vec![Key::F]),
            (Action::Step, vec![Key::Period]),
            (Action::Tool, vec![Key::Space]),
            (Action::Make, vec![Key::M]),
            (Action::Join, vec![Key::J]),
            (Action::Raise, vec![Key::Q, Key::PageUp]),
            (Action::Lower, vec![Key::Z, Key::PageDown]),
            (Action::TurnLeft, vec![Key::OpenBracket]),
            (Action::TurnRight, vec![Key::CloseBracket]),
            (Action::Deeper, vec![Key::X]),
            (Action::Shallower, vec![Key::C]),
            (Action::CutForces, vec![Key::F12]),
        ];
        let pad = |button| PadKey::of(Control::Pad(button));
        let stick = |index| PadKey::of(Control::Button(index));
        let way = |action, direction: Direction| {
            let hat = PadKey::of(Control::Hat(0, direction));
            (action, vec![pad(direction.into()), hat])
        };
        let buttons = [
            way(Action::Up, Direction::Up),
            way(Action::Down, Direction::Down),
            way(Action::Left, Direction::Left),
            way(Action::Right, Direction::Right),
            (Action::Retry, vec![pad(PadButton::North), stick(3)]),
            (Action::Rewind, vec![pad(PadButton::East), stick(1)]),
            (Action::Pause, vec![pad(PadButton::Start), stick(2)]),
            (Action::Elements, vec![pad(PadButton::West), stick(4)]),
            (Action::Slow, vec![pad(PadButton::RightShoulder), stick(5)]),
            (Action::Tool, vec![pad(PadButton::South), stick(0)]),
            (Action::TurnLeft, vec![stick(6)]),
            (Action::TurnRight, vec![stick(7)]),
            (Action::Raise, vec![stick(9)]),
            (Action::Lower, vec![stick(10)]),
            (Action::Join, vec![pad(PadButton::Back), stick(11)]),
            // Few sticks have more than twelve buttons. Actions that a round does not require are therefore
            // bound to the last of these buttons.
            (Action::Step, vec![pad(PadButton::LeftShoulder), stick(12)]),
            (Action::Make, vec![pad(PadButton::Misc), stick(13)]),
            (Action::Deeper, vec![pad(PadButton::RightStick)]),
            (Action::Shallower, vec![pad(PadButton::LeftStick)]),
            // Cutting forces is not bound on pads: a child could press the button by accident, and pads only
            // rumble.
            (Action::CutForces, vec![stick(8)]),
        ];
        Self {
            keys: keys.into(),
            buttons: buttons.into(),
        }
    }
}

impl Bindings {
    /// Returns the action of a key.
    pub fn of_key(&self, key: Key) -> Option<Action> {
        find(&self.keys, &key)
    }

    /// Returns the action of a button.
    pub fn of_button(&self, control: Control) -> Option<Action> {
        find(&self.buttons, &PadKey::of(control))
    }

    /// Display names of the keys and of the buttons of an action. `labels` is the kind of labels printed on
    /// the pad.
    pub fn names(&self, action: Action, labels: Labels) -> [String; 2] {
        let keys = self.keys.get(&action).into_iter().flatten();
        let buttons = self.buttons.get(&action).into_iter().flatten();
        [
            keys.map(|&key| name_of(key))
                .collect::<Vec<_>>()
                .join(" / "),
            buttons
                .map(|button| button.in_words(labels))
                .collect::<Vec<_>>()
                .join(" / "),
        ]
    }

    /// Display names of the first key of each action. If `on_stick`, of the first button of a stick without a
    /// pad layout.
    pub fn first_names(&self, actions: &[Action], on_stick: bool) -> String {
        let first = |action| match on_stick {
            true => {
                let mut buttons = self.buttons.get(action).into_iter().flatten();
                buttons
                    .find(|button| button.is_of_stick())
                    .map(|button| button.0.as_str())
            }
            false => self.keys.get(action)?.first().map(|&key| name_of(key)),
        };
        actions
            .iter()
            .filter_map(first)
            .collect::<Vec<_>>()
            .join(" ")
    }

    /// Whether an action has a key in a part of the keyboard.
    pub fn has_key_in(&self, action: Action, part: KeyboardPart) -> bool {
        let mut keys = self.keys.get(&action).into_iter().flatten();
        keys.any(|&key| part.has(key))
    }

    /// Display names of the first key of each action in a part of the keyboard.
    pub fn names_in(&self, actions: &[Action], part: KeyboardPart) -> String {
        let first = |action| {
            let mut keys = self.keys.get(action).into_iter().flatten();
            keys.find(|&&key| part.has(key)).map(|&key| name_of(key))
        };
        let names = actions.iter().filter_map(first);
        names.collect::<Vec<_>>().join(" ")
    }

    /// Binds a key to an action and removes its old binding. An action that loses its only key gets the old
    /// key of `action` in exchange, so that every action stays reachable.
    pub fn bind_key(&mut self, action: Action, key: Key) {
        bind(&mut self.keys, action, key, |_| true);
    }

    /// Binds a button to an action like [`Self::bind_key`]. A pad button is exchanged only for a pad button,
    /// and a button of a stick without a pad layout only for another button of such a stick.
    pub fn bind_button(&mut self, action: Action, control: Control) {
        let button = PadKey::of(control);
        let kind = button.is_of_stick();
        bind(&mut self.buttons, action, button, |other| {
            other.is_of_stick() == kind
        });
    }

    /// Returns the bindings with default keys and buttons for actions that have none.
    pub fn complete(mut self) -> Self {
        let usual = Self::default();
        // Cutting forces always needs a key, even if its default key was bound to another action.
        complete(&mut self.keys, &usual.keys, Action::CutForces);
        if self.keys[&Action::CutForces].is_empty() {
            self.bind_key(Action::CutForces, usual.keys[&Action::CutForces][0]);
        }
        for action in Action::ALL {
            complete(&mut self.keys, &usual.keys, action);
            complete(&mut self.buttons, &usual.buttons, action);
        }
        self
    }
}

/// Display name of a key. Arrows are replaced because the fonts of the game lack egui's symbols for them.
fn name_of(key: Key) -> &'static str {
    match key {
        Key::ArrowUp => "↑",
        Key::ArrowDown => "↓",
        Key::ArrowLeft => "←",
        Key::ArrowRight => "→",
        key => key.symbol_or_name(),
    }
}

fn complete<K: Clone + PartialEq>(
    map: &mut BTreeMap<Action, Vec<K>>,
    usual: &BTreeMap<Action, Vec<K>>,
    action: Action,
) {
    if map.get(&action).is_none_or(Vec::is_empty) {
        let is_free = |key: &&K| find(map, key).is_none();
        let keys = usual[&action].iter().filter(is_free).cloned().collect();
        map.insert(action, keys);
    }
}

fn find<K: PartialEq>(map: &BTreeMap<Action, Vec<K>>, key: &K) -> Option<Action> {
    let found = map.iter().find(|(_, keys)| keys.contains(key));
    found.map(|(&action, _)| action)
}

/// Binds `key` to an action. The key replaces all keys of the action for which `is_alike` is true. Another
/// action that loses its last such key gets the first of the replaced keys.
fn bind<K: PartialEq + Clone>(
    map: &mut BTreeMap<Action, Vec<K>>,
    action: Action,
    key: K,
    is_alike: impl Fn(&K) -> bool,
) {
    let keys = map.entry(action).or_default();
    let before = keys.iter().find(|&k| is_alike(k) && *k != key).cloned();
    keys.retain(|k| !is_alike(k));
    keys.insert(0, key.clone());
    for (_, keys) in map.iter_mut().filter(|(other, _)| **other != action) {
        if keys.contains(&key) {
            keys.retain(|k| *k != key);
            if !keys.iter().any(&is_alike) {
                keys.extend(before.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rebinding_keeps_bindings_unique_and_every_action_reachable() {
        let mut bindings = Bindings::default();
        bindings.bind_key(Action::Retry, Key::F);
        assert_eq!(bindings.of_key(Key::F), Some(Action::Retry));
        // F was the only key of slow motion. Slow motion therefore gets R, the old key of the restart action.
        assert_eq!(bindings.of_key(Key::R), Some(Action::Slow));
        bindings.bind_button(Action::Pause, Control::Pad(PadButton::North));
        assert_eq!(
            bindings.of_button(Control::Pad(PadButton::North)),
            Some(Action::Pause)
        );
        // Pausing and restarting exchange only their pad buttons; the bindings of plain sticks stay.
        let start = Control::Pad(PadButton::Start);
        assert_eq!(bindings.of_button(start), Some(Action::Retry));
        assert_eq!(bindings.of_button(Control::Button(3)), Some(Action::Retry));
        assert_eq!(bindings.of_button(Control::Button(2)), Some(Action::Pause));
    }

    #[test]
    fn button_names_are_readable() {
        let bindings = Bindings::default();
        let name = |action, labels| bindings.names(action, labels)[1].clone();
        let nobody_knows = Labels::Unknown;
        assert_eq!(name(Action::Slow, nobody_knows), "right shoulder / 6");
        assert_eq!(name(Action::Shallower, nobody_knows), "left stick");
        assert_eq!(name(Action::Left, nobody_knows), "left / hat left");
        for (labels, retry, slow) in [
            (Labels::Letters, "Y / 4", "RB / 6"),
            (Labels::Mirrored, "X / 4", "R / 6"),
            (Labels::Shapes, "△ / 4", "R1 / 6"),
        ] {
            assert_eq!(name(Action::Retry, labels), retry);
            assert_eq!(name(Action::Slow, labels), slow);
            assert_eq!(name(Action::Left, labels), "left / hat left");
        }
    }

    #[test]
    fn stick_with_twelve_buttons_covers_all_actions_of_round() {
        let bindings = Bindings::default();
        let is_there = |action: &Action| {
            let buttons = bindings.buttons[action].iter();
            let hat = buttons.clone().any(|button| button.0.starts_with("hat "));
            let mut numbers = buttons.filter_map(|button| button.0.parse::<u8>().ok());
            hat || numbers.any(|number| number <= 12)
        };
        let missing: Vec<Action> = Action::ALL.into_iter().filter(|k| !is_there(k)).collect();
        let rest = [
            Action::Step,
            Action::Make,
            Action::Deeper,
            Action::Shallower,
        ];
        assert_eq!(
            missing, rest,
            "only display actions, and one that the pause menu offers, may be missing"
        );
    }

    #[test]
    fn missing_bindings_are_default_unless_taken() {
        let text = "[keys]\nretry = [\"P\"]\n[buttons]\nnonsense = []\n";
        assert!(toml::from_str::<Bindings>(text).is_err(), "no such action");
        let text = "[keys]\nretry = [\"P\"]\nfuture = 1\n";
        assert!(toml::from_str::<Bindings>(text).is_err(), "no such action");
        let text = "later = 1\n[keys]\nretry = [\"P\"]\n";
        let bindings = toml::from_str::<Bindings>(text).unwrap().complete();
        assert_eq!(bindings.of_key(Key::P), Some(Action::Retry));
        assert_eq!(bindings.keys[&Action::Pause], [Key::Escape]);
        assert_eq!(bindings.buttons, Bindings::default().buttons);
    }

    #[test]
    fn cutting_forces_always_has_key() {
        let text = "[keys]\nretry = [\"F12\"]\n";
        let bindings = toml::from_str::<Bindings>(text).unwrap().complete();
        assert_eq!(bindings.of_key(Key::F12), Some(Action::CutForces));
        assert!(
            Action::ALL
                .iter()
                .all(|action| !bindings.keys[action].is_empty())
        );
    }

    #[test]
    fn bindings_survive_writing_and_reading() {
        let bindings = Bindings::default();
        let text = toml::to_string(&bindings).unwrap();
        assert!(text.contains("retry = [\"north\", \"4\"]"), "{text}");
        assert_eq!(toml::from_str::<Bindings>(&text).unwrap(), bindings);
    }
}
