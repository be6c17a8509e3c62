//! The bots play through the same input as a person: what they can do is possible.

use fuwafuwa::Dim2;
use std::sync::Arc;
use std::thread;
use tamaire_play::{Bot, BotKind, Level, Outcome, Round, Route};

/// A minute and a half is long for Classic.
const MOST_TICKS: usize = 5400;

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

fn all_win_by(kind: BotKind, route: Route) {
    for (place, outcome) in outcomes(kind, 20, MOST_TICKS).into_iter().enumerate() {
        let outcome = outcome.unwrap_or_else(|| panic!("{kind:?}, seed {}: not won", place + 1));
        assert_eq!(
            outcome.route,
            route,
            "{kind:?}, seed {}: {outcome:?}",
            place + 1
        );
    }
}

#[test]
fn squeezing_wins_twenty_of_twenty() {
    all_win_by(BotKind::Squeeze, Route::Squeeze);
}

#[test]
fn shaving_wins_twenty_of_twenty() {
    all_win_by(BotKind::Shave, Route::Shave);
}

#[test]
fn who_does_nothing_never_wins_and_who_does_anything_rarely() {
    assert_eq!(outcomes(BotKind::Idle, 1, 600), [None]);
    let won = outcomes(BotKind::Random, 8, 1200);
    assert!(won.iter().flatten().count() <= 1, "{won:?}");
}
