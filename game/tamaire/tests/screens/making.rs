//! Drawing of bodies, and making, keeping and sending of levels.

use crate::window::*;
use app_shell::Clock;
use egui::{Event, Key, PointerButton, Pos2, Rect, TouchPhase, Vec2, pos2, vec2};
use egui_kittest::kittest::Queryable;
use fuwafuwa::{DEFAULT_TICK, Vec3};
use tamaire::game::{DrawingTool, Game, Screen};
use tamaire::platform::Files;
use tamaire::words::Language;
use tamaire_maker::drawing::{Brush, Drawing};
use tamaire_maker::items::{Item, Kind};
use tamaire_play::playground::Stuff;
use tamaire_play::{AnyRound, BotKind, Level, Link};

/// Sizes of the window in landscape and portrait orientation.
const SIZES: [Vec2; 2] = [vec2(1000.0, 640.0), vec2(390.0, 844.0)];

/// Draws with the mouse through points of the paper or the block, each from 0 to 1 from its upper left corner.
fn draw(window: &mut Window, sheet: &str, points: &[[f32; 2]]) {
    let rect = window.get_by_label(sheet).rect();
    let at = |[x, y]: [f32; 2]| rect.min + vec2(x, y) * rect.size();
    drag(
        window,
        &points.iter().map(|&point| at(point)).collect::<Vec<_>>(),
    );
}

/// Drags the mouse through points of the screen.
pub fn drag(window: &mut Window, points: &[Pos2]) {
    let [first, .., last] = points else {
        panic!("a drag has two points");
    };
    window.hover_at(*first);
    frames(window, 2);
    window.event(pointer_button(*first, PointerButton::Primary, true));
    frames(window, 1);
    for pair in points.windows(2) {
        for step in 1..=6 {
            window.event(Event::PointerMoved(
                pair[0].lerp(pair[1], step as f32 / 6.0),
            ));
            frames(window, 1);
        }
    }
    window.event(pointer_button(*last, PointerButton::Primary, false));
    frames(window, 2);
}

/// A closed curve, as shares of the paper.
fn ring() -> Vec<[f32; 2]> {
    let point = |k: usize| {
        let angle = std::f32::consts::TAU * k as f32 / 24.0;
        [0.5 + 0.3 * angle.cos(), 0.5 + 0.3 * angle.sin()]
    };
    (0..=24).map(point).collect()
}

fn bodies(window: &mut Window) -> usize {
    match game(window).bout.round() {
        AnyRound::Plane(round) => round.world().soft_bodies().count(),
        AnyRound::Space(round) => round.world().soft_bodies().count(),
    }
}

/// Returns the number of solid voxels of the first body of the round.
fn voxels(window: &mut Window) -> usize {
    match game(window).bout.round() {
        AnyRound::Plane(round) => {
            let (_, body) = round.world().soft_bodies().next().expect("there is a body");
            body.grid().solid_count()
        }
        AnyRound::Space(round) => {
            let (_, body) = round.world().soft_bodies().next().expect("there is a body");
            body.grid().solid_count()
        }
    }
}

#[test]
fn closed_line_is_dropped_with_all_its_cells_after_three_presses() {
    for size in SIZES {
        for language in [Language::English, Language::Japanese] {
            let mut window = open(Files::nowhere(), size, 1.0);
            game(&mut window).settings.language = language;
            frames(&mut window, 2);
            let words = language.making();
            click(&mut window, words.draw);
            draw(&mut window, words.paper, &ring());
            let drawn = game(&mut window).maker.paper.solid_count();
            assert!(drawn > 1000, "the closed line is filled: {drawn}");
            click(&mut window, words.drop);
            assert_eq!(screen(&window), Screen::Play);
            assert_eq!((bodies(&mut window), voxels(&mut window)), (1, drawn));
            frames(&mut window, 60);
            assert_eq!(game(&mut window).bout.round().progress().pieces, 1);
            press(&mut window, Key::Escape);
            click(&mut window, words.to_paper);
            assert_eq!(screen(&window), Screen::Paper);
            assert_eq!(game(&mut window).maker.paper.solid_count(), drawn);
        }
    }
}

