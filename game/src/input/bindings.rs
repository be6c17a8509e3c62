//! Which key and which button mean what.

use super::Action;
use egui::Key;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use sticks::{Control, Direction, PadButton};

/// Keys and buttons by action. No key and no button means two actions at once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Bindings {
    /// Keys.
    pub keys: BTreeMap<Action, Vec<Key>>,
    /// Buttons of pads and sticks.
    pub buttons: BTreeMap<Action, Vec<PadKey>>,
}

/// A button as it is written down: `south` of a pad, `3` of a plain stick, `hat up`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct PadKey(pub String);

impl PadKey {
    /// The button that was pressed.
    pub fn of(control: Control) -> Self {
        Self(match control {
            Control::Button(index) => (index + 1).to_string(),
            Control::Hat(_, direction) => format!("hat {direction:?}").to_lowercase(),
            Control::Pad(button) => format!("{button:?}").to_lowercase(),
        })
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
            (Action::Pause, vec![Key::Escape, Key::P]),
            (Action::Elements, vec![Key::E, Key::Tab]),
            (Action::Slow, vec![Key::F]),
            (Action::Step, vec![Key::Period]),
            (Action::Join, vec![Key::J]),
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
            (Action::Pause, vec![pad(PadButton::Start), stick(2)]),
            (Action::Elements, vec![pad(PadButton::West), stick(4)]),
            (Action::Slow, vec![pad(PadButton::RightShoulder), stick(5)]),
            (Action::Step, vec![pad(PadButton::LeftShoulder), stick(6)]),
            (Action::Join, vec![pad(PadButton::Back), stick(7)]),
        ];
        Self {
            keys: keys.into(),
            buttons: buttons.into(),
        }
    }
}

impl Bindings {
    /// What a key means.
    pub fn of_key(&self, key: Key) -> Option<Action> {
        find(&self.keys, &key)
    }

    /// What a button means.
    pub fn of_button(&self, control: Control) -> Option<Action> {
        find(&self.buttons, &PadKey::of(control))
    }

    /// Makes a key mean an action, and nothing else. An action that loses its only key takes the old
    /// one of this action in exchange, so that nothing gets out of reach.
    pub fn bind_key(&mut self, action: Action, key: Key) {
        bind(&mut self.keys, action, key);
    }

    /// The same for a button.
    pub fn bind_button(&mut self, action: Action, control: Control) {
        bind(&mut self.buttons, action, PadKey::of(control));
    }
}

fn find<K: PartialEq>(map: &BTreeMap<Action, Vec<K>>, key: &K) -> Option<Action> {
    let found = map.iter().find(|(_, keys)| keys.contains(key));
    found.map(|(&action, _)| action)
}

fn bind<K: PartialEq + Clone>(map: &mut BTreeMap<Action, Vec<K>>, action: Action, key: K) {
    let before = map.insert(action, vec![key.clone()]).unwrap_or_default();
    for (_, keys) in map.iter_mut().filter(|(other, _)| **other != action) {
        if keys.contains(&key) {
            keys.retain(|k| *k != key);
            if keys.is_empty() {
                keys.extend(before.iter().find(|k| **k != key).cloned());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_means_one_thing_and_no_action_loses_its_last_key() {
        let mut bindings = Bindings::default();
        bindings.bind_key(Action::Retry, Key::F);
        assert_eq!(bindings.of_key(Key::F), Some(Action::Retry));
        // Slow motion had F alone: it takes over what was given up.
        assert_eq!(bindings.of_key(Key::R), Some(Action::Slow));
        bindings.bind_button(Action::Pause, Control::Pad(PadButton::North));
        assert_eq!(
            bindings.of_button(Control::Pad(PadButton::North)),
            Some(Action::Pause)
        );
        assert_eq!(bindings.of_button(Control::Button(3)), Some(Action::Retry));
    }

    #[test]
    fn bindings_are_written_in_words_and_read_again() {
        let bindings = Bindings::default();
        let text = toml::to_string(&bindings).unwrap();
        assert!(text.contains("retry = [\"north\", \"4\"]"), "{text}");
        assert_eq!(toml::from_str::<Bindings>(&text).unwrap(), bindings);
    }
}
