//! Time that runs back: every earlier state returns to the bit, and what is played on afterwards verifies.

use fuwafuwa::Vec3;
use std::sync::Arc;
use tamaire_play::{
    AnyRound, Bot, BotKind, InputFrame, Level, Link, Outcome, Playback, Replay, Rewind,
};

/// Lets time run back to a tick, or as far as it can.
fn run_back_to(rewind: &mut Rewind, round: &mut AnyRound, tick: u64) {
    rewind.begin(round);
    round.count_rewind();
    while round.ticks() > tick && rewind.left(round) > 0 {
        while !rewind.is_ready() {
            assert!(!rewind.prepare(round) || rewind.is_ready());
        }
        assert!(rewind.back(round));
    }
    rewind.end();
}

/// Plays on with a bot, and notes the hash after each tick.
fn play(
    round: &mut AnyRound,
    rewind: &mut Rewind,
    hashes: &mut Vec<u64>,
    ticks: u64,
    frame: &mut dyn FnMut(&mut AnyRound) -> InputFrame,
) {
    for _ in 0..ticks {
        if round.progress().outcome.is_some() {
            return;
        }
        let frame = frame(round);
        round.step(frame);
        rewind.note(round);
        hashes.truncate(round.ticks() as usize);
        hashes.push(round.hash());
    }
}

/// Verifies that a replay of the round plays to the same end.
fn verify(round: &AnyRound) {
    let replay = Replay::read(&round.replay().text()).unwrap();
    assert_eq!(replay.rewinds, round.rewinds());
    let mut playback = Playback::new(Arc::new(replay)).unwrap();
    while !playback.is_over() {
        playback.step().unwrap();
    }
    assert_eq!(playback.round().hash(), round.hash());
    let outcome: Option<Outcome> = round.progress().outcome;
    assert_eq!(playback.round().progress().outcome, outcome);
}

/// Runs time back at random moments by random amounts while a bot plays. Returns the number of rewinds.
fn rewind_at_random(id: &str, kind: BotKind, seed: u64, most: usize) -> usize {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut round = AnyRound::new(Arc::new(Level::open(id).unwrap()));
    let mut rewind = Rewind::new(&round);
    let mut hashes = vec![round.hash()];
    let mut bot = Bot::new(kind, seed);
    let mut count = 0;
    while count < most && round.progress().outcome.is_none() {
        // Most rewinds are short, so that the test takes less time.
        let [ticks, back] = match count % 8 {
            0 => [60, 70],
            _ => [20, 22],
        };
        let ticks = random.u64(1..ticks);
        let mut ask = |round: &mut AnyRound| round.ask(&mut bot);
        play(&mut round, &mut rewind, &mut hashes, ticks, &mut ask);
        if round.progress().outcome.is_some() {
            break;
        }
        let now = round.ticks();
        let goal = now.saturating_sub(random.u64(1..back));
        run_back_to(&mut rewind, &mut round, goal);
        let tick = round.ticks();
        assert!(
            tick <= now && (tick + rewind.stride() > goal),
            "{id}: {now} to {goal}, {tick}"
        );
        assert_eq!(round.hash(), hashes[tick as usize], "{id} at tick {tick}");
        assert_eq!(round.frames().len() as u64, tick);
        count += 1;
    }
    verify(&round);
    count
}

#[test]
fn a_thousand_random_rewinds_return_to_the_same_bits() {
    let mut count = 0;
    for seed in 0.. {
        let id = ["classic", "biscuit", "twins", "walk-the-dog"][seed as usize % 4];
        let kind = [BotKind::Shave, BotKind::Squeeze][seed as usize / 4 % 2];
        count += rewind_at_random(id, kind, seed, 60);
        if count >= 1000 {
            break;
        }
        assert!(seed < 200, "the bots win too early");
    }
    rewind_at_random("under-the-table", BotKind::Squeeze, 1, 6);
}

#[test]
fn ten_seconds_run_back_and_no_more() {
    let mut round = AnyRound::new(Arc::new(Level::open("sandbox").unwrap()));
    let mut rewind = Rewind::new(&round);
    assert_eq!(rewind.left(&round), 0, "nothing has happened yet");
    let mut hashes = vec![round.hash()];
    let mut circle = |round: &mut AnyRound| {
        let angle = 0.05 * round.ticks() as f32;
        InputFrame::towards(Vec3::new(-0.8 * angle.cos(), 0.6 * angle.sin(), 0.0))
    };
    play(&mut round, &mut rewind, &mut hashes, 900, &mut circle);
    assert_eq!(rewind.left(&round), 600);
    run_back_to(&mut rewind, &mut round, 0);
    let tick = round.ticks();
    assert!((300 - 60..=300).contains(&tick), "{tick}");
    assert_eq!(round.hash(), hashes[tick as usize]);
    // Time runs on as it did.
    let expected = hashes.clone();
    play(&mut round, &mut rewind, &mut hashes, 200, &mut circle);
    assert_eq!(hashes[..], expected[..hashes.len()]);
}

#[test]
fn a_rewound_round_says_so_in_its_link() {
    let mut round = AnyRound::new(Arc::new(Level::open("classic").unwrap()));
    let mut rewind = Rewind::new(&round);
    let mut push = |_: &mut AnyRound| InputFrame::towards(Vec3::new(-0.9, 0.0, 0.0));
    play(&mut round, &mut rewind, &mut vec![0], 90, &mut push);
    run_back_to(&mut rewind, &mut round, 40);
    let Ok(Link::Round(sent)) = Link::read(&round.replay().link().unwrap()) else {
        panic!("no round in the link");
    };
    assert_eq!((sent.rewinds, sent.ticks()), (1, round.frames().len()));
}

#[test]
fn after_a_win_time_does_not_run_back() {
    let mut round = AnyRound::new(Arc::new(Level::open("classic").unwrap()));
    let mut rewind = Rewind::new(&round);
    let mut bot = Bot::new(BotKind::Squeeze, 1);
    let mut ask = |round: &mut AnyRound| round.ask(&mut bot);
    play(&mut round, &mut rewind, &mut vec![0], 3600, &mut ask);
    assert!(round.progress().outcome.is_some());
    assert_eq!(rewind.left(&round), 0);
}