#[test]
fn drawn_animal_stays_whole_after_its_drop() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    for stuff in Stuff::ALL {
        for is_solid in [false, true] {
            let game = game(&mut window);
            game.open_paper();
            game.maker.paper.clear();
            let mut line = |from: [f32; 2], to: [f32; 2], radius: f32| {
                let [from, to] = [from, to].map(|[x, y]| Vec3::new(x, y, 0.5));
                let brush = Brush::Draw(stuff.number());
                game.maker.paper.stroke(from, to, radius, brush);
            };
            line([20.0, 32.0], [42.0, 34.0], 9.0);
            line([44.0, 36.0], [52.0, 50.0], 5.0);
            line([20.0, 32.0], [6.0, 46.0], 2.5);
            line([22.0, 30.0], [22.0, 14.0], 3.0);
            line([40.0, 30.0], [40.0, 14.0], 3.0);
            game.maker.paper.end_stroke();
            match is_solid {
                true => game.maker.make_solid(Drawing::puffed),
                false => game.maker.show_block(false),
            }
            game.drop_drawing();
            assert_eq!(game.screen(), Screen::Play);
            (0..240).for_each(|_| game.update(DEFAULT_TICK));
            let progress = game.bout.round().progress();
            assert_eq!(progress.pieces, 1, "{stuff:?}, solid: {is_solid}");
            game.leave_round();
        }
    }
}

#[test]
fn each_tool_changes_the_paper_by_mouse() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    game(&mut window).open_paper();
    frames(&mut window, 2);
    draw(&mut window, "Paper", &[[0.2, 0.5], [0.8, 0.5]]);
    let line = game(&mut window).maker.paper.solid_count();
    window.get_by_label("Eraser").click();
    frames(&mut window, 2);
    draw(&mut window, "Paper", &[[0.5, 0.2], [0.5, 0.8]]);
    assert!(game(&mut window).maker.paper.solid_count() < line);
    assert_eq!(game(&mut window).maker.paper.pieces().count, 2);
    window.get_by_label("Undo").click();
    frames(&mut window, 2);
    assert_eq!(game(&mut window).maker.paper.solid_count(), line);
    window.get_by_label("Redo").click();
    frames(&mut window, 2);
    assert!(game(&mut window).maker.paper.solid_count() < line);
    window.get_by_label("New page").click();
    window.get_by_label("Heart").click();
    frames(&mut window, 2);
    window.get_by_label("Clay").click();
    frames(&mut window, 2);
    draw(&mut window, "Paper", &[[0.5, 0.5], [0.5, 0.5]]);
    let heart = game(&mut window).maker.paper.clone();
    assert!(heart.cells().contains(&4), "the clay is drawn");
    assert_eq!(
        game(&mut window).maker.tool,
        DrawingTool::Stamp(fuwafuwa_scenes::scene::Form::Heart)
    );
    window.get_by_label("Fill").click();
    window.get_by_label("Stone").click();
    frames(&mut window, 2);
    draw(&mut window, "Paper", &[[0.02, 0.02], [0.02, 0.02]]);
    assert_eq!(notices(&window), "Close the line first, then fill it.");
    draw(&mut window, "Paper", &[[0.5, 0.5], [0.5, 0.5]]);
    let filled = game(&mut window).maker.paper.clone();
    assert_eq!(filled.solid_count(), heart.solid_count());
    assert!(filled.cells().contains(&5) && !filled.cells().contains(&4));
}

