//! Robustness against broken files and random input.

use crate::pads::pad;
use crate::window::*;
use app_shell::Pads;
use egui::accesskit::Role;
use egui::{DroppedFile, Event, Key, PointerButton, pos2};
use egui_kittest::kittest::Queryable;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use sticks::{Device, DeviceId, DeviceInfo, PadButton, Snapshot};
use tamaire::game::{Game, Screen};
use tamaire::platform::Files;
use tamaire::words::Language;
use tamaire_play::BotKind;

#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        fs::read(&self.0).map_err(|error| error.to_string())
    }
}

pub fn drop_file(window: &mut Window, path: PathBuf) {
    game(window).notices.clear();
    window
        .input_mut()
        .dropped_files
        .push(Arc::new(Dropped(path)));
    frames(window, 2);
}

#[test]
fn dropped_picture_is_played_and_broken_files_are_named() {
    let folder = folder();
    let mut window = window(Files::in_folder(folder.path()));
    drop_file(&mut window, level_file("cat.png"));
    assert_eq!(
        (screen(&window), notices(&window).as_str()),
        (Screen::Play, "")
    );
    let name = |window: &Window| {
        let level = window.state().game.bout.round().level();
        level.game().name.en.clone()
    };
    assert_eq!(name(&window), "cat");

    let broken = folder.path().join("broken.toml");
    fs::write(&broken, "dim = 2\ngravity = \"down\"\n").unwrap();
    drop_file(&mut window, broken);
    let said = notices(&window);
    assert!(
        said.contains("broken.toml") && said.contains("line 2"),
        "{said}"
    );
    for (file, bytes) in [
        ("no.png", &b"no picture"[..]),
        ("no.tamaire", b"no replay"),
        ("no.zip", b"\xff\xfe"),
        ("no", b""),
    ] {
        let path = folder.path().join(file);
        fs::write(&path, bytes).unwrap();
        drop_file(&mut window, path);
        assert!(
            notices(&window).contains(file),
            "{file}: {}",
            notices(&window)
        );
    }
    for path in [
        folder.path().join("nowhere.toml"),
        folder.path().into(),
        PathBuf::new(),
    ] {
        drop_file(&mut window, path.clone());
        assert_ne!(notices(&window), "", "{path:?}");
    }
    let before = ticks(&window);
    frames(&mut window, 5);
    assert_eq!(name(&window), "cat");
    assert!(ticks(&window) >= before + 5, "the game continues");
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_without_waiting() {
    let folder = folder();
    let mut window = window(Files::nowhere());
    for (made, file) in [
        ("mkfifo", "a.toml"),
        ("mkfifo", "a.png"),
        ("mkfifo", "a.vox"),
        ("mkfifo", "a.tamaire"),
        ("mkfifo", "a"),
        ("ln -s /dev/zero", "b.toml"),
        ("ln -s /dev/zero", "b.png"),
        ("ln -s /dev/zero", "b.tamaire"),
    ] {
        let path = folder.path().join(file);
        let mut words = made.split(' ');
        let mut command =
            std::process::Command::new(words.next().expect("the command names a program"));
        assert!(command.args(words).arg(&path).status().unwrap().success());
        drop_file(&mut window, path);
        let said = notices(&window);
        assert!(said.contains(file) && said.contains("a device"), "{said}");
    }
}

#[test]
fn notice_is_truncated() {
    let mut window = window(Files::nowhere());
    let game = game(&mut window);
    game.notices.clear();
    game.notify("ふ".repeat(1 << 20));
    let notice = game.notices.iter().next().unwrap();
    assert_eq!(notice.text.chars().count(), 601);
    assert!(notice.seconds < 60.0, "{} s", notice.seconds);
}

#[test]
fn long_notice_stays_longer() {
    let mut window = window(Files::nowhere());
    let game = game(&mut window);
    game.notices.clear();
    game.notify("short".into());
    game.notify("a level with many words ".repeat(8));
    let left = |game: &Game| game.notices.iter().count();
    game.update(5.9);
    assert_eq!(left(game), 2);
    game.update(0.2);
    assert_eq!(left(game), 1);
    game.update(7.0);
    assert_eq!(left(game), 0);
}

#[test]
fn round_pauses_when_focus_is_lost() {
    let mut window = window(Files::nowhere());
    let focus = |window: &mut Window, focused| {
        window.input_mut().focused = focused;
        window.event(Event::WindowFocused(focused));
        frames(window, 2);
    };
    focus(&mut window, false);
    assert_eq!(screen(&window), Screen::Title);
    // A round also starts in a window without focus; only losing the focus pauses a round.
    game(&mut window).start(0);
    frames(&mut window, 5);
    assert_eq!(screen(&window), Screen::Play);
    focus(&mut window, true);
    assert_eq!(screen(&window), Screen::Play);
    focus(&mut window, false);
    assert_eq!(screen(&window), Screen::Paused);
}

#[test]
fn buttons_fit_into_width_of_small_windows_with_large_text() {
    let sizes = [
        [900.0, 640.0],
        [640.0, 400.0],
        [390.0, 844.0],
        [844.0, 390.0],
    ];
    for size in sizes.map(egui::Vec2::from) {
        let mut window = open(Files::nowhere(), size, 0.5);
        game(&mut window).settings.text_size = 1.6;
        game(&mut window).start(0);
        win(&mut window);
        let round = game(&mut window).bout.round();
        let wishes = round.level().game().wish.len();
        assert!(wishes == 3 && game(&mut window).bout.won.unwrap().1);
        let screens = [Screen::Result, Screen::Paused, Screen::Title];
        for (screen, count) in screens.into_iter().zip([8, 7, 7]) {
            for (language, _) in Language::ALL {
                game(&mut window).settings.language = language;
                game(&mut window).go(screen);
                frames(&mut window, 3);
                let room = window.ctx.content_rect();
                let buttons: Vec<_> = window.get_all_by_role(Role::Button).collect();
                assert_eq!(buttons.len(), count, "{screen:?}");
                for button in buttons {
                    let rect = button.rect();
                    // Columns that are higher than the window scroll.
                    let fits = room.left() <= rect.left() && rect.right() <= room.right();
                    assert!(fits, "{screen:?}: {rect:?} in {room:?}");
                }
                last_button(&window).scroll_to_me();
                frames(&mut window, 20);
                let last = last_button(&window).rect();
                let is_seen = room.expand(1.0).contains_rect(last);
                assert!(is_seen, "{screen:?}: {last:?} in {room:?}");
            }
        }
    }
}

fn last_button(window: &Window) -> egui_kittest::Node<'_> {
    let mut buttons: Vec<_> = window.get_all_by_role(Role::Button).collect();
    buttons.pop().expect("the screen has buttons")
}

