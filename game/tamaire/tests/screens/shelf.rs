//! List of saved rounds, and the optional race against the fastest one.

use crate::window::*;
use egui_kittest::kittest::Queryable;
use tamaire::game::Screen;
use tamaire::platform::{Files, Kind};
use tamaire::words::Language;
use tamaire_play::Route;

#[test]
fn saved_round_shows_level_date_and_result() {
    let folder = folder();
    let mut window = window(Files::in_folder(folder.path()));
    game(&mut window).start(0);
    win(&mut window);
    game(&mut window).keep_replay();
    game(&mut window).finish_writing();
    // An invalid replay stays in the list under its file name.
    std::fs::write(
        folder.path().join("replays/other-1.tamaire"),
        "version = 999\n",
    )
    .unwrap();
    game(&mut window).go(Screen::Replays);
    frames(&mut window, 6);
    let shelf = &window.state().game.shelf;
    let found = |name: &str| {
        let kept = shelf.iter().find(|kept| kept.entry.name == name).unwrap();
        kept.found.clone().expect("the replay was read")
    };
    assert!(found("other-1").is_none());
    let classic = found("classic-1").expect("the replay can be played");
    assert_eq!(classic.outcome.unwrap().route, Route::Squeeze);
    let level = &window.state().game.levels[0];
    assert!(std::sync::Arc::ptr_eq(&classic.level, level));
    // The label is, for example, "Classic 1, 2026-11-22 23:10, It went in whole! 9.7 s".
    window.get_by_label_contains("Classic 1, 20");
    let time = (Language::English.words().seconds)(classic.seconds);
    window.get_by_label_contains(&format!("It went in whole! {time}"));
}

#[test]
fn fastest_round_is_raced_when_enabled() {
    let folder = folder();
    let files = Files::in_folder(folder.path());
    let mut window = window(Files::in_folder(folder.path()));
    game(&mut window).start(0);
    win(&mut window);
    game(&mut window).finish_writing();
    let level = game(&mut window).levels[0].clone();
    let first = files.best(&level).expect("the file was saved").ticks();
    game(&mut window).start(0);
    let has_ghost = |window: &Window| window.state().game.bout.session.ghost().is_some();
    assert!(!has_ghost(&window), "racing the best round is off");
    game(&mut window).settings.race_best = true;
    game(&mut window).start(0);
    assert!(has_ghost(&window));
    game(&mut window).start(1);
    assert!(!has_ghost(&window), "no win in this level");

    // A slower win does not replace the fastest one.
    game(&mut window).start(0);
    frames(&mut window, 60);
    win(&mut window);
    game(&mut window).finish_writing();
    assert_eq!(files.best(&level).unwrap().ticks(), first);
    // An unreadable replay is no ghost.
    let path = folder.path().join("best/classic.tamaire");
    assert!(path.is_file() && Kind::Best.most_bytes() > 0);
    std::fs::write(path, "version = 1\n").unwrap();
    game(&mut window).start(0);
    assert!(!has_ghost(&window));
}
