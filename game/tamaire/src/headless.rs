//! Playing without a window: a bot or a replay, as fast as it goes. Tells how it went, and films it.

mod force_log;
mod played;
mod report;

use crate::film::{Film, FilmError};
use crate::platform::{level_at, replay_in};
use clap::Args;
use clap::builder::PossibleValuesParser;
use force_log::ForceLog;
use played::{Played, RATE, of_bot, of_replay, progress};
use report::{Refusal, Report};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use tamaire_play::level::{LevelError, NAMED, NAMED_3D};
use tamaire_play::{Bot, BotKind, Level, ReplayError};

/// Exit status when a replay is refused.
const REFUSED: u8 = 1;
/// Exit status when what was asked for cannot be done; clap's for bad arguments.
pub const BAD_USAGE: u8 = 2;
/// How the name of a replay's file ends.
const REPLAY: &str = "tamaire";

/// What is played without a window, and what is told of it. The command line has a flag `headless`,
/// without which only the level counts.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Without a window")]
pub struct Options {
    /// The level, by name (see --list) or in a file (.toml, .png or .vox); without a window classic if none is given
    #[arg(long, help_heading = None::<&'static str>, value_name = "NAME or FILE")]
    pub level: Option<String>,
    /// Which bot plays
    #[arg(long, requires = "headless", default_value = "squeeze", value_parser = PossibleValuesParser::new(BotKind::NAMED.map(|(name, _)| name)))]
    pub bot: String,
    /// Bots with different seeds play differently, with the same seed the same
    #[arg(long, requires = "headless", default_value_t = 1)]
    pub seed: u64,
    /// The bot gives up after so many seconds of the game
    #[arg(long, requires = "headless", default_value_t = 60.0, value_parser = seconds, allow_negative_numbers = true)]
    pub seconds: f32,
    /// Play a replay (.tamaire) instead, and say whether it is genuine
    #[arg(long, requires = "headless", value_name = "FILE", conflicts_with_all = ["level", "bot", "seed", "seconds"])]
    pub replay: Option<PathBuf>,
    /// Film it: a strip of moments (.png) or an animation (.gif)
    #[arg(long, requires = "headless", value_name = "FILE", value_parser = film_path)]
    pub film: Option<PathBuf>,
    /// Take a photo of its end (.png)
    #[arg(long, requires = "headless", value_name = "FILE", value_parser = photo_path)]
    pub photo: Option<PathBuf>,
    /// Write a replay of the round (.tamaire)
    #[arg(long, requires = "headless", value_name = "FILE", conflicts_with = "replay", value_parser = replay_path)]
    pub save: Option<PathBuf>,
    /// Write what would be felt (.csv): a row for each substep, and for each update of a stick that points at the hand's
    /// goal and of a pad
    #[arg(long, requires = "headless", value_name = "FILE", value_parser = table_path)]
    pub force_log: Option<PathBuf>,
    /// Tell how it went as JSON
    #[arg(long, requires = "headless")]
    pub json: bool,
}

impl Options {
    /// The same with the level or the replay in a file.
    pub fn with_file(mut self, file: &Path) -> Self {
        match file.extension() {
            Some(ending) if ending == REPLAY => self.replay = Some(file.into()),
            _ => self.level = Some(file.to_string_lossy().into()),
        }
        self
    }
}

