//! What the ticks of a level cost, engine and rules apart.
//!
//! `cargo run --release -p tamaire_play --example ticks -- [LEVEL [SEEDS]]` lets three bots play for 40 s
//! at most by the seeds 1 to SEEDS, each round three times, and prints milliseconds. A round is the
//! same every time: the least of three times of a tick is what it costs, the rest is the machine.

use fuwafuwa::{Dim, Dim2, Dim3, StepReport, World};
use std::sync::Arc;
use std::time::Instant;
use tamaire_play::{Bot, BotKind, Level, Round};

const RUNS: usize = 3;
const MOST_TICKS: usize = 2400;

/// What happened in a tick, and what it took [ms]: as a whole, and the engine's part.
struct Tick {
    report: StepReport,
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
            for _ in 1..RUNS {
                let (again, _) = play::<D>(level, kind, seed);
                for (tick, again) in ticks.iter_mut().zip(again) {
                    assert_eq!(tick.report, again.report, "rounds repeat");
                    tick.engine = tick.engine.min(again.engine);
                    tick.whole = tick.whole.min(again.whole);
                }
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

/// A round, and in how many pieces it ends. A world of its own goes along with the round's: what a
/// step of the round takes more than that of the world goes to the rules.
fn play<D: Dim>(level: &Arc<Level>, kind: BotKind, seed: u64) -> (Vec<Tick>, usize) {
    let mut round = Round::<D>::new(level.clone());
    let mut bot = Bot::new(kind, seed);
    let mut world = round.world().clone();
    let mut ticks = Vec::new();
    while ticks.len() < MOST_TICKS && round.progress().outcome.is_none() {
        let frame = bot.frame(&round);
        let start = Instant::now();
        let report = round.step(frame);
        let whole = milliseconds(start);
        follow(&mut world, &round);
        let start = Instant::now();
        assert_eq!(world.step(), report, "both worlds are the same");
        ticks.push(Tick {
            report,
            whole,
            engine: milliseconds(start),
        });
    }
    (ticks, round.progress().pieces)
}

/// Wants what the players of the round wanted in its last tick.
fn follow<D: Dim>(world: &mut World<D>, round: &Round<D>) {
    let hands = round.world().manipulators();
    for player in world.manipulators().len()..hands.len() {
        let scene = round.level().scene().build::<D>();
        let scene = scene.expect("the level was built once");
        let joins = world.add_manipulator(scene.manipulators()[player].clone());
        joins.expect("it is in the round");
    }
    for (player, hand) in hands.iter().enumerate() {
        world.set_goal(player, hand.goal());
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
