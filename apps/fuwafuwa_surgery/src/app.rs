//! Window of the surgery trainer: the organ, slices beside it and measurements below.

mod bar;
mod curves;
pub mod devices;
pub mod hand;
mod help;
mod pictures;
mod section;
pub mod session;

use crate::loading::{ENDING, LoadRequest, Loaded, Loading};
use crate::record::Playback;
use crate::report::NO_DEVICE;
use crate::save;
use crate::tools::Tool;
use app_shell::widgets::fitted;
use app_shell::{Clock, GpuWatch, NoGpu, SpaceStage, Theme, View, style};
use bar::BarAction;
use devices::{DeviceAction, Devices};
use egui::{
    Align2, CentralPanel, Color32, FontId, Frame, Key, Panel, PointerButton, Pos2, Rect, Ui, Vec2,
    pos2, vec2,
};
use force_feedback::Stop;
use fuwafuwa::Vec3;
use fuwafuwa_render::Palette;
use fuwafuwa_scan::{Options, Segmentation};
use hand::HandInput;
use section::Slices;
use session::Session;
use std::path::PathBuf;

/// Camera rotation per point of mouse movement [rad/point].
const DRAG: f32 = 0.006;
/// Speed of camera rotation by keys and sticks at full deflection [rad/s].
const LOOK: f32 = 1.2;
/// Movement of the hand per scrolled point of the mouse wheel [m/point].
const WHEEL: f32 = 0.000_03;
/// Display time of a message [s].
const STAYS: f64 = 7.0;

/// Configuration of a window.
pub struct Setup {
    /// Organ or recording to open first.
    pub wanted: LoadRequest,
    /// Rule that assigns materials to the voxels of scans, also of scans dropped onto the window.
    pub segmentation: Segmentation,
    /// Options for making organs from scans.
    pub options: Options,
    /// Folder for saved files.
    pub folder: PathBuf,
}

/// State of the window.
pub struct App {
    setup: Setup,
    loading: Option<Loading>,
    session: Option<Session>,
    slices: Option<Slices>,
    devices: Devices,
    stage: SpaceStage,
    view: Option<View>,
    theme: Theme,
    colours: Palette,
    clock: Clock,
    before: f64,
    /// Whether the help with the controls is open.
    has_help: bool,
    /// Parts of the view where the mouse does not move the tool: the button of the help, and the open help.
    covered: Vec<Rect>,
    /// Message on the screen, and the time at which the message disappears [s].
    said: Option<(String, f64)>,
    gpu: GpuWatch,
}

impl App {
    /// Creates the app in an eframe window.
    ///
    /// # Errors
    /// [`NoGpu`] if the window has no GPU, not even a software adapter.
    pub fn new(
        context: &eframe::CreationContext<'_>,
        setup: Setup,
        devices: Devices,
    ) -> Result<Self, NoGpu> {
        style::apply(&context.egui_ctx);
        let state = context.wgpu_render_state.as_ref().ok_or(NoGpu)?;
        let mut app = Self {
            loading: None,
            session: None,
            slices: None,
            devices,
            stage: SpaceStage::new(state),
            view: None,
            theme: Theme::of(false),
            colours: pictures::palette(),
            clock: Clock::of_machine(),
            before: 0.0,
            has_help: false,
            covered: Vec::new(),
            said: None,
            gpu: GpuWatch::of(state, "fuwafuwa_surgery"),
            setup,
        };
        app.open(app.setup.wanted.clone());
        Ok(app)
    }

    /// Returns the monitor that notices the loss of the app's GPU.
    pub fn gpu(&self) -> GpuWatch {
        self.gpu.clone()
    }

    fn say(&mut self, text: String) {
        self.said = Some((text, self.clock.now() + STAYS));
    }

    /// Starts loading an organ or a recording. The current session stays until loading has finished.
    fn open(&mut self, wanted: LoadRequest) {
        match Loading::begin(wanted) {
            Ok(loading) => self.loading = Some(loading),
            Err(error) => self.say(error.to_string()),
        }
    }

