//! Ways back from the editor: to the paper, to the list of levels, and to a round.

use crate::making::slow_clock;
use crate::window::*;
use egui::{Event, Key, vec2};
use egui_kittest::kittest::Queryable;
use fuwafuwa::Vec3;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::MaterialText;
use std::fs;
use std::sync::Arc;
use tamaire::game::{Game, Screen};
use tamaire::platform::Files;
use tamaire_maker::drawing::{Brush, Drawing};
use tamaire_maker::palette::crayon;
use tamaire_play::level::NAMED;
use tamaire_play::playground::Stuff;
use tamaire_play::{Level, Replay};

/// Opens a window in which levels are edited.
fn editor() -> Window {
    let mut window = open(Files::nowhere(), vec2(1000.0, 640.0), 1.0);
    game(&mut window).clock = slow_clock();
    window
}

/// Returns the player's own levels.
fn own(window: &mut Window) -> Vec<Arc<Level>> {
    let game = game(window);
    let own = (0..game.levels.len()).filter(|&index| game.is_own(index));
    own.map(|index| game.levels[index].clone()).collect()
}

/// Adds an own level with this name.
fn make(window: &mut Window, name: &str) {
    let game = game(window);
    game.edit_blank(2);
    game.name_draft(name);
    assert!(game.keep_draft());
    game.leave_editor();
    game.notices.clear();
}

/// Moves the first body of the level in the editor.
fn change(game: &mut Game) {
    game.change_level(|scene| scene.body[0].at[0] += 0.05);
}

fn stroke(sheet: &mut Drawing, crayon: u8, middle: Vec3) {
    let brush = Brush::Draw(crayon);
    sheet.stroke(middle - 4.0 * Vec3::X, middle + 4.0 * Vec3::X, 3.0, brush);
    sheet.end_stroke();
}

#[test]
fn sheets_of_the_paper_come_back_from_the_editor() {
    let cat = fs::read(level_file("cat.png")).unwrap();
    for shows_block in [false, true] {
        let mut window = editor();
        let now = game(&mut window);
        now.open_paper();
        // A material that is no crayon, as a picture may bring it.
        let gold = MaterialText {
            colour: Some([212, 175, 55]),
            ..crayon(Stuff::Clay)
        };
        let gold = now.maker.palette.number_of(&gold).unwrap();
        stroke(&mut now.maker.paper, gold, Vec3::splat(20.0));
        now.draw_picture("cat.png".into(), cat.clone());
        if shows_block {
            now.maker.make_solid(Drawing::puffed);
            stroke(&mut now.maker.block, gold, Vec3::splat(16.0));
        }
        let sheets = |game: &Game| {
            let maker = &game.maker;
            (
                maker.paper.clone(),
                maker.block.clone(),
                maker.palette.clone(),
            )
        };
        let before = sheets(game(&mut window));
        frames(&mut window, 2);
        click(&mut window, "Build a level");
        assert_eq!(screen(&window), Screen::Editor);
        // Another body is drawn for the level, on the same sheets.
        let now = game(&mut window);
        now.draw_new_body();
        stroke(now.maker.drawing_mut(), 1, Vec3::splat(10.0));
        now.drop_drawing();
        assert!(sheets(now) != before);
        frames(&mut window, 2);
        click(&mut window, "Back");
        assert_eq!(screen(&window), Screen::Paper);
        let now = game(&mut window);
        assert!(sheets(now) == before && now.maker.shows_block == shows_block);
        assert!(now.maker.is_alone());
        // The picture can still be made coarser.
        assert_eq!(now.maker.picture.is_some(), !shows_block);
        // The steps of undo are there.
        let sheet = now.maker.drawing_mut();
        assert!(sheet.undo() && sheet.undo() && sheet.is_empty());
        assert_eq!(own(&mut window).len(), 1);
        click(&mut window, "Back");
        assert_eq!(screen(&window), Screen::Title);
    }
}

