//! Checks on the page on which a level is finished.

use crate::told::tells;
use crate::window::*;
use app_shell::Clock;
use egui::accesskit::Role;
use egui::{Event, Key, Rect, Shape, Vec2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use fuwafuwa_scenes::Scene;
use std::cell::Cell;
use std::sync::Arc;
use tamaire::game::Screen;
use tamaire::platform::Files;
use tamaire_play::Level;
use tamaire_play::level::NAMED;

/// Returns the progress of the checks as it is told [%]. `None` = no progress is shown.
fn progress(window: &Window) -> Option<u32> {
    let bar = window.query_by_role(Role::ProgressIndicator)?;
    let label = bar.accesskit_node().label()?;
    label.strip_suffix(" %")?.parse().ok()
}

#[test]
fn checks_show_their_progress_until_all_is_found() {
    let (id, text) = NAMED[0];
    let scene = Scene::read(id, text, &["body.n=6".to_string()]).unwrap();
    let level = Arc::new(Level::from_scene("small", scene).unwrap());
    // A tick takes two readings of the clock. The time that the maker needs is not measured with it.
    for (reading, is_quick) in [(0.0002, true), (0.01, false)] {
        let mut window = open(Files::nowhere(), vec2(1000.0, 1400.0), 0.25);
        let words = window.state().game.making();
        let [squeezed, shaved] = words.can_be;
        game(&mut window).edit_level(&level);
        game(&mut window).test_level();
        win(&mut window);
        game(&mut window).go(Screen::Editor);
        let now = Cell::new(0.0);
        game(&mut window).clock = Clock::of(move || {
            now.set(now.get() + reading);
            now.get()
        });
        game(&mut window).go(Screen::Finish);
        frames(&mut window, 2);
        for open in [squeezed, shaved, words.real_time] {
            window.get_by_label(&format!("…  {open}"));
        }
        let mut shares = vec![progress(&window).expect("the progress is shown")];
        while let Some(share) = progress(&window) {
            shares.push(share);
            frames(&mut window, 1);
            assert!(shares.len() < 20_000);
        }
        assert!(shares.is_sorted() && shares[0] < 10, "{shares:?}");
        shares.dedup();
        assert!(
            shares.len() > 20 && *shares.last().unwrap() > 80,
            "{shares:?}"
        );
        assert!(!tells(&window, "…"));
        assert!(tells(&window, &format!("✓  {squeezed}  ")));
        assert!(tells(&window, &format!("✓  {}  ", words.won_by_maker)));
        let real_time = match is_quick {
            true => format!("✓  {}", words.real_time),
            false => format!("•  {}", words.not_real_time),
        };
        window.get_by_label(&real_time);
    }
}

/// Returns a small level with a change of its text.
fn small(change: &str) -> Arc<Level> {
    let (id, text) = NAMED[0];
    let changes = ["body.n=6".to_string(), change.to_string()];
    let scene = Scene::read(id, text, &changes).unwrap();
    Arc::new(Level::from_scene("small", scene).unwrap())
}

/// Opens the editor with a level, and wins it in a test.
fn editor_after_win(files: Files, level: &Level) -> Window {
    let mut window = open(files, vec2(1000.0, 1400.0), 0.25);
    game(&mut window).edit_level(level);
    game(&mut window).test_level();
    win(&mut window);
    game(&mut window).go(Screen::Editor);
    window
}

#[test]
fn win_in_a_test_is_a_record_of_the_kept_level_and_of_no_other_version() {
    let folder = folder();
    let mut window = editor_after_win(Files::in_folder(folder.path()), &small("body.n=6"));
    let words = window.state().game.making();
    // What the page says about a win, and whether the level in the list is won.
    let wins = |window: &mut Window| {
        game(window).go(Screen::Finish);
        frames(window, 3);
        let is_told = tells(window, &format!("✓  {}", words.won_by_maker));
        assert_eq!(!is_told, tells(window, words.not_won_by_maker));
        assert!(game(window).keep_draft());
        let game = game(window);
        let level = game.levels.last().unwrap();
        let record = game.records.of_level(level);
        let is_won = record.is_some_and(|record| record.is_won());
        let id = level.id.clone();
        game.go(Screen::Editor);
        (id, is_told, is_won)
    };
    let id = "my-level-1".to_string();
    assert_eq!(wins(&mut window), (id.clone(), true, true));
    let change = |window: &mut Window, by: f32| {
        game(window).change_level(|scene| scene.body[0].at[0] += by);
    };
    change(&mut window, 0.125);
    assert_eq!(wins(&mut window), (id.clone(), false, false));
    game(&mut window).name_draft("another name");
    assert_eq!(wins(&mut window), (id.clone(), false, false));
    // The first version has its record again.
    change(&mut window, -0.125);
    assert_eq!(wins(&mut window), (id.clone(), true, true));
    change(&mut window, 0.125);
    assert_eq!(wins(&mut window), (id.clone(), false, false));
    wait_for_files(&mut window);
    drop(window);
    let mut again = crate::window::window(Files::in_folder(folder.path()));
    wait_for_files(&mut again);
    let game = game(&mut again);
    let level = game.levels.last().unwrap().clone();
    assert_eq!(level.id, id);
    assert!(
        !game
            .records
            .of_level(&level)
            .is_some_and(|record| record.is_won())
    );
}

#[test]
fn win_in_the_list_is_told_on_the_last_page() {
    let mut window = open(Files::nowhere(), vec2(1000.0, 1400.0), 0.25);
    game(&mut window).edit_level(&small("body.n=6"));
    assert!(game(&mut window).keep_draft());
    game(&mut window).leave_editor();
    let last = game(&mut window).levels.len() - 1;
    game(&mut window).start(last);
    win(&mut window);
    game(&mut window).edit(last);
    game(&mut window).go(Screen::Finish);
    frames(&mut window, 3);
    let words = window.state().game.making();
    assert!(tells(&window, &format!("✓  {}", words.won_by_maker)));
}

#[test]
fn level_that_its_maker_won_whole_can_be_squeezed_in() {
    // Bots give up before the body was in the basket for this time.
    let mut window = editor_after_win(Files::nowhere(), &small("game.hold=44.0"));
    let words = window.state().game.making();
    let [squeezed, _] = words.can_be;
    for is_won in [true, false] {
        game(&mut window).go(Screen::Finish);
        frames(&mut window, 4);
        assert_eq!(progress(&window), None, "the checks are finished");
        assert_eq!(tells(&window, &format!("✓  {squeezed}")), is_won);
        assert_eq!(!tells(&window, words.not_found[0]), is_won);
        game(&mut window).go(Screen::Editor);
        game(&mut window).change_level(|scene| scene.body[0].at[0] -= 0.01);
    }
}

/// Returns the rectangles of all buttons of a page.
fn places(window: &Window) -> Vec<(String, Rect)> {
    let buttons = window.query_all_by_role(Role::Button);
    let named = buttons.filter_map(|button| {
        let name = button.accesskit_node().label()?;
        Some((name, button.rect()))
    });
    named.collect()
}

#[test]
fn message_moves_no_button_of_the_pages_about_own_levels() {
    for size in [vec2(1000.0, 640.0), vec2(390.0, 844.0)] {
        let mut window = open(Files::nowhere(), size, 1.0);
        game(&mut window).edit_level(&small("body.n=6"));
        assert!(game(&mut window).keep_draft());
        let words = window.state().game.making();
        let name = game(&mut window)
            .levels
            .last()
            .unwrap()
            .game()
            .name
            .en
            .clone();
        let pages = [
            (Screen::Finish, words.save_file.to_string()),
            (Screen::Levels, format!("{}: {name}", words.remove)),
        ];
        for (page, last) in pages {
            game(&mut window).notices.clear();
            game(&mut window).go(page);
            frames(&mut window, 3);
            button(&window, &last).scroll_to_me();
            frames(&mut window, 30);
            let before = places(&window);
            for text in [
                words.kept.to_string(),
                format!("{} ", words.still_open).repeat(4),
            ] {
                game(&mut window).notify(text.clone());
                frames(&mut window, 20);
                assert!(tells(&window, words.kept) || tells(&window, words.still_open));
                assert_eq!(places(&window), before, "{page:?}, {size}: {text}");
            }
        }
    }
}

/// Returns the number of frames around a text field.
fn field_frames(window: &Window, field: Rect) -> usize {
    let shapes = window.output().shapes.iter();
    let frames = shapes.filter(|clipped| match &clipped.shape {
        Shape::Rect(rect) => {
            rect.stroke.width >= 3.0 && rect.rect.center().distance(field.center()) < 1.0
        }
        _ => false,
    });
    frames.count()
}

#[test]
fn enter_leaves_the_name_which_has_a_frame_before() {
    let mut window = open(Files::nowhere(), Vec2::new(1000.0, 640.0), 1.0);
    game(&mut window).edit_blank(2);
    game(&mut window).go(Screen::Finish);
    frames(&mut window, 3);
    let name = |window: &Window| window.get_by_label("Name").rect();
    let field = name(&window);
    assert_eq!(field_frames(&window, field), 0);
    window.get_by_label("Name").focus();
    frames(&mut window, 2);
    assert_eq!(field_frames(&window, field), 1);
    window.event(Event::Text("x".into()));
    frames(&mut window, 2);
    press(&mut window, Key::Enter);
    frames(&mut window, 3);
    assert_eq!(screen(&window), Screen::Finish);
    assert_eq!(game(&mut window).draft_name(), "My levelx");
    for other in ["Name", "Back", "Made by", "Keep"] {
        assert!(!window.get_by_label(other).is_focused(), "{other}");
    }
    assert_eq!(field_frames(&window, field), 0);
    // Keys go on from there.
    press(&mut window, Key::Tab);
    assert!(window.get_by_label("Name").is_focused());
    press(&mut window, Key::Tab);
    assert!(window.get_by_label("Made by").is_focused());
    // Another page begins as usual.
    press(&mut window, Key::Enter);
    press(&mut window, Key::Escape);
    game(&mut window).go(Screen::Settings);
    frames(&mut window, 3);
    assert!(window.get_by_label("Back").is_focused());
}
