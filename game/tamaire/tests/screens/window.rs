//! A window that nobody sees, and what people do with it.

use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, Node};
use fuwafuwa::world::TICK;
use std::path::PathBuf;
use tamaire::app::App;
use tamaire::game::{Game, Screen};
use tamaire::platform::{Clock, Files, Pads, Sound};
use tamaire_play::{Bot, BotKind};

pub type Window = Harness<'static, App>;

/// A window with few pixels, which are drawn quickly.
pub fn window(files: Files) -> Window {
    open(files, egui::vec2(960.0, 600.0), 0.25)
}

/// A window of so many points, each so many pixels wide.
pub fn open(files: Files, size: egui::Vec2, pixels: f32) -> Window {
    let builder = Harness::builder().with_size(size).wgpu();
    let builder = builder.with_pixels_per_point(pixels);
    let builder = builder.with_step_dt(TICK).with_render_cursor(false);
    // As the game has it; the harness would darken what egui draws.
    let builder = builder.with_theme(egui::Theme::Light);
    let mut window = builder.build_eframe(|context| {
        let mut game = Game::new(files, Sound::none(), Pads::none());
        // Nothing depends on what else the machine does.
        game.clock = Clock::of(|| 0.0);
        App::new(context, game).expect("there is a GPU, if only in software")
    });
    frames(&mut window, 2);
    // In its first two frames the harness takes points for those without the game's zoom.
    let zoom = window.ctx.zoom_factor();
    window.set_size(size / zoom);
    // Where a mouse rests when a window opens is no wish of anybody's.
    window.hover_at(egui::Pos2::ZERO);
    frames(&mut window, 2);
    window
}

/// A folder of its own for a test, empty.
pub fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("tamaire-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Lets frames pass; the game never stands still, so there is no waiting for that.
pub fn frames(window: &mut Window, count: usize) {
    window.run_steps(count);
}

pub fn game(window: &mut Window) -> &mut Game {
    &mut window.state_mut().game
}

pub fn screen(window: &Window) -> Screen {
    window.state().game.screen()
}

/// Ticks that the round has lasted.
pub fn ticks(window: &Window) -> usize {
    window.state().game.bout.round().frames().len()
}

/// What the player is told.
pub fn notices(window: &Window) -> String {
    let notices = window.state().game.notices.iter();
    notices
        .map(|notice| notice.text.as_str())
        .collect::<Vec<_>>()
        .join("\n")
}

/// Begins the level of this name, and lets it be seen.
pub fn start(window: &mut Window, id: &str) {
    let game = game(window);
    let index = game.levels.iter().position(|level| level.id == id);
    game.start(index.expect("it comes along"));
    frames(window, 2);
}

/// The button of this name.
pub fn button<'w>(window: &'w Window, name: &'w str) -> Node<'w> {
    window.get_by_role_and_label(Role::Button, name)
}

/// Clicks the button of this name.
pub fn click(window: &mut Window, name: &str) {
    button(window, name).scroll_to_me();
    frames(window, 3);
    button(window, name).click();
    frames(window, 2);
}

pub fn press(window: &mut Window, key: egui::Key) {
    window.key_press(key);
    frames(window, 2);
}

/// Lets a bot play as a person does, with its hand where the mouse points, while `goes_on`.
pub fn drive(game: &mut Game, kind: BotKind, goes_on: impl Fn(&Game) -> bool) {
    let mut bot = Bot::new(kind, 1);
    while goes_on(game) {
        assert!(
            game.bout.round().frames().len() < 60 * 60,
            "a minute, and no end"
        );
        game.controls.devices.pointer = game.bout.round().ask(&mut bot).goal(0);
        game.pass(TICK);
    }
    game.controls.devices.pointer = None;
}

/// Wins the round that is on, and waits for the result.
pub fn win(window: &mut Window) {
    drive(game(window), BotKind::Squeeze, |game| {
        game.bout.won.is_none()
    });
    game(window).pass(2.0);
    frames(window, 2);
    assert_eq!(screen(window), Screen::Result);
}

/// What a finger does, as eframe tells it: the first is a mouse as well.
pub fn touch(window: &mut Window, finger: u64, phase: egui::TouchPhase, pos: egui::Pos2) {
    window.event(egui::Event::Touch {
        device_id: egui::TouchDeviceId(1),
        id: egui::TouchId(finger),
        phase,
        pos,
        force: None,
    });
    if finger == 0 {
        window.event(egui::Event::PointerMoved(pos));
        if phase != egui::TouchPhase::Move {
            window.event(egui::Event::PointerButton {
                pos,
                button: egui::PointerButton::Primary,
                pressed: phase == egui::TouchPhase::Start,
                modifiers: egui::Modifiers::NONE,
            });
        }
    }
    frames(window, 1);
}
