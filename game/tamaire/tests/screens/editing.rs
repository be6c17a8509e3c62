//! Levels in the editor: what is kept, sent and received, and what one step of undo covers.

use crate::making::{drag, place_of_item, slow_clock};
use crate::told::tells;
use crate::window::*;
use app_shell::Pads;
use eframe::App;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, OutputCommand, PointerButton, pos2, vec2};
use egui_kittest::kittest::Queryable;
use fuwafuwa::Vec3;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::ObstacleText;
use std::fs;
use std::path::{Path, PathBuf};
use tamaire::game::{Game, Screen};
use tamaire::input::{Action, InputSource};
use tamaire::platform::{Files, OpenRequest, Sound};
use tamaire::words::Language;
use tamaire_maker::drawing::Brush;
use tamaire_maker::items::{Item, Kind};
use tamaire_play::level::NAMED;
use tamaire_play::playground::Stuff;
use tamaire_play::{Level, Pack};

/// Returns a game without a window and without storage.
fn plain_game() -> Game {
    Game::new(Files::nowhere(), Sound::none(), Pads::none())
}

/// Opens a window in which levels are edited.
fn editor(files: Files) -> Window {
    let mut window = open(files, vec2(1000.0, 640.0), 1.0);
    game(&mut window).clock = slow_clock();
    window
}

/// Returns a small level with this id and name.
fn small(id: &str, name: &str) -> Level {
    let (known, text) = NAMED[0];
    let changes = ["body.n=6".to_string(), format!("game.name.en=\"{name}\"")];
    let scene = Scene::read(known, text, &changes).unwrap();
    Level::from_scene(id, scene).unwrap()
}

/// Writes a small level to a file, and opens the file.
fn open_file(game: &mut Game, folder: &Path, file: &str, name: &str) {
    fs::create_dir_all(folder).unwrap();
    let path: PathBuf = folder.join(file);
    fs::write(&path, small(file, name).text_to_keep().unwrap()).unwrap();
    game.open(OpenRequest::at(&path));
}

/// Returns a link to a small level with this id and name.
fn link(id: &str, name: &str) -> String {
    format!("https://example.org/#{}", small(id, name).link().unwrap())
}

/// Returns the ids and the English names of the player's own levels.
fn own(game: &Game) -> Vec<(&str, &str)> {
    let own = (0..game.levels.len()).filter(|&index| game.is_own(index));
    let own = own.map(|index| &game.levels[index]);
    own.map(|level| (level.id.as_str(), level.game().name.en.as_str()))
        .collect()
}

/// Fills the list of own levels.
fn fill_list(game: &mut Game) {
    let text = |number: usize| {
        small("x", &format!("level {number}"))
            .text_to_keep()
            .unwrap()
    };
    let texts: Vec<_> = (0..100)
        .map(|number| (format!("{number}.toml"), text(number)))
        .collect();
    let pack = Pack::read("full.zip", &Pack::write(&texts)).unwrap();
    game.open(OpenRequest::Pack("full.zip".into(), Ok(Box::new(pack))));
    assert_eq!(own(game).len(), 100);
    game.notices.clear();
}

fn told(game: &Game) -> Vec<&str> {
    let notices = game.notices.iter();
    notices.map(|notice| notice.text.as_str()).collect()
}

fn scene(game: &Game) -> &Scene {
    game.maker.draft.scene()
}

/// Moves the first body a little.
fn change(game: &mut Game) {
    game.change_level(|scene| scene.body[0].at[0] += 0.05);
}

#[test]
fn files_of_two_friends_with_the_same_name_stay_apart() {
    let folder = folder();
    let mut game = plain_game();
    for (friend, name) in [("a", "one"), ("b", "two"), ("a", "one"), ("b", "two")] {
        open_file(
            &mut game,
            &folder.path().join(friend),
            "my-level-1.toml",
            name,
        );
        assert_eq!(game.bout.round().level().game().name.en, name);
    }
    let names: Vec<&str> = own(&game).into_iter().map(|(_, name)| name).collect();
    assert_eq!(names, ["one", "two"]);
    // A file with a name that its author chose replaces its earlier version.
    for name in ["three", "four"] {
        open_file(&mut game, folder.path(), "garden.toml", name);
    }
    let names: Vec<&str> = own(&game).into_iter().map(|(_, name)| name).collect();
    assert_eq!(names, ["one", "two", "four"]);
}