#[test]
fn renaming_leads_back_to_the_list() {
    let mut window = editor();
    for name in ["one", "two"] {
        make(&mut window, name);
    }
    game(&mut window).go(Screen::Levels);
    frames(&mut window, 3);
    let before = own(&mut window);
    for by_key in [false, true] {
        click(&mut window, "Rename: one");
        assert_eq!(screen(&window), Screen::Finish);
        assert!(window.get_by_label("Name").is_focused());
        match by_key {
            true => press(&mut window, Key::Escape),
            false => click(&mut window, "Back"),
        }
        assert_eq!(screen(&window), Screen::Levels);
        assert_eq!(
            (own(&mut window), notices(&window).as_str()),
            (before.clone(), "")
        );
    }
    // A typed name changes the level in its place.
    click(&mut window, "Rename: one");
    window.event(Event::Text("s".into()));
    frames(&mut window, 2);
    press(&mut window, Key::Escape);
    assert_eq!(screen(&window), Screen::Levels);
    let now = own(&mut window);
    let named = |level: &Level| (level.id.clone(), level.game().name.en.clone());
    assert_eq!(named(&now[0]), (before[0].id.clone(), "ones".into()));
    assert_eq!(now[1..], before[1..]);
    // After that, the page leads to the editor again.
    click(&mut window, "Change: ones");
    click(&mut window, "Finish");
    click(&mut window, "Back");
    assert_eq!(screen(&window), Screen::Editor);
}

#[test]
fn editor_of_a_round_leads_back_to_its_pause_menu() {
    let mut window = editor();
    start(&mut window, "classic");
    press(&mut window, Key::Escape);
    click(&mut window, "Change this level");
    assert_eq!(screen(&window), Screen::Editor);
    click(&mut window, "Back");
    assert_eq!(screen(&window), Screen::Paused);
    let classic = game(&mut window).bout.round().level().clone();
    assert_eq!(classic.scene(), Level::open("classic").unwrap().scene());
    assert_eq!(own(&mut window).len(), 0);
    // A changed copy is kept beside the level of the round.
    click(&mut window, "Change this level");
    change(game(&mut window));
    click(&mut window, "Back");
    assert!(game(&mut window).bout.round().level() == &classic);
    assert_eq!(own(&mut window).len(), 1);
    // An own level is played as it was changed.
    let id = own(&mut window)[0].id.clone();
    start(&mut window, &id);
    press(&mut window, Key::Escape);
    click(&mut window, "Change this level");
    change(game(&mut window));
    click(&mut window, "Back");
    assert_eq!(screen(&window), Screen::Paused);
    let kept = own(&mut window);
    assert_eq!(kept.len(), 1);
    assert!(game(&mut window).bout.round().level() == &kept[0]);
    click(&mut window, "Resume");
    assert_eq!(screen(&window), Screen::Play);
}

#[test]
fn editor_of_a_watched_round_leads_back_to_the_replay() {
    let mut window = editor();
    let (id, text) = NAMED[0];
    let scene = Scene::read(id, text, &["body.n=6".to_string()]).unwrap();
    let level = Arc::new(Level::from_scene("sent", scene).unwrap());
    let mut round = tamaire_play::AnyRound::new(level.clone());
    round.play(
        &mut tamaire_play::Bot::new(tamaire_play::BotKind::Random, 1),
        60,
    );
    let replay: Arc<Replay> = Arc::new(round.replay());
    for is_raced in [false, true] {
        let now = game(&mut window);
        match is_raced {
            true => now.race(replay.clone()).unwrap(),
            false => now.watch(replay.clone()).unwrap(),
        }
        now.go(Screen::Paused);
        frames(&mut window, 2);
        click(&mut window, "Change this level");
        assert_eq!(screen(&window), Screen::Editor);
        click(&mut window, "Back");
        assert_eq!(screen(&window), Screen::Paused);
        let session = &game(&mut window).bout.session;
        assert_eq!(session.is_played(), is_raced);
        assert_eq!(session.ghost().is_some(), is_raced);
        assert_eq!(session.round().level().scene(), level.scene());
    }
}
