//! Tests of accessibility: easier levels, and play with a single switch.

use crate::window::*;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use std::collections::BTreeSet;
use tamaire::game::Screen;
use tamaire::input::{Action, ScanAction, Scanning};
use tamaire::platform::Files;
use tamaire_play::playground::Tool;
use tamaire_play::{Assist, Route};

#[test]
fn assisted_wins_are_recorded_separately() {
    let folder = folder();
    let mut window = window(Files::in_folder(folder.path()));
    let all = BTreeSet::from([Assist::WiderBasket, Assist::Unbreakable]);
    game(&mut window).settings.assists = all.clone();
    start(&mut window, "biscuit");
    let level = game(&mut window).bout.round().level().clone();
    assert_eq!(level.game().assists, all);
    assert_eq!(level.routes(), [Route::Squeeze]);
    win(&mut window);
    window.get_by_label_contains("easier play: Wider basket, Unbreakable body");
    let game = game(&mut window);
    let record = game.records.of("biscuit").unwrap();
    assert!(record.best.is_empty() && record.wishes.is_empty());
    assert!(record.best_assisted.contains_key(&Route::Squeeze));
    game.keep_replay();
    game.finish_writing();
    let plain = game
        .levels
        .iter()
        .find(|level| level.id == "biscuit")
        .unwrap()
        .clone();
    assert!(game.files.best(&level).unwrap().is_of(&level));
    assert!(game.files.best(&plain).is_none());

    // A retry keeps the assists until they are switched off.
    game.retry();
    assert_eq!(game.bout.round().level(), &level);
    game.settings.assists.clear();
    game.retry();
    assert_eq!(game.bout.round().level(), &plain);
    game.go(Screen::Replays);
    frames(&mut window, 6);
    window.get_by_label_contains("s, easier play");
}

/// Waits until the button with this name has the focus in the scanning cycle, then presses the switch.
fn choose(window: &mut Window, name: &str) {
    choose_as(window, Role::Button, name);
}

fn choose_as(window: &mut Window, role: Role, name: &str) {
    let patience = 60 * 60;
    for _ in 0..patience {
        if window.get_by_role_and_label(role, name).is_focused() {
            tap(window);
            return;
        }
        frames(window, 1);
    }
    panic!("{name} is never offered");
}

fn tap(window: &mut Window) {
    window.key_down(Key::Space);
    frames(window, 3);
    window.key_up(Key::Space);
    frames(window, 3);
}

/// Waits until scanning offers an action for which `is_wanted` is true.
fn wait_for(window: &mut Window, is_wanted: impl Fn(ScanAction) -> bool) {
    for _ in 0..60 * 60 {
        let game = game(window);
        if is_wanted(game.controls.scan.offer(&game.scan_actions())) {
            return;
        }
        frames(window, 1);
    }
    panic!("the action is never offered on {:?}", screen(window));
}

#[test]
fn single_switch_chooses_and_presses_tools_of_a_playground() {
    let mut window = window(Files::nowhere());
    game(&mut window).settings.scanning = Scanning::Quick;
    start(&mut window, "sandbox");
    wait_for(&mut window, |offer| offer == ScanAction::Pause);
    tap(&mut window);
    choose(&mut window, "Tools");
    assert_eq!(screen(&window), Screen::Toolbox);
    choose_as(&mut window, Role::RadioButton, "Hand: Grab: press and hold");
    choose(&mut window, "Back");
    choose(&mut window, "Resume");
    assert_eq!(game(&mut window).bout.round().tool(), (Tool::Grab, false));
    // The switch that moves the hand presses no tool.
    wait_for(&mut window, |offer| matches!(offer, ScanAction::Move(_)));
    window.key_down(Key::Space);
    frames(&mut window, 5);
    assert_eq!(game(&mut window).bout.round().tool(), (Tool::Grab, false));
    window.key_up(Key::Space);
    for is_pressed in [true, false] {
        wait_for(&mut window, |offer| offer == ScanAction::Tool);
        tap(&mut window);
        let tool = game(&mut window).bout.round().tool();
        assert_eq!(tool, (Tool::Grab, is_pressed));
    }
}

