//! Input events inserted into egui: keys that sticks and pads press, and dwell clicks. Also filters key
//! repeats.

use egui::{Event, Key, Modifiers, PointerButton, Pos2, RawInput};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Keys without auto-repeat. A repeated press would close the screen that the initial press has just opened.
const ONCE: [Key; 3] = [Key::Escape, Key::Enter, Key::Space];

/// egui plugin that inserts and filters input events.
#[derive(Clone, Default)]
pub(super) struct Presses(Arc<Mutex<Waiting>>);

/// Input that has not yet been passed to egui.
#[derive(Default)]
pub(super) struct Waiting {
    /// Keys pressed by sticks and pads in menus.
    pub(super) keys: Vec<Key>,
    /// Position of a dwell click.
    pub(super) click: Option<Pos2>,
    /// Whether sticks or pads have pressed keys in this frame.
    pub(super) is_by_stick: bool,
    /// Whether the up and down keys move the focus in the order of the widgets instead of to the widget above
    /// or below.
    pub(super) in_order: bool,
    /// Keys of [`ONCE`] that are held down.
    held: Vec<Key>,
}

impl Presses {
    pub(super) fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl egui::Plugin for Presses {
    fn debug_name(&self) -> &'static str {
        "sticks and pads"
    }

    fn input_hook(&mut self, _: &egui::Context, input: &mut RawInput) {
        let mut waiting = self.waiting();
        let held = &mut waiting.held;
        input.events.retain(|event| match *event {
            Event::Key { key, pressed, .. } if ONCE.contains(&key) => {
                let was_held = held.contains(&key);
                held.retain(|other| *other != key);
                if pressed {
                    held.push(key);
                }
                !(pressed && was_held)
            }
            Event::WindowFocused(false) => {
                held.clear();
                true
            }
            _ => true,
        });
        if let Some(pos) = waiting.click.take() {
            input
                .events
                .extend([true, false].map(|pressed| Event::PointerButton {
                    pos,
                    button: PointerButton::Primary,
                    pressed,
                    modifiers: Modifiers::NONE,
                }));
        }
        waiting.is_by_stick = !waiting.keys.is_empty();
        for key in std::mem::take(&mut waiting.keys) {
            input.events.extend(stroke(key, Modifiers::NONE));
        }
        if waiting.in_order {
            input.events = std::mem::take(&mut input.events)
                .into_iter()
                .flat_map(|event| match event {
                    Event::Key {
                        key: Key::ArrowDown,
                        pressed: true,
                        ..
                    } => stroke(Key::Tab, Modifiers::NONE).to_vec(),
                    Event::Key {
                        key: Key::ArrowUp,
                        pressed: true,
                        ..
                    } => stroke(Key::Tab, Modifiers::SHIFT).to_vec(),
                    event => vec![event],
                })
                .collect();
        }
    }
}

/// Press and release of a key.
fn stroke(key: Key, modifiers: Modifiers) -> [Event; 2] {
    [true, false].map(|pressed| Event::Key {
        key,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers,
    })
}
