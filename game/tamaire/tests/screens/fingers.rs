//! Tests of touch buttons, for actions that have buttons on keyboards and pads.

use crate::window::*;
use egui::TouchPhase::{End, Move, Start};
use egui::{Pos2, Rect, vec2};
use fuwafuwa::Vec3;
use tamaire::input::{Action, InputMethod, InputSource};
use tamaire::platform::Files;

fn goal(window: &Window, player: usize) -> Vec3 {
    let game = &window.state().game;
    let wanted = game.controls.players.wanted(player);
    wanted.unwrap_or_else(|| game.bout.round().hands()[player].target)
}

/// Position of the touch button for an action.
fn place(window: &Window, action: Action) -> Option<Rect> {
    let buttons = &window.state().game.controls.buttons;
    let button = buttons.iter().find(|button| button.action == action);
    button.map(|button| button.rect)
}

/// Starts a round in which a finger takes the hand to a world position [m].
fn held(level: &str, at: Vec3) -> Window {
    let mut window = window(Files::nowhere());
    start(&mut window, level);
    let hand = on_screen(&window, goal(&window, 0));
    touch(&mut window, 0, Start, hand);
    touch(&mut window, 0, Move, hand + vec2(1.0, 0.0));
    let there = on_screen(&window, at);
    touch(&mut window, 0, Move, there);
    frames(&mut window, 2);
    assert_eq!(window.state().game.controls.means, InputMethod::Fingers);
    window
}

fn on_screen(window: &Window, at: Vec3) -> Pos2 {
    let view = window.state().game.bout.view;
    view.expect("the world is visible").to_screen(at)
}

fn tap(window: &mut Window, action: Action) {
    let at = place(window, action).expect("the button is shown").center();
    touch(window, 1, Start, at);
    touch(window, 1, End, at);
    frames(window, 1);
}

#[test]
fn second_finger_presses_touch_buttons() {
    let mut window = held("twins", Vec3::new(-0.9, 0.3, 0.0));
    let game = |window: &Window| {
        let bout = &window.state().game.bout;
        (bout.slow, bout.elements.is_some())
    };
    tap(&mut window, Action::Slow);
    assert_eq!(game(&window), (true, false));
    tap(&mut window, Action::Slow);
    tap(&mut window, Action::Elements);
    assert_eq!(game(&window), (false, true));
    tap(&mut window, Action::Pause);
    assert_eq!(screen(&window), tamaire::game::Screen::Paused);
    frames(&mut window, 2);
    assert_eq!(
        place(&window, Action::Pause),
        None,
        "no touch buttons in menus"
    );
}

#[test]
fn two_fingers_move_two_hands() {
    let mut window = held("twins", Vec3::new(-0.9, 0.3, 0.0));
    tap(&mut window, Action::Join);
    let second = window.state().game.controls.players.second();
    assert_eq!(second, Some(InputSource::Finger));
    let first = goal(&window, 0);
    let start = goal(&window, 1);
    let end = Vec3::new(0.5, -0.6, 0.0);
    for step in 0..=60 {
        let at = on_screen(&window, start.lerp(end, step as f32 / 60.0));
        touch(&mut window, 1, if step == 0 { Start } else { Move }, at);
    }
    let Vec3 { x, y, .. } = goal(&window, 1);
    assert!((x - 0.5).abs() < 0.05 && (y + 0.6).abs() < 0.05, "{x} {y}");
    let still = goal(&window, 0);
    assert!((still.x - first.x).abs() < 0.05, "{first:?} {still:?}");
}

#[test]
fn thumb_buttons_3d_raise_hand_and_look_deeper() {
    let mut window = held("classic-3d", Vec3::new(-0.9, 0.0, 0.6));
    let before = goal(&window, 0).y;
    let up = place(&window, Action::Raise)
        .expect("the button is shown")
        .center();
    touch(&mut window, 1, Start, up);
    frames(&mut window, 20);
    let high = goal(&window, 0).y;
    assert!(high > before + 0.2, "{before} {high}");
    touch(&mut window, 1, End, up);
    frames(&mut window, 20);
    assert!((goal(&window, 0).y - high).abs() < 0.05);
    tap(&mut window, Action::Elements);
    assert!(place(&window, Action::Raise).is_none());
    let share = |window: &Window| {
        let game = &window.state().game;
        game.bout.opening.share(game.time, false)
    };
    // The cutaway through bodies moves by itself until the player cuts deeper.
    frames(&mut window, 120);
    let whole = share(&window);
    let deeper = place(&window, Action::Deeper).expect("the button is shown");
    touch(&mut window, 1, Start, deeper.center());
    frames(&mut window, 20);
    assert!(share(&window) < whole - 0.1, "{whole}");
}

#[test]
fn mouse_shows_only_three_buttons() {
    let mut window = window(Files::nowhere());
    start(&mut window, "classic-3d");
    window.hover_at(egui::pos2(500.0, 300.0));
    frames(&mut window, 2);
    let buttons = &window.state().game.controls.buttons;
    let actions = buttons.iter().map(|button| button.action);
    let expected = [Action::Pause, Action::Retry, Action::Rewind];
    assert_eq!(actions.collect::<Vec<_>>(), expected);
}

#[test]
fn finger_on_body_at_start_breaks_nothing() {
    let mut window = window(Files::nowhere());
    start(&mut window, "biscuit");
    let middle = window.state().game.bout.effects.feelings[0].middle;
    let at = on_screen(&window, middle);
    touch(&mut window, 0, Start, at);
    for _ in 0..90 {
        touch(&mut window, 0, Move, at);
        let round = window.state().game.bout.round();
        assert!(round.split_points().is_empty(), "the body has a crack");
    }
    let round = window.state().game.bout.round();
    let hand = &round.hands()[0];
    assert!(round.distance_to_bodies(hand.position) > hand.radius);
}