#[test]
fn drawing_becomes_a_block_that_can_be_carved_and_dropped() {
    for name in ["Puff up", "Spin into a shape", "Make a slab"] {
        let mut window = open(Files::nowhere(), SIZES[0], 1.0);
        game(&mut window).open_paper();
        frames(&mut window, 2);
        draw(&mut window, "Paper", &ring());
        window.get_by_label(name).click();
        frames(&mut window, 3);
        assert!(game(&mut window).maker.shows_block);
        let made = game(&mut window).maker.block.solid_count();
        assert!(made > 500, "{name}: {made}");
        window.get_by_label("Eraser").click();
        frames(&mut window, 2);
        draw(&mut window, "Block", &[[0.5, 0.5], [0.52, 0.5]]);
        let carved = game(&mut window).maker.block.solid_count();
        assert!(carved < made && carved > 0, "{name}: {carved} of {made}");
        let before = game(&mut window).maker.angles;
        draw(&mut window, "Block", &[[0.03, 0.1], [0.2, 0.2]]);
        assert_ne!(
            game(&mut window).maker.angles,
            before,
            "a drag beside the block turns it"
        );
        assert_eq!(game(&mut window).maker.block.solid_count(), carved);
        click(&mut window, "Drop it!");
        assert_eq!(screen(&window), Screen::Play);
        assert_eq!(game(&mut window).bout.round().level().scene().dim, 3);
        assert_eq!(voxels(&mut window), carved);
        frames(&mut window, 30);
    }
}

#[test]
fn picture_comes_to_the_paper_with_a_slider() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    game(&mut window).open_paper();
    frames(&mut window, 2);
    crate::hostile::drop_file(&mut window, level_file("cat.png"));
    assert_eq!(screen(&window), Screen::Paper);
    let fine = game(&mut window).maker.paper.solid_count();
    assert!(fine > 500, "{fine}");
    window.get_by_label("Fineness").focus();
    frames(&mut window, 2);
    (0..6).for_each(|_| press(&mut window, Key::ArrowLeft));
    let coarse = game(&mut window).maker.paper.solid_count();
    assert!(coarse < fine / 2, "{coarse} of {fine}");
    click(&mut window, "Drop it!");
    assert_eq!(voxels(&mut window), coarse);
    press(&mut window, Key::M);
    assert_eq!(screen(&window), Screen::Paper);
}

#[test]
fn keys_and_one_switch_draw_without_a_pointer() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    game(&mut window).open_paper();
    frames(&mut window, 3);
    assert!(window.get_by_label("Paper").is_focused());
    press(&mut window, Key::Enter);
    press(&mut window, Key::Enter);
    (0..12).for_each(|_| press(&mut window, Key::ArrowRight));
    press(&mut window, Key::Enter);
    let drawn = game(&mut window)
        .maker
        .paper
        .bounds()
        .expect("something is drawn");
    assert!(drawn[1][0] - drawn[0][0] >= 12, "{drawn:?}");
    press(&mut window, Key::Escape);
    assert_eq!(
        screen(&window),
        Screen::Paper,
        "the first Escape leaves the pen"
    );
    press(&mut window, Key::Escape);
    assert_eq!(screen(&window), Screen::Title);

    let game_now = game(&mut window);
    game_now.settings.scanning = tamaire::input::Scanning::Quick;
    game_now.maker.paper.clear();
    game_now.open_paper();
    frames(&mut window, 2);
    window.get_by_label("Paper").focus();
    frames(&mut window, 1);
    for wait in [1, 30, 30] {
        window.key_press(Key::Space);
        frames(&mut window, wait);
    }
    frames(&mut window, 2);
    assert!(game(&mut window).maker.paper.solid_count() > 0);
    assert!(game(&mut window).maker.cursor.is_none());
    // Scanning goes on to the other buttons.
    frames(&mut window, 60);
    assert!(!window.get_by_label("Paper").is_focused());
}