    fn hear_loading(&mut self) {
        let Some(result) = self.loading.as_ref().and_then(Loading::take) else {
            return;
        };
        self.loading = None;
        match result {
            Ok((loaded, warnings)) => {
                self.begin(match loaded {
                    Loaded::Procedure(procedure) => Session::new(*procedure),
                    Loaded::Playback(playback) => Session::again(*playback),
                });
                if !warnings.is_empty() {
                    self.say(warnings.join("\n"));
                }
            }
            Err(error) => {
                self.say(error.to_string());
                if self.session.is_none() {
                    // Loads the phantom if the requested organ failed to load, so that there is always an
                    // organ.
                    self.open(LoadRequest::Phantom(self.setup.options.resolution));
                }
            }
        }
    }

    fn begin(&mut self, session: Session) {
        let [low, high] = session.seen;
        self.slices = Some(Slices::new(0.5 * (low + high)));
        self.session = Some(session);
    }

    /// Opens files that were dropped onto the window.
    fn hear_files(&mut self, ctx: &egui::Context) {
        let files = ctx.input(|input| input.raw.dropped_files.clone());
        let files: Vec<PathBuf> = files.iter().map(|file| file.path().into()).collect();
        if files.is_empty() {
            return;
        }
        self.open(wanted(files, &self.setup));
    }

    fn take(&mut self, tool: Tool) {
        if let Some(session) = &mut self.session {
            let height = session.procedure().entry();
            session.hand.take(tool, height);
        }
    }

    fn act(&mut self, ask: BarAction) {
        match ask {
            BarAction::Take(tool) => self.take(tool),
            BarAction::Rest => {
                if let Some(session) = &mut self.session {
                    session.is_paused = !session.is_paused;
                }
            }
            BarAction::Again => self.again(),
            BarAction::Watch => {
                let recording = self.session.as_ref().map(Session::recording);
                match recording.map(Playback::new) {
                    Some(Ok(playback)) => self.begin(Session::again(playback)),
                    Some(Err(error)) => self.say(error.to_string()),
                    None => {}
                }
            }
            BarAction::TakeOver => {
                if let Some(session) = self.session.take() {
                    self.begin(session.take_over());
                }
            }
            BarAction::Save => {
                if let Some(session) = &self.session {
                    let saved = save::save(&self.setup.folder, session.procedure());
                    self.say(match saved {
                        Ok(path) => {
                            format!("Saved {}, with .csv and .svg beside it.", path.display())
                        }
                        Err(error) => error,
                    });
                }
            }
        }
    }

    /// Restarts the procedure with the uncut organ.
    fn again(&mut self) {
        let Some(session) = &self.session else {
            return;
        };
        match crate::procedure::Procedure::new(session.procedure().case().clone()) {
            Ok(procedure) => {
                let mut next = Session::new(procedure);
                next.camera = session.camera.clone();
                self.begin(next);
            }
            Err(error) => self.say(error.to_string()),
        }
    }

