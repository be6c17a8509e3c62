//! The way in on a desktop: the command line, a window, and what is done where none opens.

use crate::app::App;
use crate::game::Game;
use crate::headless;
use crate::platform::{Files, Given, GpuWatch, Pads, Sound, level_at};
use clap::Parser;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::rc::Rc;
use std::time::{Duration, Instant};

/// Push a soft body into a basket that is too small for it.
#[derive(Parser)]
#[command(version, after_help = AFTER_HELP)]
struct Arguments {
    /// A level (.toml), a picture or a model to make a body of (.png, .vox), a replay (.tamaire), or a link to a round or a
    /// level (https://…#r1…)
    #[arg(conflicts_with_all = ["level", "replay"])]
    file: Option<PathBuf>,
    /// No sound
    #[arg(long)]
    mute: bool,
    /// List the levels
    #[arg(long)]
    list: bool,
    /// Play without a window, as fast as it goes, and tell how it went
    #[arg(long)]
    headless: bool,
    #[command(flatten)]
    options: headless::Options,
}

const AFTER_HELP: &str = "\
Examples:
  tamaire drawing.png
  tamaire --level hoop
  tamaire --headless --bot shave --seed 7 --film shave.gif --save shave.tamaire
  tamaire --headless --replay shave.tamaire --json
  tamaire --headless --level hoop --seconds 3 --photo hoop.png

Exit status: 0 played to the end, won or not; 1 the replay is refused, or the window broke down;
2 the arguments make no sense, or a file cannot be read or written";

/// The program `tamaire`; its exit status.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if arguments.list {
        headless::list();
        return ExitCode::SUCCESS;
    }
    let options = match &arguments.file {
        Some(file) => arguments.options.with_file(file),
        None => arguments.options,
    };
    // A file that was clicked on gets a window; a level that was typed gets an answer where it was typed.
    if let (None, Some(level)) = (&arguments.file, &options.level)
        && let Err(mistake) = level_at(level)
    {
        eprintln!("tamaire: {mistake}");
        return ExitCode::from(headless::BAD_USAGE);
    }
    let shown = arguments
        .file
        .or_else(|| options.level.clone().map(PathBuf::from));
    if arguments.headless {
        return headless::play(&options);
    }
    if !has_display() {
        return play_instead("there is no display here", &options);
    }
    let mut is_open = false;
    // A library of the window system that is not installed makes it panic.
    let opened = catch_unwind(AssertUnwindSafe(|| {
        show(shown, arguments.mute, &mut is_open)
    }));
    match opened {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(error)) if is_open => {
            eprintln!("tamaire: {error}");
            ExitCode::FAILURE
        }
        Ok(Err(error)) => play_instead(&trouble(&error), &options),
        Err(panic) if is_open => resume_unwind(panic),
        Err(_) => play_instead("no window opens", &options),
    }
}

/// Why no window opens.
fn trouble(error: &eframe::Error) -> String {
    let text = error.to_string();
    match error {
        eframe::Error::Wgpu(_) => format!(
            "there is nothing to draw with, neither Vulkan nor OpenGL, not even in software ({text})"
        ),
        // Before its reason it names a line of its source.
        eframe::Error::WinitEventLoop(_) | eframe::Error::Winit(_) => {
            let reason = text.rsplit(": ").next().unwrap_or(&text);
            format!("no window opens ({reason})")
        }
        _ => format!("no window opens ({text})"),
    }
}

/// Whose GPU is lost so soon does not begin anew: it would be lost again and again.
const LEAST_LIFE: Duration = Duration::from_secs(10);

/// Opens the window and returns when it is closed. When its GPU is lost the program begins anew: no window system lets
/// go of a window that broke down.
fn show(file: Option<PathBuf>, mute: bool, is_open: &mut bool) -> eframe::Result {
    let gpu = Rc::new(RefCell::new(None::<GpuWatch>));
    let began = Instant::now();
    // What is left of a lost GPU makes the window panic.
    let closed = catch_unwind(AssertUnwindSafe(|| {
        open_window(file, mute, gpu.clone(), is_open)
    }));
    let is_lost = gpu.take().is_some_and(|gpu| match closed {
        Ok(_) => gpu.is_lost(),
        Err(_) => gpu.tried_is_lost(),
    });
    match closed {
        _ if is_lost && began.elapsed() > LEAST_LIFE => {
            eprintln!("tamaire: the GPU was lost; the game begins anew");
            Err(eframe::Error::AppCreation(Box::new(begin_anew())))
        }
        Ok(Ok(())) if is_lost => Err(eframe::Error::AppCreation("the GPU was lost".into())),
        Ok(closed) => closed,
        Err(panic) => resume_unwind(panic),
    }
}

/// Puts the same program with the same arguments in the place of this one; returns why that cannot be.
#[cfg(unix)]
fn begin_anew() -> std::io::Error {
    use std::os::unix::process::CommandExt;
    std::env::current_exe().map_or_else(|error| error, |program| again(&program).exec())
}

/// The same elsewhere: this one ends, another one begins.
#[cfg(not(unix))]
fn begin_anew() -> std::io::Error {
    let begun = std::env::current_exe().and_then(|program| again(&program).spawn());
    begun.map_or_else(|error| error, |_| std::process::exit(0))
}

fn again(program: &Path) -> Command {
    let mut command = Command::new(program);
    command.args(std::env::args_os().skip(1));
    command
}

/// Opens the window and returns when it is closed.
fn open_window(
    file: Option<PathBuf>,
    mute: bool,
    gpu: Rc<RefCell<Option<GpuWatch>>>,
    is_open: &mut bool,
) -> eframe::Result {
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("玉入れ tamaire")
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([640.0, 400.0]),
        ..Default::default()
    };
    eframe::run_native(
        "tamaire",
        options,
        Box::new(move |context| {
            let sound = if mute { Sound::none() } else { Sound::open() };
            let mut game = Game::new(Files::usual(), sound, Pads::open());
            if let Some(file) = &file {
                game.open(Given::at(file));
            }
            let app = App::new(context, game)?;
            gpu.replace(Some(app.gpu.clone()));
            *is_open = true;
            Ok(Box::new(app))
        }),
    )
}

/// Plays a round without a window, and says why.
fn play_instead(reason: &str, options: &headless::Options) -> ExitCode {
    eprintln!(
        "tamaire: {reason}, so it plays a round by itself; --headless with --level, --bot, --seed, \
         --replay or --film lets you choose one, and --help tells more."
    );
    headless::play(options)
}

/// Whether there is a screen to open a window on: only some systems tell beforehand.
fn has_display() -> bool {
    let says_so = cfg!(all(
        unix,
        not(any(
            target_os = "macos",
            target_os = "ios",
            target_os = "android"
        ))
    ));
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !says_so
        || ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"]
            .into_iter()
            .any(is_set)
}