#[test]
fn names_are_typed_with_spaces_and_deleted_letters() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    game(&mut window).clock = slow_clock();
    game(&mut window).edit_blank(2);
    game(&mut window).go(Screen::Finish);
    frames(&mut window, 3);
    window.get_by_label("Name").focus();
    frames(&mut window, 2);
    for _ in 0.."My level".len() {
        press(&mut window, Key::Backspace);
    }
    for letter in ["e", " ", "r", "m"] {
        window.event(Event::Text(letter.into()));
        frames(&mut window, 2);
    }
    press(&mut window, Key::Backspace);
    assert_eq!(screen(&window), Screen::Finish);
    assert_eq!(game(&mut window).draft_name(), "e r");
}

#[test]
fn levels_of_two_makers_with_the_same_id_stay_apart() {
    let made = |name: &str| {
        let mut window = open(Files::nowhere(), SIZES[0], 1.0);
        game(&mut window).edit_blank(2);
        game(&mut window).name_draft(name);
        assert!(game(&mut window).keep_draft());
        game(&mut window).leave_editor();
        window
    };
    let [mut one, mut other] = ["one", "other"].map(made);
    let [mine, sent] =
        [&mut one, &mut other].map(|window| game(window).levels.last().unwrap().clone());
    assert_eq!(mine.id, sent.id);
    one.event(Event::Paste(format!(
        "https://example.org/#{}",
        sent.link().unwrap()
    )));
    frames(&mut one, 3);
    click(&mut one, "Play");
    let game = game(&mut one);
    let ids = |game: &Game, name: &str| {
        let named = game.levels.iter();
        let named = named.filter(|level| level.game().name.en == name);
        named.map(|level| level.id.clone()).collect::<Vec<_>>()
    };
    assert_eq!(ids(game, "one"), std::slice::from_ref(&mine.id));
    assert_eq!(ids(game, "other").len(), 1);
    assert_ne!(ids(game, "other"), ids(game, "one"));
    // What others have made is changed as a copy.
    let place = game
        .levels
        .iter()
        .position(|level| level.game().name.en == "other")
        .unwrap();
    game.edit(place);
    game.name_draft("changed");
    assert!(game.keep_draft());
    let changed = game.levels.last().unwrap();
    assert_eq!(changed.game().changed_from.as_deref(), Some("other"));
    assert_eq!(ids(game, "other").len(), 1);
}

/// Returns a clock that goes on by a millisecond each time it is read, so that checks in the background take several
/// frames.
pub fn slow_clock() -> Clock {
    let time = std::cell::Cell::new(0.0);
    Clock::of(move || {
        time.set(time.get() + 0.001);
        time.get()
    })
}

/// Returns the middle of an item on the screen.
pub fn place_of_item(window: &mut Window, item: Item) -> Pos2 {
    let game = game(window);
    let [low, high] =
        tamaire_maker::items::bounds(game.maker.draft.scene(), item).expect("it has a place");
    game.bout
        .view
        .expect("the room is shown")
        .to_screen(0.5 * (low + high))
}

