//! The main loop: reads the devices, advances the game, draws it, and plays its sounds.

mod dwell;
mod fingers;
mod pointing;
mod presses;
mod switch;

use crate::game::{Controls, Game, Screen};
use crate::input::{Action, InputMethod, InputSource};
use crate::look::Stage;
use crate::platform::{
    Clipboard, dropped, fill_screen, full_screen_of_page, restart, set_language,
};
use crate::screens::{self, StandController};
use app_shell::widgets::{note_use_of_keys, take_hovered};
use app_shell::{GpuWatch, NoGpu, style};
use dwell::Dwell;
use egui::{Event, Key};
use fingers::Fingers;
use pointing::{look_around, point};
use presses::Presses;
use sticks::{Change, Control, Navigator, PadButton};
use switch::Switch;

/// Smallest window in which every screen fits at zoom 1 [points].
const ROOM: egui::Vec2 = egui::vec2(900.0, 640.0);
/// Smallest window in portrait orientation in which every screen fits at zoom 1 [points].
const TALL_ROOM: egui::Vec2 = egui::vec2(600.0, 760.0);
/// Number of steps into which the zoom factors between 0 and 1 are divided.
const STEPS: f32 = 32.0;
/// Maximum time by which a public stand advances in one frame [s]. A longer frame, for example after the
/// machine was suspended, is shortened to this time.
const LONGEST: f32 = 1.0;

/// Keys that navigate menus.
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
    /// State of the game.
    pub game: Game,
    /// Controller of the game at a public stand, where visitors get no menus.
    pub attendant: Option<Box<dyn StandController>>,
    /// Monitor that notices the loss of the GPU.
    pub gpu: GpuWatch,
    stage: Stage,
    navigators: Vec<(sticks::DeviceId, Navigator)>,
    presses: Presses,
    fingers: Fingers,
    dwell: Dwell,
    clipboard: Clipboard,
    switch: Switch,
    screen_before: Screen,
    /// Whether the window has ever had the focus.
    had_focus: bool,
    /// Full-screen state that the window was last told to have.
    is_full: bool,
    /// Last known full-screen state of the web page. Always false on a desktop.
    was_full: bool,
    /// Zoom factor: size of an egui point relative to a point of the system.
    pub zoom: f32,
}

