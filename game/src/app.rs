//! The loop: devices → actions and wishes → time → picture and sound.

use crate::game::{Game, Screen};
use crate::input::{Action, Seat};
use crate::look::Stage;
use crate::screens;
use egui::{Event, Key, Modifiers, PointerButton, RawInput};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use sticks::{Change, Control, Navigator, PadButton};

/// The font that the game writes with.
const FONT: &[u8] = include_bytes!("../fonts/MPLUSRounded1c-Bold.ttf");

/// Each screen has room enough in a window of this many points.
const ROOM: egui::Vec2 = egui::vec2(900.0, 640.0);

/// In space: how far the wheel raises the hand [m/point] and what share of a body it cuts off [1/point], how far the mouse [rad/point] and how fast a key or a pad's right
/// stick turns the camera [rad/s].
const WHEEL: f32 = 0.002;
const CUT: f32 = 0.0012;
const DRAG: f32 = 0.006;
const TURN: f32 = 1.5;

/// Keys that menus understand.
const OF_MENUS: [Key; 8] = [
    Key::Escape,
    Key::Tab,
    Key::Enter,
    Key::Space,
    Key::ArrowUp,
    Key::ArrowDown,
    Key::ArrowLeft,
    Key::ArrowRight,
];

/// Keys that count once however long they are held: what they lead to must not be left at once.
const ONCE: [Key; 3] = [Key::Escape, Key::Enter, Key::Space];

/// The game in a window.
pub struct App {
    /// Its state.
    pub game: Game,
    stage: Stage,
    navigators: Vec<(sticks::DeviceId, Navigator)>,
    presses: Presses,
    screen_before: Screen,
    /// Whether the window ever had the focus.
    had_focus: bool,
}

/// The window has no GPU, not even one in software.
#[derive(Copy, Clone, Debug, thiserror::Error)]
#[error("there is nothing to draw with: neither Vulkan nor OpenGL, not even in software")]
pub struct NoGpu;

impl App {
    /// The game in a window of eframe's.
    ///
    /// # Errors
    /// When the window has no GPU, not even one in software.
    pub fn new(context: &eframe::CreationContext, game: Game) -> Result<Self, NoGpu> {
        dress(&context.egui_ctx);
        let stage = Stage::new(context.wgpu_render_state.as_ref().ok_or(NoGpu)?);
        let screen_before = game.screen.clone();
        let navigators = Vec::new();
        let presses = Presses::default();
        context.egui_ctx.add_plugin(presses.clone());
        Ok(Self {
            game,
            stage,
            navigators,
            presses,
            screen_before,
            had_focus: false,
        })
    }

    /// Takes in sticks and pads: in a round they ask for actions, in a menu they move the focus.
    fn hear_sticks(&mut self, ctx: &egui::Context, seconds: f32) {
        let changes = self.game.hear_sticks();
        if self.game.is_away {
            // They are used for something else, in another window.
            return;
        }
        // What is to get a meaning has none now.
        let in_menu = self.game.screen != Screen::Play && self.game.rebinding.is_none();
        for change in changes {
            let Change::Pressed { device, control } = change else {
                continue;
            };
            screens::note_use_of_keys(ctx, true);
            let is_of_menus = matches!(
                control,
                Control::Pad(PadButton::South | PadButton::East) | Control::Button(0 | 1)
            );
            if let Some(action) = self.game.rebinding {
                if action == Action::CutForces && is_of_menus {
                    // Nobody could go on in a menu without cutting forces.
                    continue;
                }
                self.game.rebinding = None;
                self.game.settings.bindings.bind_button(action, control);
                self.game.keep_settings();
                continue;
            }
            let action = self.game.settings.bindings.of_button(control);
            match (control, action) {
                // Whatever is on: it must not be looked for.
                (_, Some(Action::CutForces)) => {
                    self.game.act(Action::CutForces, Seat::Stick(device))
                }
                (Control::Pad(PadButton::South) | Control::Button(0), _) if in_menu => {
                    self.press(Key::Enter)
                }
                (Control::Pad(PadButton::East) | Control::Button(1), _) if in_menu => {
                    self.press(Key::Escape)
                }
                (_, Some(action)) => self.game.act(action, Seat::Stick(device)),
                (_, None) => {}
            }
        }
        let devices = self.game.devices.sticks.devices.clone();
        self.navigators
            .retain(|(id, _)| devices.iter().any(|device| device.id == *id));
        for device in &devices {
            let known = self.navigators.iter().position(|(id, _)| *id == device.id);
            let place = known.unwrap_or_else(|| {
                self.navigators.push((device.id, Navigator::default()));
                self.navigators.len() - 1
            });
            for direction in self.navigators[place].1.step(device, seconds) {
                screens::note_use_of_keys(ctx, true);
                // One that is tried is pushed about for its own sake.
                let is_tried = self
                    .game
                    .trial
                    .is_some_and(|trial| trial.device == device.id);
                if in_menu && !is_tried {
                    self.press(match direction {
                        sticks::Direction::Up => Key::ArrowUp,
                        sticks::Direction::Down => Key::ArrowDown,
                        sticks::Direction::Left => Key::ArrowLeft,
                        sticks::Direction::Right => Key::ArrowRight,
                    });
                }
            }
        }
    }