#[test]
fn level_is_built_tested_kept_and_sent_in_both_languages() {
    for language in [Language::English, Language::Japanese] {
        let folder = folder();
        let mut window = open(Files::in_folder(folder.path()), SIZES[0], 1.0);
        game(&mut window).settings.language = language;
        game(&mut window).clock = slow_clock();
        let words = language.making();
        game(&mut window).go(Screen::Levels);
        frames(&mut window, 3);
        click(&mut window, words.new_level);
        assert_eq!(screen(&window), Screen::Editor);
        for kind in [Kind::Basket, Kind::SeeSaw, Kind::Rope, Kind::Wind] {
            game(&mut window).select_nothing();
            frames(&mut window, 2);
            click(&mut window, (words.kind_name)(kind));
            frames(&mut window, 2);
            assert!(game(&mut window).maker.editor.problem.is_none(), "{kind:?}");
        }
        let scene = game(&mut window).maker.draft.scene().clone();
        assert!(
            scene
                .game
                .as_ref()
                .is_some_and(|game| game.basket.is_some())
        );
        assert!(!scene.joint.is_empty() && !scene.field.is_empty());
        // Drags the body, and takes it back.
        game(&mut window).select_nothing();
        frames(&mut window, 2);
        let from = place_of_item(&mut window, Item::Body(0));
        drag(&mut window, &[from, from + vec2(40.0, -60.0)]);
        let moved = game(&mut window).maker.draft.scene().body[0].at;
        assert_ne!(moved, scene.body[0].at);
        click(&mut window, words.undo);
        assert_eq!(game(&mut window).maker.draft.scene(), &scene);
        // Plays it.
        click(&mut window, words.test);
        assert_eq!(screen(&window), Screen::Play);
        frames(&mut window, 30);
        press(&mut window, Key::Escape);
        click(&mut window, words.to_editor);
        frames(&mut window, 60);
        assert_eq!(screen(&window), Screen::Editor);
        assert_eq!(game(&mut window).maker.draft.scene(), &scene);
        // Keeps and sends it.
        click(&mut window, words.finish);
        game(&mut window).name_draft("Mine");
        game(&mut window).settings.maker_name = "Mika\u{202e}".into();
        click(&mut window, words.keep);
        wait_for_files(&mut window);
        let kept = game(&mut window)
            .levels
            .last()
            .expect("there are levels")
            .clone();
        assert_eq!(language.of(&kept.game().name), "Mine");
        assert_eq!(kept.game().made_by.as_deref(), Some("Mika"));
        let stored = game(&mut window)
            .files
            .level_text(&kept.id)
            .expect("it is stored");
        let read = Level::read("read.toml", stored.as_bytes(), &|_| unreachable!()).unwrap();
        assert_eq!(read.scene(), kept.scene());
        let sent = kept.link().unwrap();
        let Ok(Link::Level(level)) = Link::read(&sent) else {
            panic!("{sent}");
        };
        assert_eq!(level.scene(), kept.scene());
        assert!(sent.len() <= 2500, "{}", sent.len());
        drop(window);
        // A friend sees who made it, and plays and changes it.
        let mut friend = open(Files::nowhere(), SIZES[0], 1.0);
        game(&mut friend).settings.language = language;
        friend.event(Event::Paste(format!("https://example.org/play/#{sent}")));
        frames(&mut friend, 3);
        assert_eq!(screen(&friend), Screen::Offered);
        friend.get_by_label(&(words.by)("Mika"));
        click(&mut friend, language.words().play);
        assert_eq!(screen(&friend), Screen::Play);
        press(&mut friend, Key::Escape);
        click(&mut friend, words.change_this);
        assert_eq!(game(&mut friend).maker.draft.scene(), kept.scene());
        let mut again = open(Files::in_folder(folder.path()), SIZES[0], 1.0);
        wait_for_files(&mut again);
        let game = game(&mut again);
        assert!(
            game.levels
                .iter()
                .any(|level| level.scene() == kept.scene())
        );
    }
}

#[test]
fn shipped_level_is_changed_and_removed_with_undo() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    game(&mut window).clock = slow_clock();
    start(&mut window, "classic");
    press(&mut window, Key::Escape);
    click(&mut window, "Change this level");
    assert_eq!(screen(&window), Screen::Editor);
    let classic = Level::open("classic").unwrap();
    assert_eq!(game(&mut window).maker.draft.scene(), classic.scene());
    let (_, text) = tamaire_play::level::built_in()
        .find(|(id, _)| *id == "classic")
        .unwrap();
    assert_eq!(game(&mut window).maker.draft.text(), text);
    let at = place_of_item(&mut window, Item::Body(0));
    drag(&mut window, &[at, at + vec2(30.0, 0.0)]);
    click(&mut window, "Finish");
    click(&mut window, "Keep");
    let own = game(&mut window).levels.last().unwrap().clone();
    assert_ne!(own.scene(), classic.scene());
    assert_eq!(own.game().changed_from.as_deref(), Some("Classic"));
    game(&mut window).go(Screen::Levels);
    frames(&mut window, 3);
    let name = own.game().name.en.clone();
    click(&mut window, &format!("Remove: {name}"));
    assert!(
        !game(&mut window)
            .levels
            .iter()
            .any(|level| level.id == own.id)
    );
    click(&mut window, &format!("Bring back {name}"));
    assert!(
        game(&mut window)
            .levels
            .iter()
            .any(|level| level.id == own.id)
    );
}

