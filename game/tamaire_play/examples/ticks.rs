//! Measures the processor time of ticks.
//!
//! `cargo run --release -p tamaire_play --example ticks -- all` lets three bots play every level for at most
//! 60 s with the seeds 1 to 5. The output is in milliseconds: a row per round, one per level and one for all
//! levels. Each round is played three times (`--runs`) with the same result. The shortest time of a tick
//! counts as its cost; longer times are noise of the machine. `--rules` measures engine and rules separately,
//! in twice the time. `--json` prints one object per line instead of the rows. `--help` lists all options.

use clap::Parser;
use fuwafuwa::{Dim, Dim2, Dim3, DimVector, RigidBodyHandle, StepReport, Vec3};
use serde::Serialize;
use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;
use tamaire_play::level::built_in;
use tamaire_play::{Bot, BotKind, Level, Round};

const TICKS_A_SECOND: usize = 60;

/// Measures the cost of the ticks of levels, in milliseconds.
#[derive(Parser)]
struct Options {
    /// Names of built-in levels; `all` for all of them.
    #[arg(default_value = "classic")]
    levels: Vec<String>,
    /// Number of seeds: each bot plays with the seeds 1 to this number.
    #[arg(long, default_value_t = 5)]
    seeds: u64,
    /// Number of times each round is played. The cost of a tick is the minimum of its times.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u64).range(1..))]
    runs: u64,
    /// Time limit of a round [s].
    #[arg(long, default_value_t = 60, value_parser = clap::value_parser!(u64).range(1..=3600))]
    seconds: u64,
    /// Names of the bots that play, separated by commas.
    #[arg(long, value_delimiter = ',', default_value = "squeeze,shave,random")]
    bots: Vec<String>,
    /// Also measures the engine alone and the rules alone.
    #[arg(long)]
    rules: bool,
    /// Prints one JSON object per line instead of rows for a reader.
    #[arg(long)]
    json: bool,
}

/// Measurement of a tick.
struct Tick {
    report: StepReport,
    /// Targets of the hands.
    goals: Vec<Vec3>,
    /// Duration of the tick, engine and rules [ms].
    whole: f64,
    /// Duration of the engine's part [ms].
    engine: f64,
}

/// Output row of a round, or of several rounds.
#[derive(Serialize)]
struct Row {
    level: String,
    bot: String,
    /// Seed of the round; 0 for several rounds.
    seed: u64,
    ticks: usize,
    pieces: usize,
    milliseconds: Ranks,
    /// Duration of the rules alone [ms].
    rules: Option<Ranks>,
    /// Index of the slowest tick.
    worst_tick: usize,
    /// Number of nodes split in the slowest tick.
    worst_released: u32,
}

/// Median, 99th percentile and maximum of durations [ms].
#[derive(Serialize)]
struct Ranks {
    median: f64,
    p99: f64,
    worst: f64,
}

fn main() -> ExitCode {
    match measure(&Options::parse()) {
        // A closed pipe ends the output early but is no failure.
        Err(error) if !is_closed(&*error) => {
            eprintln!("ticks: {error}");
            ExitCode::FAILURE
        }
        _ => ExitCode::SUCCESS,
    }
}

fn is_closed(error: &(dyn Error + 'static)) -> bool {
    let error = error.downcast_ref::<io::Error>();
    error.is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
}

fn measure(options: &Options) -> Result<(), Box<dyn Error>> {
    let named: Vec<&str> = built_in().map(|(id, _)| id).collect();
    let mut levels = Vec::new();
    for id in &options.levels {
        match id.as_str() {
            "all" => levels.extend(&named),
            id => levels.push(id),
        }
    }
    let levels: Result<Vec<_>, _> = levels.into_iter().map(Level::open).collect();
    let mut bots = Vec::new();
    for name in &options.bots {
        let bot = BotKind::NAMED.iter().find(|(known, _)| known == name);
        bots.push(*bot.ok_or_else(|| format!("unknown bot {name:?}"))?);
    }
    if !options.json {
        writeln!(
            io::stdout(),
            "{:>12} {:>12} {:>6} {:>6} | {:>6} {:>6} {:>6} | worst tick",
            "level",
            "bot, seed",
            "ticks",
            "pieces",
            "median",
            "99 %",
            "worst",
        )?;
    }
    let mut all = Vec::new();
    for level in levels?.into_iter().map(Arc::new) {
        let times = match level.scene().dim {
            2 => measure_level::<Dim2>(&level, &bots, options)?,
            _ => measure_level::<Dim3>(&level, &bots, options)?,
        };
        all.extend(times);
    }
    match options.levels.len() > 1 || options.levels[0] == "all" {
        true => tell(&summary("all", &all), options),
        false => Ok(()),
    }
}

/// Measures a level, and returns the duration of each tick of all rounds [ms].
fn measure_level<D: Dim>(
    level: &Arc<Level>,
    bots: &[(&str, BotKind)],
    options: &Options,
) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut all = Vec::new();
    for &(bot, kind) in bots {
        for seed in 1..=options.seeds {
            let (ticks, pieces) = least::<D>(level, kind, seed, options);
            let whole = || ticks.iter().map(|tick| tick.whole);
            let rules = || ticks.iter().map(|tick| tick.whole - tick.engine);
            let worst = (0..ticks.len()).max_by(|&a, &b| ticks[a].whole.total_cmp(&ticks[b].whole));
            let worst = worst.ok_or("the round was over before it began")?;
            let row = Row {
                level: level.id.clone(),
                bot: bot.into(),
                seed,
                ticks: ticks.len(),
                pieces,
                milliseconds: Ranks::of(whole()),
                rules: options.rules.then(|| Ranks::of(rules())),
                worst_tick: worst,
                worst_released: ticks[worst].report.nodes_split,
            };
            tell(&row, options)?;
            all.extend(whole());
        }
    }
    tell(&summary(&level.id, &all), options)?;
    Ok(all)
}

