//! Entry points of a public stand: the supervisor that keeps it running, and the game itself.

use super::window::open_game;
use crate::exhibit::Stand;
use crate::exhibit::config::{Config, DEFAULT_CONFIG};
use crate::game::{Game, PublicMode, Screen};
use crate::headless::BAD_USAGE;
use crate::look::Stage;
use crate::platform::supervisor::{
    Heartbeat, LOST_GRAPHICS, MAX_CRASHES, PAUSE, SupervisorConfig, supervise,
};
use crate::platform::{Files, Sound, StandFolder, TextFile, keep_awake};
use crate::screens::{CrashScreen, StandController};
use app_shell::Pads;
use app_shell::window::{WindowOutcome, has_display};
use egui::{Context, Ui, ViewportBuilder, ViewportCommand};
use std::ffi::OsString;
use std::panic::resume_unwind;
use std::path::Path;
use std::process::ExitCode;

/// Supervises a stand until staff ends it.
pub(super) fn keep_running(file: &Path, mute: bool) -> ExitCode {
    let is_new = !file.exists();
    let text = TextFile(file.into()).read_or(DEFAULT_CONFIG);
    let config = text.and_then(|text| {
        Config::read(&text).map_err(|error| format!("{}: {error}", file.display()))
    });
    let config = match config {
        Ok(config) => config,
        Err(error) => return refused(&error, BAD_USAGE),
    };
    if is_new {
        output::warn(format_args!(
            "tamaire: created the stand's configuration file {}",
            file.display()
        ));
    }
    if !has_display() {
        return refused("a stand requires a display, and none was found", 1);
    }
    let program = match std::env::current_exe() {
        Ok(program) => program,
        Err(error) => return refused(&error.to_string(), 1),
    };
    let words = |kind: &str| {
        let mut words: Vec<OsString> = vec![kind.into(), file.into()];
        words.extend(mute.then(|| "--mute".into()));
        words
    };
    let plan = SupervisorConfig {
        program,
        game: words("--stand"),
        calm: words("--rest"),
        folder: StandFolder::of(config.logbook.folder.as_deref()),
        stand: config.stand.0,
        most: MAX_CRASHES,
        pause: PAUSE,
    };
    match supervise(&plan) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => refused(&reason, 1),
    }
}

fn refused(reason: &str, code: u8) -> ExitCode {
    output::warn(format_args!("tamaire: {reason}"));
    ExitCode::from(code)
}

/// Runs the game of a stand in a full-screen window.
pub(super) fn play(file: &Path, mute: bool) -> ExitCode {
    let stand = match Stand::open(TextFile(file.into())) {
        Ok(stand) => stand,
        Err(error) => return refused(&error, BAD_USAGE),
    };
    show(move || {
        let sound = if mute { Sound::none() } else { Sound::open() };
        // The storage of the game is in the folder of the stand: the calibrations of sticks, and clips.
        let folder = StandFolder::of(stand.config.logbook.folder.as_deref());
        let mut game = Game::new(folder.files(), sound, Pads::open());
        let mut stand = stand;
        stand.prepare(&mut game);
        (game, Box::new(stand))
    })
}

/// Shows a calm picture in place of a game that keeps failing.
pub(super) fn rest(file: &Path) -> ExitCode {
    let text = TextFile(file.into()).read_or(DEFAULT_CONFIG);
    let config = text.and_then(|text| Config::read(&text));
    let settings = config.map(|config| config.settings()).unwrap_or_default();
    show(move || {
        let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::none());
        game.settings = settings;
        game.public = Some(PublicMode::default());
        // The settings screen shows no round, so no round is simulated.
        game.go(Screen::Settings);
        (game, Box::new(CrashScreen::default()))
    })
}

fn show(make: impl FnOnce() -> (Game, Box<dyn StandController>) + 'static) -> ExitCode {
    if let Err(error) = keep_awake() {
        output::warn(format_args!("tamaire: {error}"));
    }
    let viewport = ViewportBuilder::default().with_fullscreen(true);
    let opened = open_game(viewport, move || {
        let (game, attendant) = make();
        let pulse = Heartbeat::begin();
        let watched = Watched { attendant, pulse };
        (game, Some(Box::new(watched) as Box<dyn StandController>))
    });
    match opened {
        WindowOutcome::Closed => ExitCode::SUCCESS,
        WindowOutcome::LostGpu => ExitCode::from(LOST_GRAPHICS),
        WindowOutcome::Failed(reason) | WindowOutcome::Never(reason) => {
            refused(&reason, LOST_GRAPHICS)
        }
        WindowOutcome::Broken(panic) => resume_unwind(panic),
    }
}

/// Wrapper of a stand's controller that sends a heartbeat to the supervisor, and ends the game when the
/// supervisor has ended.
struct Watched {
    attendant: Box<dyn StandController>,
    pulse: Heartbeat,
}

impl StandController for Watched {
    fn live(&mut self, ctx: &Context) {
        if self.pulse.beat().is_err() {
            self.attendant.end();
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
        self.attendant.live(ctx);
    }

    fn pass(&mut self, game: &mut Game, ctx: &Context, seconds: f32) {
        fill(ctx);
        self.attendant.pass(game, ctx, seconds);
    }

    fn show(&mut self, game: &mut Game, stage: &mut Stage, ui: &mut Ui) {
        self.attendant.show(game, stage, ui);
    }

    fn end(&mut self) {
        self.attendant.end();
    }

    fn close(&mut self, game: &mut Game) {
        self.pulse.end();
        self.attendant.close(game);
    }
}

/// Makes the window as large as the screen. Without a window manager, full screen alone does not do this.
fn fill(ctx: &Context) {
    let (screen, window) = ctx.input(|input| {
        let viewport = input.viewport();
        (viewport.monitor_size, viewport.inner_rect)
    });
    if let (Some(screen), Some(window)) = (screen, window)
        && (window.size() - screen).abs().max_elem() > 1.0
    {
        ctx.send_viewport_cmd(ViewportCommand::OuterPosition(egui::Pos2::ZERO));
        ctx.send_viewport_cmd(ViewportCommand::InnerSize(screen));
    }
}
