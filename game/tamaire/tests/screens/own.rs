//! Levels added by the player.

use crate::hostile::drop_file;
use crate::window::*;
use egui::Key;
use egui_kittest::kittest::Queryable;
use std::fs;
use std::path::PathBuf;
use tamaire::game::{Game, ListEntry, Screen};
use tamaire::platform::Files;
use tamaire_maker::items::Kind;

/// Picture file to drop onto the window.
fn cat() -> PathBuf {
    level_file("cat.png")
}

/// Returns the ids of the player's own levels once all have been read.
fn own(window: &mut Window) -> Vec<String> {
    wait_for_files(window);
    let game = game(window);
    let places = (0..game.levels.len()).filter(|&place| game.is_own(place));
    places.map(|place| game.levels[place].id.clone()).collect()
}

#[test]
fn dropped_level_is_saved_until_removed() {
    let folder = folder();
    let begin = || window(Files::in_folder(folder.path()));
    let mut first = begin();
    drop_file(&mut first, cat());
    assert_eq!(screen(&first), Screen::Play);
    win(&mut first);
    assert_eq!(own(&mut first), ["cat.png"]);
    let dropped = game(&mut first).bout.round().level().clone();
    drop(first);

    let mut again = begin();
    assert_eq!(own(&mut again), ["cat.png"]);
    assert!(game(&mut again).levels.contains(&dropped));
    game(&mut again).go(Screen::Levels);
    frames(&mut again, 2);
    click(&mut again, "Remove: cat");
    assert_eq!(own(&mut again).len(), 0);
    click(&mut again, "Bring back cat");
    assert_eq!(own(&mut again), ["cat.png"], "removal can be undone");
    click(&mut again, "Remove: cat");
    assert_eq!(own(&mut again).len(), 0);
    assert_eq!(screen(&again), Screen::Levels);
    drop(again);

    let mut last = begin();
    assert_eq!(own(&mut last).len(), 0);
    assert!(game(&mut last).records.of("cat.png").is_some());
    assert!(cat().exists(), "the original picture is not deleted");
}

#[test]
fn level_is_removed_and_brought_back_by_keys() {
    let mut window = window(Files::nowhere());
    drop_file(&mut window, cat());
    game(&mut window).go(Screen::Levels);
    frames(&mut window, 3);
    for (name, count) in [("Remove: cat", 0), ("Bring back cat", 1)] {
        for _ in 0..200 {
            if window.get_by_label(name).is_focused() {
                break;
            }
            press(&mut window, Key::Tab);
        }
        assert!(window.get_by_label(name).is_focused(), "{name}");
        press(&mut window, Key::Enter);
        assert_eq!(own(&mut window).len(), count);
    }
    let chosen = game(&mut window).chosen;
    assert!(chosen < game(&mut window).levels.len());
}

#[test]
fn damaged_saved_level_is_moved_and_reported_once() {
    let folder = folder();
    let begin = || window(Files::in_folder(folder.path()));
    let mut first = begin();
    drop_file(&mut first, cat());
    assert_eq!(own(&mut first).len(), 1);
    drop(first);
    let levels = folder.path().join("levels");
    let good = fs::read_to_string(levels.join("cat.png.toml")).unwrap();
    let body = good
        .find("content = ")
        .expect("the level contains its picture");
    for (name, text) in [
        ("cut.png.toml", &good[..body]),
        ("classic.toml", &good),
        ("large.toml", &good.replacen("n = ", "n = 100000", 1)),
    ] {
        fs::write(levels.join(name), text).unwrap();
    }
    let mut again = begin();
    assert_eq!(own(&mut again), ["cat.png"]);
    let told = notices(&again);
    for name in ["cut.png", "classic", "large"] {
        let aside = levels.join(format!("{name}.broken-1.toml"));
        assert!(
            aside.exists() && told.contains(aside.to_str().unwrap()),
            "{told}"
        );
    }
    drop(again);
    let mut last = begin();
    assert_eq!((own(&mut last).len(), notices(&last).as_str()), (1, ""));
}

