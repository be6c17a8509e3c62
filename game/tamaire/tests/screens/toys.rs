//! Tests of the playground in the window.

use crate::window::*;
use egui::{pos2, vec2};
use egui_kittest::kittest::Queryable;
use tamaire::game::{Game, Screen};
use tamaire::platform::Files;
use tamaire_play::AnyRound;
use tamaire_play::playground::{Change, Tool};

fn bodies(game: &Game) -> usize {
    match game.bout.round() {
        AnyRound::Plane(round) => round.world().soft_bodies().count(),
        AnyRound::Space(round) => round.world().soft_bodies().count(),
    }
}

#[test]
fn shapes_are_added_and_cleared_by_buttons() {
    for level in ["sandbox", "sandbox-3d"] {
        let mut window = open(Files::nowhere(), vec2(1000.0, 640.0), 1.0);
        start(&mut window, level);
        let before = bodies(game(&mut window));
        for name in ["Clay", "Add a ring", "Stone", "Add a heart"] {
            window.get_by_label(name).click();
            frames(&mut window, 4);
        }
        assert_eq!(bodies(game(&mut window)), before + 2, "{level}");
        window.get_by_label("Clear the room").click();
        frames(&mut window, 4);
        assert_eq!(bodies(game(&mut window)), 0, "{level}");
    }
}

#[test]
fn tools_are_on_a_page_that_keys_reach() {
    let mut window = open(Files::nowhere(), vec2(1000.0, 640.0), 1.0);
    start(&mut window, "sandbox");
    let before = bodies(game(&mut window));
    press(&mut window, egui::Key::Escape);
    for name in [
        "Tools",
        "Material: Stone",
        "Add a heart",
        "Add a ball",
        "Hand: Pin: press",
    ] {
        for _ in 0..40 {
            if window.get_by_label(name).is_focused() {
                break;
            }
            press(&mut window, egui::Key::Tab);
        }
        assert!(window.get_by_label(name).is_focused(), "{name}");
        press(&mut window, egui::Key::Enter);
    }
    assert_eq!(game(&mut window).screen(), Screen::Toolbox);
    press(&mut window, egui::Key::Escape);
    press(&mut window, egui::Key::Escape);
    frames(&mut window, 4);
    assert_eq!(bodies(game(&mut window)), before + 2);
    // The key that chose *Resume* presses no tool.
    assert_eq!(game(&mut window).bout.round().tool(), (Tool::Pin, false));
}

#[test]
fn pause_menu_names_the_level() {
    let mut window = open(Files::nowhere(), vec2(1000.0, 640.0), 1.0);
    start(&mut window, "classic");
    press(&mut window, egui::Key::Escape);
    window.get_by_label("Classic");
}

#[test]
fn pressing_uses_the_tool_but_not_on_a_button() {
    let mut window = open(Files::nowhere(), vec2(1000.0, 640.0), 1.0);
    start(&mut window, "sandbox");
    window.get_by_label("Knife: press and hold").click();
    frames(&mut window, 3);
    assert_eq!(game(&mut window).bout.toys.tool, Tool::Knife);
    let presses = |window: &mut Window| {
        let changes = game(window).bout.round().changes().iter();
        changes
            .filter(|change| matches!(change.change, Change::Press(_)))
            .count()
    };
    assert_eq!(presses(&mut window), 0, "the press on the button");
    window.hover_at(pos2(500.0, 200.0));
    window.drag_at(pos2(500.0, 200.0));
    frames(&mut window, 3);
    assert_eq!(presses(&mut window), 1);
    window.drop_at(pos2(500.0, 200.0));
    frames(&mut window, 3);
    assert_eq!(presses(&mut window), 2);
    // A button of the round is no place for the tool, either.
    let again = window.get_by_label("Rewind").rect().center();
    window.drag_at(again);
    frames(&mut window, 3);
    window.drop_at(again);
    frames(&mut window, 3);
    assert!(presses(&mut window) <= 2);
}

#[test]
fn tools_follow_when_time_runs_back() {
    let mut window = open(Files::nowhere(), vec2(1000.0, 640.0), 1.0);
    start(&mut window, "sandbox");
    frames(&mut window, 40);
    window.get_by_label("Knife: press and hold").click();
    frames(&mut window, 20);
    game(&mut window).change_playground(Change::Gravity(30));
    frames(&mut window, 5);
    assert_eq!(game(&mut window).bout.toys.tool, Tool::Knife);
    let rewind = window.get_by_label("Rewind").rect().center();
    window.drag_at(rewind);
    frames(&mut window, 50);
    window.drop_at(rewind);
    frames(&mut window, 3);
    let toys = game(&mut window).bout.toys;
    assert_eq!(toys.tool, Tool::Push);
    assert!(toys.gravity < 2.0, "{}", toys.gravity);
}

#[test]
fn a_finger_on_a_tool_does_not_move_the_hand() {
    let mut window = open(Files::nowhere(), vec2(390.0, 844.0), 1.0);
    start(&mut window, "sandbox");
    let place = window.get_by_label("Add a ball").rect().center();
    let hand = game(&mut window).bout.round().hands()[0].target;
    touch(&mut window, 0, egui::TouchPhase::Start, place);
    frames(&mut window, 3);
    touch(&mut window, 0, egui::TouchPhase::End, place);
    frames(&mut window, 6);
    let now = game(&mut window).bout.round().hands()[0].target;
    assert!((now - hand).length() < 0.01, "{now}");
}

#[test]
fn sliders_change_the_world() {
    let mut window = open(Files::nowhere(), vec2(1000.0, 640.0), 1.0);
    start(&mut window, "sandbox");
    window.get_by_label("Gravity, air, hand").click();
    frames(&mut window, 3);
    let slider = window.get_by_label("Gravity [m/s²]").rect();
    let at = slider.right_center() - vec2(4.0, 0.0);
    window.drag_at(at);
    frames(&mut window, 2);
    window.drop_at(at);
    frames(&mut window, 3);
    let AnyRound::Plane(round) = game(&mut window).bout.round() else {
        panic!("the level is in 2D");
    };
    assert!(
        round.world().config().gravity.y < -10.0,
        "{}",
        round.world().config().gravity
    );
    // The hand follows the mouse while the sliders are shown.
    let view = game(&mut window).bout.view.unwrap();
    let hand = game(&mut window).bout.round().hands()[0].position;
    for away in [0.02, 0.0, 0.3] {
        window.hover_at(view.to_screen(hand + away * fuwafuwa::Vec3::X));
        frames(&mut window, 30);
    }
    let now = game(&mut window).bout.round().hands()[0].position;
    assert!((now.x - hand.x - 0.3).abs() < 0.05, "{hand} to {now}");
}
