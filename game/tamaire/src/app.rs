//! The loop: devices → actions and wishes → time → picture and sound.

mod dwell;
mod fingers;
mod pointing;
mod presses;
mod switch;

use crate::game::{Game, Screen};
use crate::input::{Action, Means, Seat};
use crate::look::{Stage, dress};
use crate::platform::{
    Clipboard, GpuWatch, begin_anew, dropped, fill_screen, is_full_by_itself, speak,
};
use crate::screens::{self, Attendant};
use dwell::Dwell;
use egui::{Event, Key};
use fingers::Fingers;
use pointing::{look_around, point};
use presses::Presses;
use sticks::{Change, Control, Navigator, PadButton};
use switch::Switch;

/// Each screen has room enough in a window of this many points.
const ROOM: egui::Vec2 = egui::vec2(900.0, 640.0);
/// And in one of so many that is held upright.
const TALL_ROOM: egui::Vec2 = egui::vec2(600.0, 760.0);
/// In so many steps a screen grows from nothing to its usual size.
const STEPS: f32 = 32.0;
/// A frame that took longer than this [s] counts as this long at a stand: a machine that was asleep has not waited.
const LONGEST: f32 = 1.0;

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

/// The game in a window.
pub struct App {
    /// Its state.
    pub game: Game,
    /// What leads it where visitors find no menus.
    pub attendant: Option<Box<dyn Attendant>>,
    /// An eye on what it is drawn with.
    pub gpu: GpuWatch,
    stage: Stage,
    navigators: Vec<(sticks::DeviceId, Navigator)>,
    presses: Presses,
    fingers: Fingers,
    dwell: Dwell,
    clipboard: Clipboard,
    switch: Switch,
    screen_before: Screen,
    /// Whether the window ever had the focus, whether it was asked to fill the screen, and whether a page did.
    had_focus: bool,
    is_full: bool,
    was_full: bool,
    /// How large points are, as compared with those of the system.
    pub zoom: f32,
}

/// The window has no GPU, not even one in software.
#[derive(Copy, Clone, Debug, thiserror::Error)]
#[error("there is nothing to draw with: neither Vulkan nor OpenGL, not even in software")]
pub struct NoGpu;

impl App {
    /// The game in a window of eframe's, which closes when its GPU is lost.
    ///
    /// # Errors
    /// When the window has no GPU, not even one in software.
    pub fn new(context: &eframe::CreationContext, mut game: Game) -> Result<Self, NoGpu> {
        dress(&context.egui_ctx);
        let state = context.wgpu_render_state.as_ref().ok_or(NoGpu)?;
        let (stage, gpu) = (Stage::new(state), GpuWatch::of(state));
        #[cfg(target_family = "wasm")]
        crate::film::lend(state);
        // Browsers fill the screen only when they are asked by a press.
        game.settings.full_screen &= !cfg!(target_family = "wasm");
        let screen_before = game.screen();
        let navigators = Vec::new();
        let presses = Presses::default();
        context.egui_ctx.add_plugin(presses.clone());
        Ok(Self {
            game,
            attendant: None,
            gpu,
            stage,
            navigators,
            presses,
            fingers: Fingers::default(),
            dwell: Dwell::default(),
            clipboard: Clipboard::default(),
            switch: Switch::default(),
            screen_before,
            had_focus: false,
            is_full: false,
            was_full: false,
            zoom: 1.0,
        })
    }

    /// What was drawn of worlds since this was asked last cost the GPU; what lies over them, egui draws.
    pub fn take_cost(&self) -> fuwafuwa_render::Cost {
        self.stage.take_cost()
    }