    /// Advances hand and organ by `seconds`.
    fn pass(&mut self, ctx: &egui::Context, seconds: f32) {
        let focused = ctx.input(|input| input.focused);
        let is_typing = ctx.egui_wants_keyboard_input();
        let Some(session) = &mut self.session else {
            return;
        };
        let (room, turn) = (session.procedure().table().room, session.camera.azimuth());
        let mut wishes = HandInput::default();
        let (presses, look) = self.devices.hear(&mut wishes, room, turn, seconds);
        let keys_look = match is_typing {
            true => Vec2::ZERO,
            false => hear_keys(ctx, &mut wishes),
        };
        if let Some(view) = &self.view {
            hear_mouse(ctx, view, &self.covered, session, &mut wishes, keys_look);
        }
        let look = LOOK * seconds * (look + keys_look);
        session.camera.orbit(look.x, look.y);
        if session.is_by_hand() && !session.is_paused {
            session.hand.pass(&wishes, room, turn, seconds);
        }
        let now = self.clock.now();
        session.pass(&self.clock, (now - self.before).min(0.25));
        self.before = now;
        let tool = session.procedure().tool().position();
        session.camera.follow(tool, session.seen, seconds, true);
        let silence = match () {
            () if !focused => Some(Stop::FocusLost),
            () if session.is_paused => Some(Stop::Paused),
            () if !session.is_by_hand() => Some(Stop::Idle),
            () => None,
        };
        let (force, torn) = (session.last().force, session.take_torn());
        if silence.is_none() {
            self.devices.tear(torn);
        }
        self.devices.feel(force, turn, silence);
        if std::mem::take(&mut session.has_gripped_nothing) {
            self.say("The forceps hold nothing: touch the organ with their tip, then grip.".into());
        }
        let Some(session) = &mut self.session else {
            return;
        };
        if let Some(verdict) = session.verdict.take() {
            session.is_paused = true;
            self.say(verdict);
        }
        for press in presses {
            match press {
                DeviceAction::NextTool => self.take(self.next_tool()),
                DeviceAction::Pause => self.act(BarAction::Rest),
                DeviceAction::CutForces => self.cut_forces(),
            }
        }
    }

    fn next_tool(&self) -> Tool {
        let tool = self.session.as_ref().map(|session| session.hand.tool);
        let place = Tool::ALL
            .iter()
            .position(|one| Some(*one) == tool)
            .unwrap_or(0);
        Tool::ALL[(place + 1) % Tool::ALL.len()]
    }

    fn cut_forces(&mut self) {
        let is_cut = self.devices.cut_or_restore();
        self.say(match is_cut {
            true => "All forces are off. Press F12 to switch them on again.".into(),
            false => "Forces are on.".into(),
        });
    }

    /// Handles keys that act once per press.
    fn hear_presses(&mut self, ctx: &egui::Context) {
        let pressed = |key| ctx.input(|input| input.key_pressed(key));
        let keys = [Key::Num1, Key::Num2, Key::Num3];
        for (key, tool) in keys.into_iter().zip(Tool::ALL) {
            if pressed(key) {
                self.take(tool);
            }
        }
        if pressed(Key::P) {
            self.act(BarAction::Rest);
        }
        if pressed(Key::R) {
            self.again();
        }
        if pressed(Key::X)
            && let Some(session) = &mut self.session
        {
            session.hand.turned = Vec3::ZERO;
        }
        if pressed(Key::F12) {
            self.cut_forces();
        }
        if pressed(Key::F1) || pressed(Key::Questionmark) {
            self.has_help = !self.has_help;
        }
    }

    fn show(&mut self, ui: &mut Ui) {
        let plain = Frame::new().fill(self.theme.paper);
        let ask = Panel::top("tools")
            .exact_size(72.0)
            .frame(plain.inner_margin(10.0))
            .show(ui, |ui| {
                bar::show(ui, &self.theme, self.session.as_mut(), self.slices.as_mut())
            })
            .inner;
        Panel::bottom("no device")
            .exact_size(28.0)
            .frame(plain)
            .show(ui, |ui| {
                let at = ui.max_rect().center();
                let font = FontId::proportional(15.0);
                let text = format!("{NO_DEVICE}   {}", self.devices.told());
                ui.painter()
                    .text(at, Align2::CENTER_CENTER, text, font, self.theme.ink);
            });
        Panel::bottom("curves")
            .exact_size(132.0)
            .frame(plain.inner_margin(8.0))
            .show(ui, |ui| {
                if let Some(session) = &self.session {
                    curves::show(ui, session, &self.theme);
                }
            });
        let wide = (0.27 * ui.available_width()).clamp(220.0, 420.0);
        Panel::right("slices")
            .exact_size(wide)
            .resizable(false)
            .frame(plain.inner_margin(8.0))
            .show(ui, |ui| {
                if let (Some(slices), Some(session)) = (&mut self.slices, &self.session) {
                    let procedure = session.procedure();
                    slices.refresh(procedure);
                    slices.show(ui, procedure, session.sliced, &self.colours);
                }
            });
        CentralPanel::default().frame(plain).show(ui, |ui| {
            let rect = ui.max_rect();
            self.view = self
                .session
                .as_ref()
                .map(|session| pictures::show(ui, rect, &mut self.stage, session, &self.colours));
            if let (Some(session), Some(slices)) = (&self.session, &self.slices) {
                let case = session.procedure().case();
                help::legend(ui, &self.theme, rect, case, slices.shown, &self.colours);
            }
            self.covered = help::show(ui, &self.theme, rect, &mut self.has_help);
            self.show_words(ui, rect);
        });
        if let Some(ask) = ask {
            self.act(ask);
        }
    }

