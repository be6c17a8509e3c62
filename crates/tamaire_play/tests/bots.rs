//! The bots play through the same input as a person: what they can do is possible.

use fuwafuwa::Dim2;
use std::sync::Arc;
use std::thread;
use tamaire_play::{Bot, BotKind, Level, Outcome, Round, Route};

/// Forty seconds are long for Classic.
const MOST_TICKS: usize = 2400;

/// How a bot's rounds of Classic end, by seed, a round a thread.
fn outcomes(kind: BotKind, seeds: u64, ticks: usize) -> Vec<Option<Outcome>> {
    let level = Arc::new(Level::open("classic").unwrap());
    let play = |seed| {
        let mut round = Round::<Dim2>::new(level.clone());
        let mut bot = Bot::new(kind, seed);
        for _ in 0..ticks {
            let frame = bot.frame(&round);
            let report = round.step(frame);
            assert_eq!(report.quarantined, 0, "{kind:?}, seed {seed}");
            if round.progress().outcome.is_some() {
                break;
            }
        }
        round.progress().outcome
    };
    thread::scope(|scope| {
        let play = &play;
        let threads: Vec<_> = (1..=seeds)
            .map(|seed| scope.spawn(move || play(seed)))
            .collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .collect()
    })
}

/// That so many of twenty rounds at least are won, all of them by a route.
fn win_by(kind: BotKind, route: Route, least: usize) {
    let won: Vec<Outcome> = outcomes(kind, 20, MOST_TICKS)
        .into_iter()
        .flatten()
        .collect();
    assert!(won.len() >= least, "{kind:?}: {} of 20 won", won.len());
    assert!(won.iter().all(|outcome| outcome.route == route), "{won:?}");
}

#[test]
fn squeezing_wins_twenty_of_twenty() {
    win_by(BotKind::Squeeze, Route::Squeeze, 20);
}

/// Now and then it shreds the body so finely that gathering takes longer than this.
#[test]
fn shaving_wins_nearly_always() {
    win_by(BotKind::Shave, Route::Shave, 15);
}

#[test]
fn who_does_nothing_never_wins_and_who_does_anything_rarely() {
    assert_eq!(outcomes(BotKind::Idle, 1, 600), [None]);
    let won = outcomes(BotKind::Random, 8, 1200);
    assert!(won.iter().flatten().count() <= 1, "{won:?}");
}