#[test]
fn newer_file_replaces_the_level_of_its_maker_only() {
    let mut game = plain_game();
    let files = [
        ("Mika", "garden", 2.0),
        ("Kai", "garden", 3.0),
        ("Mika", "garden", 4.0),
        ("Kai", "garden", 5.0),
        // Another level of the same maker, whose file has the id of the one that is numbered here.
        ("Kai", "pond", 6.0),
    ];
    for (maker, name, hold) in files {
        let mut scene = small("garden.toml", name).scene().clone();
        let rules = scene.game.as_mut().unwrap();
        (rules.made_by, rules.hold) = (Some(maker.into()), hold);
        let level = Level::from_scene("garden.toml", scene).unwrap();
        game.open(OpenRequest::Level(Ok(Box::new(level))));
        let played = game.bout.round().level().game();
        assert_eq!(
            (played.made_by.as_deref(), played.hold),
            (Some(maker), hold)
        );
    }
    let own = game
        .levels
        .iter()
        .filter(|level| level.id.starts_with("garden"));
    let own: Vec<_> = own
        .map(|level| (level.id.as_str(), level.game().hold))
        .collect();
    assert_eq!(own, [("garden", 4.0), ("garden-2", 5.0), ("garden-3", 6.0)]);
}

#[test]
fn file_is_not_added_to_a_full_list() {
    let folder = folder();
    let mut game = plain_game();
    fill_list(&mut game);
    open_file(&mut game, folder.path(), "garden.toml", "garden");
    assert_eq!(own(&game).len(), 100);
    assert_eq!(told(&game), ["There is only room for 100 levels."]);
    // A level that the list has needs no room.
    open_file(&mut game, folder.path(), "7.toml", "new version");
    assert_eq!(own(&game).len(), 100);
    assert!(own(&game).contains(&("7", "new version")));
}

#[test]
fn link_to_an_own_level_starts_it_and_adds_nothing() {
    let mut game = plain_game();
    game.open_link(&link("my-level-1", "friend"));
    game.play_offered();
    game.edit_blank(2);
    game.name_draft("mine");
    assert!(game.keep_draft());
    game.leave_editor();
    let before = own(&game).len();
    let mine = game.levels.last().unwrap().clone();
    let sent = mine.link().unwrap();
    game.open_link(&format!("https://example.org/#{sent}"));
    assert_eq!(game.screen(), Screen::Play);
    assert_eq!(game.bout.round().level().id, mine.id);
    assert_eq!(own(&game).len(), before);
    assert!(own(&game).contains(&("sent-level-1", "friend")));
}

#[test]
fn link_that_is_opened_twice_adds_one_level() {
    let mut game = plain_game();
    let sent = link("my-level-1", "friend");
    game.open_link(&sent);
    assert_eq!(game.screen(), Screen::Offered);
    game.play_offered();
    game.go(Screen::Title);
    game.open_link(&sent);
    assert_eq!(game.screen(), Screen::Play);
    assert_eq!(own(&game), [("sent-level-1", "friend")]);
}

#[test]
fn offered_level_stays_offered_while_the_list_is_full() {
    let mut game = plain_game();
    fill_list(&mut game);
    game.open_link(&link("my-level-1", "friend"));
    game.play_offered();
    assert_eq!(game.screen(), Screen::Offered);
    assert!(game.offered.is_some());
    game.take_out(place_of(&game, "7"));
    game.play_offered();
    assert_eq!(game.screen(), Screen::Play);
    assert!(game.offered.is_none() && own(&game).contains(&("sent-level-1", "friend")));
}

