//! Measures how often a bot wins a level by the intended route.
//!
//! `cargo run --release -p tamaire_play --example bots -- LEVEL|all squeeze|shave FROM TO` lets the bot play
//! with the seeds FROM to TO, for at most a minute each, on two threads. `all` stands for all built-in levels
//! that offer the bot's route. The output has a row per level with
//!
//! - the number of rounds won by the bot's route, won by another route, and lost,
//! - the medians of the won rounds: seconds, share of the mass kept in the largest pieces, number of pieces,
//! - the seeds of the rounds won by another route or lost.
//!
//! `--rounds` also prints a row per round.

use clap::Parser;
use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use tamaire_play::level::{NAMED, NAMED_3D};
use tamaire_play::{AnyRound, Bot, BotKind, Level, Outcome, Route};

/// Time limit of a round [ticks].
const MINUTE: usize = 60 * 60;
const THREADS: usize = 2;
/// Bots and their routes by name.
const ROUTES: [(&str, BotKind, Route); 2] = [
    ("squeeze", BotKind::Squeeze, Route::Squeeze),
    ("shave", BotKind::Shave, Route::Shave),
];

/// Measures how often a bot wins a level by the intended route.
#[derive(Parser)]
struct Options {
    /// Name of a level, or `all` for all built-in levels that offer the bot's route.
    level: String,
    /// Bot to play: squeeze or shave.
    bot: String,
    /// First seed.
    from: u64,
    /// Last seed.
    to: u64,
    /// Also prints a row per round.
    #[arg(long)]
    rounds: bool,
}

/// Seed of a round, and its outcome if it was won.
type Ending = (u64, Option<Outcome>);

fn main() -> ExitCode {
    match play_all(&Options::parse()) {
        // A closed pipe ends the output early but is no failure.
        Err(error) if !is_closed(&*error) => {
            eprintln!("bots: {error}");
            ExitCode::FAILURE
        }
        _ => ExitCode::SUCCESS,
    }
}

fn is_closed(error: &(dyn Error + 'static)) -> bool {
    let error = error.downcast_ref::<io::Error>();
    error.is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
}

fn play_all(options: &Options) -> Result<(), Box<dyn Error>> {
    let Options { from, to, .. } = *options;
    let known = ROUTES.iter().find(|(name, ..)| *name == options.bot);
    let &(name, kind, route) =
        known.ok_or_else(|| format!("expected squeeze or shave, found {:?}", options.bot))?;
    if from > to {
        return Err(format!("expected seeds FROM to TO, found {from} to {to}").into());
    }
    let levels = levels(&options.level, route)?;
    writeln!(
        io::stdout(),
        "{:>12} {name:>8} {:>6} {:>6} | {:>7} {:>5} {:>6} | seeds",
        "level",
        "other",
        "lost",
        "seconds",
        "kept",
        "pieces"
    )?;
    for level in levels.into_iter().map(Arc::new) {
        let endings = endings(&level, kind, from, to);
        if options.rounds {
            tell_rounds(&level.id, &endings)?;
        }
        tell(&level.id, route, &endings)?;
    }
    Ok(())
}

/// Returns the level with the name `asked`; for `all`, returns all built-in levels that offer the route.
fn levels(asked: &str, route: Route) -> Result<Vec<Level>, Box<dyn Error>> {
    let offers = |level: &Level| level.routes().contains(&route);
    if asked != "all" {
        let level = Level::open(asked)?;
        return match offers(&level) {
            true => Ok(vec![level]),
            false => Err(format!("{asked} does not offer the route {route:?}").into()),
        };
    }
    let all = NAMED.iter().chain(&NAMED_3D).map(|(id, _)| Level::open(id));
    let all: Vec<Level> = all.collect::<Result<_, _>>()?;
    Ok(all.into_iter().filter(offers).collect())
}

/// Plays a level with the seeds from `from` to `to` and returns the endings of the rounds, sorted by seed.
fn endings(level: &Arc<Level>, kind: BotKind, from: u64, to: u64) -> Vec<Ending> {
    let seeds: Vec<u64> = (from..=to).collect();
    let next = AtomicUsize::new(0);
    let play_on = || {
        let mut endings = Vec::new();
        while let Some(&seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed)) {
            endings.push((seed, play(level, kind, seed)));
        }
        endings
    };
    let mut endings: Vec<Ending> = thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS).map(|_| scope.spawn(play_on)).collect();
        let joined = threads.into_iter().map(|thread| thread.join());
        joined
            .flat_map(|part| part.expect("a round must not panic"))
            .collect()
    });
    endings.sort_by_key(|(seed, _)| *seed);
    endings
}

fn play(level: &Arc<Level>, kind: BotKind, seed: u64) -> Option<Outcome> {
    let mut round = AnyRound::new(level.clone());
    round.play(&mut Bot::new(kind, seed), MINUTE)
}

fn tell_rounds(id: &str, endings: &[Ending]) -> io::Result<()> {
    for (seed, outcome) in endings {
        match outcome {
            None => writeln!(io::stdout(), "{id:>12} {seed:>8} lost")?,
            Some(won) => writeln!(
                io::stdout(),
                "{id:>12} {seed:>8} {:<13} | {:>7.1} {:>5.2} {:>6} | {} not in the basket",
                format!("{:?}", won.route),
                won.seconds(),
                won.kept,
                won.pieces,
                won.lost
            )?,
        }
    }
    Ok(())
}

/// Prints the row of a level.
fn tell(id: &str, route: Route, endings: &[Ending]) -> io::Result<()> {
    let won: Vec<Outcome> = endings.iter().filter_map(|(_, outcome)| *outcome).collect();
    let of = |wanted: &dyn Fn(&Outcome) -> bool| -> Vec<u64> {
        let wanted = endings
            .iter()
            .filter(|(_, outcome)| outcome.is_some_and(|won| wanted(&won)));
        wanted.map(|(seed, _)| *seed).collect()
    };
    let other = of(&|won| won.route != route);
    let lost = endings.iter().filter(|(_, outcome)| outcome.is_none());
    let lost: Vec<u64> = lost.map(|(seed, _)| *seed).collect();
    let seeds = [("other", &other), ("lost", &lost)].map(|(name, seeds)| match seeds.is_empty() {
        true => String::new(),
        false => format!(" {name} {seeds:?}"),
    });
    writeln!(
        io::stdout(),
        "{id:>12} {:>8} {:>6} {:>6} | {:>7.1} {:>5.2} {:>6} |{}",
        won.len() - other.len(),
        other.len(),
        lost.len(),
        median(won.iter().map(Outcome::seconds)),
        median(won.iter().map(|won| won.kept)),
        median(won.iter().map(|won| won.pieces as f32)),
        seeds.concat(),
    )
}

/// Returns the median of the values; 0 without values.
fn median(values: impl Iterator<Item = f32>) -> f32 {
    let mut sorted: Vec<f32> = values.collect();
    sorted.sort_by(f32::total_cmp);
    let middle = |from: usize| sorted.get(from / 2).copied().unwrap_or(0.0);
    0.5 * (middle(sorted.len().saturating_sub(1)) + middle(sorted.len()))
}