#[test]
fn selection_is_copied_turned_scaled_and_removed_by_buttons() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    game(&mut window).edit_blank(2);
    game(&mut window).add_thing(Kind::Wall);
    let wall = game(&mut window).maker.editor.selection[0];
    game(&mut window).select(wall);
    frames(&mut window, 2);
    let before = game(&mut window).maker.draft.scene().clone();
    click(&mut window, "Copy");
    click(&mut window, "Paste");
    let count = game(&mut window).maker.draft.scene().obstacle.len();
    assert_eq!(count, before.obstacle.len() + 1);
    click(&mut window, "Larger");
    click(&mut window, "Turn left");
    frames(&mut window, 2);
    click(&mut window, "Remove");
    assert_eq!(
        game(&mut window).maker.draft.scene().obstacle.len(),
        before.obstacle.len()
    );
    for _ in 0..4 {
        game(&mut window).undo_edit(false);
    }
    assert_eq!(game(&mut window).maker.draft.scene(), &before);
    // The last body stays.
    game(&mut window).select_all();
    game(&mut window).remove_selection();
    let scene = game(&mut window).maker.draft.scene();
    assert!(scene.body.len() == 1 && scene.hand.len() == 1);
    frames(&mut window, 2);
}

#[test]
fn finger_draws_and_builds_at_the_size_of_a_phone() {
    let mut window = open(Files::nowhere(), SIZES[1], 1.0);
    click(&mut window, "Draw");
    let rect: Rect = window.get_by_label("Paper").rect();
    let at = |x: f32, y: f32| rect.min + vec2(x, y) * rect.size();
    touch(&mut window, 0, TouchPhase::Start, at(0.2, 0.5));
    for k in 1..10 {
        touch(
            &mut window,
            0,
            TouchPhase::Move,
            at(0.2 + 0.06 * k as f32, 0.5),
        );
    }
    touch(&mut window, 0, TouchPhase::End, at(0.74, 0.5));
    frames(&mut window, 2);
    let drawn = game(&mut window).maker.paper.solid_count();
    assert!(drawn > 100, "{drawn}");
    click(&mut window, "Drop it!");
    press(&mut window, Key::Escape);
    click(&mut window, "Build a level");
    assert_eq!(screen(&window), Screen::Editor);
    game(&mut window).add_thing(Kind::Basket);
    frames(&mut window, 2);
    assert!(game(&mut window).maker.draft.level().is_ok());
}

#[test]
fn screens_of_making_match_pictures() {
    let mut results = egui_kittest::SnapshotResults::new();
    for (size, tag) in SIZES.into_iter().zip(["", "upright_"]) {
        let mut window = open(Files::nowhere(), size, 1.0);
        game(&mut window).settings.reduced_motion = true;
        game(&mut window).clock = slow_clock();
        game(&mut window).open_paper();
        frames(&mut window, 2);
        draw(&mut window, "Paper", &ring());
        game(&mut window).maker.crayon = 5;
        draw(&mut window, "Paper", &[[0.35, 0.4], [0.4, 0.42]]);
        game(&mut window).maker.crayon = 3;
        draw(&mut window, "Paper", &[[0.1, 0.1], [0.3, 0.1]]);
        window.hover_at(pos2(0.0, 0.0));
        // Each language is seen on some of the screens in each orientation.
        let picture = |window: &mut Window, language: Language, name: &str| {
            game(window).settings.language = language;
            frames(window, 3);
            crate::pictures::picture(window, &format!("{tag}{name}"));
            game(window).settings.language = Language::English;
        };
        let [one, other] = match tag {
            "" => [Language::English, Language::Japanese],
            _ => [Language::Japanese, Language::English],
        };
        picture(&mut window, one, "paper");
        if tag.is_empty() {
            game(&mut window).drop_drawing();
            drive(game(&mut window), BotKind::Idle, |game| {
                game.bout.round().ticks() < 30
            });
            picture(&mut window, one, "dropped");
            game(&mut window).leave_round();
        }
        game(&mut window).maker.make_solid(Drawing::puffed);
        picture(&mut window, other, "block");
        start(&mut window, "lever");
        game(&mut window).edit_current();
        frames(&mut window, 3);
        if tag.is_empty() {
            game(&mut window).select(Item::Body(0));
        }
        picture(&mut window, one, "editor");
        game(&mut window).select_nothing();
        game(&mut window).go(Screen::Properties);
        picture(&mut window, other, "properties");
        game(&mut window).go(Screen::Editor);
        game(&mut window).go(Screen::Finish);
        frames(&mut window, 2);
        picture(&mut window, one, "finish");
        results.extend(window.take_snapshot_results());
    }
}

