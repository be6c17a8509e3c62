//! Report on a round, as text and as JSON.

use super::played::Played;
use crate::film::by_route;
use serde::Serialize;
use std::fmt;
use std::time::Duration;
use tamaire_play::{Outcome, Route};

/// Report on a round. The fields are those of the JSON.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Version of the game.
    game: &'static str,
    /// Id of the level.
    level: String,
    /// Name of the level in English.
    name: String,
    #[serde(flatten)]
    by: Player,
    won: bool,
    route: Option<Route>,
    /// Game time from the first push until the round was won or given up [s].
    seconds: f32,
    ticks: u64,
    /// Sum of the masses of each body's largest piece, relative to this sum at the start.
    kept: f32,
    /// Fraction of the mass that is at rest in the basket.
    inside: f32,
    /// Fraction of the mass that must be at rest in the basket to win.
    needed: f32,
    pieces: usize,
    /// Whether each wish of the level is fulfilled. A fulfilled wish is a star.
    wishes: Vec<bool>,
    /// Hash of the final state of the world, in hexadecimal.
    hash: String,
    /// Median computing time of a tick [ms].
    p50_tick_ms: f64,
    /// Computing time that 99 % of all ticks do not exceed [ms].
    p99_tick_ms: f64,
    /// Longest computing time of a tick [ms].
    worst_tick_ms: f64,
}

/// Player of the round.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Player {
    /// A bot.
    Bot { bot: String, seed: u64 },
    /// A replay file.
    Replay { replay: String, genuine: bool },
}

/// Report on a rejected replay.
#[derive(Debug, Serialize)]
pub struct Refusal {
    pub replay: String,
    pub genuine: bool,
    pub reason: String,
}

impl Report {
    /// Creates the report on a round.
    pub fn of(played: &Played, by: Player) -> Self {
        let (round, level) = (&played.round, played.round.level());
        let progress = round.progress();
        let outcome = progress.outcome;
        let fulfilled = |wish| outcome.is_some_and(|outcome: Outcome| outcome.fulfils(wish));
        let mut times: Vec<f64> = played.times.iter().map(Duration::as_secs_f64).collect();
        times.sort_by(f64::total_cmp);
        let milliseconds = |share| {
            let seconds = output::quantile(&times, share).unwrap_or(0.0);
            (1e6 * seconds).round() / 1e3
        };
        Self {
            game: env!("CARGO_PKG_VERSION"),
            level: level.id.clone(),
            name: level.game().name.en.clone(),
            by,
            won: outcome.is_some(),
            route: outcome.map(|outcome| outcome.route),
            seconds: round.seconds(),
            ticks: round.frames().len() as u64,
            kept: progress.kept,
            // Turns -0, the sum of an empty iterator, into 0.
            inside: progress.inside + 0.0,
            needed: level.game().share,
            pieces: progress.pieces,
            wishes: level.game().wish.iter().map(fulfilled).collect(),
            hash: format!("{:016x}", round.hash()),
            p50_tick_ms: milliseconds(0.5),
            p99_tick_ms: milliseconds(0.99),
            worst_tick_ms: milliseconds(1.0),
        }
    }
}

/// Formats a value as JSON with a line end.
pub fn json(value: &impl Serialize) -> String {
    let text = serde_json::to_string_pretty(value);
    text.expect("maps have string keys") + "\n"
}

impl fmt::Display for Report {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        match &self.by {
            Player::Bot { bot, seed } => {
                writeln!(to, "{}, played by the bot {bot}, seed {seed}", self.name)?;
            }
            Player::Replay { replay, .. } => {
                writeln!(to, "{}, as recorded in {replay}: genuine", self.name)?;
            }
        }
        let mut row = |name: &str, value: String| writeln!(to, "  {name:<12}{value}");
        let percent = |share: f32| format!("{:.0} %", 100.0 * share);
        row(
            "result",
            match self.route {
                Some(route) => format!("{} in {:.1} s", by_route(route), self.seconds),
                None => format!("not won in {:.1} s", self.seconds),
            },
        )?;
        let needed = percent(self.needed);
        row("mass kept", percent(self.kept))?;
        row(
            "in basket",
            format!("{} ({needed} required)", percent(self.inside)),
        )?;
        row("pieces", self.pieces.to_string())?;
        if !self.wishes.is_empty() {
            let fulfilled = self.wishes.iter().filter(|&&wish| wish).count();
            row("stars", format!("{fulfilled} of {}", self.wishes.len()))?;
        }
        row("state", format!("{} after {} ticks", self.hash, self.ticks))?;
        let (median, p99, worst) = (self.p50_tick_ms, self.p99_tick_ms, self.worst_tick_ms);
        row(
            "simulation",
            format!(
                "{median:.2} ms per tick (median), {p99:.2} ms (99th percentile), {worst:.2} ms (worst)"
            ),
        )
    }
}
