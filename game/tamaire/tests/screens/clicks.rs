//! Tests of mouse and keyboard.

use crate::window::*;
use app_shell::Pads;
use egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, TouchPhase, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use fuwafuwa::Vec3;
use std::fs;
use std::sync::Arc;
use tamaire::game::{Game, Notice, Screen};
use tamaire::input::{Action, InputSource};
use tamaire::platform::{Files, Sound};
use tamaire::records::Records;
use tamaire::settings::Settings;
use tamaire::words::Language;
use tamaire_play::replay::VERSION;
use tamaire_play::{BotKind, Level, Route};

#[test]
fn menus_lead_from_title_to_round_and_back() {
    let mut window = window(Files::nowhere());
    click(&mut window, "Play");
    assert_eq!(screen(&window), Screen::Levels);
    click(&mut window, "Classic");
    assert_eq!(screen(&window), Screen::Play);
    frames(&mut window, 10);
    assert!(ticks(&window) >= 10);
    press(&mut window, Key::Escape);
    assert_eq!(screen(&window), Screen::Paused);
    let before = ticks(&window);
    frames(&mut window, 10);
    assert_eq!(ticks(&window), before, "no ticks while paused");
    press(&mut window, Key::Escape);
    assert_eq!(screen(&window), Screen::Play);
    press(&mut window, Key::P);
    click(&mut window, "Restart");
    assert_eq!(screen(&window), Screen::Play);
    assert!(ticks(&window) < before);
    press(&mut window, Key::Escape);
    click(&mut window, "Levels");
    assert_eq!(screen(&window), Screen::Levels);
    click(&mut window, "Back");
    assert_eq!(screen(&window), Screen::Title);
}

#[test]
fn retry_key_restarts_round_at_once() {
    let mut window = window(Files::nowhere());
    game(&mut window).start(0);
    frames(&mut window, 30);
    assert!(ticks(&window) >= 29);
    window.key_press(Key::R);
    window.step();
    // The key is down in the first frame and up in the second, so the restarted round has at most two ticks.
    assert!(ticks(&window) <= 2, "{} ticks", ticks(&window));
    frames(&mut window, 5);
    assert!(ticks(&window) >= 5, "the round continues");
}