#[test]
fn single_switch_can_win_and_continue() {
    let mut window = window(Files::nowhere());
    game(&mut window).settings.scanning = Scanning::Quick;
    choose(&mut window, "Play");
    assert_eq!(screen(&window), Screen::Levels);
    choose(&mut window, "Classic");
    assert_eq!(screen(&window), Screen::Play);
    // The press that chose the level has not moved the hand.
    let start = game(&mut window).bout.round().start(0);
    assert_eq!(game(&mut window).bout.round().hands()[0].target, start);

    wait_for(&mut window, |offer| offer == ScanAction::Pause);
    tap(&mut window);
    assert_eq!(screen(&window), Screen::Paused);
    choose(&mut window, "Resume");
    assert_eq!(screen(&window), Screen::Play);

    // The body is right of the hand, and the basket is right of the body.
    wait_for(
        &mut window,
        |offer| matches!(offer, ScanAction::Move(way) if way.x > 0.9995),
    );
    window.key_down(Key::Space);
    for _ in 0..60 * 10 {
        let progress = game(&mut window).bout.round().progress();
        if progress.inside > 0.8 || progress.outcome.is_some() {
            break;
        }
        frames(&mut window, 1);
    }
    window.key_up(Key::Space);
    // The hand moves away, so that the body comes to rest in the basket, unless that happens before.
    let is_won = |window: &mut Window| game(window).bout.round().progress().outcome.is_some();
    for _ in 0..600 {
        let game = game(&mut window);
        let offer = game.controls.scan.offer(&game.scan_actions());
        let is_left = matches!(offer, ScanAction::Move(way) if way.x < -0.99);
        if is_left || is_won(&mut window) {
            break;
        }
        frames(&mut window, 1);
    }
    if !is_won(&mut window) {
        window.key_down(Key::Space);
        frames(&mut window, 60);
        window.key_up(Key::Space);
    }
    frames(&mut window, 150);
    assert_eq!(screen(&window), Screen::Result);
    assert_eq!(game(&mut window).bout.won.unwrap().0.route, Route::Squeeze);
    choose(&mut window, "Levels");
    assert_eq!(screen(&window), Screen::Levels);
}

#[test]
fn single_switch_3d_raises_and_lowers_hand() {
    let mut window = window(Files::nowhere());
    game(&mut window).settings.scanning = Scanning::Medium;
    game(&mut window).settings.toggle_keys = true;
    start(&mut window, "classic-3d");
    frames(&mut window, 2);
    let height = |window: &mut Window| game(window).bout.round().hands()[0].target.y;
    let before = height(&mut window);
    wait_for(&mut window, |offer| offer == ScanAction::Raise);
    // One press starts the action, the next one stops it.
    tap(&mut window);
    frames(&mut window, 20);
    let raised = height(&mut window);
    assert!(raised > before + 0.1, "{before} m, then {raised} m");
    tap(&mut window);
    wait_for(&mut window, |offer| offer == ScanAction::Lower);
    tap(&mut window);
    frames(&mut window, 10);
    assert!(height(&mut window) < raised);
}

#[test]
fn single_switch_is_never_trapped() {
    let mut window = window(Files::nowhere());
    game(&mut window).settings.scanning = Scanning::Quick;
    // The switch cannot be bound to anything else, and it cancels a pending binding.
    for action in Action::ALL {
        game(&mut window).go(Screen::Settings);
        frames(&mut window, 2);
        let before = game(&mut window).settings.bindings.clone();
        game(&mut window).controls.rebinding = Some(action);
        tap(&mut window);
        let game = game(&mut window);
        assert_eq!(game.controls.rebinding, None, "{action:?}");
        assert_eq!(game.settings.bindings, before, "{action:?}");
    }
    // Two presses are needed to switch scanning off, and a reset of the settings keeps it on.
    let first = window.get_by_label("One-switch scanning: Off");
    first.scroll_to_me();
    frames(&mut window, 3);
    window.get_by_label("One-switch scanning: Off").click();
    frames(&mut window, 2);
    assert!(game(&mut window).settings.scanning.is_on());
    game(&mut window).settings.speed = 0.6;
    click(&mut window, "Restore default settings");
    frames(&mut window, 2);
    assert!(button(&window, "Cancel").is_focused());
    // The question waits longer than any other confirmation, because a single switch is slow.
    frames(&mut window, 400);
    click(&mut window, "Cancel");
    assert_eq!(
        game(&mut window).settings.speed,
        0.6,
        "the reset asks first"
    );
    click(&mut window, "Restore default settings");
    click(&mut window, "Restore");
    assert_eq!(game(&mut window).settings.speed, 1.0);
    assert!(game(&mut window).settings.scanning.is_on());
    // The switch also leaves a round that is only watched.
    game(&mut window).start(0);
    frames(&mut window, 5);
    let replay = game(&mut window).bout.round().replay();
    game(&mut window).watch(replay.into()).unwrap();
    frames(&mut window, 1);
    tap(&mut window);
    assert_ne!(screen(&window), Screen::Play);
}