#[test]
fn replay_bar_has_two_rows_in_narrow_window() {
    for (size, is_narrow) in [([390.0, 844.0], true), ([960.0, 600.0], false)] {
        let mut window = open(Files::nowhere(), egui::Vec2::from(size), 0.5);
        game(&mut window).settings.text_size = if is_narrow { 1.6 } else { 1.0 };
        game(&mut window).start(0);
        frames(&mut window, 20);
        let replay = game(&mut window).bout.round().replay();
        game(&mut window).watch(replay.into()).unwrap();
        frames(&mut window, 3);
        let room = window.ctx.content_rect();
        let slider = window.get_by_role(Role::Slider).rect();
        let speeds = window.get_all_by_role(Role::RadioButton);
        let speeds: Vec<_> = speeds.map(|speed| speed.rect()).collect();
        assert_eq!(speeds.len(), 4);
        assert!(room.contains_rect(slider) && slider.width() >= 60.0);
        for speed in speeds {
            assert!(room.contains_rect(speed), "{speed:?} in {room:?}");
            assert!(!speed.intersects(slider), "{speed:?} and {slider:?}");
            assert_eq!(speed.top() > slider.bottom(), is_narrow);
        }
    }
}

#[test]
fn random_input_causes_no_fault() {
    let folder = folder();
    let mut random = fastrand::Rng::with_seed(7);
    let mut window = window(Files::in_folder(folder.path()));
    let stick = Device::at_rest(DeviceId(2), DeviceInfo::default(), 2, 8, 1);
    let mut devices = vec![pad(1), stick];
    let mut seen = std::collections::BTreeSet::new();
    // The test window handles one queued event in each frame, so a click takes three frames.
    for frame in 0..1000 {
        let at = pos2(960.0 * random.f32(), 600.0 * random.f32());
        match random.u32(0..12) {
            0..4 => {
                window.event(Event::PointerMoved(at));
                for pressed in [true, false] {
                    window.event(pointer_button(at, PointerButton::Primary, pressed));
                }
            }
            4..7 => window.key_press(Key::ALL[random.usize(..Key::ALL.len())]),
            7 => window.key_press(Key::Enter),
            8 => devices[0].pad.as_mut().unwrap().left = [random.f32() * 2.0 - 1.0, f32::NAN],
            9 | 10 => {
                let button = PadButton::ALL[random.usize(..PadButton::ALL.len())];
                let pad = devices[0].pad.as_mut().unwrap();
                for other in PadButton::ALL {
                    pad.button_mut(other).down = false;
                }
                pad.button_mut(button).press();
                let button = random.usize(..8);
                devices[1].buttons[button].press();
            }
            _ => {}
        }
        let told = match frame % 100 {
            90.. => Vec::new(),
            _ => devices.clone(),
        };
        let game = game(&mut window);
        game.controls.pads = Pads::of(Snapshot { devices: told });
        match (frame % 100, random.u32(..5)) {
            (99, 0) => game.go(Screen::Title),
            (99, 1) => game.go(Screen::Replays),
            (99, 2) => game.go(Screen::Settings),
            (99, _) => game.start(random.usize(..game.levels.len())),
            _ => {}
        }
        if frame == 500 {
            game.start(0);
            drive(game, BotKind::Squeeze, |game| game.bout.won.is_none());
            game.update(2.0);
        }
        seen.insert(format!("{:?}", screen(&window)));
        frames(&mut window, 1);
        check(&window.state().game, frame);
    }
    assert!(seen.len() >= 6, "{seen:?}");
}

fn check(game: &Game, frame: usize) {
    let round = game.bout.round();
    let [low, high] = round.level().arena();
    for hand in round.hands() {
        let at = hand.position;
        let is_in = |axis: usize| low[axis] <= at[axis] && at[axis] <= high[axis];
        assert!(is_in(0) && is_in(1), "frame {frame}: a hand at {at:?}");
    }
    assert_eq!(
        game.settings,
        game.settings.clone().in_range(),
        "frame {frame}"
    );
}
