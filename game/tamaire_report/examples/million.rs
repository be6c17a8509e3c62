//! Makes a logbook of a million rounds, to measure a report on it.
//!
//! `cargo run --release -p tamaire_report --example million -- a.logbook 1000000 300` lets bots play 300
//! rounds, and writes copies of these rounds as plausible visits spread over many days. `/usr/bin/time -v
//! tamaire report --csv --json --out out a.logbook` measures duration and peak memory of a report on the
//! logbook.

use fastrand::Rng;
use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use tamaire_logbook::{Entry, Event, Id, Kind, Logbook, Moment, Round, RoundEnd, Visit};
use tamaire_play::{AnyRound, Bot, BotKind, Level, Route};

/// Level, bot and maximum number of ticks of each kind of round that bots play.
const PLAYED: [(&str, BotKind, usize); 8] = [
    ("classic", BotKind::Squeeze, 3600),
    ("classic", BotKind::Shave, 3600),
    ("classic", BotKind::Random, 1500),
    ("neck", BotKind::Squeeze, 3600),
    ("neck", BotKind::Shave, 3600),
    ("donut", BotKind::Squeeze, 3600),
    ("donut", BotKind::Random, 1200),
    ("hoop", BotKind::Squeeze, 1800),
];
/// Relative number of visits in each hour from 10:00 on, with peaks before noon and in the afternoon.
const CROWD: [u32; 8] = [6, 11, 7, 5, 10, 12, 9, 4];
const DAY_MS: i64 = 86_400_000;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match &arguments[..] {
        [file, rounds, bots] => make(Path::new(file), rounds.parse()?, bots.parse()?),
        _ => Err("expected the arguments FILE ROUNDS BOTS".into()),
    }
}

fn make(file: &Path, count: usize, bots: usize) -> Result<(), Box<dyn Error>> {
    let played = play(bots);
    println!("{} rounds played", played.len());
    let (mut book, _) = Logbook::open(file, "Stand 1")?;
    let mut random = Rng::with_seed(1);
    let days = (count as i64 / 1200).clamp(3, 365);
    let mut written = 0;
    while written < count {
        let mut entries = Vec::new();
        while entries.len() < 5000 && written < count {
            written += visit(&mut random, &played, days, &mut entries);
        }
        book.write_all(&entries)?;
    }
    println!("{written} rounds, {} bytes", book.bytes());
    Ok(())
}

/// Lets bots play `bots` rounds on all cores.
fn play(bots: usize) -> Vec<Round> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut rounds = Vec::new();
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= bots {
                return rounds;
            }
            let (level, kind, ticks) = PLAYED[seed % PLAYED.len()];
            rounds.push(play_one(level, kind, ticks, seed as u64));
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        let threads: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let rounds = threads.into_iter().flat_map(|thread| thread.join());
        rounds.flatten().collect()
    })
}

fn play_one(name: &str, kind: BotKind, ticks: usize, seed: u64) -> Round {
    let level = Arc::new(Level::open(name).expect("built-in level"));
    let mut round = AnyRound::new(level.clone());
    let mut bot = Bot::new(kind, seed);
    while round.frames().len() < ticks && round.progress().outcome.is_none() {
        let frame = round.ask(&mut bot);
        round.step(frame);
    }
    let progress = round.progress();
    let outcome = progress.outcome;
    Round {
        id: Id(0),
        visit: Id(0),
        stand: String::new(),
        number: 0,
        began: Moment {
            utc_ms: 0,
            offset_s: 0,
        },
        seconds: round.frames().len() as f32 / 60.0,
        level: level.id.clone(),
        level_hash: level.hash(),
        players: 1,
        end: if outcome.is_some() {
            RoundEnd::Won
        } else {
            RoundEnd::Retried
        },
        route: outcome.map(|won| won.route),
        kept: progress.kept,
        inside: progress.inside,
        pieces: progress.pieces as u32,
        lost: outcome.map_or(0, |won| won.lost as u32),
        dare: None,
        replay: round
            .replay()
            .fragment()
            .expect("a played round has a replay"),
    }
}

/// Adds the entries of a visit whose players learn and often try the other route. Returns the number of
/// rounds.
fn visit(random: &mut Rng, played: &[Round], days: i64, entries: &mut Vec<Entry>) -> usize {
    let began = moment(random, days);
    let id = Id(random.u128(..));
    let stand = ["Stand 1", "Stand 2"][usize::from(random.u8(..3) == 0)];
    let language = ["ja", "ja", "ja", "en", "zh"][random.usize(..5)];
    entries.push(Entry::VisitBegan(Visit {
        id,
        stand: stand.into(),
        began,
        ended: None,
        language: language.into(),
    }));
    let mut clock = began.after(random.i64(3000..15_000));
    let (mut number, mut dare) = (0, None);
    loop {
        number += 1;
        let mut round = chosen(random, played, number, dare);
        round.id = Id(random.u128(..));
        (round.visit, round.stand) = (id, stand.into());
        (round.number, round.began, round.dare) = (number, clock, dare);
        clock = clock.after((1000.0 * round.seconds) as i64 + random.i64(2000..8000));
        let route = round.route;
        let goes = random.f32() < if route.is_some() { 0.4 } else { 0.3 } || number == 30;
        if goes && route.is_none() {
            round.end = RoundEnd::Left;
        }
        entries.push(Entry::Round(round));
        if goes {
            break;
        }
        dare = match route {
            Some(Route::Squeeze) => Some(Route::Shave),
            Some(_) => Some(Route::Squeeze),
            None => dare,
        };
    }
    if random.u16(..300) > 0 {
        entries.push(Entry::VisitEnded {
            id,
            at: clock.after(20_000),
            language: String::new(),
        });
    } else {
        entries.push(Entry::Event(Event {
            id: Id(random.u128(..)),
            stand: stand.into(),
            at: clock,
            kind: [Kind::Hung, Kind::Crashed, Kind::DeviceLost][random.usize(..3)].clone(),
            text: String::new(),
        }));
    }
    number as usize
}

/// Returns a copy of a round in `played`. The probability that it is won grows with `number`, the number of
/// the round within its visit.
fn chosen(random: &mut Rng, played: &[Round], number: u32, dare: Option<Route>) -> Round {
    let wins = random.f32() < [0.35, 0.5, 0.6, 0.65][(number as usize - 1).min(3)];
    let tries_dare = random.f32() < 0.4;
    // The classic level is chosen most often.
    let is_classic = random.f32() < 0.6;
    for _ in 0..200 {
        let round = &played[random.usize(..played.len())];
        let fits = round.route.is_some() == wins
            && (round.level == "classic") == is_classic
            && (!wins || !tries_dare || dare.is_none() || round.route == dare);
        if fits {
            return round.clone();
        }
    }
    played[random.usize(..played.len())].clone()
}

/// Returns a moment within the opening hours of one of the last `days` days up to 2026-11-23, in Japan.
fn moment(random: &mut Rng, days: i64) -> Moment {
    let midnight = 1_795_359_600_000 - DAY_MS * random.i64(0..days);
    let mut place = random.u32(0..CROWD.iter().sum::<u32>());
    let mut hour = 10;
    for many in CROWD {
        if place < many {
            break;
        }
        place -= many;
        hour += 1;
    }
    Moment {
        utc_ms: midnight + 3_600_000 * hour + random.i64(0..3_600_000),
        offset_s: 9 * 3600,
    }
}
