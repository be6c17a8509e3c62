//! What the ticks of a level cost, engine and rules apart.
//!
//! `cargo run --release -p tamaire_play --example ticks -- [LEVEL [SEEDS]]` lets three bots play for 40 s
//! at most by the seeds 1 to SEEDS, each round three times, and prints milliseconds. A round is the
//! same every time: the least of three times of a tick is what it costs, the rest is the machine.

use fuwafuwa::{Dim, Dim2, Dim3, StepReport, Vector};
use std::sync::Arc;
use std::time::Instant;
use tamaire_play::{Bot, BotKind, Level, Round};

const RUNS: usize = 3;
const MOST_TICKS: usize = 2400;

/// What happened in a tick, where the hands wanted to be, and what it took [ms]: as a whole, and the
/// engine's part.
struct Tick {
    report: StepReport,
    goals: Vec<Vector>,
    whole: f64,
    engine: f64,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or("classic".into());
    let seeds: u64 = arguments.next().map_or(Ok(5), |seeds| seeds.parse())?;
    let level = Arc::new(Level::open(&name)?);
    match level.scene().dim {
        2 => measure::<Dim2>(&level, seeds),
        _ => measure::<Dim3>(&level, seeds),
    }
    Ok(())
}

fn measure<D: Dim>(level: &Arc<Level>, seeds: u64) {
    println!(
        "{:>12} {:>5} {:>6} | {:>6} {:>6} {:>6} | {:>6} {:>6} | worst tick",
        "bot, seed", "ticks", "pieces", "median", "99 %", "worst", "rules", "worst"
    );
    let bots = [
        ("squeeze", BotKind::Squeeze),
        ("shave", BotKind::Shave),
        ("random", BotKind::Random),
    ];
    for (bot, kind) in bots {
        for seed in 1..=seeds {
            let (mut ticks, pieces) = play::<D>(level, kind, seed);
            run::<D>(level, &mut ticks);
            for _ in 1..RUNS {
                let (again, _) = play::<D>(level, kind, seed);
                for (tick, again) in ticks.iter_mut().zip(again) {
                    assert_eq!(tick.report, again.report, "rounds repeat");
                    tick.whole = tick.whole.min(again.whole);
                }
                run::<D>(level, &mut ticks);
            }
            let [median, most, worst] = ranks(ticks.iter().map(|tick| tick.engine));
            let [rules, _, worst_rules] = ranks(ticks.iter().map(|tick| tick.whole - tick.engine));
            let slow = ticks.iter().position(|tick| tick.engine == worst);
            let slow = slow.expect("a round has ticks");
            println!(
                "{:>12} {:>5} {pieces:>6} | {median:>6.2} {most:>6.2} {worst:>6.2} | {rules:>6.3} {worst_rules:>6.3} | {slow}: {} nodes released",
                format!("{bot} {seed}"),
                ticks.len(),
                ticks[slow].report.released,
            );
        }
    }
}

/// A round, and in how many pieces it ends.
fn play<D: Dim>(level: &Arc<Level>, kind: BotKind, seed: u64) -> (Vec<Tick>, usize) {
    let mut round = Round::<D>::new(level.clone());
    let mut bot = Bot::new(kind, seed);
    let mut ticks = Vec::new();
    while ticks.len() < MOST_TICKS && round.progress().outcome.is_none() {
        let frame = bot.frame(&round);
        let start = Instant::now();
        let report = round.step(frame);
        let whole = milliseconds(start);
        let hands = round.world().manipulators().iter();
        ticks.push(Tick {
            report,
            goals: hands.map(|hand| hand.goal()).collect(),
            whole,
            engine: f64::INFINITY,
        });
    }
    (ticks, round.progress().pieces)
}

/// The world of a round alone, whose hands want what they wanted in it: what a tick of the round takes
/// more goes to the rules. Not beside the round, where both would have to share the caches.
fn run<D: Dim>(level: &Arc<Level>, ticks: &mut [Tick]) {
    let mut world = Round::<D>::new(level.clone()).world().clone();
    for tick in ticks {
        for player in world.manipulators().len()..tick.goals.len() {
            let scene = level.scene().build::<D>();
            let scene = scene.expect("the level was built once");
            let joins = world.add_manipulator(scene.manipulators()[player].clone());
            joins.expect("it is in the round");
        }
        for (player, &goal) in tick.goals.iter().enumerate() {
            world.set_goal(player, goal);
        }
        let start = Instant::now();
        assert_eq!(world.step(), tick.report, "both worlds are the same");
        tick.engine = tick.engine.min(milliseconds(start));
    }
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

/// The median, what 99 % stay below, and the greatest.
fn ranks(values: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len() - 1;
    [last / 2, last * 99 / 100, last].map(|place| sorted[place])
}