    /// Takes in sticks and pads: in a round they ask for actions, in a menu they move the focus.
    fn hear_sticks(&mut self, ctx: &egui::Context, seconds: f32) {
        let changes = self.game.hear_sticks();
        if self.game.is_away {
            // They are used for something else, in another window.
            return;
        }
        // What is to get a meaning has none now.
        let in_menu = self.game.screen() != Screen::Play && self.game.controls.rebinding.is_none();
        for change in changes {
            let Change::Pressed { device, control } = change else {
                continue;
            };
            screens::note_use_of_keys(ctx, true);
            self.game.controls.note_stick(device);
            let is_of_menus = matches!(
                control,
                Control::Pad(PadButton::South | PadButton::East) | Control::Button(0 | 1)
            );
            let is_switch = self.game.settings.scanning.is_on() && Switch::is(control);
            if let Some(action) = self.game.controls.rebinding {
                if is_switch {
                    self.game.controls.rebinding = None;
                    continue;
                }
                if action == Action::CutForces && is_of_menus {
                    // Nobody could go on in a menu without cutting forces.
                    continue;
                }
                self.game.controls.rebinding = None;
                self.game.settings.bindings.bind_button(action, control);
                self.game.keep_settings();
                continue;
            }
            if is_switch && !in_menu {
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
        let devices = self.game.controls.devices.sticks.devices.clone();
        self.navigators
            .retain(|(id, _)| devices.iter().any(|device| device.id == *id));
        for device in &devices {
            let known = self.navigators.iter().position(|(id, _)| *id == device.id);
            let index = known.unwrap_or_else(|| {
                self.navigators.push((device.id, Navigator::default()));
                self.navigators.len() - 1
            });
            for direction in self.navigators[index].1.step(device, seconds) {
                screens::note_use_of_keys(ctx, true);
                self.game.controls.note_stick(device.id);
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

    /// Makes the window as large as was chosen.
    fn fill_screen(&mut self, ctx: &egui::Context) {
        if let Some(is_full) = is_full_by_itself().filter(|is_full| *is_full != self.was_full) {
            // By a key or a gesture of the browser.
            (self.was_full, self.is_full) = (is_full, is_full);
            self.game.settings.full_screen = is_full;
        }
        let wanted = self.game.settings.full_screen;
        if wanted != self.is_full {
            self.is_full = wanted;
            fill_screen(ctx, wanted);
        }
    }

    /// Presses what the mouse rests on, for whoever wants it so.
    fn press_by_resting(&mut self, ctx: &egui::Context, seconds: f32) {
        let on = screens::take_hovered(ctx).filter(|_| self.game.settings.dwell);
        let Some(at) = ctx.input(|input| input.pointer.latest_pos()) else {
            return;
        };
        let has_moved = ctx.input(|input| input.pointer.delta() != egui::Vec2::ZERO);
        if self.dwell.pass(on, has_moved, seconds) {
            self.presses.waiting().click = Some(at);
        }
        self.dwell.draw(ctx, at, &self.game.theme());
    }

    /// As if a key were pressed and let go in the next frame.
    fn press(&self, key: Key) {
        self.presses.waiting().keys.push(key);
    }

    /// Takes in keys and the pointer.
    fn hear_window(&mut self, ctx: &egui::Context) {
        let game = &mut self.game;
        let events = ctx.input(|input| input.events.clone());
        if game.screen() != Screen::Play {
            game.controls.buttons.clear();
        }
        let pressed = self.fingers.hear(&events, &game.controls.buttons);
        game.controls.devices.pressed = self.fingers.pressed().collect();
        let is_by_stick = self.presses.waiting().is_by_stick;
        let is_touched = ctx.input(|input| input.any_touches())
            || events
                .iter()
                .any(|event| matches!(event, Event::Touch { .. }));
        for event in &events {
            match event {
                Event::Key { pressed, .. } => {
                    screens::note_use_of_keys(ctx, true);
                    if *pressed && !is_by_stick {
                        game.controls.means = Means::Keys;
                    }
                }
                Event::PointerMoved(_) | Event::PointerButton { .. } => {
                    screens::note_use_of_keys(ctx, false);
                    // A finger is told of as a mouse too, after it.
                    if !is_touched {
                        game.controls.means = Means::Mouse;
                    }
                }
                Event::Touch { .. } => game.controls.means = Means::Fingers,
                // A window may never get the focus, and be played with the mouse: only losing it counts.
                Event::WindowFocused(focused) => {
                    game.is_away = self.had_focus && !focused;
                    self.had_focus |= focused;
                    if game.is_away {
                        game.pause_round();
                    }
                }
                _ => {}
            }
        }
        for button in pressed {
            game.act(button.action, button.seat());
        }
        point(game, ctx, &self.fingers);
        if game.screen() != Screen::Play {
            game.controls.latch.release();
        }
        game.controls.devices.keys = match game.settings.toggle_keys {
            true => game.controls.latch.keys(),
            false => ctx.input(|input| input.keys_down.iter().copied().collect()),
        };
        if game.screen() == Screen::Play
            && game.bout.turn().is_some()
            && game.bout.session.is_played()
        {
            look_around(game, ctx, &mut self.fingers);
        }
        let is_playing = game.screen() == Screen::Play;
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
            let is_switch = game.settings.scanning.is_on() && Switch::KEYS.contains(&key);
            if is_switch && game.controls.rebinding.take().is_some() {
                // Who has nothing else could give nothing a key, nor leave what waits for one.
                taken.push(key);
                continue;
            }
            if is_switch && is_playing {
                continue;
            }
            if let Some(action) = game.controls.rebinding {
                if action == Action::CutForces && OF_MENUS.contains(&key) && key != Key::Escape {
                    taken.push(key);
                    continue;
                }
                game.controls.rebinding = None;
                if key != Key::Escape {
                    game.settings.bindings.bind_key(action, key);
                    game.keep_settings();
                }
                taken.push(key);
                continue;
            }
            let action = game.settings.bindings.of_key(key);
            if is_playing && game.settings.toggle_keys {
                game.controls.latch.press(key, &game.settings.bindings);
            }
            // A browser has this key for itself.
            let fills = !cfg!(target_family = "wasm") && game.public.is_none();
            if key == Key::F11 && action.is_none() && fills {
                game.settings.full_screen ^= true;
                game.keep_settings();
            }
            // In a menu these move about in it, whatever they mean in a round. But for what must not be looked for.
            let is_of_menu = game.screen() != Screen::Play && OF_MENUS.contains(&key);
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
        if game.public.is_some() {
            return;
        }
        for given in dropped(ctx) {
            game.open(given);
        }
        let pasted = events.iter().filter_map(|event| match event {
            Event::Paste(text) => Some(text),
            _ => None,
        });
        for link in pasted {
            game.open_link(link);
        }
    }
}

impl eframe::App for App {
    /// Runs where nothing is drawn, too.
    fn logic(&mut self, ctx: &egui::Context, _: &mut eframe::Frame) {
        if let Some(attendant) = &mut self.attendant {
            attendant.live(ctx);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        if self.gpu.is_lost() {
            self.game.rescue();
            begin_anew();
            return ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        self.fill_screen(&ctx);
        speak(
            &ctx,
            self.game.settings.language,
            self.game.has_strange_names(),
        );
        // In public it is seen from afar.
        let text_size = match self.game.public {
            Some(_) => f32::INFINITY,
            None => self.game.settings.text_size,
        };
        fit(&ctx, text_size);
        self.zoom = ctx.zoom_factor();
        let seconds = ctx.input(|input| input.stable_dt).min(0.1);
        self.hear_sticks(&ctx, seconds);
        self.hear_window(&ctx);
        self.switch
            .pass(&mut self.game, &self.presses, &ctx, seconds);
        self.game.pass(seconds);
        if let Some(attendant) = &mut self.attendant {
            // However slow the frames are, who waits does so for as long as is said.
            let seconds = ctx.input(|input| input.stable_dt).min(LONGEST);
            attendant.pass(&mut self.game, &ctx, seconds);
        }
        if self.screen_before != self.game.screen() {
            // What had the focus is gone.
            self.screen_before = self.game.screen();
            self.dwell = Dwell::default();
            ctx.memory_mut(|memory| {
                if let Some(id) = memory.focused() {
                    memory.surrender_focus(id);
                }
            });
        }
        match &mut self.attendant {
            Some(attendant) => attendant.show(&mut self.game, &mut self.stage, ui),
            None => screens::show(&mut self.game, &mut self.stage, ui),
        }
        // Some browsers take it only in the frame of the press.
        if let Some(copied) = self.game.copied.take() {
            self.clipboard.copy(&ctx, copied);
        }
        if let Some(took) = self.clipboard.took() {
            self.game.tell_of_copy(took);
        }
        self.press_by_resting(&ctx, seconds);
        // What stands in these is of many widths.
        let is_list = matches!(
            self.game.screen(),
            Screen::Settings | Screen::Forces | Screen::Licences | Screen::Replays
        );
        self.presses.waiting().in_order = is_list && self.game.controls.rebinding.is_none();
        ctx.request_repaint();
    }

    /// Browsers hand it out so.
    #[cfg(target_family = "wasm")]
    fn as_any_mut(&mut self) -> Option<&mut dyn std::any::Any> {
        Some(self)
    }

    /// Some systems end the program with its last window, and nothing is dropped.
    fn on_exit(&mut self) {
        if let Some(attendant) = &mut self.attendant {
            attendant.close(&mut self.game);
        }
        self.game.files.close();
    }
}

/// Shows letters and all else at a size that was chosen, or smaller where the window lacks room.
fn fit(ctx: &egui::Context, text_size: f32) {
    let zoom = zoom(ctx.content_rect().size() * ctx.zoom_factor(), text_size);
    // Nothing changes its size under the mouse that drags it.
    if !ctx.input(|input| input.pointer.any_down()) {
        ctx.set_zoom_factor(zoom);
    }
}

/// The size that was chosen, or a smaller one for which a window has room. There are few of these: egui keeps the letters of
/// each that it has ever shown.
fn zoom(window: egui::Vec2, text_size: f32) -> f32 {
    // What was multiplied and divided by the last zoom is not quite the same.
    let is_tall = window.x < window.y;
    let room = if is_tall { TALL_ROOM } else { ROOM };
    let room = (window / room).min_elem() + 1e-4;
    text_size.min((STEPS * room).floor() / STEPS).max(0.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_that_is_pulled_about_has_room_and_few_sizes() {
        let mut zooms: Vec<f32> = Vec::new();
        for height in 200..1000u16 {
            let room = f32::from(height) / ROOM.y;
            let zoom = zoom(egui::vec2(1600.0, height.into()), 1.0);
            assert!(zoom <= room && (zoom == 1.0 || room - zoom < 1.0 / STEPS));
            zooms.push(zoom);
        }
        zooms.dedup();
        assert!(zooms.len() < 25 && zooms.is_sorted(), "{zooms:?}");
        assert_eq!(zoom(0.999_999 * ROOM, 1.0), 1.0);
    }
}