    /// As if a key were pressed and let go in the next frame.
    fn press(&self, key: Key) {
        self.presses.waiting().keys.push(key);
    }

    /// Takes in keys and the pointer.
    fn hear_window(&mut self, ctx: &egui::Context) {
        let game = &mut self.game;
        let (events, keys, pointer, is_down) = ctx.input(|input| {
            let pointer = &input.pointer;
            (
                input.events.clone(),
                input.keys_down.clone(),
                pointer.latest_pos(),
                pointer.button_down(PointerButton::Primary),
            )
        });
        for event in &events {
            match event {
                Event::Key { .. } => screens::note_use_of_keys(ctx, true),
                Event::PointerMoved(_) | Event::PointerButton { .. } => {
                    screens::note_use_of_keys(ctx, false);
                }
                // A window may never get the focus, and be played with the mouse: only losing it counts.
                Event::WindowFocused(focused) => {
                    game.is_away = self.had_focus && !focused;
                    self.had_focus |= focused;
                    if game.is_away {
                        game.rest();
                    }
                }
                _ => {}
            }
        }
        // Where the mouse is counts until a tick has heard of it; on a button it does not mean the hand.
        let has_moved = |event: &Event| matches!(event, Event::PointerMoved(_));
        // Nor while it turns the camera.
        let turns = ctx.input(|input| input.pointer.button_down(PointerButton::Secondary));
        let points = !turns && (is_down || events.iter().any(has_moved));
        let is_on_button = ctx.interaction_snapshot(|seen| !seen.hovered.is_empty());
        if game.screen != Screen::Play || is_on_button {
            game.devices.pointer = None;
        } else if let (Some(view), Some(at), true) = (game.view, pointer, points) {
            let height = game.session.round().hands()[0].goal()[1];
            game.devices.pointer = Some(view.in_world(at, height));
        }
        game.devices.keys = keys.into_iter().collect();
        if game.screen == Screen::Play && game.turn().is_some() && game.session.is_played() {
            look_around(game, ctx, turns);
        }
        let mut taken = Vec::new();
        for event in &events {
            let Event::Key {
                key,
                pressed: true,
                repeat: false,
                ..
            } = *event
            else {
                continue;
            };
            if let Some(action) = game.rebinding {
                if action == Action::CutForces && OF_MENUS.contains(&key) && key != Key::Escape {
                    taken.push(key);
                    continue;
                }
                game.rebinding = None;
                if key != Key::Escape {
                    game.settings.bindings.bind_key(action, key);
                    game.keep_settings();
                }
                taken.push(key);
                continue;
            }
            let action = game.settings.bindings.of_key(key);
            // In a menu these move about in it, whatever they mean in a round. But for what must not be looked for.
            let is_of_menu = game.screen != Screen::Play && OF_MENUS.contains(&key);
            if let Some(action) =
                action.filter(|action| !is_of_menu || *action == Action::CutForces)
            {
                game.act(action, Seat::Keys);
                taken.push(key);
            }
        }
        // A menu that has just come up must not take it for a click or for the way back.
        let is_taken = |event: &Event| match event {
            Event::Key { key, pressed, .. } => *pressed && taken.contains(key),
            _ => false,
        };
        ctx.input_mut(|input| input.events.retain(|event| !is_taken(event)));
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        for file in dropped {
            game.open(file.path());
        }
    }
}

