//! 3D levels: movement of the hand with each device, the camera, and a round that is won, watched and raced.

use crate::pads::{Table, pad};
use crate::told::tells;
use crate::window::*;
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, TouchPhase, pos2, vec2};
use fuwafuwa::{DEFAULT_TICK, Vec2, Vec3};
use sticks::{DeviceId, PadButton};
use tamaire::game::{Game, Screen};
use tamaire::input::{InputMethod, InputSource};
use tamaire::platform::Files;
use tamaire_play::{AnyRound, Route};

pub fn in_space() -> Window {
    let mut window = window(Files::nowhere());
    start(&mut window, "classic-3d");
    window
}

/// Target position of a player's hand [m].
pub fn goal(window: &Window, player: usize) -> Vec3 {
    hand_targets(window)[player]
}

fn turned(window: &Window) -> [f32; 2] {
    window.state().game.bout.camera.orbit_angles()
}

/// Advances the game by ticks and draws one frame: in software, a 3D frame takes longer than a tick.
pub fn wait(window: &mut Window, ticks: usize) {
    (0..ticks).for_each(|_| game(window).update(DEFAULT_TICK));
    frames(window, 1);
}

/// Points with the mouse at a point of the floor, and waits until the hand is above it.
pub fn point_at(window: &mut Window, x: f32, z: f32) {
    let view = window.state().game.bout.view.expect("the world is visible");
    window.hover_at(view.to_screen(Vec3::new(x, 0.0, z)));
    frames(window, 1);
    wait(window, 60);
}

/// Turns the wheel by `points`, and waits.
fn wheel(window: &mut Window, points: f32) {
    window.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, points),
        phase: TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers: Modifiers::NONE,
    });
    frames(window, 12);
    wait(window, 30);
}

pub fn assert_near(found: Vec3, expected: impl Into<Vec3>) {
    let expected = expected.into();
    let away = (found - expected).length();
    assert!(away < 0.03, "{found:?}, expected {expected:?}");
}

#[test]
fn mouse_sets_floor_position_and_wheel_raises_hand() {
    let mut window = in_space();
    let height = goal(&window, 0).y;
    for [x, z] in [[-1.2, 0.7], [0.2, 0.6], [0.0, -0.6]] {
        point_at(&mut window, x, z);
        assert_near(goal(&window, 0), [x, height, z]);
    }
    point_at(&mut window, -1.2, 0.7);
    wheel(&mut window, 250.0);
    assert_near(goal(&window, 0), [-1.2, height + 0.5, 0.7]);
    // The target keeps its height while the hand lags behind over a long distance, and while the camera
    // turns.
    point_at(&mut window, 1.2, 0.75);
    assert_near(goal(&window, 0), [1.2, height + 0.5, 0.75]);
    game(&mut window).bout.camera.orbit(1.2, 0.3);
    frames(&mut window, 1);
    assert_near(goal(&window, 0), [1.2, height + 0.5, 0.75]);
    point_at(&mut window, 0.8, 0.75);
    assert_near(goal(&window, 0), [0.8, height + 0.5, 0.75]);
    wheel(&mut window, -250.0);
    assert_near(goal(&window, 0), [0.8, height, 0.75]);
    assert_eq!(window.state().game.controls.means, InputMethod::Mouse);
}

#[test]
fn mouse_sets_position_on_shelf() {
    let mut window = window(Files::nowhere());
    start(&mut window, "hoop");
    let height = goal(&window, 0).y;
    // Points on the shelf, over the hole in the shelf, and on the shelf behind the hole.
    for [x, z] in [[-1.3, 0.3], [0.7, 0.1], [0.7, -0.7]] {
        let view = window.state().game.bout.view.expect("the world is visible");
        window.hover_at(view.to_screen(Vec3::new(x, 0.55, z)));
        frames(&mut window, 1);
        wait(&mut window, 90);
        assert_near(goal(&window, 0), [x, height, z]);
    }
}

