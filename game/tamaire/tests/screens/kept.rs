//! Tests of saved data, and of failures in saving and loading them.

use crate::told::tells;
use crate::window::*;
use app_shell::Pads;
use egui::accesskit::Role;
use egui::{Event, PointerButton};
use egui_kittest::kittest::Queryable;
use fuwafuwa::DEFAULT_TICK;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::thread::{self, ThreadId};
use std::time::SystemTime;
use tamaire::game::{Game, Screen};
use tamaire::input::Scanning;
use tamaire::platform::{Entry, Files, Kind, Nowhere, OpenRequest, Sound, Storage, UpdateEntry};
use tamaire_play::Level;

/// Storage in memory that records the writing threads, and that can be full.
#[derive(Clone, Default)]
struct Memory(Arc<Mutex<Inside>>);

#[derive(Default)]
struct Inside {
    kept: BTreeMap<(Kind, String), Vec<u8>>,
    writers: Vec<ThreadId>,
    is_full: bool,
    /// Locations whose folders were opened.
    opened: Vec<String>,
}

impl Memory {
    fn text(&self, name: &str) -> String {
        let inside = self.0.lock().unwrap();
        let bytes = inside.kept.get(&(Kind::Note, name.into()));
        String::from_utf8(bytes.cloned().unwrap_or_default()).unwrap()
    }

    fn writes(&self) -> usize {
        self.0.lock().unwrap().writers.len()
    }
}

impl Storage for Memory {
    fn list(&self, kind: Kind) -> io::Result<Vec<Entry>> {
        let inside = self.0.lock().unwrap();
        let names = inside.kept.keys().filter(|key| key.0 == kind);
        let written = SystemTime::UNIX_EPOCH;
        let name = |key: &(Kind, String)| key.1.clone();
        Ok(names
            .map(name)
            .map(|name| Entry { name, written })
            .collect())
    }

    fn read(&self, kind: Kind, name: &str) -> io::Result<Option<Vec<u8>>> {
        let inside = self.0.lock().unwrap();
        Ok(inside.kept.get(&(kind, name.into())).cloned())
    }

    fn change(&self, kind: Kind, name: &str, change: &mut UpdateEntry) -> io::Result<()> {
        let mut inside = self.0.lock().unwrap();
        inside.writers.push(thread::current().id());
        if inside.is_full {
            return Err(io::ErrorKind::StorageFull.into());
        }
        let key = (kind, name.to_string());
        if let Some(after) = change(inside.kept.get(&key).map(Vec::as_slice)) {
            inside.kept.insert(key, after);
        }
        Ok(())
    }

    fn remove(&self, kind: Kind, name: &str) -> io::Result<()> {
        self.0.lock().unwrap().kept.remove(&(kind, name.into()));
        Ok(())
    }

    fn location(&self, _: Kind, name: &str) -> PathBuf {
        name.into()
    }

    fn has_folders(&self) -> bool {
        true
    }

    fn open_folder_of(&self, location: &Path) -> io::Result<()> {
        self.0
            .lock()
            .unwrap()
            .opened
            .push(location.display().to_string());
        Ok(())
    }
}

#[test]
fn dragged_slider_is_saved_once_by_writer_thread() {
    let memory = Memory::default();
    let mut window = window(Files::on(memory.clone()));
    click(&mut window, "Settings");
    let slider = window.get_by_role_and_label(Role::Slider, "Volume").rect();
    let button = |pos, pressed| pointer_button(pos, PointerButton::Primary, pressed);
    window.event(Event::PointerMoved(slider.center()));
    window.event(button(slider.center(), true));
    let mut seen = Vec::new();
    for step in 0..90 {
        let across = 0.2 + 0.6 * (step as f32 / 90.0);
        let at = egui::pos2(slider.left() + across * slider.width(), slider.center().y);
        window.event(Event::PointerMoved(at));
        frames(&mut window, 1);
        seen.push(game(&mut window).settings.volume);
    }
    window.event(button(slider.center(), false));
    seen.dedup();
    assert!(seen.len() > 5, "the slider moves: {seen:?}");
    assert_eq!(memory.writes(), 0);
    frames(&mut window, 70);
    wait_for_files(&mut window);
    assert_eq!(memory.writes(), 1);
    let volume = game(&mut window).settings.volume;
    let text = memory.text("settings");
    assert!(text.contains(&format!("volume = {volume}")), "{text}");
    let writers = memory.0.lock().unwrap().writers.clone();
    assert!(!writers.contains(&thread::current().id()));
}

