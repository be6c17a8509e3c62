//! Tests of the instructions for 3D levels, each of which is shown until the player has followed it.

use crate::pads::{Table, about, pad};
use crate::space::{in_space, point_at, wait};
use crate::window::*;
use egui::epaint::ClippedShape;
use egui::{Key, vec2};
use sticks::{Device, DeviceId};
use tamaire::input::{Action, InputMethod};
use tamaire::platform::Files;
use tamaire::words::Language;

/// Returns all texts on the screen with their rectangles.
fn words(window: &Window) -> Vec<(String, egui::Rect)> {
    fn add(shape: &egui::Shape, words: &mut Vec<(String, egui::Rect)>) {
        match shape {
            egui::Shape::Text(text) => {
                words.push((text.galley.text().into(), text.visual_bounding_rect()));
            }
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|shape| add(shape, words)),
            _ => {}
        }
    }
    let mut words = Vec::new();
    for ClippedShape { shape, .. } in &window.output().shapes {
        add(shape, &mut words);
    }
    words
}

pub fn tells(window: &Window, what: &str) -> bool {
    words(window).iter().any(|(text, _)| text.contains(what))
}

#[test]
fn instructions_3d_disappear_once_followed() {
    let mut window = in_space();
    // With reduced motion, lines disappear at once instead of fading out.
    game(&mut window).settings.reduced_motion = true;
    wait(&mut window, 60);
    let told = ["Move: mouse", "wheel, or Q Z", "right mouse button, or [ ]"];
    assert!(
        told.iter().all(|line| tells(&window, line)),
        "{:?}",
        words(&window)
    );
    game(&mut window)
        .settings
        .bindings
        .bind_key(Action::Raise, Key::U);
    frames(&mut window, 1);
    assert!(tells(&window, "wheel, or U Z"), "the bound key is named");
    point_at(&mut window, -1.0, 0.7);
    assert!(!tells(&window, "Move") && tells(&window, "wheel"));
    window.key_down(Key::U);
    frames(&mut window, 2);
    assert!(
        tells(&window, "Look around: [ ]"),
        "the controls of the last device are named"
    );
    wait(&mut window, 10);
    window.key_up(Key::U);
    frames(&mut window, 2);
    assert!(!tells(&window, "Up and down") && tells(&window, "Look around"));
    press(&mut window, Key::R);
    wait(&mut window, 60);
    assert!(
        !tells(&window, "Move") && tells(&window, "Look around"),
        "a followed instruction does not return"
    );
    window.key_down(Key::OpenBracket);
    frames(&mut window, 12);
    window.key_up(Key::OpenBracket);
    frames(&mut window, 1);
    assert!(!tells(&window, "Look around"));
    start(&mut window, "classic");
    frames(&mut window, 2);
    assert!(!tells(&window, "Move"), "no instructions in 2D");
}

#[test]
fn instructions_name_current_device_and_time_out() {
    let mut table = Table::with(vec![
        pad(1),
        Device::at_rest(DeviceId(2), about("Stick"), 2, 12, 1),
    ]);
    game(&mut table.window).settings.reduced_motion = true;
    start(&mut table.window, "hoop");
    table.pad(0).left = [0.0, 0.7];
    table.frames(2);
    table.pad(0).left = [0.0; 2];
    table.frames(2);
    assert!(tells(&table.window, "triggers") && tells(&table.window, "right stick"));
    table.devices[1].axes = vec![1.0, 0.0];
    table.frames(2);
    table.devices[1].axes = vec![0.0; 2];
    table.frames(2);
    assert!(tells(&table.window, "buttons 10 11") && tells(&table.window, "buttons 7 8"));
    // Before the first push, nobody is stuck.
    game(&mut table.window).retry();
    for _ in 0..25 {
        game(&mut table.window).update(2.0);
    }
    table.frames(2);
    assert!(!tells(&table.window, "buttons"));
}

#[test]
fn instructions_return_when_player_is_stuck() {
    let mut window = in_space();
    game(&mut window).settings.reduced_motion = true;
    let push = |window: &mut Window, key| {
        window.key_down(key);
        frames(window, 2);
        wait(window, 15);
        window.key_up(key);
        frames(window, 2);
    };
    push(&mut window, Key::ArrowDown);
    push(&mut window, Key::Q);
    let lines = |window: &Window| ["Move", "Up and down"].map(|line| tells(window, line));
    assert_eq!(lines(&window), [false, false]);
    for _ in 0..11 {
        game(&mut window).update(2.0);
    }
    frames(&mut window, 1);
    assert_eq!(lines(&window), [true, true], "no progress for 20 s");
    push(&mut window, Key::Q);
    assert_eq!(lines(&window), [true, false]);
    // A win does not teach what was not done.
    let level = game(&mut window).bout.round().level().clone();
    let won = tamaire_play::Outcome {
        ticks: 600,
        route: tamaire_play::Route::Squeeze,
        kept: 1.0,
        inside: 1.0,
        pieces: 1,
        lost: 0,
        broken: 0,
        torn: 0,
    };
    game(&mut window).records.note(&level, &won, 0);
    start(&mut window, "hoop");
    assert_eq!(lines(&window), [true, false]);
    // Two rounds that are given up are the same failure.
    push(&mut window, Key::ArrowDown);
    assert_eq!(lines(&window), [false, false]);
    for _ in 0..2 {
        press(&mut window, Key::R);
        push(&mut window, Key::ArrowDown);
    }
    press(&mut window, Key::R);
    assert!(lines(&window)[1], "the hoop needs the hand to be raised");
}

#[test]
fn instructions_fit_into_smallest_window() {
    for text_size in [1.0, 1.6] {
        let mut window = open(Files::nowhere(), vec2(640.0, 400.0), 0.5);
        game(&mut window).settings.text_size = text_size;
        start(&mut window, "classic-3d");
        let bindings = &mut game(&mut window).settings.bindings;
        // Keys with the longest names are bound, so that the texts are as long as possible.
        for (action, key) in [
            (Action::Raise, Key::BrowserBack),
            (Action::Lower, Key::Questionmark),
        ] {
            bindings.bind_key(action, key);
        }
        for means in [
            InputMethod::Mouse,
            InputMethod::Fingers,
            InputMethod::Keys,
            InputMethod::Pad,
            InputMethod::Stick,
        ] {
            for (language, _) in Language::ALL {
                game(&mut window).controls.means = means;
                game(&mut window).settings.language = language;
                frames(&mut window, 1);
                let lines = window.state().game.lesson();
                let room = window.ctx.content_rect();
                let words = words(&window);
                for (line, is_missing) in &lines {
                    let found = words.iter().find(|(text, _)| text == line);
                    let (_, rect) = found.unwrap_or_else(|| panic!("{line} in {words:?}"));
                    assert!(
                        *is_missing && room.contains_rect(*rect),
                        "{line}: {rect:?} in {room:?}"
                    );
                }
                assert_eq!(lines.len(), 3);
            }
        }
    }
}
