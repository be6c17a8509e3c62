//! Rounds without a window: plays a bot or a replay at full speed, prints a report, and makes films.

mod force_log;
mod played;
mod report;

use crate::film::{Film, FilmError};
use crate::platform::{OpenRequest, level_at, replay_in};
use clap::Args;
use clap::builder::PossibleValuesParser;
use force_log::ForceLog;
use played::{Played, RATE, of_bot, of_replay, progress};
use report::{Refusal, Report};
use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use tamaire_play::level::{LevelError, NAMED, built_in};
use tamaire_play::link::{LinkError, is_link};
use tamaire_play::{Bot, BotKind, Level, Link, Replay, ReplayError};

/// Exit status for a replay that is not genuine.
const REFUSED: u8 = 1;
/// Exit status for a request that cannot be carried out. Equal to clap's status for invalid arguments.
pub const BAD_USAGE: u8 = 2;
/// Default bot.
const BOT: &str = "squeeze";
/// Default seed of the bot.
const SEED: u64 = 1;
/// Default time limit of the bot [s].
const SECONDS: f32 = 60.0;
/// File extension of replays.
const REPLAY: &str = "tamaire";

/// Options of rounds without a window. Except `level`, they require the flag `--headless`.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Without a window")]
pub struct Options {
    /// Level, by name (see --list), by file (a level, a picture or a MagicaVoxel model) or by link. Without a window
    /// the default is classic
    #[arg(long, help_heading = None::<&'static str>, value_name = "NAME or FILE")]
    pub level: Option<PathBuf>,
    /// Bot that plays. The default is squeeze
    #[arg(long, requires = "headless", value_parser = PossibleValuesParser::new(BotKind::NAMED.map(|(name, _)| name)))]
    pub bot: Option<String>,
    /// Random seed of the bot. The same seed gives the same round. The default is 1
    #[arg(long, requires = "headless")]
    pub seed: Option<u64>,
    /// Time limit of the bot, in seconds of game time. The default is 60
    #[arg(long, requires = "headless", value_parser = seconds, allow_negative_numbers = true)]
    pub seconds: Option<f32>,
    /// Play a replay (.tamaire) instead of a bot, and check whether it is genuine
    #[arg(long, requires = "headless", value_name = "FILE", conflicts_with_all = ["level", "bot", "seed", "seconds"])]
    pub replay: Option<PathBuf>,
    /// Make a film: a strip of moments (.png) or an animation (.gif)
    #[arg(long, requires = "headless", value_name = "FILE", value_parser = path_to(&["png", "gif"]))]
    pub film: Option<PathBuf>,
    /// Make a photo of the end (.png)
    #[arg(long, requires = "headless", value_name = "FILE", value_parser = path_to(&["png"]))]
    pub photo: Option<PathBuf>,
    /// Write a replay of the round (.tamaire)
    #[arg(long, requires = "headless", value_name = "FILE", conflicts_with = "replay", value_parser = path_to(&[REPLAY]))]
    pub save: Option<PathBuf>,
    /// Write the force feedback as a table (.csv): a row for each substep, and for each update of a simulated
    /// stick and pad
    #[arg(long, requires = "headless", value_name = "FILE", value_parser = path_to(&["csv"]))]
    pub force_log: Option<PathBuf>,
    /// Print the result as JSON
    #[arg(long, requires = "headless")]
    pub json: bool,
    /// Level, replay or link that was given without an option. Its content decides which it is.
    #[arg(skip)]
    pub file: Option<PathBuf>,
}

impl Options {
    /// Returns the options with the level or replay in `file`, which may be a link.
    pub fn with_file(mut self, file: &Path) -> Self {
        self.file = Some(file.into());
        self
    }

    /// Returns the first option among those that need a bot, if one was given.
    fn option_of_bots(&self) -> Option<&'static str> {
        let given = [
            ("save", self.save.is_some()),
            ("bot", self.bot.is_some()),
            ("seed", self.seed.is_some()),
            ("seconds", self.seconds.is_some()),
        ];
        given
            .iter()
            .find(|(_, is_given)| *is_given)
            .map(|(name, _)| *name)
    }
}