#[test]
fn changed_level_is_kept_when_a_test_leads_elsewhere() {
    let leave: [fn(&mut Game); 3] = [
        |game| game.go(Screen::Levels),
        |game| game.open_link(&link("my-level-1", "friend")),
        |game| game.edit_blank(3),
    ];
    for leave in leave {
        let mut game = plain_game();
        game.edit_blank(2);
        change(&mut game);
        let kept = scene(&game).clone();
        game.test_level();
        assert!(game.is_test());
        leave(&mut game);
        assert_eq!(own(&game), [("my-level-1", "My level")]);
        assert_eq!(game.levels.last().unwrap().scene(), &kept);
        let words = game.making();
        assert!(told(&game).contains(&words.kept));
    }
}

#[test]
fn changed_copy_is_kept_as_an_own_level_and_an_unchanged_one_is_not() {
    let mut game = plain_game();
    game.edit(place_of(&game, "classic"));
    game.leave_editor();
    assert_eq!(own(&game), []);
    game.edit(place_of(&game, "classic"));
    change(&mut game);
    game.leave_editor();
    assert_eq!(own(&game), [("my-level-1", "Classic")]);
    assert!(!game.has_unsaved_level());
    let kept = game.levels.last().unwrap();
    assert_eq!(kept.game().changed_from.as_deref(), Some("Classic"));
    // Another level opens while the copy is in the editor.
    game.edit(place_of(&game, "classic"));
    change(&mut game);
    game.edit(place_of(&game, "my-level-1"));
    assert_eq!(own(&game).len(), 2);
    assert_eq!(game.maker.draft.id(), "my-level-1");
}

#[test]
fn level_without_a_name_stays_in_the_making_when_the_editor_closes() {
    let mut game = plain_game();
    game.edit_blank(2);
    game.name_draft("");
    game.leave_editor();
    assert_eq!(own(&game), []);
    let words = game.making();
    assert!(game.has_unsaved_level() && told(&game).contains(&words.still_open));
    game.go_on_editing();
    game.name_draft("named");
    game.leave_editor();
    assert_eq!(own(&game), [("my-level-1", "named")]);
}

#[test]
fn changed_copy_is_kept_when_the_window_closes_or_the_gpu_is_lost() {
    let close: [fn(&mut Window); 3] = [
        |window| window.state_mut().on_exit(),
        |window| game(window).rescue(),
        |window| game(window).flush(),
    ];
    for close in close {
        let folder = folder();
        let mut first = window(Files::in_folder(folder.path()));
        start(&mut first, "classic");
        game(&mut first).edit_current();
        change(game(&mut first));
        game(&mut first).notices.clear();
        close(&mut first);
        assert_eq!(notices(&first), "");
        drop(first);
        let mut again = window(Files::in_folder(folder.path()));
        wait_for_files(&mut again);
        assert_eq!(own(game(&mut again)), [("my-level-1", "Classic")]);
    }
}

#[test]
fn level_that_is_too_large_gets_no_id_until_it_is_kept() {
    let mut game = plain_game();
    game.edit_blank(2);
    let blank = scene(&game).clone();
    let cat = Level::open("cat").unwrap().scene().clone();
    game.change_level(|scene| {
        let mut body = cat.body[0].clone();
        // A picture may be followed by other data.
        let picture = body.content.take().unwrap().replace('=', "A");
        body.content = Some(picture + &"AAAA".repeat(3 << 20));
        scene.material = cat.material.clone();
        scene.body = vec![body];
    });
    assert_eq!(game.draft_problem(), None);
    assert!(!game.keep_draft());
    let words = game.making();
    assert!(told(&game).contains(&words.not_kept));
    game.duplicate(0);
    game.change_level(|scene| *scene = blank);
    change(&mut game);
    assert!(game.keep_draft());
    assert_eq!(
        own(&game),
        [("my-level-1", "Classic 2"), ("my-level-2", "My level")]
    );
}

