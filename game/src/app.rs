//! The loop: devices → actions and wishes → time → picture and sound.

use crate::game::{Game, Screen};
use crate::input::{Action, Seat};
use crate::look::Stage;
use crate::screens;
use egui::{Event, Key, Modifiers, PointerButton, RawInput};
use std::sync::{Arc, Mutex, PoisonError};
use sticks::{Change, Control, Navigator, PadButton};

/// The font that the game writes with.
const FONT: &[u8] = include_bytes!("../fonts/MPLUSRounded1c-Bold.ttf");

/// The game in a window.
pub struct App {
    /// Its state.
    pub game: Game,
    stage: Stage,
    navigators: Vec<(sticks::DeviceId, Navigator)>,
    presses: Presses,
    text_size: f32,
    screen_before: Screen,
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
        let (navigators, text_size) = (Vec::new(), 0.0);
        let presses = Presses::default();
        context.egui_ctx.add_plugin(presses.clone());
        Ok(Self {
            game,
            stage,
            navigators,
            presses,
            text_size,
            screen_before,
        })
    }

    /// Takes in sticks and pads: in a round they ask for actions, in a menu they move the focus.
    fn hear_sticks(&mut self, seconds: f32) {
        let changes = self.game.hear_sticks();
        let in_menu = !matches!(self.game.screen, Screen::Play);
        for change in changes {
            let Change::Pressed { device, control } = change else {
                continue;
            };
            if let Some(action) = self.game.rebinding.take() {
                self.game.settings.bindings.bind_button(action, control);
                self.game.keep_settings();
                continue;
            }
            match (in_menu, control) {
                (true, Control::Pad(PadButton::South) | Control::Button(0)) => {
                    self.press(Key::Enter)
                }
                (true, Control::Pad(PadButton::East) | Control::Button(1)) => {
                    self.press(Key::Escape)
                }
                _ => {
                    if let Some(action) = self.game.settings.bindings.of_button(control) {
                        self.game.act(action, Seat::Stick(device));
                    }
                }
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
                if in_menu {
                    self.press(match direction {
                            sticks::Direction::Up => Key::ArrowUp,
                            sticks::Direction::Down => Key::ArrowDown,
                            sticks::Direction::Left => Key::ArrowLeft,
                            sticks::Direction::Right => Key::ArrowRight,
                        },
                    );
                }
            }
        }
    }

    /// As if a key were pressed and let go in the next frame.
    fn press(&self, key: Key) {
        self.presses.0.lock().unwrap_or_else(PoisonError::into_inner).push(key);
    }

    /// Takes in keys and the pointer.
    fn hear_window(&mut self, ctx: &egui::Context) {
        let game = &mut self.game;
        let (events, keys, pointer, down, focused) = ctx.input(|input| {
            let pointer = &input.pointer;
            (
                input.events.clone(),
                input.keys_down.clone(),
                pointer.latest_pos(),
                pointer.button_down(PointerButton::Primary) || pointer.delta() != egui::Vec2::ZERO,
                input.focused,
            )
        });
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
            if let Some(action) = game.rebinding.take() {
                if key != Key::Escape {
                    game.settings.bindings.bind_key(action, key);
                    game.keep_settings();
                }
                continue;
            }
            if let Some(action) = game.settings.bindings.of_key(key) {
                // In a menu Escape goes back, which the menus see to.
                let is_back = key == Key::Escape && game.screen != Screen::Play;
                if !is_back || game.screen == Screen::Paused {
                    game.act(action, Seat::Keys);
                }
            }
        }
        game.devices.keys = keys.into_iter().collect();
        game.devices.pointer = match (game.view, pointer) {
            (Some(view), Some(at)) if down => Some(view.in_world(at)),
            _ => None,
        };
        if !focused && game.screen == Screen::Play && game.session.is_played() {
            game.act(Action::Pause, Seat::Keys);
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        for file in dropped {
            game.open(file.path());
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        if self.text_size != self.game.settings.text_size {
            self.text_size = self.game.settings.text_size;
            ctx.set_zoom_factor(self.text_size);
        }
        let seconds = ctx.input(|input| input.stable_dt).min(0.1);
        self.hear_sticks(seconds);
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
        ctx.request_repaint();
    }
}

/// Keys that sticks and pads press in menus, on their way into egui.
#[derive(Clone, Default)]
struct Presses(Arc<Mutex<Vec<Key>>>);

impl egui::Plugin for Presses {
    fn debug_name(&self) -> &'static str {
        "sticks and pads"
    }

    fn input_hook(&mut self, _: &egui::Context, input: &mut RawInput) {
        let mut keys = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        for key in keys.drain(..) {
            let event = |pressed| Event::Key {
                key,
                physical_key: None,
                pressed,
                repeat: false,
                modifiers: Modifiers::NONE,
            };
            input.events.extend([event(true), event(false)]);
        }
    }
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
    context.all_styles_mut(|style| {
        style.interaction.selectable_labels = false;
        style.spacing.item_spacing = egui::vec2(10.0, 6.0);
    });
}
