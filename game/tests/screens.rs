//! The game in a window that nobody sees: what can be clicked, pressed and read, and how it looks.
//! Pictures are drawn by software (Mesa's llvmpipe) and compared with those in `tests/snapshots`;
//! `UPDATE_SNAPSHOTS=1 cargo test -p tamaire` draws them anew.

use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, SnapshotOptions};
use tamaire::app::App;
use tamaire::game::{Game, Screen};
use tamaire::platform::{Files, Pads, Sound};
use tamaire::words::Language;

/// A window of the size of a small tablet, with settings and replays in a folder of its own.
fn window(files: Files) -> Harness<'static, App> {
    let builder = Harness::builder().with_size(egui::vec2(1024.0, 640.0)).wgpu();
    let builder = builder.with_step_dt(1.0 / 60.0);
    builder.build_eframe(|context| {
        let game = Game::new(files, Sound::none(), Pads::none());
        App::new(context, game).expect("there is a GPU in software")
    })
}

/// Lets frames pass; the game never stands still, so there is no waiting for it.
fn frames(window: &mut Harness<'_, App>, count: usize) {
    window.run_steps(count);
}

/// Clicks what has a name.
fn click(window: &mut Harness<'_, App>, name: &str) {
    window.get_by_label(name).click();
    frames(window, 2);
}

fn picture(window: &mut Harness<'_, App>, name: &str) {
    // Another driver rounds corners another way: single pixels may differ, shapes may not.
    let options = SnapshotOptions::new().threshold(2.0).max_failed_pixels(400);
    window.snapshot_options(name, &options);
}

#[test]
fn from_the_title_to_a_round_and_back_by_clicks() {
    let mut window = window(Files::nowhere());
    frames(&mut window, 3);
    click(&mut window, "Play");
    assert_eq!(window.state().game.screen, Screen::Levels);
    click(&mut window, "Classic");
    assert_eq!(window.state().game.screen, Screen::Play);
    frames(&mut window, 10);
    assert!(window.state().game.session.round().frames().len() >= 8);
    window.key_press(egui::Key::Escape);
    frames(&mut window, 2);
    assert_eq!(window.state().game.screen, Screen::Paused);
    let before = window.state().game.session.round().frames().len();
    frames(&mut window, 10);
    assert_eq!(window.state().game.session.round().frames().len(), before);
    click(&mut window, "Again");
    assert_eq!(window.state().game.screen, Screen::Play);
    assert!(window.state().game.session.round().frames().len() < 5);
}

#[test]
fn every_screen_in_both_languages() {
    for language in [Language::English, Language::Japanese] {
        let mut window = window(Files::nowhere());
        window.state_mut().game.settings.language = language;
        let tag = match language {
            Language::English => "en",
            Language::Japanese => "ja",
        };
        frames(&mut window, 60);
        picture(&mut window, &format!("title_{tag}"));
        window.state_mut().game.go(Screen::Levels);
        frames(&mut window, 20);
        picture(&mut window, &format!("levels_{tag}"));
        window.state_mut().game.go(Screen::Settings(Box::new(Screen::Title)));
        frames(&mut window, 20);
        picture(&mut window, &format!("settings_{tag}"));
    }
}