#[test]
fn level_kept_after_its_removal_leaves_the_removed_one() {
    let mut game = plain_game();
    game.edit_blank(2);
    game.name_draft("first");
    assert!(game.keep_draft());
    game.take_out(place_of(&game, "my-level-1"));
    game.name_draft("second");
    assert!(game.keep_draft());
    game.bring_back();
    let expected = [("my-level-1", "first"), ("my-level-2", "second")];
    assert_eq!(own(&game), expected);
}

#[test]
fn qr_code_follows_the_name_of_the_maker() {
    let mut game = plain_game();
    game.edit_blank(2);
    game.settings.maker_name = "Mika".into();
    let first = game.code_of_draft().expect("the level is small");
    game.settings.maker_name = "Kai".into();
    assert!(game.code_of_draft() != Some(first));
}

#[test]
fn typed_name_is_one_step_of_undo() {
    let mut window = editor(Files::nowhere());
    game(&mut window).edit_blank(2);
    game(&mut window).go(Screen::Finish);
    frames(&mut window, 3);
    window.get_by_label("Name").focus();
    frames(&mut window, 2);
    for letter in ["a", "b", "c"] {
        window.event(Event::Text(letter.into()));
        frames(&mut window, 2);
    }
    press(&mut window, Key::Escape);
    let game = game(&mut window);
    assert_eq!(game.screen(), Screen::Editor);
    assert_eq!(game.draft_name(), "My levelabc");
    game.undo_edit(false);
    assert_eq!(game.draft_name(), "My level");
    assert!(!game.maker.draft.can_undo());
}

#[test]
fn number_in_the_name_of_a_new_level_is_no_step_of_undo() {
    let mut game = plain_game();
    for number in [1, 2] {
        game.edit_blank(2);
        assert!(!game.maker.draft.can_undo(), "{number}");
        assert!(game.keep_draft());
    }
    let names: Vec<&str> = own(&game).into_iter().map(|(_, name)| name).collect();
    assert_eq!(names, ["My level", "My level 2"]);
}

#[test]
fn keeping_and_sending_add_no_step_of_undo_and_keep_redo() {
    let mut game = plain_game();
    game.settings.maker_name = "Mika".into();
    game.edit(place_of(&game, "classic"));
    let before = scene(&game).clone();
    change(&mut game);
    let changed = scene(&game).clone();
    game.undo_edit(false);
    game.copy_link_to_draft();
    assert!(game.copied.is_some());
    assert_eq!(scene(&game), &before);
    assert!(game.keep_draft());
    game.save_draft_file();
    assert!(!game.maker.draft.can_undo());
    game.undo_edit(true);
    assert_eq!(scene(&game), &changed);
}

#[test]
fn level_from_a_drawing_has_no_steps_of_earlier_drawings() {
    let mut game = plain_game();
    game.open_paper();
    for stuff in [Stuff::Jelly, Stuff::Clay] {
        let [from, to] = [20.0, 40.0].map(|x| Vec3::new(x, 32.0, 0.5));
        let paper = &mut game.maker.paper;
        paper.stroke(from, to, 6.0, Brush::Draw(stuff.number()));
        paper.end_stroke();
        game.drop_drawing();
        game.leave_round();
    }
    game.edit_room();
    assert_eq!(game.screen(), Screen::Editor);
    assert!(!game.maker.draft.can_undo());
    assert!(scene(&game).body[0].voxels.is_some());
}

#[test]
fn second_point_of_a_path_changes_alone() {
    let mut window = editor(Files::nowhere());
    let path = [[1.0, 0.1, 0.0, 0.0], [3.0, 0.5, 0.0, 0.0]];
    game(&mut window).edit_blank(2);
    game(&mut window).add_thing(Kind::Lift);
    let item = game(&mut window).maker.editor.selection[0];
    let Item::Obstacle(index) = item else {
        panic!("{item:?}");
    };
    game(&mut window).change_level(|scene| {
        scene.obstacle[index] = ObstacleText {
            path: path.to_vec(),
            ..scene.obstacle[index].clone()
        };
    });
    game(&mut window).go(Screen::Properties);
    frames(&mut window, 3);
    let name = window.state().game.making().moves_by[0];
    window.get_by_role_and_label(Role::Slider, name).focus();
    frames(&mut window, 2);
    press(&mut window, Key::ArrowRight);
    let changed = &scene(game(&mut window)).obstacle[index].path;
    assert_eq!(changed[0], path[0]);
    assert!(changed[1][1] > 0.5 && changed.len() == 2, "{changed:?}");
}

