//! Packs of levels: zips and folders.

use crate::hostile::drop_file;
use crate::window::*;
use app_shell::Pads;
use fuwafuwa_scenes::Scene;
use std::fs;
use std::path::{Path, PathBuf};
use tamaire::game::{Game, Screen};
use tamaire::platform::{Files, OpenRequest, Sound};
use tamaire::words::Language;
use tamaire_play::level::NAMED;
use tamaire_play::{Level, Pack};

/// Returns a small level with this name, as text.
fn small(name: &str) -> String {
    let (id, text) = NAMED[0];
    let changes = ["body.n=6".to_string(), format!("game.name.en=\"{name}\"")];
    let scene = Scene::read(id, text, &changes).unwrap();
    let level = Level::from_scene(id, scene).unwrap();
    level.text_to_keep().unwrap()
}

/// Writes a pack of levels, each given by its file and its name.
fn pack(folder: &Path, name: &str, levels: &[(&str, &str)]) -> PathBuf {
    let texts = levels
        .iter()
        .map(|(id, name)| (id.to_string(), small(name)));
    let path = folder.join(name);
    fs::write(&path, Pack::write(&texts.collect::<Vec<_>>())).unwrap();
    path
}

/// Returns the ids and the English names of the player's own levels.
fn own(game: &Game) -> Vec<(String, String)> {
    let own = (0..game.levels.len()).filter(|&index| game.is_own(index));
    let own = own.map(|index| &game.levels[index]);
    own.map(|level| (level.id.clone(), level.game().name.en.clone()))
        .collect()
}

fn pairs(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
    let owned = |(id, name): &(&str, &str)| (id.to_string(), name.to_string());
    pairs.iter().map(owned).collect()
}

#[test]
fn dropped_pack_adds_its_levels_in_both_languages() {
    for (language, added, known) in [
        (
            Language::English,
            "2 new levels are under Your levels.",
            "You already have these levels.",
        ),
        (
            Language::Japanese,
            "あたらしいステージが 2こ ふえたよ。",
            "もう ぜんぶ もっているよ。",
        ),
    ] {
        let folder = folder();
        let dropped = pack(
            folder.path(),
            "two.zip",
            &[("a.toml", "one"), ("b.toml", "two")],
        );
        let begin = || window(Files::in_folder(folder.path().join("data")));
        let expected = pairs(&[("a", "one"), ("b", "two")]);
        let mut first = begin();
        game(&mut first).settings.language = language;
        game(&mut first).start(0);
        drop_file(&mut first, dropped.clone());
        assert_eq!(screen(&first), Screen::Levels);
        assert_eq!(
            (own(game(&mut first)), notices(&first)),
            (expected.clone(), added.into())
        );
        let chosen = game(&mut first).chosen;
        assert_eq!(game(&mut first).levels[chosen].id, "a");
        drop_file(&mut first, dropped);
        assert_eq!(
            (own(game(&mut first)), notices(&first)),
            (expected.clone(), known.into())
        );
        wait_for_files(&mut first);
        drop(first);
        let mut again = begin();
        wait_for_files(&mut again);
        assert_eq!(own(game(&mut again)), expected, "the levels are stored");
    }
}

#[test]
fn dropped_folder_adds_its_levels_and_names_what_did_not_open() {
    let folder = folder();
    let dropped = folder.path().join("levels");
    fs::create_dir_all(dropped.join("inside")).unwrap();
    // A copy of a built-in level is not added.
    let cat = fs::read_to_string(level_file("cat.toml")).unwrap();
    fs::write(dropped.join("copy.toml"), &cat).unwrap();
    let changed = cat.replacen("\"Cat\"", "\"My cat\"", 1);
    fs::write(dropped.join("a.toml"), changed).unwrap();
    fs::copy(level_file("cat.png"), dropped.join("cat.png")).unwrap();
    fs::write(dropped.join(".hidden"), "dim").unwrap();
    fs::write(dropped.join("inside/b.toml"), small("inside")).unwrap();
    for number in 0..6 {
        fs::write(
            dropped.join(format!("broken-{number}.toml")),
            "[game]\nname = 1",
        )
        .unwrap();
    }
    let mut window = window(Files::nowhere());
    drop_file(&mut window, dropped);
    assert_eq!(screen(&window), Screen::Levels);
    assert_eq!(own(game(&mut window)), pairs(&[("a", "My cat")]));
    let told = notices(&window);
    assert!(told.contains("1 new level is under Your levels."), "{told}");
    assert!(told.contains("These did not open. broken-0.toml"), "{told}");
    assert!(
        told.contains("broken-3.toml") && !told.contains("broken-4.toml"),
        "{told}"
    );
    assert!(told.ends_with(" / …"), "{told}");

    // A pack that adds nothing leaves the player where he is.
    game(&mut window).start(0);
    let empty = folder.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let zip = folder.path().join("damaged.zip");
    fs::write(&zip, b"PK\x03\x04").unwrap();
    for (path, reason) in [(empty, "found none"), (zip, "end is missing")] {
        drop_file(&mut window, path);
        let told = notices(&window);
        assert!(told.contains(reason), "{told}");
        assert_eq!(
            (screen(&window), own(game(&mut window)).len()),
            (Screen::Play, 1)
        );
    }
}

