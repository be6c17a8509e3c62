//! Entry point on a desktop: the command line, a window, and a round without a window if no display is found.

mod exhibit;
mod report;
mod window;

use crate::game::Game;
use crate::headless;
use crate::licences;
use crate::platform::{Files, OpenRequest, Sound, level_at};
use app_shell::Pads;
use app_shell::window::{WindowOutcome, has_display};
use clap::{CommandFactory, Parser, Subcommand};
use std::io::Write;
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
    let arguments = Arguments::parse();
    match &arguments.chore {
        Some(Task::Report(options)) => return report::write(options),
        Some(Task::Manual(options)) => return manual::run(Arguments::command(), options),
        None => {}
    }
    if arguments.licences {
        return print_licences();
    }
    if arguments.list {
        headless::list();
        return ExitCode::SUCCESS;
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
        return play_instead("no display was found", &options);
    }
    let opened = open_game(egui::ViewportBuilder::default(), move || {
        let sound = if mute { Sound::none() } else { Sound::open() };
        let mut game = Game::new(Files::usual(), sound, Pads::open());
        if let Some(file) = &shown {
            game.open(OpenRequest::at(file));
        }
        (game, None)
    });
    match opened {
        WindowOutcome::Closed => ExitCode::SUCCESS,
        WindowOutcome::LostGpu => {
            eprintln!("tamaire: the GPU was lost; restarting the game");
            eprintln!("tamaire: {}", begin_anew());
            ExitCode::FAILURE
        }
        WindowOutcome::Failed(error) => {
            eprintln!("tamaire: {error}");
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

fn print_licences() -> ExitCode {
    // Ignores a failure to write: the reader, for example a pager, may have been closed early.
    let _read = std::io::stdout().write_all(licences::TEXT.as_bytes());
    ExitCode::SUCCESS
}

/// Prints `reason` and plays a round without a window.
fn play_instead(reason: &str, options: &headless::Options) -> ExitCode {
    eprintln!(
        "tamaire: {reason}, so a bot plays a round without a window; choose the round with --headless and --level, --bot, \
         --seed or --replay (see --help)"
    );
    headless::play(options)
}