#[test]
fn secondary_button_moves_the_camera_and_no_thing() {
    let mut window = editor(Files::nowhere());
    game(&mut window).edit_blank(3);
    frames(&mut window, 3);
    let before = scene(game(&mut window)).clone();
    let angles = game(&mut window).bout.camera.orbit_angles();
    game(&mut window).select(Item::Hand(0));
    let at = place_of_item(&mut window, Item::Body(0));
    window.hover_at(at);
    frames(&mut window, 2);
    window.event(pointer_button(at, PointerButton::Secondary, true));
    frames(&mut window, 1);
    for step in 1..=6 {
        window.event(Event::PointerMoved(at + step as f32 * vec2(8.0, 4.0)));
        frames(&mut window, 1);
    }
    window.event(pointer_button(
        at + vec2(48.0, 24.0),
        PointerButton::Secondary,
        false,
    ));
    frames(&mut window, 2);
    let now = game(&mut window);
    assert_ne!(now.bout.camera.orbit_angles(), angles);
    assert!(scene(now) == &before && !now.maker.draft.can_undo());
    assert_eq!(now.maker.editor.selection, [Item::Hand(0)]);
    // A button turns the camera back.
    click(&mut window, "Front view");
    frames(&mut window, 200);
    let [right, up] = game(&mut window).bout.camera.orbit_angles();
    assert!(right.hypot(up) < 0.01, "{right} {up}");
    assert!(window.query_by_label("Front view").is_none());
}

#[test]
fn tabs_of_the_strip_lead_to_the_things_and_to_the_selection() {
    let mut window = editor(Files::nowhere());
    game(&mut window).edit_blank(2);
    frames(&mut window, 2);
    click(&mut window, "Basket");
    // The things stay, so that another one can be added.
    assert!(window.query_by_label("Details").is_none());
    click(&mut window, "Selected: Basket 1");
    click(&mut window, "Remove");
    assert_eq!(game(&mut window).draft_problem(), None);
    let baskets = |window: &mut Window| scene(game(window)).game.clone().unwrap().basket;
    assert_eq!(baskets(&mut window), None);
    click(&mut window, "Seesaw");
    click(&mut window, "Selected: Seesaw 1");
    click(&mut window, "Add a thing");
    assert!(window.query_by_label("Details").is_none());
    // The actions have the same places for a body and for a wall.
    let mut places = [Item::Body(0), Item::Obstacle(0)].map(|item| {
        game(&mut window).select(item);
        frames(&mut window, 2);
        let names = [
            "Details",
            "Copy",
            "Remove",
            "Turn left",
            "Turn right",
            "Done",
        ];
        names.map(|name| window.get_by_label(name).rect().min)
    });
    places[0].sort_by(|a, b| a.y.total_cmp(&b.y));
    places[1].sort_by(|a, b| a.y.total_cmp(&b.y));
    assert_eq!(places[0], places[1]);
}