/// Why there is nothing to tell.
#[derive(Debug, thiserror::Error)]
enum Trouble {
    #[error(transparent)]
    Level(#[from] LevelError),
    #[error("{}: {reason}", path.display())]
    Replay { path: PathBuf, reason: ReplayError },
    #[error("{}: {reason}", path.display())]
    File { path: PathBuf, reason: io::Error },
    #[error("the film: {0}")]
    Film(#[from] FilmError),
}

/// Plays, and tells how it went.
pub fn play(options: &Options) -> ExitCode {
    let told = match &options.replay {
        Some(path) => check(path, options),
        None => try_bot(options),
    };
    match told {
        Ok(text) => {
            say(&text);
            ExitCode::SUCCESS
        }
        Err(Trouble::Replay { path, reason }) => {
            let refusal = Refusal {
                replay: path.display().to_string(),
                genuine: false,
                reason: reason.to_string(),
            };
            if options.json {
                say(&report::json(&refusal));
            } else {
                eprintln!("tamaire: {}: {}", refusal.replay, refusal.reason);
            }
            ExitCode::from(REFUSED)
        }
        Err(trouble) => {
            eprintln!("tamaire: {trouble}");
            ExitCode::from(BAD_USAGE)
        }
    }
}

/// Prints the names of the levels.
pub fn list() {
    let mut text = String::new();
    for (id, _) in NAMED.iter().chain(&NAMED_3D) {
        let level = Level::open(id).expect("the tests open it");
        let name = &level.game().name;
        let other = name.ja.as_deref().unwrap_or_default();
        text += &format!("{id:12}  {:20}  {other}\n", name.en);
    }
    say(&text);
}

/// Lets a bot play.
fn try_bot(options: &Options) -> Result<String, Trouble> {
    let level = options.level.as_deref().unwrap_or(NAMED[0].0);
    let level = Arc::new(level_at(level)?);
    for path in pictures(options).chain(&options.save) {
        can_be_written(path)?;
    }
    let mut log = force_log(options)?;
    let named = BotKind::NAMED.iter().find(|(name, _)| *name == options.bot);
    let (_, kind) = named.expect("the parser lets no other through");
    let most = (options.seconds * RATE) as u64;
    let played = of_bot(level, Bot::new(*kind, options.seed), most, &mut log);
    if let Some(path) = &options.save {
        let text = played.round.replay().text_to_keep();
        let text = text.map_err(|reason| Trouble::File {
            path: path.clone(),
            reason: io::Error::other(reason.to_string()),
        })?;
        write(path, text.as_bytes())?;
    }
    let by = report::Player::Bot {
        bot: options.bot.clone(),
        seed: options.seed,
    };
    let told = tell(&played, by, options)?;
    finish(log, options)?;
    Ok(told)
}

/// Runs a replay.
fn check(path: &Path, options: &Options) -> Result<String, Trouble> {
    for path in pictures(options) {
        can_be_written(path)?;
    }
    let refused = |reason| Trouble::Replay {
        path: path.into(),
        reason,
    };
    let replay = replay_in(path).map_err(|error| match error {
        ReplayError::Unreadable(reason) => Trouble::File {
            path: path.into(),
            reason: io::Error::other(reason),
        },
        error => refused(error),
    })?;
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

fn tell(played: &Played, by: report::Player, options: &Options) -> Result<String, Trouble> {
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

/// A film of a round, with a bar for whoever waits.
fn shoot(film: Film, played: &Played) -> Result<Vec<u8>, FilmError> {
    let bar = progress("filming", 0);
    let told = |tick: usize, ticks: usize| {
        bar.set_length(ticks as u64);
        bar.set_position(tick as u64);
    };
    pollster::block_on(film.shoot(&played.round, &mut None, &told))
}

/// Where films and photos are to go.
fn pictures(options: &Options) -> impl Iterator<Item = &PathBuf> {
    options.film.iter().chain(&options.photo)
}

/// The table of forces, if it was asked for.
fn force_log(options: &Options) -> Result<Option<ForceLog>, Trouble> {
    let create = |path: &PathBuf| {
        ForceLog::create(path).map_err(|reason| Trouble::File {
            path: path.clone(),
            reason,
        })
    };
    options.force_log.as_ref().map(create).transpose()
}

fn finish(log: Option<ForceLog>, options: &Options) -> Result<(), Trouble> {
    if let (Some(log), Some(path)) = (log, &options.force_log) {
        log.finish().map_err(|reason| Trouble::File {
            path: path.clone(),
            reason,
        })?;
        eprintln!("wrote {}", path.display());
    }
    Ok(())
}

/// Better to hear of a missing folder before a long round than after it.
fn can_be_written(path: &Path) -> Result<(), Trouble> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    if folder.is_none_or(Path::is_dir) {
        return Ok(());
    }
    let reason = io::Error::new(io::ErrorKind::NotFound, "there is no such folder");
    let path = path.into();
    Err(Trouble::File { path, reason })
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Trouble> {
    let failed = |reason| Trouble::File {
        path: path.into(),
        reason,
    };
    std::fs::write(path, bytes).map_err(failed)?;
    eprintln!("wrote {}", path.display());
    Ok(())
}

/// To whoever reads on; nobody has to.
fn say(text: &str) {
    let _ = io::stdout().write_all(text.as_bytes());
}

/// A time to play for.
fn seconds(text: &str) -> Result<f32, String> {
    let seconds: f32 = text.parse().map_err(|_| "expected a number".to_string())?;
    let good = (1.0..=3600.0).contains(&seconds);
    good.then_some(seconds)
        .ok_or("expected 1 to 3600 seconds".into())
}

/// Where a film goes.
fn film_path(text: &str) -> Result<PathBuf, String> {
    ends_in(text, &["png", "gif"])
}

/// Where a photo goes.
fn photo_path(text: &str) -> Result<PathBuf, String> {
    ends_in(text, &["png"])
}

/// Where a replay goes.
fn replay_path(text: &str) -> Result<PathBuf, String> {
    ends_in(text, &[REPLAY])
}

/// Where a table goes.
fn table_path(text: &str) -> Result<PathBuf, String> {
    ends_in(text, &["csv"])
}

fn ends_in(text: &str, endings: &[&str]) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let ending = path.extension().and_then(|ending| ending.to_str());
    if ending.is_some_and(|ending| endings.contains(&ending)) {
        return Ok(path);
    }
    Err(format!(
        "expected a name that ends in .{}",
        endings.join(" or .")
    ))
}