#[test]
fn right_mouse_button_turns_only_the_camera() {
    let mut window = in_space();
    point_at(&mut window, -1.2, 0.6);
    let before = goal(&window, 0);
    let button = |pressed, pos| pointer_button(pos, PointerButton::Secondary, pressed);
    let view = window.state().game.bout.view.expect("the world is visible");
    let at = view.to_screen(Vec3::new(-1.2, 0.0, 0.6));
    window.event(button(true, at));
    frames(&mut window, 1);
    for step in 1..=10 {
        window.hover_at(at + step as f32 * vec2(-10.0, 5.0));
        frames(&mut window, 1);
    }
    window.event(button(false, at + vec2(-100.0, 50.0)));
    frames(&mut window, 1);
    let [right, up] = turned(&window);
    assert!(right > 0.5 && up > 0.2, "{right} {up}");
    assert_near(goal(&window, 0), before);
    // A retry keeps the camera's orientation; a double click resets it.
    game(&mut window).retry();
    frames(&mut window, 1);
    assert_eq!(turned(&window), [right, up]);
    for pressed in [true, false, true, false] {
        window.event(button(pressed, at));
        frames(&mut window, 1);
    }
    frames(&mut window, 60);
    assert!(
        Vec2::from(turned(&window)).length() < 0.01,
        "{:?}",
        turned(&window)
    );
}

#[test]
fn keys_move_hand_relative_to_camera() {
    let mut window = in_space();
    let hold = |window: &mut Window, key, count: usize| {
        let before = goal(window, 0);
        window.key_down(key);
        frames(window, 1);
        // The camera turns only when the window is drawn, so its key is held for frames instead of ticks.
        match key {
            Key::CloseBracket => frames(window, count - 1),
            _ => wait(window, count - 2),
        }
        window.key_up(key);
        frames(window, 1);
        goal(window, 0) - before
    };
    let Vec3 { x, y, z } = hold(&mut window, Key::Q, 20);
    assert!(x.abs() < 0.01 && y > 0.3 && z.abs() < 0.01, "{x} {y} {z}");
    let Vec3 { x, y, z } = hold(&mut window, Key::S, 10);
    assert!(x.abs() < 0.01 && y.abs() < 0.01 && z > 0.2, "{x} {y} {z}");
    let Vec3 { x, y, z } = hold(&mut window, Key::Z, 20);
    assert!(x.abs() < 0.01 && y < -0.3 && z.abs() < 0.01, "{x} {y} {z}");
    hold(&mut window, Key::CloseBracket, 63);
    let [right, up] = turned(&window);
    assert!((1.4..1.8).contains(&right) && up == 0.0, "{right} {up}");
    // The camera is on the right and looks to the left, along the first axis.
    let Vec3 { x, y, z } = hold(&mut window, Key::D, 10);
    assert!(x.abs() < 0.08 && y.abs() < 0.01 && z < -0.2, "{x} {y} {z}");
    let Vec3 { x, y, z } = hold(&mut window, Key::S, 10);
    assert!(x > 0.2 && y.abs() < 0.01 && z.abs() < 0.08, "{x} {y} {z}");
    // In 2D the key that raises the hand has no effect.
    start(&mut window, "classic");
    let still = hold(&mut window, Key::Q, 10);
    assert_near(still, Vec3::ZERO);
}

#[test]
fn triggers_raise_hand_and_right_stick_turns_camera() {
    let mut table = Table::with(vec![pad(1)]);
    start(&mut table.window, "classic-3d");
    let before = goal(&table.window, 0);
    let hold = |table: &mut Table, right, triggers, count: usize| {
        let pad = table.pad(0);
        (pad.right, pad.triggers) = (right, triggers);
        table.frames(1);
        match right {
            [0.0, 0.0] => wait(&mut table.window, count - 2),
            _ => table.frames(count - 1),
        }
    };
    hold(&mut table, [0.0; 2], [0.0, 1.0], 20);
    let raised = goal(&table.window, 0);
    assert_near(raised, before + Vec3::Y * 0.4);
    assert_eq!(turned(&table.window), [0.0; 2]);
    // Half the deflection beyond the dead zone gives half the speed.
    hold(&mut table, [0.0; 2], [0.55, 0.0], 20);
    assert_near(goal(&table.window, 0), before + Vec3::Y * 0.2);
    let low = goal(&table.window, 0);
    hold(&mut table, [1.0, 0.0], [0.0; 2], 20);
    let [right, up] = turned(&table.window);
    assert!(right > 0.3 && up == 0.0, "{right} {up}");
    hold(&mut table, [0.0, 1.0], [0.0; 2], 20);
    let [after, up] = turned(&table.window);
    assert!(after == right && up > 0.3, "{after} {up}");
    assert_near(goal(&table.window, 0), low);
    // The elevation has a lower limit.
    hold(&mut table, [0.0, -1.0], [0.0; 2], 40);
    assert!((-0.4..-0.2).contains(&turned(&table.window)[1]));
}