/// Returns one row for all ticks of several rounds.
fn summary(level: &str, times: &[f64]) -> Row {
    Row {
        level: level.into(),
        bot: "all".into(),
        seed: 0,
        ticks: times.len(),
        pieces: 0,
        milliseconds: Ranks::of(times.iter().copied()),
        rules: None,
        worst_tick: 0,
        worst_released: 0,
    }
}

fn tell(row: &Row, options: &Options) -> Result<(), Box<dyn Error>> {
    if options.json {
        return Ok(writeln!(io::stdout(), "{}", serde_json::to_string(row)?)?);
    }
    let Ranks { median, p99, worst } = row.milliseconds;
    let (name, pieces, what) = match row.seed {
        0 => (row.bot.clone(), String::new(), String::new()),
        seed => (
            format!("{} {seed}", row.bot),
            row.pieces.to_string(),
            format!("{}: {} nodes released", row.worst_tick, row.worst_released),
        ),
    };
    let rules = row.rules.as_ref().map_or(String::new(), |rules| {
        format!("; rules {:.3}, worst {:.3}", rules.median, rules.worst)
    });
    writeln!(
        io::stdout(),
        "{:>12} {name:>12} {:>6} {pieces:>6} | {median:>6.2} {p99:>6.2} {worst:>6.2} | {what}{rules}",
        row.level,
        row.ticks,
    )?;
    Ok(())
}

/// Plays a round several times. Returns its ticks with their minimum durations, and its final number of
/// pieces.
fn least<D: Dim>(
    level: &Arc<Level>,
    kind: BotKind,
    seed: u64,
    options: &Options,
) -> (Vec<Tick>, usize) {
    let most = options.seconds as usize * TICKS_A_SECOND;
    let (mut ticks, pieces) = play::<D>(level, kind, seed, most);
    for run in 1..=options.runs {
        if options.rules {
            step_alone::<D>(level, &mut ticks);
        }
        if run == options.runs {
            break;
        }
        let (again, _) = play::<D>(level, kind, seed, most);
        for (tick, again) in ticks.iter_mut().zip(again) {
            assert_eq!(
                tick.report, again.report,
                "a repeated round must be identical"
            );
            tick.whole = tick.whole.min(again.whole);
        }
    }
    (ticks, pieces)
}

/// Plays a round. Returns its ticks and its final number of pieces.
fn play<D: Dim>(level: &Arc<Level>, kind: BotKind, seed: u64, most: usize) -> (Vec<Tick>, usize) {
    let mut round = Round::<D>::new(level.clone());
    let mut bot = Bot::new(kind, seed);
    let mut ticks = Vec::new();
    while ticks.len() < most && round.progress().outcome.is_none() {
        let frame = bot.frame(&round);
        let start = Instant::now();
        let report = round.step(frame);
        let whole = milliseconds(start);
        let hands = round.hands();
        ticks.push(Tick {
            report,
            goals: hands.map(|hand| hand.target_position().to_vec3()).collect(),
            whole,
            engine: f64::INFINITY,
        });
    }
    (ticks, round.progress().pieces)
}

/// Steps the world without the rules, with the recorded targets, and stores the duration of each tick. The
/// difference from the tick of the round is the cost of the rules. Runs after the round, because in parallel
/// both would compete for the caches.
fn step_alone<D: Dim>(level: &Arc<Level>, ticks: &mut [Tick]) {
    let mut world = Round::<D>::new(level.clone()).world().clone();
    let mut hands: Vec<RigidBodyHandle> = Vec::new();
    hands.extend(world.nth_target_follower(0));
    for tick in ticks {
        for player in hands.len()..tick.goals.len() {
            let scene = level.scene().build::<D>();
            let scene = scene.expect("the level was built before");
            let hand = scene
                .nth_target_follower(player)
                .expect("the level has this hand");
            let hand = scene.rigid_body(hand).expect("the scene has this hand");
            let joins = world.add_rigid_body(hand.definition());
            hands.push(joins.expect("the round accepted this hand"));
        }
        for (&hand, &goal) in hands.iter().zip(&tick.goals) {
            world
                .set_target_position(hand, D::Vector::from_vec3(goal))
                .expect("the hand and target were valid in the round");
        }
        let start = Instant::now();
        assert_eq!(
            world.step(),
            tick.report,
            "the world must behave as in the round"
        );
        tick.engine = tick.engine.min(milliseconds(start));
    }
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

impl Ranks {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.collect();
        sorted.sort_by(f64::total_cmp);
        let part = |percent| match sorted.len() {
            0 => 0.0,
            count => sorted[(count - 1) * percent / 100],
        };
        Self {
            median: part(50),
            p99: part(99),
            worst: part(100),
        }
    }
}