/// Reason why a round without a window has no report.
#[derive(Debug, thiserror::Error)]
enum HeadlessError {
    #[error(transparent)]
    Level(#[from] LevelError),
    #[error("{}: {reason}", path.display())]
    Replay { path: PathBuf, reason: ReplayError },
    #[error("{}: {reason}", path.display())]
    File { path: PathBuf, reason: io::Error },
    #[error("cannot make the film: {0}")]
    Film(#[from] FilmError),
    #[error("{0}")]
    Link(#[from] LinkError),
    #[error("--{0} cannot be used with a replay, because no bot plays")]
    Replayed(&'static str),
    #[error("{0}")]
    Output(io::Error),
}

impl HeadlessError {
    fn file(path: &Path, reason: io::Error) -> Self {
        let path = path.into();
        Self::File { path, reason }
    }
}

/// Plays a round and prints its report.
pub fn play(options: &Options) -> ExitCode {
    match try_play(options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(HeadlessError::Replay { path, reason }) => {
            let refusal = Refusal {
                replay: path.display().to_string(),
                genuine: false,
                reason: reason.to_string(),
            };
            if !options.json {
                output::warn(format_args!(
                    "tamaire: {}: {}",
                    refusal.replay, refusal.reason
                ));
                return ExitCode::from(REFUSED);
            }
            match output::print(&report::json(&refusal)) {
                Ok(()) => ExitCode::from(REFUSED),
                Err(error) => failed(&error),
            }
        }
        Err(trouble) => failed(&trouble),
    }
}

fn failed(trouble: &dyn Error) -> ExitCode {
    output::warn(format_args!("tamaire: {trouble}"));
    ExitCode::from(BAD_USAGE)
}

/// Plays a round of a bot or a replay, writes its files and prints its report.
fn try_play(options: &Options) -> Result<(), HeadlessError> {
    let told = match (&options.file, &options.replay, &options.level) {
        (Some(file), ..) => match OpenRequest::at(file) {
            OpenRequest::Link(link) => try_link(&link, options),
            OpenRequest::Level(level) => try_bot(*level?, options),
            OpenRequest::Body(name, bytes) => {
                try_bot(OpenRequest::level_around(&name, &bytes)?, options)
            }
            OpenRequest::Pack(name, _) => {
                let reason = "expected a level or a replay, found a folder or a pack of levels";
                Err(LevelError::Unreadable(name, reason.into()).into())
            }
            OpenRequest::Replay(_, replay) => {
                let replay = replay.map_err(|error| not_read(file, error))?;
                check(file, *replay, options)
            }
        },
        (None, Some(path), _) => check(path, read_replay(path)?, options),
        (None, None, Some(place)) if is_link_argument(place) => {
            try_link(&place.to_string_lossy(), options)
        }
        (None, None, Some(place)) => try_bot(level_at(place)?, options),
        (None, None, None) => try_bot(Level::open(NAMED[0].0)?, options),
    }?;
    output::print(&told).map_err(HeadlessError::Output)
}

/// Plays the round or the level in a link, and returns the report.
fn try_link(link: &str, options: &Options) -> Result<String, HeadlessError> {
    match Link::read(link)? {
        Link::Level(level) => try_bot(*level, options),
        Link::Round(replay) => check(Path::new("the link"), *replay, options),
    }
}

/// Returns whether an argument is a link to a round or a level. A file with this name takes precedence.
pub fn is_link_argument(argument: &Path) -> bool {
    is_link(&argument.to_string_lossy()) && !argument.exists()
}

/// Prints the id of each level and its names in English and Japanese. Returns the exit status of the program.
pub fn list() -> ExitCode {
    let mut text = String::new();
    for (id, _) in built_in() {
        let level = Level::open(id).expect("built-in level opens");
        let name = &level.game().name;
        let other = name.ja.as_deref().unwrap_or_default();
        text += &format!("{id:16}  {:20}  {other}\n", name.en);
    }
    print(&text)
}

/// Prints a text. Returns the exit status of the program.
pub fn print(text: &str) -> ExitCode {
    match output::print(text) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failed(&error),
    }
}

/// Lets a bot play a round, and returns the report.
fn try_bot(level: Level, options: &Options) -> Result<String, HeadlessError> {
    let level = Arc::new(level);
    for note in level.scene().notes() {
        output::warn(format_args!("tamaire: note: {note}"));
    }
    for path in pictures(options).chain(&options.save) {
        can_be_written(path)?;
    }
    let mut log = force_log(options)?;
    let bot = options.bot.as_deref().unwrap_or(BOT);
    let named = BotKind::NAMED.iter().find(|(name, _)| *name == bot);
    let (_, kind) = named.expect("clap accepts only names in BotKind::NAMED");
    let seed = options.seed.unwrap_or(SEED);
    let most = (options.seconds.unwrap_or(SECONDS) * RATE) as u64;
    let played = of_bot(level, Bot::new(*kind, seed), most, &mut log);
    if let Some(path) = &options.save {
        let text = played.round.replay().text_to_keep();
        let text =
            text.map_err(|reason| HeadlessError::file(path, io::Error::other(reason.to_string())))?;
        write(path, text.as_bytes())?;
    }
    let by = report::Player::Bot {
        bot: bot.into(),
        seed,
    };
    let told = tell(&played, by, options)?;
    finish(log, options)?;
    Ok(told)
}

/// Reads a replay from a file.
fn read_replay(path: &Path) -> Result<Replay, HeadlessError> {
    replay_in(path).map_err(|error| not_read(path, error))
}

/// Converts the error of reading a replay from a file.
fn not_read(path: &Path, error: ReplayError) -> HeadlessError {
    match error {
        ReplayError::Unreadable(reason) => HeadlessError::file(path, io::Error::other(reason)),
        reason => HeadlessError::Replay {
            path: path.into(),
            reason,
        },
    }
}

/// Plays a replay, checks that it is genuine, and returns the report. `path` names the replay.
fn check(path: &Path, replay: Replay, options: &Options) -> Result<String, HeadlessError> {
    if let Some(option) = options.option_of_bots() {
        return Err(HeadlessError::Replayed(option));
    }
    for path in pictures(options) {
        can_be_written(path)?;
    }
    let refused = |reason| HeadlessError::Replay {
        path: path.into(),
        reason,
    };
    let mut log = force_log(options)?;
    let played = of_replay(Arc::new(replay), &mut log).map_err(refused)?;
    let by = report::Player::Replay {
        replay: path.display().to_string(),
        genuine: true,
    };
    let told = tell(&played, by, options)?;
    finish(log, options)?;
    Ok(told)
}

fn tell(played: &Played, by: report::Player, options: &Options) -> Result<String, HeadlessError> {
    if let Some(path) = &options.film {
        let is_animation = path.extension().is_some_and(|ending| ending == "gif");
        let film = if is_animation {
            Film::Animation
        } else {
            Film::Strip
        };
        write(path, &shoot(film, played)?)?;
    }
    if let Some(path) = &options.photo {
        write(path, &shoot(Film::Photo, played)?)?;
    }
    let report = Report::of(played, by);
    Ok(if options.json {
        report::json(&report)
    } else {
        report.to_string()
    })
}

/// Makes a film of a round and shows a progress bar.
fn shoot(film: Film, played: &Played) -> Result<Vec<u8>, FilmError> {
    let bar = progress("filming", 0);
    let told = |tick: usize, ticks: usize| {
        bar.set_length(ticks as u64);
        bar.set_position(tick as u64);
    };
    pollster::block_on(film.shoot(&played.round, &mut None, &told))
}

/// Returns the paths of films and photos.
fn pictures(options: &Options) -> impl Iterator<Item = &PathBuf> {
    options.film.iter().chain(&options.photo)
}

/// Creates the table of forces, if requested.
fn force_log(options: &Options) -> Result<Option<ForceLog>, HeadlessError> {
    let create =
        |path: &PathBuf| ForceLog::create(path).map_err(|reason| HeadlessError::file(path, reason));
    options.force_log.as_ref().map(create).transpose()
}

fn finish(log: Option<ForceLog>, options: &Options) -> Result<(), HeadlessError> {
    if let (Some(log), Some(path)) = (log, &options.force_log) {
        log.finish()
            .map_err(|reason| HeadlessError::file(path, reason))?;
        output::warn(format_args!("wrote {}", path.display()));
    }
    Ok(())
}

/// Checks that the folder of `path` exists. Done before the round, so that a long round is not played in
/// vain.
fn can_be_written(path: &Path) -> Result<(), HeadlessError> {
    output::check_folder(path).map_err(|reason| HeadlessError::file(path, reason))
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), HeadlessError> {
    output::write(path, bytes).map_err(|reason| HeadlessError::file(path, reason))?;
    output::warn(format_args!("wrote {}", path.display()));
    Ok(())
}

/// Parses a time limit [s].
fn seconds(text: &str) -> Result<f32, String> {
    let seconds: f32 = text.parse().map_err(|_| "expected a number".to_string())?;
    let good = (1.0..=3600.0).contains(&seconds);
    good.then_some(seconds)
        .ok_or("expected 1 to 3600 seconds".into())
}

/// Returns a parser of paths with one of these file extensions.
fn path_to(
    endings: &'static [&'static str],
) -> impl Fn(&str) -> Result<PathBuf, String> + Clone + Send + Sync {
    move |text| ends_in(text, endings)
}

fn ends_in(text: &str, endings: &[&str]) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let ending = path.extension().and_then(|ending| ending.to_str());
    if ending.is_some_and(|ending| endings.contains(&ending)) {
        return Ok(path);
    }
    Err(format!(
        "expected a file name with the extension .{}",
        endings.join(" or .")
    ))
}
