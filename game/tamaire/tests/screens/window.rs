//! Offscreen window, and the ways in which players operate it.

use app_shell::{Clock, Pads};
use egui::accesskit::Role;
use egui::{Event, PointerButton, Pos2};
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, Node};
use fuwafuwa::{DEFAULT_TICK, Vec3};
use std::path::{Path, PathBuf};
use tamaire::app::App;
use tamaire::game::{Game, Screen};
use tamaire::platform::{Files, Sound};
use tamaire_play::{Bot, BotKind};
use tempfile::TempDir;

pub type Window = Harness<'static, App>;

/// Opens a window with few pixels, which draws quickly.
pub fn window(files: Files) -> Window {
    open(files, egui::vec2(960.0, 600.0), 0.25)
}

/// Opens a window of `size` points, with `pixels` pixels per point.
pub fn open(files: Files, size: egui::Vec2, pixels: f32) -> Window {
    let builder = Harness::builder().with_size(size).wgpu();
    let builder = builder.with_pixels_per_point(pixels);
    let builder = builder.with_step_dt(DEFAULT_TICK).with_render_cursor(false);
    // Theme of the game; the harness would use dark colours.
    let builder = builder.with_theme(egui::Theme::Light);
    let mut window = builder.build_eframe(|context| {
        let mut game = Game::new(files, Sound::none(), Pads::none());
        // A constant clock makes the test independent of the machine's load.
        game.clock = Clock::of(|| 0.0);
        App::new(context, game).expect("a GPU or a software adapter is available")
    });
    frames(&mut window, 2);
    // The size is set after two frames, because the harness does not know the game's zoom before.
    let zoom = window.ctx.zoom_factor();
    window.set_size(size / zoom);
    // The mouse is away from all buttons, so that no button is hovered.
    window.hover_at(egui::Pos2::ZERO);
    frames(&mut window, 2);
    window
}

/// Creates an empty folder for a test.
pub fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Runs frames until everything is written.
pub fn wait_for_files(window: &mut Window) {
    while game(window).files.is_busy() {
        frames(window, 1);
    }
    frames(window, 1);
}

/// Press or release of a mouse button.
pub fn pointer_button(pos: Pos2, button: PointerButton, pressed: bool) -> Event {
    Event::PointerButton {
        pos,
        button,
        pressed,
        modifiers: egui::Modifiers::NONE,
    }
}

/// Targets of all hands [m].
pub fn hand_targets(window: &Window) -> Vec<Vec3> {
    let hands = window.state().game.bout.round().hands();
    hands.iter().map(|hand| hand.target).collect()
}

/// Path of a file among the levels of the game.
pub fn level_file(name: &str) -> PathBuf {
    let levels = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tamaire_play/levels");
    levels.join(name)
}

/// Runs `count` frames. The game always repaints, so there is no state to wait for. Draws every 16th frame: drawing in
/// software is slow, but the memory of uploads is freed only when a frame is drawn.
pub fn frames(window: &mut Window, count: usize) {
    for _ in 0..count {
        window.run_steps(1);
        if window.ctx.cumulative_frame_nr().is_multiple_of(16) {
            window.render().expect("the frame is drawn");
        }
    }
}

pub fn game(window: &mut Window) -> &mut Game {
    &mut window.state_mut().game
}

pub fn screen(window: &Window) -> Screen {
    window.state().game.screen()
}

/// Number of ticks of the current round.
pub fn ticks(window: &Window) -> usize {
    window.state().game.bout.round().frames().len()
}

/// Returns the notices on the screen.
pub fn notices(window: &Window) -> String {
    let notices = window.state().game.notices.iter();
    notices
        .map(|notice| notice.text.as_str())
        .collect::<Vec<_>>()
        .join("\n")
}

/// Starts the level with this id, and draws it.
pub fn start(window: &mut Window, id: &str) {
    let game = game(window);
    game.start(place_of(game, id));
    frames(window, 2);
}

/// Returns the index of the level with this id.
pub fn place_of(game: &Game, id: &str) -> usize {
    let index = game.levels.iter().position(|level| level.id == id);
    index.expect("the level is built in")
}

/// Returns the button with this name.
pub fn button<'w>(window: &'w Window, name: &'w str) -> Node<'w> {
    window.get_by_role_and_label(Role::Button, name)
}

/// Clicks the button with this name.
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

/// Lets a bot play while `goes_on` holds, as a player does with the mouse.
pub fn drive(game: &mut Game, kind: BotKind, goes_on: impl Fn(&Game) -> bool) {
    let mut bot = Bot::new(kind, 1);
    while goes_on(game) {
        assert!(
            game.bout.round().frames().len() < 60 * 60,
            "the round takes longer than a minute"
        );
        let round = game.bout.round();
        game.controls.devices.pointer = match game.controls.players.is_picked_up(0) {
            true => round.ask(&mut bot).goal(0),
            // The player picks up the hand first.
            false => Some(round.hands()[0].target),
        };
        game.update(DEFAULT_TICK);
    }
    game.controls.devices.pointer = None;
}

/// Lets a bot win the current round, and waits for the result.
pub fn win(window: &mut Window) {
    drive(game(window), BotKind::Squeeze, |game| {
        game.bout.won.is_none()
    });
    game(window).update(2.0);
    frames(window, 2);
    assert_eq!(screen(window), Screen::Result);
}

/// Sends a touch event as eframe does, which also reports the first finger as the mouse.
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
            let pressed = phase == egui::TouchPhase::Start;
            window.event(pointer_button(pos, PointerButton::Primary, pressed));
        }
    }
    frames(window, 1);
}

/// Moves the mouse to the first hand, which then follows it.
pub fn pick_up(window: &mut Window) {
    let view = window.state().game.bout.view.expect("the world is visible");
    let at = view.to_screen(hand_targets(window)[0]);
    window.hover_at(at);
    frames(window, 1);
    window.hover_at(at + egui::vec2(1.0, 0.0));
    frames(window, 1);
    assert!(game(window).controls.players.is_picked_up(0));
}