#[test]
fn two_players_3d_share_one_camera() {
    let mut table = Table::with(vec![pad(1), pad(2)]);
    start(&mut table.window, "classic-3d");
    table.tap(PadButton::Back);
    let second = table.window.state().game.controls.players.second();
    assert_eq!(second, Some(InputSource::Stick(DeviceId(2))));
    table.frames(2);
    let before = [0, 1].map(|player| goal(&table.window, player));
    assert_near(before[1], table.window.state().game.bout.round().start(1));
    let hold = |table: &mut Table, held: [([f32; 2], [f32; 2]); 2], count| {
        for (device, (left, triggers)) in table.devices.iter_mut().zip(held) {
            let pad = device.pad.as_mut().expect("the device is a pad");
            (pad.left, pad.right, pad.triggers) = (left, [0.5, 0.0], triggers);
        }
        table.frames(count);
    };
    hold(
        &mut table,
        [([0.0; 2], [0.0; 2]), ([0.0; 2], [0.0, 1.0])],
        15,
    );
    let after = [0, 1].map(|player| goal(&table.window, player));
    assert_near(after[0], before[0]);
    assert_near(after[1], before[1] + Vec3::Y * 0.3);
    // Two players who turn the camera do not turn it faster than one.
    let [right, _] = turned(&table.window);
    assert!(right < 0.5 * 1.5 * 16.0 / 60.0, "{right}");
    hold(
        &mut table,
        [([0.0, -1.0], [0.0; 2]), ([0.0; 2], [0.0; 2])],
        10,
    );
    let moved = [0, 1].map(|player| goal(&table.window, player));
    assert!(moved[0].z > after[0].z + 0.2, "{after:?} {moved:?}");
    assert_near(moved[1], after[1]);
}

#[test]
fn first_finger_moves_hand_and_second_raises_it_or_turns_camera() {
    let mut window = in_space();
    let height = goal(&window, 0).y;
    let view = window.state().game.bout.view.expect("the world is visible");
    touch(
        &mut window,
        0,
        TouchPhase::Start,
        view.to_screen(Vec3::new(-1.2, 0.0, 0.5)),
    );
    touch(
        &mut window,
        0,
        TouchPhase::Move,
        view.to_screen(Vec3::new(-0.9, 0.0, 0.6)),
    );
    wait(&mut window, 40);
    assert_near(goal(&window, 0), [-0.9, height, 0.6]);
    let drag = |window: &mut Window, by: egui::Vec2| {
        let from = pos2(700.0, 400.0);
        touch(window, 1, TouchPhase::Start, from);
        for step in 1..=10 {
            touch(window, 1, TouchPhase::Move, from + 0.1 * step as f32 * by);
        }
        touch(window, 1, TouchPhase::End, from + by);
        wait(window, 30);
    };
    drag(&mut window, vec2(20.0, -0.4 * view.scale));
    let raised = goal(&window, 0);
    assert!((raised.y - height - 0.4).abs() < 0.03, "{raised:?}");
    assert_eq!(turned(&window), [0.0; 2]);
    drag(&mut window, vec2(-100.0, 20.0));
    let [right, up] = turned(&window);
    assert!((right - 0.6).abs() < 0.05 && up == 0.0, "{right} {up}");
    assert!((goal(&window, 0).y - raised.y).abs() < 0.01);
    assert_eq!(window.state().game.controls.means, InputMethod::Fingers);
}