#[test]
fn last_change_is_saved_when_game_ends() {
    let memory = Memory::default();
    let mut game = Game::new(Files::on(memory.clone()), Sound::none(), Pads::none());
    game.settings.speed = 0.75;
    game.keep_settings();
    assert_eq!(memory.writes(), 0);
    drop(game);
    assert!(memory.text("settings").contains("speed = 0.75"));
}

#[test]
fn two_games_at_once_lose_no_record() {
    let folder = folder();
    let begin = || window(Files::in_folder(folder.path()));
    let mut windows = [begin(), begin()];
    for (window, level) in windows.iter_mut().zip(["classic", "classic-3d"]) {
        start(window, level);
        win(window);
    }
    drop(windows);
    let (records, damage) = Files::in_folder(folder.path()).records();
    assert_eq!(damage, None);
    assert!(records.of("classic").is_some() && records.of("classic-3d").is_some());
}

#[test]
fn win_without_a_moved_hand_is_no_record_and_no_ghost() {
    let folder = folder();
    let mut window = window(Files::in_folder(folder.path()));
    game(&mut window).settings.race_best = true;
    // The body is in the basket from the start.
    let mut scene = Level::open("classic").unwrap().scene().clone();
    let basket = &mut scene.game.as_mut().unwrap().basket;
    basket.as_mut().unwrap().half = [3.0; 3];
    let level = Level::from_scene("easy", scene).unwrap();
    game(&mut window).open(OpenRequest::Level(Ok(Box::new(level.clone()))));
    for is_pushed in [false, true] {
        if is_pushed {
            win(&mut window);
        } else {
            let game = game(&mut window);
            (0..300).for_each(|_| game.update(DEFAULT_TICK));
        }
        assert_eq!(screen(&window), Screen::Result);
        frames(&mut window, 2);
        let said = game(&mut window).words();
        assert_eq!(tells(&window, said.won_by_itself), !is_pushed);
        assert_eq!(tells(&window, said.new_best), is_pushed);
        wait_for_files(&mut window);
        let now = game(&mut window);
        assert_eq!(now.records.of("easy").is_some(), is_pushed);
        assert_eq!(now.files.best(&level).is_some(), is_pushed);
        now.retry();
        assert_eq!(now.bout.session.ghost().is_some(), is_pushed);
    }
    // Nor does its maker win it in a test.
    let game = game(&mut window);
    game.edit_current();
    game.test_level();
    (0..300).for_each(|_| game.update(DEFAULT_TICK));
    assert!(game.bout.won.is_some() && game.maker.won.is_none());
}

#[test]
fn full_disk_is_reported_once_and_game_continues() {
    let memory = Memory::default();
    memory.0.lock().unwrap().is_full = true;
    let mut window = window(Files::on(memory.clone()));
    let full = game(&mut window).words().full;
    let mut told = 0;
    for speed in [0.6, 0.7, 0.8] {
        game(&mut window).notices.clear();
        game(&mut window).settings.speed = speed;
        game(&mut window).keep_settings();
        wait_for_files(&mut window);
        told += notices(&window).matches(full).count();
    }
    assert_eq!((told, memory.writes()), (1, 3));
    // A save that the player requested reports the failure each time.
    for _ in 0..2 {
        game(&mut window).notices.clear();
        game(&mut window).keep_replay();
        wait_for_files(&mut window);
        assert!(notices(&window).contains(full));
    }
    memory.0.lock().unwrap().is_full = false;
    game(&mut window).keep_settings();
    wait_for_files(&mut window);
    assert!(memory.text("settings").contains("speed = 0.8"));
    assert_eq!(screen(&window), Screen::Title);
}

#[test]
fn missing_folder_is_reported_once() {
    let folder = folder();
    let file = folder.path().join("file");
    std::fs::write(&file, "in the way").unwrap();
    let nowhere = Nowhere {
        reason: Some("no home"),
    };
    for files in [Files::in_folder(file.join("inside")), Files::on(nowhere)] {
        let mut window = window(files);
        let mut told = notices(&window);
        game(&mut window).notices.clear();
        for _ in 0..3 {
            game(&mut window).keep_settings();
            wait_for_files(&mut window);
            told = format!("{told}\n{}", notices(&window));
            game(&mut window).notices.clear();
        }
        let count = told.matches("saved").count() + told.matches("read").count();
        assert_eq!(count, 1, "{told}");
    }
}

