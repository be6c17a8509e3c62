//! Tests of the appearance, which is compared with the pictures in `tests/snapshots`.

use crate::hostile::drop_file;
use crate::pads::about;
use crate::window::*;
use app_shell::Pads;
use egui::{Key, Vec2, pos2, vec2};
use egui_kittest::SnapshotOptions;
use egui_kittest::kittest::Queryable;
use force_feedback::{Ability, Recording};
use sticks::{Device, DeviceId, Pad, Snapshot};
use tamaire::game::Screen;
use tamaire::input::{Action, InputSource};
use tamaire::platform::Files;
use tamaire::words::Language;
use tamaire_play::{BotKind, Outcome, Route};

/// Permitted difference of a pixel, some ten of 256 grey levels. Drivers differ in antialiasing and colour
/// mixing.
const STEP: f32 = 50.0;
/// Permitted number of pixels that differ by more than [`STEP`]. The number is higher if a part of the screen
/// moved or is missing, or if the language is wrong.
const PIXELS: usize = 800;

/// Window size for detailed pictures [points], small to limit the size of the files.
const SMALLER: Vec2 = vec2(592.0, 370.0);

/// Outcome of an earlier win.
const WON: Outcome = Outcome {
    ticks: 600,
    route: Route::Squeeze,
    kept: 1.0,
    inside: 1.0,
    pieces: 1,
    lost: 0,
    broken: 0,
    torn: 0,
};

pub fn picture(window: &mut Window, name: &str) {
    let options = SnapshotOptions::new()
        .threshold(STEP)
        .max_failed_pixels(PIXELS);
    window.snapshot_options(name, &options);
}

/// Takes a picture in each language.
pub fn pictures(window: &mut Window, name: &str) {
    for (language, tag) in [(Language::English, "en"), (Language::Japanese, "ja")] {
        game(window).settings.language = language;
        // A new layout takes one frame to appear and one to be measured.
        frames(window, 3);
        picture(window, &format!("{name}_{tag}"));
    }
    game(window).settings.language = Language::English;
}

#[test]
fn screens_match_pictures() {
    let mut window = open(Files::nowhere(), vec2(704.0, 440.0), 1.0);
    drive(game(&mut window), BotKind::Idle, |game| game.time < 2.0);
    pictures(&mut window, "title");
    game(&mut window).go(Screen::Levels);
    // One thumbnail is rendered in each frame.
    let levels = game(&mut window).levels.len();
    frames(&mut window, levels);
    pictures(&mut window, "levels");
    game(&mut window).go(Screen::Settings);
    pictures(&mut window, "settings");
    game(&mut window).controls.pads = sticks_and_pads();
    game(&mut window).go(Screen::Forces);
    // The device thread reports the abilities of the devices within these frames.
    frames(&mut window, 5);
    pictures(&mut window, "forces");
    game(&mut window).controls.pads = Pads::none();
    frames(&mut window, 1);

    game(&mut window).start(0);
    // A key press shows the focus ring.
    press(&mut window, Key::P);
    pictures(&mut window, "paused");
    game(&mut window).go(Screen::Play);
    window.hover_at(pos2(10.0, 10.0));
    win(&mut window);
    pictures(&mut window, "result");
    own_level(&mut window);
}

#[test]
fn portrait_screens_match_pictures() {
    let mut window = open(Files::nowhere(), vec2(390.0, 844.0), 1.0);
    drive(game(&mut window), BotKind::Idle, |game| game.time < 2.0);
    pictures(&mut window, "upright_title");
    game(&mut window).go(Screen::Settings);
    pictures(&mut window, "upright_settings");
    game(&mut window).start(0);
    window.hover_at(pos2(10.0, 10.0));
    win(&mut window);
    pictures(&mut window, "upright_result");
    let link = game(&mut window).bout.round().replay().link();
    game(&mut window).open_link(&link.expect("the round of the bot fits into a link"));
    // One thumbnail is rendered in each frame.
    frames(&mut window, 20);
    pictures(&mut window, "upright_offered");
}

#[test]
fn playground_matches_pictures() {
    let mut window = open(Files::nowhere(), vec2(704.0, 440.0), 1.0);
    start(&mut window, "sandbox");
    frames(&mut window, 3);
    pictures(&mut window, "playground");
}

#[test]
fn portrait_playground_matches_picture() {
    let mut window = open(Files::nowhere(), vec2(390.0, 844.0), 1.0);
    start(&mut window, "sandbox-3d");
    window.get_by_label("Gravity, air, hand").click();
    frames(&mut window, 4);
    picture(&mut window, "upright_playground");
}

#[test]
fn ending_matches_pictures() {
    take_ending("ending", vec2(704.0, 440.0));
}

