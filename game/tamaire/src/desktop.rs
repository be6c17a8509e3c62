//! Entry point on a desktop: the command line, a window, and a round without a window if no display is found.

mod exhibit;
mod report;
mod window;

use crate::game::Game;
use crate::headless::{self, is_link_argument};
use crate::licences;
use crate::platform::{Files, OpenRequest, Sound, level_at, today};
use app_shell::Pads;
use app_shell::window::{WindowOutcome, has_display};
use clap::{CommandFactory, Parser, Subcommand};
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use window::open_game;

/// Push a soft body into a basket that is too small for it.
#[derive(Parser)]
#[command(version, after_help = AFTER_HELP, args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(subcommand)]
    chore: Option<Task>,
    /// A level, a picture (PNG, JPEG, WebP, GIF or BMP) or a MagicaVoxel model to make a body of, a replay, or a
    /// link to a round or a level (https://…#r1…)
    #[arg(conflicts_with_all = ["level", "replay"])]
    file: Option<PathBuf>,
    /// Turn the sound off
    #[arg(long)]
    mute: bool,
    /// List the levels
    #[arg(long)]
    list: bool,
    /// Print the third-party parts of this program and their licences
    #[arg(long)]
    licences: bool,
    /// Play a round without a window at full speed, and print the result
    #[arg(long)]
    headless: bool,
    /// Run a public stand with this configuration file, which is created if it does not exist
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "exhibit.toml")]
    #[arg(conflicts_with_all = ["file", "list", "licences", "headless"])]
    exhibit: Option<PathBuf>,
    /// Run the game of a stand (started by its supervisor)
    #[arg(long, hide = true)]
    stand: Option<PathBuf>,
    /// Show the calm picture of a stand (started by its supervisor)
    #[arg(long, hide = true)]
    rest: Option<PathBuf>,
    #[command(flatten)]
    options: headless::Options,
}

/// Subcommands, which do not play a round.
#[derive(Subcommand)]
enum Task {
    /// Write an HTML report about visitors from the logbooks of one or more stands and days
    Report(report::Options),
    Manual(manual::Options),
}

const AFTER_HELP: &str = "\
Examples:
  tamaire drawing.png
  tamaire --level hoop
  tamaire --headless --bot shave --seed 7 --film shave.gif --save shave.tamaire
  tamaire --headless --replay shave.tamaire --json
  tamaire --headless --level hoop --seconds 3 --photo hoop.png
  tamaire --exhibit stand.toml
  tamaire report visits.sqlite --out report --csv

Exit status: 0 the round was played to its end, won or not; 1 the replay was rejected, or the window failed;
2 invalid arguments, or a file could not be read or written";

/// Runs the program `tamaire` and returns its exit status.
pub fn main() -> ExitCode {
    let arguments: Arguments = output::parse();
    if let Some(error) = without_driver_messages(&arguments) {
        output::warn(format_args!(
            "tamaire: the program cannot start itself again to keep graphics drivers quiet: {error}"
        ));
    }
    match &arguments.chore {
        Some(Task::Report(options)) => return report::write(options),
        Some(Task::Manual(options)) => return manual::run(Arguments::command(), options),
        None => {}
    }
    if arguments.licences {
        return headless::print(licences::TEXT);
    }
    if arguments.list {
        return headless::list();
    }
    let mute = arguments.mute;
    match (&arguments.exhibit, &arguments.stand, &arguments.rest) {
        (Some(file), ..) => return exhibit::keep_running(file, mute),
        (_, Some(file), _) => return exhibit::play(file, mute),
        (.., Some(file)) => return exhibit::rest(file),
        _ => {}
    }
    let options = match &arguments.file {
        Some(file) => arguments.options.with_file(file),
        None => arguments.options,
    };
    // Checks a level given by `--level` and reports its errors on the terminal. Errors of a file opened by a
    // double click are shown in the window instead.
    if let (None, Some(level)) = (&arguments.file, &options.level)
        && !is_link_argument(level)
        && let Err(mistake) = level_at(level)
    {
        output::warn(format_args!("tamaire: {mistake}"));
        return ExitCode::from(headless::BAD_USAGE);
    }
    let shown = arguments.file.or_else(|| options.level.clone());
    if arguments.headless {
        return headless::play(&options);
    }
    if !has_display() {
        return play_instead("no display was found", &options);
    }
    let opened = open_game(egui::ViewportBuilder::default(), move || {
        let sound = if mute { Sound::none() } else { Sound::open() };
        let mut game = Game::new(Files::usual(), sound, Pads::open());
        game.calendar = Some(today);
        if let Some(file) = &shown {
            game.open(OpenRequest::at(file));
        }
        (game, None)
    });
    match opened {
        WindowOutcome::Closed => ExitCode::SUCCESS,
        WindowOutcome::LostGpu => {
            output::warn("tamaire: the GPU was lost; restarting the game");
            output::warn(format_args!(
                "tamaire: the game could not be restarted: {}",
                begin_anew()
            ));
            ExitCode::FAILURE
        }
        WindowOutcome::Failed(error) => {
            output::warn(format_args!("tamaire: {error}"));
            ExitCode::FAILURE
        }
        WindowOutcome::Broken(panic) => resume_unwind(panic),
        WindowOutcome::Never(reason) => play_instead(&reason, &options),
    }
}

/// Replaces this process with a new instance with the same arguments. Returns only on failure, with the
/// reason.
#[cfg(unix)]
fn begin_anew() -> std::io::Error {
    use std::os::unix::process::CommandExt;
    std::env::current_exe().map_or_else(|error| error, |program| again(&program).exec())
}

/// Starts a new instance with the same arguments and ends this process. Returns only on failure, with the
/// reason.
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

/// Replaces this process with one in which graphics drivers find no display, if pictures are made without a
/// session. Otherwise Mesa looks for a Wayland display and prints errors about the missing `XDG_RUNTIME_DIR`.
/// Returns only if nothing has to be done, or with the reason why the process cannot be replaced.
#[cfg(all(unix, not(target_os = "macos")))]
fn without_driver_messages(arguments: &Arguments) -> Option<std::io::Error> {
    use std::os::unix::process::CommandExt;
    /// Environment variable with the folder of the sockets of a session.
    const SESSION: &str = "XDG_RUNTIME_DIR";
    let options = &arguments.options;
    let makes_pictures = match &arguments.chore {
        Some(Task::Report(options)) => options.makes_clips(),
        Some(Task::Manual(_)) => false,
        None => arguments.headless && (options.film.is_some() || options.photo.is_some()),
    };
    let has_session =
        std::env::var_os(SESSION).is_some_and(|folder| Path::new(&folder).is_absolute());
    if !makes_pictures || has_session {
        return None;
    }
    let program = std::env::current_exe();
    // No display has its socket in a folder that does not exist.
    let replaced = |program: PathBuf| again(&program).env(SESSION, "/nonexistent").exec();
    Some(program.map_or_else(|error| error, replaced))
}

#[cfg(not(all(unix, not(target_os = "macos"))))]
fn without_driver_messages(_: &Arguments) -> Option<std::io::Error> {
    None
}

/// Prints `reason` and plays a round without a window.
fn play_instead(reason: &str, options: &headless::Options) -> ExitCode {
    output::warn(format_args!(
        "tamaire: {reason}, so a round is played without a window; choose the round with --headless and --level, --bot, \
         --seed or --replay (see --help)"
    ));
    headless::play(options)
}