impl App {
    /// Creates the game in an eframe window, which closes when its GPU is lost.
    ///
    /// # Errors
    /// If the window has no GPU, not even one in software.
    pub fn new(context: &eframe::CreationContext, mut game: Game) -> Result<Self, NoGpu> {
        style::apply(&context.egui_ctx);
        let state = context.wgpu_render_state.as_ref().ok_or(NoGpu)?;
        let (stage, gpu) = (Stage::new(state), GpuWatch::of(state, "tamaire"));
        #[cfg(target_family = "wasm")]
        crate::film::lend(state);
        // Starts without full screen in a browser, because browsers allow full screen only in response to a
        // press.
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

    /// Returns the GPU cost of drawing worlds since the last call. The interface, which egui draws, is not
    /// included.
    pub fn take_cost(&self) -> fuwafuwa_render::Cost {
        self.stage.take_cost()
    }

    /// Reads sticks and pads: in a round their buttons trigger actions, in a menu they move the focus.
    fn read_sticks(&mut self, ctx: &egui::Context, seconds: f32) {
        let changes = self.game.hear_sticks();
        if self.game.is_away {
            // Another window has the focus, so the sticks are not meant for the game.
            return;
        }
        // While a control is being rebound, buttons do not operate the menu.
        let in_menu = self.game.screen() != Screen::Play && self.game.controls.rebinding.is_none();
        for change in changes {
            let Change::Pressed { device, control } = change else {
                continue;
            };
            note_use_of_keys(ctx, true);
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
                    // These buttons confirm and go back in menus, so they cannot be bound to the action that
                    // cuts the forces.
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
                // The button that switches the forces off works on every screen.
                (_, Some(Action::CutForces)) => {
                    self.game.act(Action::CutForces, InputSource::Stick(device))
                }
                (Control::Pad(PadButton::South) | Control::Button(0), _) if in_menu => {
                    self.press(Key::Enter)
                }
                (Control::Pad(PadButton::East) | Control::Button(1), _) if in_menu => {
                    self.press(Key::Escape)
                }
                (_, Some(action)) => self.game.act(action, InputSource::Stick(device)),
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
                note_use_of_keys(ctx, true);
                self.game.controls.note_stick(device.id);
                // A stick under test or measurement does not navigate the menu.
                let is_tried = self
                    .game
                    .trial
                    .is_some_and(|trial| trial.device == device.id);
                // A stick that moves the pen does not move the focus as well.
                let draws = self.game.maker.cursor.is_some()
                    && sticks::radial_dead_zone(device.aim(), 0.3, 1.0) != [0.0; 2];
                if in_menu && !is_tried && !draws {
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

    /// Applies the full-screen setting to the window.
    fn fill_screen(&mut self, ctx: &egui::Context) {
        if let Some(is_full) = full_screen_of_page().filter(|is_full| *is_full != self.was_full) {
            // The player left or entered full screen through the browser, with a key or a gesture.
            (self.was_full, self.is_full) = (is_full, is_full);
            self.game.settings.full_screen = is_full;
        }
        let wanted = self.game.settings.full_screen;
        if wanted != self.is_full {
            self.is_full = wanted;
            fill_screen(ctx, wanted);
        }
    }

    /// Clicks the widget on which the mouse has stayed for long enough, if the player has turned dwell
    /// clicking on.
    fn press_by_resting(&mut self, ctx: &egui::Context, seconds: f32) {
        let on = take_hovered(ctx).filter(|_| self.game.settings.dwell);
        let Some(at) = ctx.input(|input| input.pointer.latest_pos()) else {
            return;
        };
        let has_moved = ctx.input(|input| input.pointer.delta() != egui::Vec2::ZERO);
        if self.dwell.pass(on, has_moved, seconds) {
            self.presses.waiting().click = Some(at);
        }
        self.dwell.draw(ctx, at, &self.game.theme());
    }

    /// Presses and releases `key` in the next frame.
    fn press(&self, key: Key) {
        self.presses.waiting().keys.push(key);
    }

    /// Reads the keyboard and the pointer.
    fn read_window(&mut self, ctx: &egui::Context) {
        let game = &mut self.game;
        let events = ctx.input(|input| input.events.clone());
        if game.screen() != Screen::Play {
            game.controls.buttons.clear();
            game.controls.covers.clear();
        }
        let Controls {
            buttons, covers, ..
        } = &game.controls;
        let pressed = self.fingers.read_events(&events, buttons, covers);
        game.controls.devices.pressed = self.fingers.pressed().collect();
        let is_by_stick = self.presses.waiting().is_by_stick;
        let is_touched = ctx.input(|input| input.any_touches())
            || events
                .iter()
                .any(|event| matches!(event, Event::Touch { .. }));
        for event in &events {
            match event {
                Event::Key { pressed, .. } => {
                    note_use_of_keys(ctx, true);
                    if *pressed && !is_by_stick {
                        game.controls.means = InputMethod::Keys;
                    }
                }
                Event::PointerMoved(_) | Event::PointerButton { .. } => {
                    note_use_of_keys(ctx, false);
                    // A touch also produces emulated mouse events. Only mouse events without a touch mean
                    // that the player uses the mouse.
                    if !is_touched {
                        game.controls.means = InputMethod::Mouse;
                    }
                }
                Event::Touch { .. } => game.controls.means = InputMethod::Fingers,
                // Pauses the game only if the window had the focus and lost it. A window that never had the
                // focus can still be played with the mouse.
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
                // The switch cancels the wait for the key to bind: a player with a single switch has no other
                // way to cancel it.
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
            // F11 toggles full screen only on a desktop and outside a public stand. Browsers handle F11
            // themselves.
            let fills = !cfg!(target_family = "wasm") && game.public.is_none();
            if key == Key::F11 && action.is_none() && fills {
                game.settings.full_screen ^= true;
                game.keep_settings();
            }
            // In a menu, a navigation key does not trigger the action to which it is bound in a round.
            // Cutting the forces is the exception: this action works on every screen.
            let is_of_menu = game.screen() != Screen::Play && OF_MENUS.contains(&key);
            // Where players draw, write and edit, letters are letters.
            let is_of_menu = is_of_menu || game.screen().is_of_making();
            if let Some(action) =
                action.filter(|action| !is_of_menu || *action == Action::CutForces)
            {
                game.act(action, InputSource::Keys);
                taken.push(key);
            }
        }
        // Removes the handled key presses from egui's input. Otherwise a menu that has just opened would take
        // them as a click or as "back".
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
        // While a level is made, pasted text is a name, or stands for copied things.
        if !game.screen().is_of_making() {
            for link in pasted {
                game.open_link(link);
            }
        }
    }
}

impl eframe::App for App {
    /// Reports that a stand is alive. eframe calls this method even if nothing is drawn.
    fn logic(&mut self, ctx: &egui::Context, _: &mut eframe::Frame) {
        if let Some(attendant) = &mut self.attendant {
            attendant.live(ctx);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        if self.gpu.is_lost() {
            self.game.rescue();
            restart();
            return ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        self.fill_screen(&ctx);
        set_language(
            &ctx,
            self.game.settings.language,
            self.game.has_strange_names(),
        );
        // A public stand is read from a distance, so its text has the largest size that fits into the window.
        let text_size = match self.game.public {
            Some(_) => f32::INFINITY,
            None => self.game.settings.text_size,
        };
        fit(&ctx, text_size);
        self.zoom = ctx.zoom_factor();
        let seconds = ctx.input(|input| input.stable_dt).min(0.1);
        self.game.note_frame(ctx.input(|input| input.unstable_dt));
        self.read_sticks(&ctx, seconds);
        self.read_window(&ctx);
        self.switch
            .pass(&mut self.game, &self.presses, &ctx, seconds);
        self.game.update(seconds);
        if let Some(attendant) = &mut self.attendant {
            // The frame time for the stand is limited to 1 s instead of 0.1 s, so that waiting times of the
            // stand stay correct at low frame rates.
            let seconds = ctx.input(|input| input.stable_dt).min(LONGEST);
            attendant.pass(&mut self.game, &ctx, seconds);
        }
        if self.screen_before != self.game.screen() {
            // Removes the focus after a change of screen, because the focused widget belonged to the previous
            // screen.
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
        // Copies in the same frame as the press, because some browsers refuse to copy later.
        if let Some(copied) = self.game.copied.take() {
            self.clipboard.copy(&ctx, copied);
        }
        if let Some(took) = self.clipboard.took() {
            self.game.tell_of_copy(took);
        }
        self.press_by_resting(&ctx, seconds);
        // On these screens the rows differ in width. The up and down keys therefore move the focus in the
        // order of the widgets.
        let is_list = matches!(
            self.game.screen(),
            Screen::Settings
                | Screen::Forces
                | Screen::Licences
                | Screen::Replays
                | Screen::Toolbox
        );
        self.presses.waiting().in_order = is_list && self.game.controls.rebinding.is_none();
        ctx.request_repaint();
    }

    /// Called by eframe's web runner to access the app.
    #[cfg(target_family = "wasm")]
    fn as_any_mut(&mut self) -> Option<&mut dyn std::any::Any> {
        Some(self)
    }

    /// Closes the stand, keeps the level in the editor and closes the files before the window closes. On some systems the program ends with its
    /// last window without running destructors.
    fn on_exit(&mut self) {
        if let Some(attendant) = &mut self.attendant {
            attendant.close(&mut self.game);
        }
        self.game.close();
    }
}

/// Sets the zoom of the interface.
fn fit(ctx: &egui::Context, text_size: f32) {
    let zoom = zoom(ctx.content_rect().size() * ctx.zoom_factor(), text_size);
    // The zoom does not change while a mouse button is down, so that a dragged widget keeps its size.
    if !ctx.input(|input| input.pointer.any_down()) {
        ctx.set_zoom_factor(zoom);
    }
}

/// Returns the zoom for a text size: `text_size` in a window in which every screen fits at zoom 1, and less in
/// a smaller window, in proportion. Large texts are therefore always as large as promised; what does not fit
/// any more scrolls. If `text_size` is infinite, returns the largest zoom with which every screen fits. There are
/// only a few steps, because egui keeps the glyphs of every zoom factor that was ever used.
fn zoom(window: egui::Vec2, text_size: f32) -> f32 {
    // The tolerance of 1e-4 covers rounding errors: `window` was divided and multiplied by the previous zoom
    // factor.
    let is_tall = window.x < window.y;
    let room = if is_tall { TALL_ROOM } else { ROOM };
    let room = (window / room).min_elem() + 1e-4;
    let largest = (STEPS * room).floor() / STEPS;
    let zoom = match text_size.is_finite() {
        true => text_size * largest.min(1.0),
        false => largest,
    };
    zoom.max(0.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zoom_fits_window_and_has_few_values() {
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
        assert_eq!(zoom(4.0 * ROOM, 1.0), 1.0);
        assert_eq!(zoom(1.5 * ROOM, f32::INFINITY), 1.5, "a stand");
    }

    #[test]
    fn text_size_is_true_in_every_window() {
        for window in [
            [1280.0, 800.0],
            [1920.0, 1080.0],
            [704.0, 440.0],
            [390.0, 844.0],
        ] {
            let window = egui::Vec2::from(window);
            let usual = zoom(window, 1.0);
            for size in [0.8, 1.0, 1.3, 1.6] {
                let share = zoom(window, size) / usual;
                assert!((share - size).abs() < 1e-5, "{window}: {share} of {size}");
            }
        }
    }
}