#[test]
fn invalid_setting_is_reset_and_reported_once() {
    let folder = folder();
    let path = folder.path().join("settings.toml");
    let bad = "speed = \"fast\"\nvolume = 0.25\nhaptics = 0.5\nwarp = 9\n";
    std::fs::write(&path, bad).unwrap();
    let begin = || Game::new(Files::in_folder(folder.path()), Sound::none(), Pads::none());
    let told = |game: &Game| {
        let texts = game.notices.iter().map(|notice| notice.text.as_str());
        texts.collect::<Vec<_>>().join("\n")
    };
    let game = begin();
    let found = (game.settings.volume, game.settings.haptics);
    assert_eq!((found, game.settings.speed), ((0.25, 0.5), 1.0));
    let words = ["speed (", "warp (", "settings.broken-1.toml"];
    let said = told(&game);
    assert!(words.iter().all(|word| said.contains(word)), "{said}");
    let aside = folder.path().join("settings.broken-1.toml");
    assert_eq!(std::fs::read_to_string(aside).unwrap(), bad);
    drop(game);
    let again = begin();
    assert_eq!(told(&again), "");
    assert_eq!(again.settings.volume, 0.25);
}

#[test]
fn photos_and_clips_are_queued_and_saved_at_reported_paths() {
    let folder = folder();
    let mut window = window(Files::in_folder(folder.path()));
    start(&mut window, "classic");
    win(&mut window);
    click(&mut window, "Photo");
    let mut told = wait_for_pictures(&mut window);
    click(&mut window, "Clip");
    // The clip takes seconds. The second clip is the same as the first, and is not queued.
    let game = game(&mut window);
    assert!(game.files.picture_progress().is_some());
    game.keep_clip();
    game.keep_photo();
    told += &wait_for_pictures(&mut window);
    let pictures = folder.path().join("pictures");
    let names = [
        ("classic-1.png", &b"\x89PNG"[..]),
        ("classic-1.gif", b"GIF89a"),
        ("classic-2.png", b"\x89PNG"),
    ];
    for (name, magic) in names {
        let file = pictures.join(name);
        let bytes = fs::read(&file).expect("the file was saved");
        assert!(bytes.starts_with(magic), "{name}");
        let place = format!("Saved as {name} in {}", pictures.display());
        assert!(told.contains(&place), "{told}");
    }
    assert_eq!(fs::read_dir(&pictures).unwrap().count(), names.len());
}

/// Waits until all photos and clips are saved, and returns the messages meanwhile.
fn wait_for_pictures(window: &mut Window) -> String {
    let (mut told, mut shares) = (String::new(), Vec::new());
    while let Some(share) = game(window).files.picture_progress() {
        shares.push(share);
        frames(window, 1);
        told += &notices(window);
    }
    // The progress begins again with each further picture. There are two at most.
    let starts = shares.windows(2).filter(|pair| pair[1] < pair[0]);
    assert!(starts.count() <= 1, "{shares:?}");
    told
}

#[test]
fn message_about_saved_file_leaves_result_visible_and_opens_folder() {
    let memory = Memory::default();
    let mut window = open(Files::on(memory.clone()), egui::vec2(1280.0, 800.0), 0.25);
    start(&mut window, "classic");
    win(&mut window);
    click(&mut window, "Save replay");
    wait_for_files(&mut window);
    assert!(
        notices(&window).contains("Saved as classic-1"),
        "{}",
        notices(&window)
    );
    let folder = button(&window, "Open folder").rect();
    for name in ["Play again", "Save replay", "Levels"] {
        let covered = button(&window, name).rect();
        assert!(
            folder.left() > covered.right(),
            "{name}: {covered:?}, {folder:?}"
        );
    }
    click(&mut window, "Open folder");
    assert_eq!(memory.0.lock().unwrap().opened, ["classic-1"]);
    // A file manager cannot be operated with a single switch.
    game(&mut window).notices.clear();
    game(&mut window).settings.scanning = Scanning::Slow;
    game(&mut window).keep_replay();
    wait_for_files(&mut window);
    assert!(notices(&window).contains("Saved as classic-2"));
    assert!(window.query_by_label("Open folder").is_none());
}

#[test]
fn replay_names_avoid_existing_entries() {
    let folder = folder();
    let replays = folder.path().join("replays");
    fs::create_dir_all(replays.join("classic-1.tamaire")).unwrap();
    let mut window = window(Files::in_folder(folder.path()));
    start(&mut window, "classic");
    win(&mut window);
    for name in ["classic-2", "classic-3"] {
        click(&mut window, "Save replay");
        game(&mut window).files.finish();
        assert!(replays.join(format!("{name}.tamaire")).is_file(), "{name}");
    }
    drop(window);
    // A game without storage saves nothing, and does not wait for anything.
    let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
    game.keep_replay();
    assert_eq!(game.files.finish().len(), 1);
}