#[test]
fn round_is_won_saved_watched_raced_and_deleted() {
    let folder = folder();
    let files = Files::in_folder(folder.path());
    let mut window = window(Files::in_folder(folder.path()));
    game(&mut window).start(0);
    win(&mut window);
    let (outcome, is_best) = game(&mut window).bout.won.unwrap();
    assert!(is_best && outcome.route == Route::Squeeze, "{outcome:?}");
    window.get_by_label("It went in whole!");
    click(&mut window, "Save replay");
    game(&mut window).finish_writing();
    assert!(notices(&window).contains("classic-1.tamaire"));
    let path = files.location(&files.replays()[0].name);
    let saved = fs::read_to_string(&path).unwrap();

    click(&mut window, "Race it");
    assert_eq!(screen(&window), Screen::Play);
    window.key_down(Key::ArrowLeft);
    frames(&mut window, 6);
    window.key_up(Key::ArrowLeft);
    let ghost = |window: &Window| {
        let ghost = window.state().game.bout.session.ghost();
        ghost.map(|round| round.frames().len())
    };
    assert!(ghost(&window).unwrap() >= 5);
    press(&mut window, Key::R);
    assert!(ghost(&window).unwrap() <= 4, "the ghost restarts, too");
    win(&mut window);
    assert!(
        !game(&mut window).bout.won.unwrap().1,
        "an equal time is no record"
    );
    click(&mut window, "Play again");
    assert_eq!(screen(&window), Screen::Play);
    win(&mut window);
    press(&mut window, Key::Escape);
    assert_eq!(screen(&window), Screen::Levels);
    press(&mut window, Key::Escape);

    click(&mut window, "Replays");
    click(&mut window, "Watch");
    assert_eq!(screen(&window), Screen::Play);
    assert!(!game(&mut window).bout.session.is_played());
    while screen(&window) == Screen::Play {
        let game = game(&mut window);
        let goes_on = |game: &Game| !game.bout.session.is_over();
        drive(game, tamaire_play::BotKind::Idle, goes_on);
        assert_eq!(game.bout.round().progress().outcome, Some(outcome));
        frames(&mut window, 2);
    }
    assert_eq!(
        (screen(&window), notices(&window).as_str()),
        (Screen::Replays, "")
    );
    frames(&mut window, 1);
    click(&mut window, "Race it");
    assert!(game(&mut window).bout.session.is_played() && ghost(&window).is_some());
    game(&mut window).go(Screen::Title);
    game(&mut window).go(Screen::Replays);

    // Neither a replay of another version of the game nor a manipulated replay is accepted.
    fs::write(
        &path,
        saved.replacen(&format!("version = {VERSION}"), "version = 999", 1),
    )
    .unwrap();
    frames(&mut window, 2);
    click(&mut window, "Watch");
    assert!(
        notices(&window).contains("version 999"),
        "{}",
        notices(&window)
    );
    assert_eq!(screen(&window), Screen::Replays);
    // The first hash is wrong, which is detected after a second of playback.
    let start = saved.find("hashes = [").unwrap();
    let digit = start + saved[start..].find('"').unwrap() + 1;
    let mut lie = saved.clone();
    let other = if &saved[digit..=digit] == "0" {
        "1"
    } else {
        "0"
    };
    lie.replace_range(digit..=digit, other);
    fs::write(&path, lie).unwrap();
    for way in ["Watch", "Race it"] {
        game(&mut window).notices.clear();
        click(&mut window, way);
        assert_eq!(screen(&window), Screen::Play);
        // A ghost begins with the player.
        window.key_down(Key::ArrowLeft);
        frames(&mut window, 66);
        window.key_up(Key::ArrowLeft);
        assert!(
            notices(&window).contains("was changed"),
            "{way}: {}",
            notices(&window)
        );
        game(&mut window).go(Screen::Replays);
        frames(&mut window, 2);
    }
    click(&mut window, "Delete");
    assert!(
        !files.replays().is_empty(),
        "the first press deletes nothing"
    );
    click(&mut window, "Really?");
    assert!(files.replays().is_empty());
    window.get_by_label_contains("No replays yet");
}

#[test]
fn settings_are_saved_and_language_changes_at_once() {
    let folder = folder();
    let files = Files::in_folder(folder.path());
    let mut window = window(Files::in_folder(folder.path()));
    click(&mut window, "Settings");
    let slider = egui::accesskit::Role::Slider;
    let before = game(&mut window).settings.volume;
    window
        .get_by_role_and_label(slider, "Volume")
        .decrement_accesskit();
    frames(&mut window, 2);
    let after = game(&mut window).settings.volume;
    assert!((before - after - 0.05).abs() < 1e-3, "{before} {after}");
    let option = |window: &Window, name: &str| {
        let option = window.get_by_role_and_label(egui::accesskit::Role::RadioButton, name);
        option.accesskit_node().toggled()
    };
    use egui::accesskit::Toggled::{False, True};
    assert_eq!(option(&window, "Reduce motion: Off"), Some(True));
    assert_eq!(option(&window, "Colour-blind friendly: Off"), Some(True));
    assert_eq!(option(&window, "Colour-blind friendly: On"), Some(False));
    window.get_by_label("Language: 日本語").click();
    frames(&mut window, 2);
    let said = Language::Japanese.words();
    window.get_by_label(said.volume);
    click(&mut window, said.back);
    window.get_by_label(said.play);
    game(&mut window).finish_writing();
    let again = Game::new(files, Sound::none(), Pads::none());
    assert_eq!(again.settings.language, Language::Japanese);
    assert_eq!(again.settings.volume, after);
    fs::write(folder.path().join("settings.toml"), "volume = [").unwrap();
    let again = Game::new(Files::in_folder(folder.path()), Sound::none(), Pads::none());
    // Without readable settings the wanted strength is unknown, so force feedback is off.
    let usual = Settings {
        haptics: 0.0,
        ..Settings::default()
    };
    assert_eq!(again.settings, usual);
    let aside = |notice: &Notice| notice.text.contains("settings.broken-1.toml");
    assert!(again.notices.iter().any(aside));
}