#[test]
fn portrait_ending_matches_pictures() {
    take_ending("upright_ending", vec2(390.0, 844.0));
}

fn take_ending(name: &str, size: Vec2) {
    let mut window = open(Files::nowhere(), size, 1.0);
    game(&mut window).settings.reduced_motion = true;
    for index in game(&mut window).path() {
        let level = game(&mut window).levels[index].clone();
        game(&mut window).records.note(&level, &WON, 0);
    }
    game(&mut window).show_ending();
    // One thumbnail is rendered in each frame.
    let levels = game(&mut window).levels.len();
    frames(&mut window, levels);
    press(&mut window, Key::Enter);
    frames(&mut window, 2);
    window.get_by_label_contains("Thank you for playing!");
    pictures(&mut window, name);
    press(&mut window, Key::Escape);
    frames(&mut window, 2);
    assert_eq!(game(&mut window).screen(), Screen::Levels);
}

/// Takes pictures of the list with a dropped level at its end, whose remove button was pressed once.
fn own_level(window: &mut Window) {
    drop_file(window, level_file("cat.png"));
    game(window).go(Screen::Levels);
    frames(window, 3);
    button(window, "Remove: cat").scroll_to_me();
    frames(window, 60);
    pictures(window, "own");
}

#[test]
fn saved_round_shows_route() {
    let folder = folder();
    let mut window = open(Files::in_folder(folder.path()), vec2(704.0, 440.0), 1.0);
    game(&mut window).start(0);
    win(&mut window);
    game(&mut window).keep_replay();
    game(&mut window).finish_writing();
    game(&mut window).notices.clear();
    game(&mut window).go(Screen::Replays);
    frames(&mut window, 20);
    window.get_by_label_contains("It went in whole!");
}

#[test]
fn touch_buttons_match_pictures() {
    let mut window = open(Files::nowhere(), vec2(704.0, 440.0), 1.0);
    for level in ["twins", "classic-3d"] {
        start(&mut window, level);
        let at = pos2(500.0, 300.0);
        touch(&mut window, 0, egui::TouchPhase::Start, at);
        frames(&mut window, 3);
        picture(&mut window, &format!("fingers_{level}"));
        touch(&mut window, 0, egui::TouchPhase::End, at);
    }
}

/// Returns a stick with force feedback and a pad with rumble, both at rest.
fn sticks_and_pads() -> Pads {
    let mut stick = Device::at_rest(DeviceId(1), about("Force Stick 3D"), 4, 12, 1);
    stick.axes = vec![0.6, -0.4, 0.2, -1.0];
    stick.buttons[4].down = true;
    let mut pad = Device::at_rest(DeviceId(2), about("Rumble Pad"), 6, 0, 0);
    pad.pad = Some(Pad::default());
    pad.axes[5] = -1.0;
    let abilities = [(stick.id, Ability::Force), (pad.id, Ability::Rumble)];
    let notes = abilities.map(|(id, ability)| (id, Recording::new(ability)));
    let devices = vec![stick, pad];
    Pads::of(Snapshot { devices }).noting(notes.into())
}

#[test]
fn round_2d_matches_picture() {
    let mut window = open(Files::nowhere(), SMALLER, 1.0);
    game(&mut window).start(0);
    drive(game(&mut window), BotKind::Squeeze, |game| {
        game.bout.round().frames().len() < 150
    });
    frames(&mut window, 1);
    picture(&mut window, "play");
}

#[test]
fn round_3d_matches_pictures() {
    let mut window = open(Files::nowhere(), SMALLER, 1.0);
    let classic = place_of(game(&mut window), "classic-3d");
    // No instructions are shown after a win.
    let level = game(&mut window).levels[classic].clone();
    game(&mut window).records.note(&level, &WON, 0);
    game(&mut window).start(classic);
    drive(game(&mut window), BotKind::Squeeze, |game| {
        game.bout.round().frames().len() < 120
    });
    frames(&mut window, 1);
    picture(&mut window, "space");
    game(&mut window).bout.elements = Some(fuwafuwa_render::frame::ElementColour::Level);
    game(&mut window).bout.opening.cut(0.05, 0.0, true);
    game(&mut window).bout.camera.orbit(0.5, 0.1);
    frames(&mut window, 1);
    picture(&mut window, "space_elements");
}

#[test]
fn tear_and_elements_match_pictures() {
    let mut window = open(Files::nowhere(), SMALLER, 1.0);
    game(&mut window).start(0);
    drive(game(&mut window), BotKind::Shave, |game| {
        game.bout.round().progress().pieces < 8
    });
    frames(&mut window, 1);
    picture(&mut window, "tear");
    for action in [Action::Elements, Action::Slow] {
        game(&mut window).act(action, InputSource::Keys);
    }
    pictures(&mut window, "elements");
}