#[test]
fn second_finger_does_not_move_hand_after_first_lifts() {
    let mut window = in_space();
    let view = window.state().game.bout.view.expect("the world is visible");
    let [here, there] = [-0.9, 0.3].map(|x| view.to_screen(Vec3::new(x, 0.0, 0.6)));
    touch(&mut window, 0, TouchPhase::Start, here);
    touch(&mut window, 1, TouchPhase::Start, there);
    wait(&mut window, 60);
    let before = goal(&window, 0);
    touch(&mut window, 0, TouchPhase::End, here);
    // A browser reports the finger that remains on the screen as the mouse.
    window.event(Event::PointerMoved(there));
    touch(&mut window, 1, TouchPhase::Move, there);
    wait(&mut window, 60);
    assert_near(goal(&window, 0), before);
}

#[test]
fn keys_and_pad_move_element_cut_and_hint_names_them() {
    let mut table = Table::with(vec![pad(1)]);
    start(&mut table.window, "classic-3d");
    let share = |table: &mut Table| {
        let game = game(&mut table.window);
        game.bout.opening.share(game.time, true)
    };
    press(&mut table.window, Key::E);
    game(&mut table.window).bout.opening.cut(0.0, 0.0, true);
    let before = share(&mut table);
    let hold = |table: &mut Table, key| {
        table.window.key_down(key);
        table.frames(15);
        table.window.key_up(key);
        table.frames(1);
    };
    hold(&mut table, Key::X);
    let deeper = share(&mut table);
    assert!(
        (0.05..0.15).contains(&(before - deeper)),
        "{before} {deeper}"
    );
    assert!(tells(&table.window, "X: look deeper, C: back"));
    hold(&mut table, Key::C);
    assert!((share(&mut table) - before).abs() < 0.02);
    let height = goal(&table.window, 0).y;
    table.tap(PadButton::RightStick);
    assert!(share(&mut table) < before);
    assert!(tells(&table.window, "Press the right stick: look deeper"));
    wheel(&mut table.window, 100.0);
    assert!(
        share(&mut table) < before - 0.05,
        "scrolling up looks deeper"
    );
    assert!((goal(&table.window, 0).y - height).abs() < 1e-3);
}

#[test]
fn round_3d_is_won_saved_watched_and_raced() {
    let folder = folder();
    let files = Files::in_folder(folder.path());
    let mut window = window(Files::in_folder(folder.path()));
    start(&mut window, "classic-3d");
    win(&mut window);
    let (outcome, is_best) = game(&mut window).bout.won.expect("the round was won");
    assert!(is_best && outcome.route == Route::Squeeze, "{outcome:?}");
    click(&mut window, "Save replay");
    game(&mut window).finish_writing();
    game(&mut window).notices.clear();
    assert_eq!(files.replays().len(), 1);

    click(&mut window, "Race it");
    // The ghost begins with the player.
    window.key_down(Key::ArrowLeft);
    frames(&mut window, 31);
    window.key_up(Key::ArrowLeft);
    let is_space = |round: &AnyRound| matches!(round, AnyRound::Space(_));
    let ghost = |window: &Window| {
        let ghost = window.state().game.bout.session.ghost();
        let ghost = ghost.expect("the session has a ghost");
        assert!(is_space(ghost));
        (ghost.frames().len(), ghost.hands()[0].position)
    };
    let (ticks, at) = ghost(&window);
    let mine = window.state().game.bout.round().hands()[0].position;
    assert!(
        ticks >= 28 && (at - mine).length() > 0.1,
        "{ticks} {at:?} {mine:?}"
    );

    game(&mut window).go(Screen::Title);
    game(&mut window).go(Screen::Replays);
    frames(&mut window, 2);
    click(&mut window, "Watch");
    assert!(!game(&mut window).bout.session.is_played());
    let before = goal(&window, 0);
    // During a replay, keys do not move the hand.
    window.key_down(Key::Q);
    frames(&mut window, 5);
    window.key_up(Key::Q);
    assert!(!tells(&window, "Up and down"));
    let goes_on = |game: &Game| !game.bout.session.is_over();
    drive(game(&mut window), tamaire_play::BotKind::Idle, goes_on);
    let game = game(&mut window);
    assert_eq!(game.bout.round().progress().outcome, Some(outcome));
    assert!(game.notices.iter().next().is_none(), "{:?}", game.notices);
    assert!((goal(&window, 0) - before).length() > 0.1);
}
