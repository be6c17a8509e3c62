//! Time that runs back: by key, by a button on the screen, by touch and with one switch.

use crate::window::*;
use egui::{Key, PointerButton, TouchPhase, vec2};
use egui_kittest::kittest::Queryable;
use force_feedback::Stop;
use fuwafuwa::{DEFAULT_TICK, Vec3};
use std::collections::BTreeMap;
use tamaire::game::Screen;
use tamaire::input::Action;
use tamaire::platform::Files;

/// Runs frames and notes the hash of the world at each tick.
fn run(window: &mut Window, count: usize, hashes: &mut BTreeMap<u64, u64>) {
    for _ in 0..count {
        frames(window, 1);
        let round = window.state().game.bout.round();
        hashes.insert(round.ticks(), round.hash());
    }
}

/// Presses the hand into the body of a level for a while.
fn pushed(id: &str) -> (Window, BTreeMap<u64, u64>) {
    let mut window = window(Files::nowhere());
    start(&mut window, id);
    let mut hashes = BTreeMap::new();
    window.key_down(Key::D);
    run(&mut window, 150, &mut hashes);
    window.key_up(Key::D);
    run(&mut window, 2, &mut hashes);
    (window, hashes)
}

/// Checks that time runs on after it ran back, and that the round says so.
fn check_runs_on(window: &mut Window, before: u64) {
    let tick = window.state().game.bout.round().ticks();
    assert!(tick < before - 20, "{before} to {tick}");
    frames(window, 10);
    let round = window.state().game.bout.round();
    assert!(round.ticks() > tick && round.rewinds() == 1);
    assert_eq!(screen(window), Screen::Play);
}

#[test]
fn held_key_lets_time_run_back_to_the_same_bits_without_forces() {
    for id in ["classic", "under-the-table"] {
        let (mut window, hashes) = pushed(id);
        let before = window.state().game.bout.round().ticks();
        window.key_down(Key::B);
        frames(&mut window, 60);
        assert!(window.state().game.bout.session.is_rewinding(), "{id}");
        assert_eq!(window.state().game.silence(), Some(Stop::Reset), "{id}");
        window.key_up(Key::B);
        // The first frame still sees the key.
        frames(&mut window, 1);
        let round = window.state().game.bout.round();
        let hash = (round.ticks(), round.hash());
        assert_eq!(hashes.get(&hash.0), Some(&hash.1), "{id}");
        frames(&mut window, 1);
        assert!(!window.state().game.bout.session.is_rewinding(), "{id}");
        check_runs_on(&mut window, before);
    }
}

#[test]
fn button_on_the_screen_is_held_by_mouse_or_finger() {
    for is_finger in [false, true] {
        let (mut window, hashes) = pushed("classic");
        if is_finger {
            touch(&mut window, 0, TouchPhase::Start, egui::pos2(500.0, 80.0));
            touch(&mut window, 0, TouchPhase::End, egui::pos2(500.0, 80.0));
        }
        frames(&mut window, 2);
        let before = window.state().game.bout.round().ticks();
        let buttons = &window.state().game.controls.buttons;
        let mut buttons = buttons
            .iter()
            .filter(|button| button.action == Action::Rewind);
        let at = buttons.next().expect("there is a button").rect.center();
        match is_finger {
            true => touch(&mut window, 0, TouchPhase::Start, at),
            false => window.event(pointer_button(at, PointerButton::Primary, true)),
        }
        frames(&mut window, 60);
        let round = window.state().game.bout.round();
        assert!(round.ticks() < before - 20, "finger: {is_finger}");
        assert_eq!(hashes.get(&round.ticks()), Some(&round.hash()));
        match is_finger {
            true => touch(&mut window, 0, TouchPhase::End, at),
            false => window.event(pointer_button(at, PointerButton::Primary, false)),
        }
        frames(&mut window, 3);
        check_runs_on(&mut window, before);
    }
}

#[test]
fn a_win_after_a_rewind_is_kept_apart() {
    let (mut window, _) = pushed("classic");
    window.key_down(Key::B);
    // As far back as it goes: the hand is at its start again.
    frames(&mut window, (4.0 / DEFAULT_TICK) as usize);
    window.key_up(Key::B);
    frames(&mut window, 2);
    win(&mut window);
    let record = window.state().game.records.of("classic").unwrap();
    assert!(record.best.is_empty() && !record.best_rewound.is_empty());
    window.get_by_label_contains("with rewind");
}

#[test]
fn hand_follows_the_mouse_in_a_round_that_cannot_be_won() {
    let mut window = open(Files::nowhere(), vec2(1280.0, 800.0), 1.0);
    start(&mut window, "spoon-race");
    frames(&mut window, 2);
    let view = game(&mut window).bout.view.unwrap();
    let at = |x: f32, y: f32| view.to_screen(Vec3::new(x, y, 0.0));
    // Picks the spoon up and swings it, so that the egg breaks.
    let hand = game(&mut window).bout.round().hands()[0].position;
    window.hover_at(at(hand.x + 0.05, hand.y));
    frames(&mut window, 3);
    window.hover_at(at(hand.x, hand.y));
    frames(&mut window, 20);
    for swing in 0..12 {
        let x = if swing % 2 == 0 { 0.4 } else { -1.2 };
        window.hover_at(at(x, 0.3 + 0.02 * swing as f32));
        frames(&mut window, 16);
    }
    assert!(game(&mut window).bout.round().progress().pieces > 3);
    frames(&mut window, 40);
    // One button is at the top, one beside the message that the round cannot be won.
    assert_eq!(window.get_all_by_label("Restart").count(), 2);
    for x in [-0.8, 0.3, -0.5] {
        window.hover_at(at(x, 0.4));
        frames(&mut window, 3);
        // The spoon itself may be caught by the rubble.
        let wanted = game(&mut window).controls.players.wanted(0);
        let wanted = wanted.expect("the mouse has picked up the hand");
        assert!((wanted.x - x).abs() < 0.05, "{x}: {wanted}");
    }
}