#[test]
fn scroll_positions_of_screens_are_independent() {
    let mut window = window(Files::nowhere());
    let language = |window: &Window| window.get_by_label("Language: English").rect();
    click(&mut window, "Settings");
    let before = language(&window);
    click(&mut window, "Back");
    click(&mut window, "Play");
    button(&window, "Playground 3D").scroll_to_me();
    frames(&mut window, 30);
    click(&mut window, "Back");
    click(&mut window, "Settings");
    assert_eq!(language(&window), before);
}

#[test]
fn licences_scroll_with_keys() {
    let mut window = window(Files::nowhere());
    click(&mut window, "Settings");
    click(&mut window, "Licences");
    assert_eq!(screen(&window), Screen::Licences);
    window.get_by_label("What others made");
    // Arrow keys scroll past the back button to the end of the text.
    let lines = tamaire::licences::lines();
    let last = lines.iter().rfind(|line| !line.is_empty()).unwrap();
    let room = window.ctx.content_rect();
    let is_seen = |window: &Window| {
        let mut found = window.query_all_by_label(last);
        found.any(|line| room.contains_rect(line.rect()))
    };
    for _ in lines {
        if !is_seen(&window) {
            press(&mut window, Key::ArrowDown);
            frames(&mut window, 30);
        }
    }
    assert!(is_seen(&window));
    press(&mut window, Key::Escape);
    assert_eq!(screen(&window), Screen::Settings);
}

#[test]
fn any_key_can_be_bound() {
    let mut window = window(Files::nowhere());
    click(&mut window, "Settings");
    let row = |window: &Window| {
        let row = window.get_by_label_contains("Try again:");
        let label = row.accesskit_node().label();
        label.expect("the row was found by its label")
    };
    for key in [Key::Q, Key::Enter, Key::ArrowDown, Key::Tab] {
        let row = row(&window);
        click(&mut window, &row);
        assert_eq!(game(&mut window).controls.rebinding, Some(Action::Retry));
        window.get_by_label("Press a key or button…");
        press(&mut window, key);
        let game = game(&mut window);
        assert_eq!(
            game.settings.bindings.of_key(key),
            Some(Action::Retry),
            "{key:?}"
        );
        assert_eq!(game.controls.rebinding, None, "{key:?}");
    }
    // During the choice of a new key, Escape keeps the old binding and does not leave the screen.
    let row = row(&window);
    click(&mut window, &row);
    press(&mut window, Key::Escape);
    assert!(matches!(screen(&window), Screen::Settings));
    let game = game(&mut window);
    assert_eq!(game.settings.bindings.of_key(Key::Tab), Some(Action::Retry));
    assert_eq!(game.controls.rebinding, None);
    game.settings = Settings::default();
    game.go(Screen::Title);
}

#[test]
fn mouse_and_keys_move_two_hands() {
    let mut window = window(Files::nowhere());
    game(&mut window).start(0);
    frames(&mut window, 2);
    press(&mut window, Key::J);
    assert_eq!(
        game(&mut window).controls.players.second(),
        Some(InputSource::Keys)
    );
    frames(&mut window, 2);
    let before = hand_targets(&window);
    let level = window.state().game.bout.round().level().clone();
    let start = level.scene().hand_targets(0);
    for (at, start) in before.iter().zip(&start) {
        let is_near = (0..2).all(|axis| (at[axis] - start[axis]).abs() < 1e-3);
        assert!(
            is_near,
            "a new hand starts at the position of the level: {at:?} {start:?}"
        );
    }
    pick_up(&mut window);
    window.key_down(Key::D);
    window.hover_at(egui::pos2(480.0, 100.0));
    frames(&mut window, 20);
    let after = hand_targets(&window);
    assert!(after[0].y > before[0].y + 0.3, "{before:?} {after:?}");
    assert!(after[1].x > before[1].x + 0.3, "{before:?} {after:?}");
    assert!(
        (after[1].y - before[1].y).abs() < 1e-3,
        "{before:?} {after:?}"
    );
    window.key_up(Key::D);
    press(&mut window, Key::J);
    assert_eq!(game(&mut window).controls.players.second(), None);
}

