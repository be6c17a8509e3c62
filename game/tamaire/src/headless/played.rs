//! Playing rounds at full speed.

use super::force_log::ForceLog;
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use std::sync::Arc;
use std::time::{Duration, Instant};
use tamaire_play::{AnyRound, Bot, Level, Playback, Replay, ReplayError};

/// Ticks per second.
pub const RATE: f32 = 60.0;

/// A finished round, and the computing time of each tick.
pub struct Played {
    pub round: AnyRound,
    pub times: Vec<Duration>,
}

/// Lets a bot play a round until it has won or `most_ticks` have passed.
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

/// Plays a replay to its end and checks that the world does not diverge from it.
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

/// Creates a progress bar that disappears when dropped. It is shown only on a terminal.
pub fn progress(what: &'static str, ticks: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent} %  {elapsed}");
    ProgressBar::new(ticks)
        .with_style(style.expect("template is valid"))
        .with_message(what)
        .with_finish(ProgressFinish::AndClear)
}