    /// Shows the loading progress and the current message.
    fn show_words(&mut self, ui: &Ui, rect: Rect) {
        let painter = ui.painter().with_clip_rect(rect);
        if let Some(loading) = &self.loading {
            let size = vec2((0.6 * rect.width()).min(460.0), 26.0);
            let whole = Rect::from_center_size(rect.center(), size);
            let card = whole.expand2(vec2(24.0, 40.0));
            painter.rect_filled(card, 20.0, self.theme.card);
            painter.rect_filled(whole, 13.0, self.theme.button);
            let share = loading.progress().clamp(0.06, 1.0);
            let done = Rect::from_min_size(whole.min, vec2(share * size.x, size.y));
            painter.rect_filled(done, 13.0, self.theme.accent);
            let at = whole.center_top() - vec2(0.0, 8.0);
            let (font, ink) = (FontId::proportional(20.0), self.theme.ink);
            let text = "Loading the organ";
            painter.text(at, Align2::CENTER_BOTTOM, text, font, ink);
        }
        if self
            .said
            .as_ref()
            .is_some_and(|(_, until)| *until < self.clock.now())
        {
            self.said = None;
        }
        let played = self.session.as_ref().and_then(Session::played);
        let replay = played.map(|share| format!("Replay: {:.0} %", 100.0 * share));
        let said = self.said.as_ref().map(|(text, _)| text.clone());
        if let Some(text) = said.or(replay) {
            let galley = fitted(&painter, &text, 20.0, rect.width() - 60.0, self.theme.ink);
            let at = pos2(
                rect.center().x - 0.5 * galley.size().x,
                rect.bottom() - 24.0 - galley.size().y,
            );
            let paper = Rect::from_min_size(at, galley.size()).expand2(vec2(16.0, 8.0));
            painter.rect_filled(paper, 18.0, Color32::from_white_alpha(232));
            painter.galley(at, galley, self.theme.ink);
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        if self.gpu.is_lost() {
            return ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        let seconds = ctx.input(|input| input.stable_dt).min(0.1);
        self.hear_files(&ctx);
        self.hear_loading();
        self.hear_presses(&ctx);
        self.pass(&ctx, seconds);
        self.show(ui);
        ctx.request_repaint();
    }
}

/// Returns what to load for some files: a recording if one is among them, otherwise scans.
pub fn wanted(files: Vec<PathBuf>, setup: &Setup) -> LoadRequest {
    let is_recording = |file: &PathBuf| file.extension().is_some_and(|end| end == ENDING);
    match files.iter().find(|file| is_recording(file)) {
        Some(file) => LoadRequest::Recording(file.clone()),
        None => LoadRequest::Scans {
            files,
            segmentation: setup.segmentation.clone(),
            options: setup.options.clone(),
        },
    }
}

/// Handles the mouse. Its position moves the hand in the horizontal plane at the height of the hand, and the wheel
/// changes the height. The left button grips, and the right button turns the camera.
///
/// From a movement of the mouse on, until keys or sticks move the hand or the camera turns, the tip of the tool stays
/// under the pointer at each height. `wishes` are those of keys and sticks, and `keys_look` is the turning of the
/// camera by keys. The mouse is ignored in the `covered` parts of the view.
fn hear_mouse(
    ctx: &egui::Context,
    view: &View,
    covered: &[Rect],
    session: &mut Session,
    wishes: &mut HandInput,
    keys_look: Vec2,
) {
    let (at, origin, delta, grips, turns, wheel, twice) = ctx.input(|input| {
        let pointer = &input.pointer;
        (
            pointer.latest_pos(),
            pointer.press_origin(),
            pointer.delta(),
            pointer.button_down(PointerButton::Primary),
            pointer.button_down(PointerButton::Secondary),
            input.smooth_scroll_delta().y,
            pointer.button_double_clicked(PointerButton::Secondary),
        )
    });
    let Some(at) = at.filter(|at| view.rect.contains(*at)) else {
        return;
    };
    if is_covered(covered, at, origin) {
        return;
    }
    wishes.wheel += WHEEL * wheel;
    wishes.grips |= grips;
    if twice {
        session.camera.return_to_front();
    }
    if turns {
        session.camera.orbit(-DRAG * delta.x, DRAG * delta.y);
    }
    let is_led = wishes.place.is_some() || wishes.lean != Vec2::ZERO;
    let is_left = is_led || keys_look != Vec2::ZERO || turns || twice;
    session.follows_pointer = match is_left {
        true => false,
        false => session.follows_pointer || delta != Vec2::ZERO,
    };
    if session.follows_pointer {
        let [low, high] = session.procedure().table().room;
        let height = (session.hand.goal.y + wishes.wheel).clamp(low.y, high.y);
        wishes.place = Some(view.to_world(at, height));
    }
}

/// Returns whether the mouse belongs to a covered part of the view: while a button is held, by the position at which
/// it was pressed, otherwise by its position.
fn is_covered(covered: &[Rect], at: Pos2, origin: Option<Pos2>) -> bool {
    let at = origin.unwrap_or(at);
    covered.iter().any(|rect| rect.contains(at))
}

/// Handles held keys and returns the camera's turning speed as a fraction of [`LOOK`].
fn hear_keys(ctx: &egui::Context, wishes: &mut HandInput) -> Vec2 {
    ctx.input(|input| {
        let held = |keys: &[Key]| f32::from(u8::from(keys.iter().any(|key| input.key_down(*key))));
        let along = |more: &[Key], less: &[Key]| held(more) - held(less);
        wishes.lean += vec2(
            along(&[Key::ArrowRight, Key::D], &[Key::ArrowLeft, Key::A]),
            along(&[Key::ArrowUp, Key::W], &[Key::ArrowDown, Key::S]),
        );
        wishes.lift += along(&[Key::Q, Key::PageUp], &[Key::Z, Key::PageDown]);
        wishes.turn += Vec3::new(
            along(&[Key::J], &[Key::L]),
            along(&[Key::I], &[Key::K]),
            along(&[Key::U], &[Key::O]),
        );
        wishes.grips |= input.key_down(Key::Space);
        vec2(along(&[Key::CloseBracket], &[Key::OpenBracket]), 0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn click_on_the_help_does_not_reach_the_tool() {
        let button = Rect::from_min_size(pos2(12.0, 12.0), vec2(110.0, 36.0));
        let (inside, outside) = (pos2(20.0, 20.0), pos2(300.0, 300.0));
        assert!(is_covered(&[button], inside, None));
        assert!(is_covered(&[button], outside, Some(inside)));
        assert!(!is_covered(&[button], outside, None));
        // A grip goes on while the tool is moved below the button.
        assert!(!is_covered(&[button], inside, Some(outside)));
    }
}