#[test]
fn font_contains_all_characters_of_the_game() {
    let window = window(Files::nowhere());
    let mut texts = vec![
        include_str!("../../src/words/en.rs"),
        include_str!("../../src/words/ja.rs"),
        include_str!("../../src/words/stand.rs"),
        include_str!("../../../tamaire_play/src/daily/twist.rs"),
    ];
    texts.extend(tamaire_play::level::built_in().map(|(_, text)| text));
    let font = egui::FontId::proportional(20.0);
    for letter in texts.join("").chars().filter(|k| !k.is_control()) {
        let is_there = window.ctx.fonts_mut(|fonts| fonts.has_glyph(&font, letter));
        assert!(is_there, "{letter}: run apps/app_shell/fonts/make.py");
    }
}

#[test]
fn full_screen_key_toggles_and_is_saved() {
    let folder = folder();
    let mut window = window(Files::in_folder(folder.path()));
    for wanted in [true, false, true] {
        window.key_press(Key::F11);
        // The viewport command for full screen follows within two frames.
        let asked = (0..2).any(|_| {
            frames(&mut window, 1);
            let root = &window.output().viewport_output[&egui::ViewportId::ROOT];
            let command = egui::ViewportCommand::Fullscreen(wanted);
            root.commands.contains(&command)
        });
        assert!(asked && game(&mut window).settings.full_screen == wanted);
    }
    drop(window);
    let again = Game::new(Files::in_folder(folder.path()), Sound::none(), Pads::none());
    assert!(again.settings.full_screen);
}

#[test]
fn language_follows_system_until_chosen() {
    let folder = folder();
    let files = |locale: &str| Files::in_folder(folder.path()).speaking(locale);
    for (locale, language) in [
        ("ja_JP.UTF-8", Language::Japanese),
        ("ja", Language::Japanese),
        ("fr-FR", Language::English),
        ("", Language::English),
    ] {
        let game = Game::new(files(locale), Sound::none(), Pads::none());
        assert_eq!(game.settings.language, language, "{locale}");
    }
    let mut window = window(files("ja-JP"));
    click(&mut window, "English");
    assert_eq!(game(&mut window).settings.language, Language::English);
    drop(window);
    let game = Game::new(files("ja-JP"), Sound::none(), Pads::none());
    assert_eq!(
        game.settings.language,
        Language::English,
        "the chosen language is kept"
    );
}

#[test]
fn resting_mouse_moves_no_hand() {
    let mut window = window(Files::nowhere());
    start(&mut window, "classic");
    for (at, moves) in [(egui::Pos2::ZERO, false), (egui::pos2(400.0, 300.0), true)] {
        window.hover_at(at);
        frames(&mut window, 2);
        assert_eq!(
            game(&mut window).controls.players.wanted(0).is_some(),
            moves,
            "{at}"
        );
    }
}

#[test]
fn hovering_clicks_only_when_enabled() {
    let mut window = window(Files::nowhere());
    let at = button(&window, "Play").rect().center();
    window.hover_at(at);
    frames(&mut window, 90);
    assert_eq!(screen(&window), Screen::Title, "click by hovering is off");
    window.hover_at(egui::Pos2::ZERO);
    frames(&mut window, 2);
    game(&mut window).settings.dwell = true;
    window.hover_at(at);
    frames(&mut window, 30);
    assert_eq!(screen(&window), Screen::Title);
    frames(&mut window, 60);
    assert_eq!(screen(&window), Screen::Levels);
}