/// In space the wheel raises the hand, or cuts bodies open where their elements are seen, and the camera turns: with the mouse where that `drags`, with keys and pads.
fn look_around(game: &mut Game, ctx: &egui::Context, drags: bool) {
    let (wheel, delta, seconds) = ctx.input(|input| {
        let seconds = input.stable_dt.min(0.1);
        (input.smooth_scroll_delta.y, input.pointer.delta(), seconds)
    });
    if game.elements.is_none() {
        game.devices.lift += WHEEL * wheel;
    } else if wheel != 0.0 {
        let still = game.settings.reduced_motion;
        game.opening.cut(CUT * wheel, game.time, still);
    }
    if drags {
        game.camera.orbit(-DRAG * delta.x, DRAG * delta.y);
    }
    let bindings = &game.settings.bindings;
    let held = |action| {
        let mut keys = game.devices.keys.iter();
        f32::from(u8::from(
            keys.any(|&key| bindings.of_key(key) == Some(action)),
        ))
    };
    let sticks = game.devices.sticks.devices.iter();
    let pads: f32 = sticks.filter_map(|device| Some(device.pad?.right[0])).sum();
    let pads = if pads.abs() > 0.3 {
        pads.clamp(-1.0, 1.0)
    } else {
        0.0
    };
    let turn = held(Action::TurnRight) - held(Action::TurnLeft) + pads;
    game.camera.orbit(TURN * turn * seconds, 0.0);
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        fit(&ctx, self.game.settings.text_size);
        let seconds = ctx.input(|input| input.stable_dt).min(0.1);
        self.hear_sticks(&ctx, seconds);
        self.hear_window(&ctx);
        self.game.pass(seconds);
        if self.screen_before != self.game.screen {
            // What had the focus is gone.
            self.screen_before = self.game.screen.clone();
            ctx.memory_mut(|memory| {
                if let Some(id) = memory.focused() {
                    memory.surrender_focus(id);
                }
            });
        }
        screens::show(&mut self.game, &mut self.stage, ui);
        // What stands in these is of many widths.
        let is_list = matches!(
            self.game.screen,
            Screen::Settings(_) | Screen::Forces(_) | Screen::Replays
        );
        self.presses.waiting().in_order = is_list && self.game.rebinding.is_none();
        ctx.request_repaint();
    }
}

/// Shows letters and all else at a size that was chosen, or smaller where the window lacks room.
fn fit(ctx: &egui::Context, text_size: f32) {
    let room = ctx.content_rect().size() * ctx.zoom_factor() / ROOM;
    let zoom = text_size.min(room.min_elem()).max(0.1);
    // Nothing changes its size under the mouse that drags it.
    if !ctx.input(|input| input.pointer.any_down()) {
        ctx.set_zoom_factor(zoom);
    }
}

/// Keys on their way into egui.
#[derive(Clone, Default)]
struct Presses(Arc<Mutex<Waiting>>);

#[derive(Default)]
struct Waiting {
    /// What sticks and pads press in menus.
    keys: Vec<Key>,
    /// Whether up and down lead through everything in its order, and not to what lies above or below.
    in_order: bool,
    /// Which of [`ONCE`] are held.
    held: Vec<Key>,
}

impl Presses {
    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl egui::Plugin for Presses {
    fn debug_name(&self) -> &'static str {
        "sticks and pads"
    }

    fn input_hook(&mut self, _: &egui::Context, input: &mut RawInput) {
        let mut waiting = self.waiting();
        let held = &mut waiting.held;
        input.events.retain(|event| match *event {
            Event::Key { key, pressed, .. } if ONCE.contains(&key) => {
                let was_held = held.contains(&key);
                held.retain(|other| *other != key);
                if pressed {
                    held.push(key);
                }
                !(pressed && was_held)
            }
            Event::WindowFocused(false) => {
                held.clear();
                true
            }
            _ => true,
        });
        for key in std::mem::take(&mut waiting.keys) {
            input.events.extend(stroke(key, Modifiers::NONE));
        }
        if waiting.in_order {
            input.events = std::mem::take(&mut input.events)
                .into_iter()
                .flat_map(|event| match event {
                    Event::Key {
                        key: Key::ArrowDown,
                        pressed: true,
                        ..
                    } => stroke(Key::Tab, Modifiers::NONE).to_vec(),
                    Event::Key {
                        key: Key::ArrowUp,
                        pressed: true,
                        ..
                    } => stroke(Key::Tab, Modifiers::SHIFT).to_vec(),
                    event => vec![event],
                })
                .collect();
        }
    }
}

/// A key is pressed and let go.
fn stroke(key: Key, modifiers: Modifiers) -> [Event; 2] {
    [true, false].map(|pressed| Event::Key {
        key,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers,
    })
}

/// Gives egui the game's font and takes its toolbox look away.
fn dress(context: &egui::Context) {
    let mut fonts = egui::FontDefinitions::empty();
    let name = "rounded".to_string();
    fonts
        .font_data
        .insert(name.clone(), Arc::new(egui::FontData::from_static(FONT)));
    for family in [egui::FontFamily::Proportional, egui::FontFamily::Monospace] {
        fonts.families.entry(family).or_default().push(name.clone());
    }
    context.set_fonts(fonts);
    context.set_theme(egui::Theme::Light);
    // The text size is a setting.
    context.options_mut(|options| options.zoom_with_keyboard = false);
    context.all_styles_mut(|style| {
        style.interaction.selectable_labels = false;
        style.spacing.item_spacing = egui::vec2(10.0, 6.0);
    });
}