#[test]
fn basket_moves_with_its_bars_and_undo_restores_the_selection() {
    let mut window = editor(Files::nowhere());
    game(&mut window).edit_blank(2);
    game(&mut window).add_thing(Kind::Basket);
    game(&mut window).select_nothing();
    frames(&mut window, 3);
    let bars: Vec<Item> = { tamaire_maker::items::items(scene(game(&mut window))).into_iter() }
        .filter(|&item| {
            tamaire_maker::items::kind_of(scene(game(&mut window)), item) == Some(Kind::Bar)
        })
        .collect();
    assert_eq!(bars.len(), 3);
    let corner = |window: &mut Window, item| {
        tamaire_maker::items::bounds(scene(game(window)), item).unwrap()[0]
    };
    let all: Vec<Item> = [Item::Basket(0)].into_iter().chain(bars.clone()).collect();
    let before = all
        .clone()
        .into_iter()
        .map(|item| corner(&mut window, item));
    let before: Vec<Vec3> = before.collect();
    let from = place_of_item(&mut window, bars[0]);
    drag(&mut window, &[from, from - vec2(90.0, 0.0)]);
    let moved: Vec<f32> = { all.iter().zip(&before) }
        .map(|(&item, before)| before.x - corner(&mut window, item).x)
        .collect();
    assert!(moved[0] > 0.2, "{moved:?}");
    assert!(
        moved.iter().all(|by| (by - moved[0]).abs() < 1e-3),
        "{moved:?}"
    );
    // Undo restores what was selected, and so does redo.
    let selected = game(&mut window).maker.editor.selection.clone();
    game(&mut window).select(Item::Hand(0));
    game(&mut window).undo_edit(false);
    assert_eq!(game(&mut window).maker.editor.selection, selected);
    game(&mut window).undo_edit(true);
    assert_eq!(game(&mut window).maker.editor.selection, [Item::Hand(0)]);
    // A second press takes a bar alone.
    for count in [4, 1] {
        game(&mut window).select(bars[0]);
        assert_eq!(game(&mut window).maker.editor.selection.len(), count);
    }
}

#[test]
fn keys_mark_take_and_move_things() {
    let mut window = editor(Files::nowhere());
    game(&mut window).edit_blank(2);
    frames(&mut window, 3);
    let before = scene(game(&mut window)).clone();
    press(&mut window, Key::Tab);
    let focused = window.ctx.memory(|memory| memory.focused());
    assert!(focused.is_some(), "the first press marks something");
    for _ in 0..20 {
        press(&mut window, Key::Enter);
        if game(&mut window).maker.editor.selection == [Item::Body(0)] {
            break;
        }
        game(&mut window).select_nothing();
        press(&mut window, Key::Tab);
    }
    assert_eq!(game(&mut window).maker.editor.selection, [Item::Body(0)]);
    assert!(!game(&mut window).maker.editor.moves_by_keys);
    let height = |window: &mut Window| scene(game(window)).body[0].at[1];
    let floor = height(&mut window);
    press(&mut window, Key::Enter);
    press(&mut window, Key::ArrowUp);
    let raised = height(&mut window);
    assert!(raised > floor + 0.01, "{raised}");
    press(&mut window, Key::Enter);
    press(&mut window, Key::ArrowUp);
    assert_eq!(height(&mut window), raised, "it was let go");
    press(&mut window, Key::Escape);
    assert_eq!(game(&mut window).maker.editor.selection, []);
    assert_eq!(screen(&window), Screen::Editor);
    press(&mut window, Key::Escape);
    assert_ne!(screen(&window), Screen::Editor);
    assert!(scene(game(&mut window)) != &before);
}

#[test]
fn drag_out_of_the_room_ends_with_the_button() {
    let mut window = editor(Files::nowhere());
    game(&mut window).edit_blank(2);
    game(&mut window).add_thing(Kind::Ball);
    let item = game(&mut window).maker.editor.selection[0];
    game(&mut window).select_nothing();
    frames(&mut window, 3);
    let before = scene(game(&mut window)).clone();
    let from = place_of_item(&mut window, item);
    drag(
        &mut window,
        &[from, pos2(from.x, 635.0), pos2(from.x, 900.0)],
    );
    assert_eq!(game(&mut window).maker.editor.drag, None);
    assert_ne!(scene(game(&mut window)), &before);
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    frames(&mut window, 2);
    assert_eq!(scene(game(&mut window)), &before);
}