#[test]
fn pack_replaces_no_level_of_the_same_name() {
    let folder = folder();
    let data = folder.path().join("data");
    let first = pack(
        folder.path(),
        "first.zip",
        &[("a.toml", "one"), ("B.toml", "two")],
    );
    let second = pack(
        folder.path(),
        "second.zip",
        &[
            ("other.toml", "one"),
            ("A.toml", "three"),
            ("classic", "four"),
        ],
    );
    let open = || Game::new(Files::in_folder(&data), Sound::none(), Pads::none());
    let mut game = open();
    game.open(OpenRequest::at(&first));
    drop(game);
    // The stored levels have not been read when the pack is opened.
    let mut game = open();
    game.open(OpenRequest::at(&second));
    let expected = pairs(&[
        ("a", "one"),
        ("B", "two"),
        ("A-2", "three"),
        ("classic-2", "four"),
    ]);
    assert_eq!(own(&game), expected);
    // The id of a level that can be brought back is taken, too.
    let place = place_of(&game, "a");
    game.take_out(place);
    game.open(OpenRequest::at(&pack(
        folder.path(),
        "third.zip",
        &[("a.toml", "five")],
    )));
    game.bring_back();
    let mut ids: Vec<String> = own(&game).into_iter().map(|(id, _)| id).collect();
    ids.sort();
    assert_eq!(ids, ["A-2", "B", "a", "a-3", "classic-2"]);
}

#[test]
fn pack_fills_the_list_of_own_levels_at_most() {
    let folder = folder();
    let levels: Vec<String> = (0..100).map(|number| format!("{number}.toml")).collect();
    let levels: Vec<(&str, &str)> = levels.iter().map(|id| (id.as_str(), id.as_str())).collect();
    let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
    game.open(OpenRequest::at(&pack(
        folder.path(),
        "few.zip",
        &[("a.toml", "a")],
    )));
    game.notices.clear();
    game.open(OpenRequest::at(&pack(folder.path(), "many.zip", &levels)));
    assert_eq!(own(&game).len(), 100);
    let told: Vec<&str> = game
        .notices
        .iter()
        .map(|notice| notice.text.as_str())
        .collect();
    let expected = [
        "99 new levels are under Your levels.",
        "These did not open. 99.toml: There is only room for 100 levels.",
    ];
    assert_eq!(told, expected);
}

#[test]
fn own_levels_are_saved_as_a_pack_that_opens_elsewhere() {
    for (language, label) in [
        (Language::English, "Save all as a pack"),
        (Language::Japanese, "ぜんぶ まとめて のこす"),
    ] {
        let folder = folder();
        let mut first = window(Files::in_folder(folder.path()));
        drop_file(&mut first, level_file("cat.png"));
        drop_file(&mut first, level_file("pudding.vox"));
        game(&mut first).settings.language = language;
        game(&mut first).edit_blank(2);
        game(&mut first).name_draft("mine");
        game(&mut first).keep_draft();
        game(&mut first).go(Screen::Levels);
        frames(&mut first, 3);
        let path = folder.path().join("replays/my-levels.zip");
        for _ in 0..2 {
            click(&mut first, label);
            wait_for_files(&mut first);
            let told = notices(&first);
            let folder = path.parent().unwrap().to_str().unwrap();
            assert!(
                told.contains("my-levels.zip") && told.contains(folder),
                "{told}"
            );
        }
        let packs = fs::read_dir(folder.path().join("replays")).unwrap().count();
        assert_eq!(packs, 1, "an equal pack is not written twice");

        let mut second = window(Files::nowhere());
        drop_file(&mut second, path);
        // On another machine, a level that was made here counts as one that was sent.
        let sent = |(id, name): (String, String)| (id.replace("my-level-", "sent-level-"), name);
        let names = |list: Vec<(String, String)>| -> Vec<(String, String)> {
            let stem = |id: String| id.trim_end_matches(".toml").to_string();
            list.into_iter()
                .map(sent)
                .map(|(id, name)| (stem(id), name))
                .collect()
        };
        let [before, after] = [&mut first, &mut second].map(|window| names(own(game(window))));
        assert_eq!(after, before);
        let scenes = |window: &mut Window| {
            let levels = game(window).levels.iter().rev().take(3);
            let scenes = levels.map(|level| level.scene().clone());
            scenes.collect::<Vec<_>>()
        };
        assert_eq!(scenes(&mut second), scenes(&mut first));
        assert_eq!(own(game(&mut second)).len(), 3);
    }
}
