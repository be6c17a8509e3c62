//! Sticky keys: a key stays down until it is pressed again, for players who cannot hold keys.

use super::{Action, Bindings};
use egui::Key;
use std::collections::BTreeSet;

/// Keys that stay down.
#[derive(Clone, Debug, Default)]
pub struct StickyKeys(BTreeSet<Key>);

impl StickyKeys {
    /// Presses a key: it stays down, or is released if it was down. Keys of the opposite action are released.
    pub fn press(&mut self, key: Key, bindings: &Bindings) {
        let Some(opposite) = bindings.of_key(key).and_then(opposite) else {
            // Only keys of continuous actions, such as moving, stay down.
            return;
        };
        self.0
            .retain(|&other| bindings.of_key(other) != Some(opposite));
        if !self.0.remove(&key) {
            self.0.insert(key);
        }
    }

    /// Releases all keys.
    pub fn release(&mut self) {
        self.0.clear();
    }

    /// Returns the keys that are down.
    pub fn keys(&self) -> BTreeSet<Key> {
        self.0.clone()
    }
}

/// Returns the opposite of a continuous action. `None` for other actions.
fn opposite(action: Action) -> Option<Action> {
    let pairs = [
        (Action::Up, Action::Down),
        (Action::Left, Action::Right),
        (Action::Raise, Action::Lower),
        (Action::TurnLeft, Action::TurnRight),
        (Action::Deeper, Action::Shallower),
    ];
    pairs.into_iter().find_map(|(one, other)| match action {
        _ if action == one => Some(other),
        _ if action == other => Some(one),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn key_stays_down_until_it_or_its_opposite_is_pressed() {
        let (mut latch, bindings) = (StickyKeys::default(), Bindings::default());
        let mut press = |key| {
            latch.press(key, &bindings);
            latch.keys().into_iter().collect::<Vec<_>>()
        };
        assert_eq!(press(Key::ArrowRight), [Key::ArrowRight]);
        assert_eq!(press(Key::ArrowUp).len(), 2);
        assert_eq!(press(Key::R).len(), 2, "the action is not continuous");
        assert_eq!(press(Key::A), [Key::ArrowUp, Key::A]);
        assert_eq!(press(Key::ArrowUp), [Key::A]);
        assert_eq!(press(Key::A), []);
    }
}
