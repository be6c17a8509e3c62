//! In space: where the hand goes with each device, how the camera turns, what is told of it, and what is dropped.

use crate::hostile::drop_file;
use crate::pads::{Table, about, pad};
use crate::window::*;
use egui::epaint::ClippedShape;
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, TouchPhase, pos2, vec2};
use fuwafuwa::Vector;
use fuwafuwa::vector::{length, minus};
use fuwafuwa::world::TICK;
use std::path::Path;
use sticks::{Device, DeviceId, PadButton};
use tamaire::game::{Game, Screen};
use tamaire::input::{Action, Means, Seat};
use tamaire::platform::Files;
use tamaire::words::Language;
use tamaire_play::{AnyRound, Route};

const MODEL: &str = "../crates/tamaire_play/levels/pudding.vox";

fn in_space() -> Window {
    let mut window = window(Files::nowhere());
    start(&mut window, "classic-3d");
    window
}

/// Where a player's hand is to go next [m].
fn goal(window: &Window, player: usize) -> Vector {
    window.state().game.session.round().hands()[player].goal()
}

fn turned(window: &Window) -> [f32; 2] {
    window.state().game.camera.gone_around()
}

/// Lets ticks pass that nobody looks at: in software a picture of space takes longer than a tick.
fn wait(window: &mut Window, ticks: usize) {
    (0..ticks).for_each(|_| game(window).pass(TICK));
    frames(window, 1);
}

/// Points with the mouse at a place of the floor, and waits until the hand is above it.
fn point_at(window: &mut Window, x: f32, z: f32) {
    let view = window.state().game.view.expect("it is seen");
    window.hover_at(view.on_screen([x, 0.0, z]));
    frames(window, 1);
    wait(window, 60);
}

/// Turns the wheel by so many points, and waits.
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

fn assert_near(found: Vector, expected: Vector) {
    let away = length(minus(found, expected));
    assert!(away < 0.03, "{found:?}, expected {expected:?}");
}

#[test]
fn the_mouse_points_at_the_floor_and_the_wheel_raises_the_hand() {
    let mut window = in_space();
    let height = goal(&window, 0)[1];
    for [x, z] in [[-1.2, 0.7], [0.2, 0.6], [0.0, -0.6]] {
        point_at(&mut window, x, z);
        assert_near(goal(&window, 0), [x, height, z]);
    }
    point_at(&mut window, -1.2, 0.7);
    wheel(&mut window, 250.0);
    assert_near(goal(&window, 0), [-1.2, height + 0.5, 0.7]);
    // A long way, on which the hand stays behind, takes none of the height; nor does another camera.
    point_at(&mut window, 1.2, 0.75);
    assert_near(goal(&window, 0), [1.2, height + 0.5, 0.75]);
    game(&mut window).camera.orbit(1.2, 0.3);
    frames(&mut window, 1);
    assert_near(goal(&window, 0), [1.2, height + 0.5, 0.75]);
    point_at(&mut window, 0.8, 0.75);
    assert_near(goal(&window, 0), [0.8, height + 0.5, 0.75]);
    wheel(&mut window, -250.0);
    assert_near(goal(&window, 0), [0.8, height, 0.75]);
    assert_eq!(window.state().game.means, Means::Mouse);
}