#[test]
fn drag_of_the_fineness_is_one_step_of_undo() {
    let mut window = editor(Files::nowhere());
    game(&mut window).open_paper();
    frames(&mut window, 2);
    crate::hostile::drop_file(&mut window, level_file("cat.png"));
    let fine = game(&mut window).maker.paper.clone();
    let slider = window.get_by_label("Fineness").rect();
    let at = |share: f32| slider.lerp_inside(vec2(share, 0.5));
    drag(&mut window, &[at(0.9), at(0.6), at(0.2)]);
    assert_ne!(game(&mut window).maker.paper, fine);
    assert!(game(&mut window).maker.picture.is_some());
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    frames(&mut window, 2);
    assert!(game(&mut window).maker.paper == fine);
    assert!(game(&mut window).maker.picture.is_none());
}

#[test]
fn many_pictures_keep_their_colours() {
    let bytes = fs::read(level_file("cat.png")).unwrap();
    let colours = |game: &Game| {
        let cells = game.maker.paper.cells().iter();
        cells
            .map(|&cell| game.maker.palette.colour(cell))
            .collect::<Vec<_>>()
    };
    let drawn = |game: &mut Game, across: usize| {
        game.draw_picture("cat.png".into(), bytes.clone());
        game.redraw_picture(across, false);
    };
    let mut game = plain_game();
    game.open_paper();
    (12..64).for_each(|across| drawn(&mut game, across));
    let mut other = plain_game();
    other.open_paper();
    drawn(&mut other, 63);
    assert!(colours(&game) == colours(&other));
}

#[test]
fn copying_without_a_selection_leaves_the_clipboard() {
    let mut window = editor(Files::nowhere());
    game(&mut window).edit_blank(2);
    frames(&mut window, 2);
    window.event(Event::Copy);
    for _ in 0..3 {
        window.step();
        let commands = &window.output().platform_output.commands;
        let is_copy = |command: &OutputCommand| matches!(command, OutputCommand::CopyText(_));
        assert!(!commands.iter().any(is_copy));
    }
}

#[test]
fn hint_tells_what_keys_do_with_the_marked_thing() {
    for dim in [2, 3] {
        let mut window = editor(Files::nowhere());
        game(&mut window).edit_blank(dim);
        let words = window.state().game.making();
        let held = words.how_held[usize::from(dim == 3)];
        let hints = [
            words.how_in_space[0],
            words.how_marked,
            words.how_selected,
            held,
        ];
        let check = |window: &Window, shown: Option<&str>| {
            for hint in hints {
                assert_eq!(tells(window, hint), shown == Some(hint), "{dim}: {hint}");
            }
        };
        frames(&mut window, 3);
        check(&window, hints[..1].iter().copied().find(|_| dim == 3));
        press(&mut window, Key::Tab);
        let name = game(&mut window).item_name(Item::Body(0));
        window.get_by_label(&name).focus();
        frames(&mut window, 2);
        check(&window, Some(words.how_marked));
        // The mark stays after Escape, and the next one leaves the editor.
        let steps = [
            (Key::Enter, words.how_selected),
            (Key::Enter, held),
            (Key::Escape, words.how_selected),
            (Key::Escape, words.how_marked),
        ];
        for (key, hint) in steps {
            press(&mut window, key);
            check(&window, Some(hint));
        }
        press(&mut window, Key::Escape);
        assert_ne!(screen(&window), Screen::Editor);
    }
}

#[test]
fn elements_of_a_test_are_hidden_in_the_editor() {
    let mut game = plain_game();
    game.settings.reduced_motion = true;
    game.edit_blank(2);
    game.test_level();
    game.act(Action::Elements, InputSource::Keys);
    assert!(game.bout.elements.is_some());
    game.end_test();
    game.update(0.02);
    assert_eq!(game.screen(), Screen::Editor);
    assert!(game.bout.elements.is_none());
}

#[test]
fn seconds_of_properties_are_named_in_the_language() {
    for (language, second) in [(Language::English, " s"), (Language::Japanese, "秒")] {
        let mut window = editor(Files::nowhere());
        game(&mut window).settings.language = language;
        game(&mut window).edit(0);
        game(&mut window).change_level(|scene| scene.game.as_mut().unwrap().hold = 2.5);
        game(&mut window).go(Screen::Properties);
        frames(&mut window, 3);
        assert!(tells(&window, &format!("2.5{second}")), "{language:?}");
    }
}