#[test]
fn sticky_keys_hold_until_pressed_again() {
    let mut window = window(Files::nowhere());
    start(&mut window, "classic");
    game(&mut window).settings.toggle_keys = true;
    let x = |window: &Window| {
        let players = &window.state().game.controls.players;
        players.wanted(0).map_or(-1.4, |wanted| wanted.x)
    };
    press(&mut window, Key::ArrowRight);
    frames(&mut window, 30);
    let first = x(&window);
    assert!(first > -1.2, "{first}");
    press(&mut window, Key::ArrowRight);
    frames(&mut window, 10);
    let second = x(&window);
    frames(&mut window, 10);
    assert_eq!(x(&window), second);
}

/// Position of a point of the world on the screen.
fn on_screen(window: &Window, at: Vec3) -> egui::Pos2 {
    let view = window.state().game.bout.view;
    view.expect("the world is visible").to_screen(at)
}

#[test]
fn pointer_over_body_at_start_breaks_nothing() {
    let mut window = window(Files::nowhere());
    for level in ["classic", "biscuit", "core", "cat"] {
        start(&mut window, level);
        for restarts in [false, true] {
            if restarts {
                press(&mut window, Key::R);
            }
            let middle = window.state().game.bout.effects.feelings[0].middle;
            let at = on_screen(&window, middle);
            window.hover_at(at);
            frames(&mut window, 1);
            window.hover_at(at + egui::vec2(3.0, 2.0));
            let mut splits = 0;
            for _ in 0..90 {
                frames(&mut window, 1);
                let round = window.state().game.bout.round();
                splits += round.split_points().len();
            }
            let game = game(&mut window);
            let hand = &game.bout.round().hands()[0];
            assert_eq!(splits, 0, "{level}: the body has a crack");
            let gap = game.bout.round().distance_to_bodies(hand.position) - hand.radius;
            assert!(gap > 0.0, "{level}: {gap} m");
            assert!(!game.controls.players.is_picked_up(0), "{level}");
        }
    }
    // As soon as the pointer has been at the hand, the hand follows and may push.
    start(&mut window, "classic");
    pick_up(&mut window);
    let middle = window.state().game.bout.effects.feelings[0].middle;
    let at = on_screen(&window, middle);
    window.hover_at(at);
    frames(&mut window, 60);
    let after = window.state().game.bout.effects.feelings[0].middle;
    assert!((after - middle).length() > 0.1, "{middle} {after}");
}

#[test]
fn clock_starts_with_the_first_push() {
    let mut window = window(Files::nowhere());
    start(&mut window, "classic");
    frames(&mut window, 90);
    let seconds = |window: &Window| window.state().game.bout.round().seconds();
    assert_eq!((seconds(&window), ticks(&window) >= 90), (0.0, true));
    window.key_down(Key::ArrowUp);
    frames(&mut window, 31);
    let shown = seconds(&window);
    assert!((0.4..0.6).contains(&shown), "{shown} s");
    window.key_up(Key::ArrowUp);
    frames(&mut window, 30);
    assert!(seconds(&window) > shown + 0.4, "the clock goes on");
    press(&mut window, Key::R);
    frames(&mut window, 30);
    assert_eq!(seconds(&window), 0.0);
}

#[test]
fn two_players_screen_parts_the_keyboard() {
    let mut window = window(Files::nowhere());
    click(&mut window, "Two players");
    window.get_by_label("First hand: mouse, or ↑ ← ↓ →");
    window.get_by_label("Second hand: W A S D");
    click(&mut window, "Play as two");
    assert_eq!(screen(&window), Screen::Levels);
    click(&mut window, "Classic");
    frames(&mut window, 2);
    let before = hand_targets(&window);
    assert_eq!(before.len(), 2);
    window.key_down(Key::ArrowUp);
    window.key_down(Key::S);
    frames(&mut window, 20);
    let after = hand_targets(&window);
    assert!(after[0].y > before[0].y + 0.2, "{before:?} {after:?}");
    assert!(after[1].y < before[1].y - 0.2, "{before:?} {after:?}");
    window.key_up(Key::ArrowUp);
    window.key_up(Key::S);
    game(&mut window).go(Screen::Title);
    frames(&mut window, 2);
    click(&mut window, "Two players");
    click(&mut window, "Play alone");
    assert_eq!(game(&mut window).controls.players.second(), None);
}