#[test]
fn copy_of_a_level_of_others_tells_its_origin() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    let game = game(&mut window);
    let mut scene = Level::open("sandbox").unwrap().scene().clone();
    let rules = scene.game.as_mut().unwrap();
    (rules.name.en, rules.made_by) = ("Theirs".into(), Some("Mika".into()));
    let level = Level::from_scene("my-level-1", scene).unwrap();
    let sent = level.link().unwrap();
    game.open_link(&format!("https://example.org/#{sent}"));
    game.play_offered();
    let theirs = game.levels.last().unwrap().clone();
    assert!(!theirs.id.starts_with("my-level-"), "{}", theirs.id);
    game.duplicate(game.levels.len() - 1);
    let copy = game.levels.last().unwrap();
    assert_eq!(copy.game().name.en, "Theirs 2");
    assert_eq!(copy.game().changed_from.as_deref(), Some("Theirs (Mika)"));
    assert_eq!(copy.game().made_by.as_deref(), Some("Mika"));
}

#[test]
fn escape_leaves_the_editor_after_presses_by_pointer() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    game(&mut window).edit_blank(2);
    frames(&mut window, 2);
    let at = place_of_item(&mut window, Item::Body(0));
    window.hover_at(at);
    window.event(pointer_button(at, PointerButton::Primary, true));
    frames(&mut window, 1);
    window.event(pointer_button(at, PointerButton::Primary, false));
    frames(&mut window, 2);
    assert_eq!(game(&mut window).maker.editor.selection, [Item::Body(0)]);
    click(&mut window, "Larger");
    for _ in 0..3 {
        press(&mut window, Key::Escape);
    }
    assert_ne!(screen(&window), Screen::Editor);
}

#[test]
fn level_without_a_name_is_not_kept() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    let game = game(&mut window);
    game.edit_blank(2);
    game.name_draft("");
    let count = game.levels.len();
    assert!(!game.keep_draft());
    assert_eq!(game.levels.len(), count);
    let words = game.making();
    assert!(
        game.notices
            .iter()
            .any(|notice| notice.text == words.needs_name)
    );
}

#[test]
fn colours_of_a_picture_stay_after_another_one_and_undo() {
    let mut window = open(Files::nowhere(), SIZES[0], 1.0);
    let game = game(&mut window);
    game.open_paper();
    let bytes = std::fs::read(level_file("cat.png")).unwrap();
    game.draw_picture("cat.png".into(), bytes.clone());
    let colours = |game: &Game| {
        let cells = game.maker.paper.cells().iter();
        cells
            .map(|&cell| game.maker.palette.colour(cell))
            .collect::<Vec<_>>()
    };
    let before = colours(game);
    game.redraw_picture(24, false);
    assert_ne!(colours(game), before);
    assert!(game.maker.paper.undo());
    assert_eq!(colours(game), before);
}