#[test]
fn two_games_at_once_lose_no_level() {
    let folder = folder();
    let other = folder.path().join("other.png");
    fs::copy(cat(), &other).unwrap();
    let begin = || window(Files::in_folder(folder.path()));
    let mut windows = [begin(), begin()];
    for (window, file) in windows.iter_mut().zip([cat(), other]) {
        drop_file(window, file);
        wait_for_files(window);
    }
    drop(windows);
    let mut ids = own(&mut begin());
    ids.sort();
    assert_eq!(ids, ["cat.png", "other.png"]);
}

/// Keeps levels with these names, and opens the list.
fn list_of(names: &[&str]) -> Window {
    let mut window = open(Files::nowhere(), egui::vec2(1000.0, 640.0), 1.0);
    for name in names {
        let game = game(&mut window);
        game.edit_blank(2);
        game.add_thing(Kind::Basket);
        game.name_draft(name);
        assert!(game.keep_draft());
        game.leave_editor();
    }
    game(&mut window).notices.clear();
    game(&mut window).go(Screen::Levels);
    frames(&mut window, 3);
    window
}

/// Returns the names of the player's own levels.
fn names(window: &mut Window) -> Vec<String> {
    let game = game(window);
    let own = (0..game.levels.len()).filter(|&place| game.is_own(place));
    own.map(|place| game.levels[place].game().name.en.clone())
        .collect()
}

fn own_count(game: &Game) -> usize {
    (0..game.levels.len())
        .filter(|&place| game.is_own(place))
        .count()
}

#[test]
fn double_press_of_remove_removes_one_level() {
    let mut window = list_of(&["a", "b", "c"]);
    button(&window, "Remove: a").scroll_to_me();
    frames(&mut window, 30);
    let at = button(&window, "Remove: a").rect().center();
    let others = |window: &Window| {
        ["Remove: b", "Change: b", "Remove: c"].map(|name| button(window, name).rect())
    };
    let before = others(&window);
    for _ in 0..2 {
        window.hover_at(at);
        frames(&mut window, 1);
        for pressed in [true, false] {
            window.event(pointer_button(at, egui::PointerButton::Primary, pressed));
            frames(&mut window, 1);
        }
        frames(&mut window, 3);
        assert_eq!(names(&mut window), ["b", "c"]);
        assert_eq!(others(&window), before, "nothing has moved");
    }
    click(&mut window, "Bring back a");
    assert_eq!(names(&mut window), ["a", "b", "c"]);
}

#[test]
fn removed_levels_come_back_to_their_places_in_any_order() {
    let orders = [
        ["a", "b", "c"],
        ["c", "a", "b"],
        ["b", "c", "a"],
        ["c", "b", "a"],
    ];
    let mut window = list_of(&["a", "b", "c"]);
    for removed in orders {
        for back in orders {
            let game = game(&mut window);
            for name in removed {
                let mut places = 0..game.levels.len();
                let place = places.find(|&place| game.levels[place].game().name.en == name);
                game.take_out(place.unwrap());
            }
            assert_eq!(game.own_entries().len(), 3);
            for (count, name) in (1..).zip(back) {
                let card = game
                    .own_entries()
                    .into_iter()
                    .find_map(|entry| match entry {
                        ListEntry::Removed(index) => {
                            (game.removed_name(index) == name).then_some(index)
                        }
                        ListEntry::Level(_) => None,
                    });
                game.bring_back_removed(card.unwrap());
                assert_eq!((game.own_entries().len(), own_count(game)), (3, count));
            }
            assert_eq!(names(&mut window), ["a", "b", "c"], "{removed:?}, {back:?}");
        }
    }
    // After the list was left, only the last one can be brought back.
    click(&mut window, "Remove: a");
    click(&mut window, "Remove: b");
    game(&mut window).go(Screen::Title);
    frames(&mut window, 3);
    game(&mut window).go(Screen::Levels);
    frames(&mut window, 3);
    assert!(window.query_by_label("Bring back a").is_none());
    click(&mut window, "Bring back b");
    assert_eq!(names(&mut window), ["b", "c"]);
}