#[test]
fn the_right_mouse_button_turns_the_camera_and_leaves_the_hand_alone() {
    let mut window = in_space();
    point_at(&mut window, -1.2, 0.6);
    let before = goal(&window, 0);
    let button = |pressed, pos| Event::PointerButton {
        pos,
        button: PointerButton::Secondary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let view = window.state().game.view.expect("it is seen");
    let at = view.on_screen([-1.2, 0.0, 0.6]);
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
}

#[test]
fn keys_move_the_hand_away_from_the_camera_raise_it_and_turn_the_camera() {
    let mut window = in_space();
    let hold = |window: &mut Window, key, count: usize| {
        let before = goal(window, 0);
        window.key_down(key);
        frames(window, 1);
        // The camera turns as the window is drawn.
        match key {
            Key::CloseBracket => frames(window, count - 1),
            _ => wait(window, count - 2),
        }
        window.key_up(key);
        frames(window, 1);
        minus(goal(window, 0), before)
    };
    let [x, y, z] = hold(&mut window, Key::Q, 20);
    assert!(x.abs() < 0.01 && y > 0.3 && z.abs() < 0.01, "{x} {y} {z}");
    let [x, y, z] = hold(&mut window, Key::S, 10);
    assert!(x.abs() < 0.01 && y.abs() < 0.01 && z > 0.2, "{x} {y} {z}");
    let [x, y, z] = hold(&mut window, Key::Z, 20);
    assert!(x.abs() < 0.01 && y < -0.3 && z.abs() < 0.01, "{x} {y} {z}");
    hold(&mut window, Key::CloseBracket, 63);
    let [right, up] = turned(&window);
    assert!((1.4..1.8).contains(&right) && up == 0.0, "{right} {up}");
    // The camera looks to the left, along the first axis, from the right.
    let [x, y, z] = hold(&mut window, Key::D, 10);
    assert!(x.abs() < 0.08 && y.abs() < 0.01 && z < -0.2, "{x} {y} {z}");
    let [x, y, z] = hold(&mut window, Key::S, 10);
    assert!(x > 0.2 && y.abs() < 0.01 && z.abs() < 0.08, "{x} {y} {z}");
    // In the plane the same keys do nothing.
    start(&mut window, "classic");
    let still = hold(&mut window, Key::Q, 10);
    assert_near(still, [0.0; 3]);
}

#[test]
fn triggers_raise_the_hand_and_the_right_stick_looks_around() {
    let mut table = Table::with(vec![pad(1)]);
    start(&mut table.window, "classic-3d");
    let before = goal(&table.window, 0);
    let hold = |table: &mut Table, right, triggers, count: usize| {
        let pad = table.devices[0].pad.as_mut().expect("a pad");
        (pad.right, pad.triggers) = (right, triggers);
        table.frames(1);
        match right {
            [0.0, 0.0] => wait(&mut table.window, count - 2),
            _ => table.frames(count - 1),
        }
    };
    hold(&mut table, [0.0; 2], [0.0, 1.0], 20);
    let raised = goal(&table.window, 0);
    let expected = [before[0], before[1] + 0.4, before[2]];
    assert_near(raised, expected);
    assert_eq!(turned(&table.window), [0.0; 2]);
    // Half as far, half as fast.
    hold(&mut table, [0.0; 2], [0.55, 0.0], 20);
    assert_near(
        goal(&table.window, 0),
        [before[0], before[1] + 0.2, before[2]],
    );
    let low = goal(&table.window, 0);
    hold(&mut table, [1.0, 0.0], [0.0; 2], 20);
    let [right, up] = turned(&table.window);
    assert!(right > 0.3 && up == 0.0, "{right} {up}");
    hold(&mut table, [0.0, 1.0], [0.0; 2], 20);
    let [after, up] = turned(&table.window);
    assert!(after == right && up > 0.3, "{after} {up}");
    assert_near(goal(&table.window, 0), low);
    // Beyond its end it does not go.
    hold(&mut table, [0.0, -1.0], [0.0; 2], 40);
    assert!((-0.4..-0.2).contains(&turned(&table.window)[1]));
}

#[test]
fn two_players_in_space_have_a_hand_each_and_one_camera() {
    let mut table = Table::with(vec![pad(1), pad(2)]);
    start(&mut table.window, "classic-3d");
    table.tap(PadButton::Back);
    let second = table.window.state().game.players.second();
    assert_eq!(second, Some(Seat::Stick(DeviceId(2))));
    table.frames(2);
    let before = [0, 1].map(|player| goal(&table.window, player));
    assert_near(
        before[1],
        table.window.state().game.session.round().start(1),
    );
    let hold = |table: &mut Table, held: [([f32; 2], [f32; 2]); 2], count| {
        for (device, (left, triggers)) in table.devices.iter_mut().zip(held) {
            let pad = device.pad.as_mut().expect("a pad");
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
    assert_near(after[1], [before[1][0], before[1][1] + 0.3, before[1][2]]);
    // Both lean, and the camera goes no faster for it.
    let [right, _] = turned(&table.window);
    assert!(right < 0.5 * 1.5 * 16.0 / 60.0, "{right}");
    hold(
        &mut table,
        [([0.0, -1.0], [0.0; 2]), ([0.0; 2], [0.0; 2])],
        10,
    );
    let moved = [0, 1].map(|player| goal(&table.window, player));
    assert!(moved[0][2] > after[0][2] + 0.2, "{after:?} {moved:?}");
    assert_near(moved[1], after[1]);
}

/// What a finger does, as eframe tells it: the first is a mouse as well.
fn touch(window: &mut Window, finger: u64, phase: TouchPhase, pos: Pos2) {
    window.event(Event::Touch {
        device_id: egui::TouchDeviceId(1),
        id: egui::TouchId(finger),
        phase,
        pos,
        force: None,
    });
    if finger == 0 {
        window.event(Event::PointerMoved(pos));
        if phase != TouchPhase::Move {
            window.event(Event::PointerButton {
                pos,
                button: PointerButton::Primary,
                pressed: phase == TouchPhase::Start,
                modifiers: Modifiers::NONE,
            });
        }
    }
    frames(window, 1);
}

#[test]
fn one_finger_moves_the_hand_and_a_second_one_raises_it_or_turns_the_camera() {
    let mut window = in_space();
    let height = goal(&window, 0)[1];
    let view = window.state().game.view.expect("it is seen");
    touch(
        &mut window,
        0,
        TouchPhase::Start,
        view.on_screen([-1.2, 0.0, 0.5]),
    );
    touch(
        &mut window,
        0,
        TouchPhase::Move,
        view.on_screen([-0.9, 0.0, 0.6]),
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
    assert!((raised[1] - height - 0.4).abs() < 0.03, "{raised:?}");
    assert_eq!(turned(&window), [0.0; 2]);
    drag(&mut window, vec2(-100.0, 20.0));
    let [right, up] = turned(&window);
    assert!((right - 0.6).abs() < 0.05 && up == 0.0, "{right} {up}");
    assert!((goal(&window, 0)[1] - raised[1]).abs() < 0.01);
    assert_eq!(window.state().game.means, Means::Fingers);
}

/// All words on the screen, each with where it is.
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

fn tells(window: &Window, what: &str) -> bool {
    words(window).iter().any(|(text, _)| text.contains(what))
}

#[test]
fn what_can_be_done_in_space_is_told_until_it_was_tried() {
    let mut window = in_space();
    // Nothing takes its time to go.
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
    assert!(tells(&window, "wheel, or U Z"), "what is bound is named");
    point_at(&mut window, -1.0, 0.7);
    assert!(!tells(&window, "Move") && tells(&window, "wheel"));
    window.key_down(Key::U);
    frames(&mut window, 2);
    assert!(
        tells(&window, "Look around: [ ]"),
        "what was used last is named"
    );
    wait(&mut window, 10);
    window.key_up(Key::U);
    frames(&mut window, 2);
    assert!(!tells(&window, "Up and down") && tells(&window, "Look around"));
    press(&mut window, Key::R);
    wait(&mut window, 60);
    assert!(
        !tells(&window, "Move") && tells(&window, "Look around"),
        "what is known is not told again"
    );
    window.key_down(Key::OpenBracket);
    frames(&mut window, 12);
    window.key_up(Key::OpenBracket);
    frames(&mut window, 1);
    assert!(!tells(&window, "Look around"));
    start(&mut window, "classic");
    frames(&mut window, 2);
    assert!(
        !tells(&window, "Move"),
        "in the plane nothing needs to be told"
    );
}

#[test]
fn a_pad_is_told_of_its_own_controls_and_nothing_is_told_for_ever() {
    let mut table = Table::with(vec![
        pad(1),
        Device::at_rest(DeviceId(2), about("Stick"), 2, 12, 1),
    ]);
    game(&mut table.window).settings.reduced_motion = true;
    start(&mut table.window, "hoop");
    table.devices[0].pad.as_mut().expect("a pad").left = [0.0, 0.7];
    table.frames(2);
    table.devices[0].pad.as_mut().expect("a pad").left = [0.0; 2];
    table.frames(2);
    assert!(tells(&table.window, "triggers") && tells(&table.window, "right stick"));
    table.devices[1].axes = vec![1.0, 0.0];
    table.frames(2);
    table.devices[1].axes = vec![0.0; 2];
    table.frames(2);
    assert!(tells(&table.window, "buttons 10 11") && tells(&table.window, "buttons 12 13"));
    for _ in 0..25 {
        game(&mut table.window).pass(2.0);
    }
    table.frames(2);
    assert!(!tells(&table.window, "buttons"));
}

#[test]
fn what_is_told_fits_into_the_smallest_window() {
    for text_size in [1.0, 1.6] {
        let mut window = open(Files::nowhere(), vec2(640.0, 400.0), 0.5);
        game(&mut window).settings.text_size = text_size;
        start(&mut window, "classic-3d");
        let bindings = &mut game(&mut window).settings.bindings;
        // The longest names there are.
        for (action, key) in [
            (Action::Raise, Key::BrowserBack),
            (Action::Lower, Key::Questionmark),
        ] {
            bindings.bind_key(action, key);
        }
        for means in [
            Means::Mouse,
            Means::Fingers,
            Means::Keys,
            Means::Pad,
            Means::Stick,
        ] {
            for (language, _) in Language::ALL {
                game(&mut window).means = means;
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

#[test]
fn a_round_in_space_is_won_kept_watched_and_raced() {
    let folder = folder("space");
    let files = Files::in_folder(&folder);
    let mut window = window(files.clone());
    start(&mut window, "classic-3d");
    win(&mut window);
    let (outcome, is_best) = game(&mut window).won.expect("it was won");
    assert!(is_best && outcome.route == Route::Squeeze, "{outcome:?}");
    click(&mut window, "Save replay");
    game(&mut window).notices.clear();
    assert_eq!(files.replays().len(), 1);

    click(&mut window, "Race it");
    frames(&mut window, 30);
    let is_space = |round: &AnyRound| matches!(round, AnyRound::Space(_));
    let ghost = |window: &Window| {
        let ghost = window.state().game.session.ghost().expect("a ghost");
        assert!(is_space(ghost));
        (ghost.frames().len(), ghost.hands()[0].position())
    };
    let (ticks, at) = ghost(&window);
    let mine = window.state().game.session.round().hands()[0].position();
    assert!(
        ticks >= 28 && length(minus(at, mine)) > 0.1,
        "{ticks} {at:?} {mine:?}"
    );

    game(&mut window).go(Screen::Title);
    game(&mut window).go(Screen::Replays);
    frames(&mut window, 2);
    click(&mut window, "Watch");
    assert!(!game(&mut window).session.is_played());
    let before = goal(&window, 0);
    // Who watches looks on: the hand belongs to the replay.
    window.key_down(Key::Q);
    frames(&mut window, 5);
    window.key_up(Key::Q);
    assert!(!tells(&window, "Up and down"));
    let goes_on = |game: &Game| !game.session.is_over();
    drive(game(&mut window), tamaire_play::BotKind::Idle, goes_on);
    let game = game(&mut window);
    assert_eq!(game.session.round().progress().outcome, Some(outcome));
    assert!(game.notices.is_empty(), "{:?}", game.notices);
    assert!(length(minus(goal(&window, 0), before)) > 0.1);
    std::fs::remove_dir_all(folder).expect("it is ours");
}

#[test]
fn a_model_dropped_onto_any_round_is_played_in_space() {
    let mut window = window(Files::nowhere());
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join(MODEL);
    for level in ["classic", "hoop"] {
        start(&mut window, level);
        frames(&mut window, 10);
        drop_file(&mut window, model.clone());
        assert_eq!(
            (screen(&window), notices(&window).as_str()),
            (Screen::Play, ""),
            "{level}"
        );
        let round = window.state().game.session.round();
        assert!(matches!(round, AnyRound::Space(_)), "{level}");
        assert_eq!(round.level().game().name.en, "pudding");
        assert!(
            round.progress().mass > 0.0 && ticks(&window) <= 2,
            "{level}"
        );
        // It is offered once, however often it is dropped.
        let levels = &window.state().game.levels;
        let name = &round.level().id;
        assert_eq!(levels.iter().filter(|level| &level.id == name).count(), 1);
        point_at(&mut window, -1.0, 0.7);
        assert!(
            (goal(&window, 0)[2] - 0.7).abs() < 0.05,
            "{level}: it can be played"
        );
    }
}

#[test]
fn a_damaged_model_is_named_and_nothing_is_lost() {
    let folder = folder("vox");
    let whole =
        std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(MODEL)).expect("it comes along");
    let mut window = in_space();
    point_at(&mut window, -1.0, 0.7);
    let levels = window.state().game.levels.len();
    let mut size = whole.clone();
    // The number of voxels, far beyond the end of the file.
    let count = whole
        .windows(4)
        .position(|word| word == b"XYZI")
        .expect("it has voxels")
        + 12;
    size[count..count + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    let damaged: [(&str, &[u8], &str); 5] = [
        ("cut.vox", &whole[..whole.len() / 2], "cut.vox"),
        ("head.VOX", &whole[..3], "head.VOX"),
        ("empty.vox", b"", "empty.vox"),
        ("count.vox", &size, "count.vox"),
        (
            "picture.vox",
            b"\x89PNG\r\n\x1a\n and no model",
            "picture.vox",
        ),
    ];
    for (file, bytes, told) in damaged {
        let path = folder.join(file);
        std::fs::write(&path, bytes).expect("it is ours");
        let (before, at) = (ticks(&window), goal(&window, 0));
        drop_file(&mut window, path);
        let said = notices(&window);
        assert!(
            said.contains(told) && said.contains("expected"),
            "{file}: {said}"
        );
        assert_eq!(window.state().game.levels.len(), levels, "{file}");
        assert_eq!(screen(&window), Screen::Play, "{file}");
        assert!(ticks(&window) > before, "{file}: the round goes on");
        assert_near(goal(&window, 0), at);
    }
    std::fs::remove_dir_all(folder).expect("it is ours");
}
