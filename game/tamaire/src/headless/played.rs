//! Playing a round, as fast as it goes.

use super::force_log::ForceLog;
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use std::sync::Arc;
use std::time::{Duration, Instant};
use tamaire_play::{AnyRound, Bot, Level, Playback, Replay, ReplayError};

/// Ticks in a second.
pub const RATE: f32 = 60.0;

/// A round that was played, and how long each tick took.
pub struct Played {
    pub round: AnyRound,
    pub times: Vec<Duration>,
}

/// A round that a bot plays for so many ticks at most, unless it wins.
pub fn of_bot(
    level: Arc<Level>,
    mut bot: Bot,
    most_ticks: u64,
    log: &mut Option<ForceLog>,
) -> Played {
    let mut round = AnyRound::new(level);
    let mut times = Vec::new();
    let bar = progress("playing", most_ticks);
    while round.progress().outcome.is_none() && round.ticks() < most_ticks {
        let frame = round.ask(&mut bot);
        let start = Instant::now();
        round.step(frame);
        times.push(start.elapsed());
        bar.inc(1);
        if let Some(log) = log {
            log.note(&round);
        }
    }
    Played { round, times }
}

/// A round as it was recorded.
pub fn of_replay(replay: Arc<Replay>, log: &mut Option<ForceLog>) -> Result<Played, ReplayError> {
    let bar = progress("playing", replay.ticks() as u64);
    let mut playback = Playback::new(replay)?;
    let mut times = Vec::new();
    while !playback.is_over() {
        let start = Instant::now();
        playback.step()?;
        times.push(start.elapsed());
        bar.inc(1);
        if let Some(log) = log {
            log.note(playback.round());
        }
    }
    let round = playback.round().clone();
    Ok(Played { round, times })
}

/// A bar for whoever waits at a terminal, until it is dropped; into a file or a pipe it writes nothing.
pub fn progress(what: &'static str, ticks: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent} %  {elapsed}");
    ProgressBar::new(ticks)
        .with_style(style.expect("the template is well formed"))
        .with_message(what)
        .with_finish(ProgressFinish::AndClear)
}