#[test]
fn two_players_screen_names_the_missing_keys() {
    let said = Language::English.words();
    for (key, action, told, other) in [
        (
            Key::A,
            Action::Left,
            said.no_letter_keys,
            said.no_arrow_keys,
        ),
        (
            Key::ArrowLeft,
            Action::Left,
            said.no_arrow_keys,
            said.no_letter_keys,
        ),
    ] {
        let mut window = window(Files::nowhere());
        click(&mut window, "Two players");
        assert!(window.query_by_label(told).is_none());
        // The action has another key that belongs to the other player, so it needs no key in exchange.
        let bindings = &mut game(&mut window).settings.bindings;
        assert_eq!(bindings.of_key(key), Some(action));
        bindings.bind_key(Action::Elements, key);
        frames(&mut window, 2);
        window.get_by_label(told);
        assert!(window.query_by_label(other).is_none());
        let as_two = button(&window, "Play as two");
        assert!(as_two.accesskit_node().is_disabled());
        click(&mut window, "Play alone");
        assert_eq!(screen(&window), Screen::Levels);
    }
}

#[test]
fn goals_are_listed_in_pause_and_ticked_off() {
    let mut window = window(Files::nowhere());
    start(&mut window, "biscuit");
    press(&mut window, Key::P);
    window.get_by_label_contains("in the basket: 0 of");
    window.get_by_label("☆ shave it to fit");
    window.get_by_label("☆ at least 40 pieces");
    press(&mut window, Key::P);
    drive(game(&mut window), BotKind::Shave, |game| {
        game.bout.round().progress().pieces < 40
    });
    press(&mut window, Key::P);
    window.get_by_label("★ at least 40 pieces");
    start(&mut window, "core");
    drive(game(&mut window), BotKind::Shave, |game| {
        game.bout.round().progress().kept > 0.98
    });
    press(&mut window, Key::P);
    window.get_by_label("× squeeze it in whole");
    window.get_by_label("☆ tear off at most 10 %");
}

#[test]
fn large_text_is_as_large_as_promised() {
    let mut window = open(Files::nowhere(), egui::vec2(1280.0, 800.0), 0.25);
    for (size, zoom) in [(1.0, 1.0), (1.6, 1.6), (0.8, 0.8)] {
        game(&mut window).settings.text_size = size;
        frames(&mut window, 3);
        let ratio = window.ctx.zoom_factor();
        assert!((ratio - zoom).abs() < 1e-3, "{size}: {ratio}");
    }
}

#[test]
fn tooltips_of_levels_leave_the_header_free() {
    let mut window = open(Files::nowhere(), vec2(960.0, 420.0), 0.25);
    // Wins by all routes, with and without assists, give long tooltips.
    let best = "{ squeeze = 900, shave = 900, mix = 900 }";
    let record =
        |level: &Arc<Level>| format!("[{}]\nbest = {best}\nbest_assisted = {best}\n", level.id);
    let records: String = game(&mut window).levels.iter().map(record).collect();
    game(&mut window).records = Records::read(&records).0;
    game(&mut window).go(Screen::Levels);
    frames(&mut window, 2);
    window.hover_at(window.ctx.content_rect().lerp_inside(vec2(0.1, 0.8)));
    let mut shown = 0;
    for _ in 0..30 {
        window.event(Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: vec2(0.0, -20.0),
            phase: TouchPhase::Move,
            source: MouseWheelSource::Unknown,
            modifiers: Modifiers::NONE,
        });
        frames(&mut window, 6);
        let header = button(&window, "Back").rect();
        for line in window.query_all_by_label_contains("☆ ") {
            let line = line.rect();
            assert!(line.top() > header.bottom(), "{line:?}, {header:?}");
            shown += 1;
        }
    }
    assert!(shown > 30, "{shown}");
}
