//! The bots play through the same input as a person: what they can do is possible.

use fuwafuwa::Dim2;
use std::sync::Arc;
use std::thread;
use tamaire_play::level::NAMED;
use tamaire_play::{Bot, BotKind, Level, Outcome, Round, Route};

/// Nobody should take longer than a minute.
const MINUTE: usize = 60 * 60;

/// The bot that wins a level as it is meant, and how.
const WINNERS: [(&str, BotKind, Route); 9] = [
    ("classic", BotKind::Squeeze, Route::Squeeze),
    ("gravity", BotKind::Squeeze, Route::Squeeze),
    ("neck", BotKind::Squeeze, Route::Squeeze),
    ("twins", BotKind::Squeeze, Route::Squeeze),
    ("core", BotKind::Squeeze, Route::Squeeze),
    ("donut", BotKind::Squeeze, Route::Squeeze),
    ("cat", BotKind::Squeeze, Route::Squeeze),
    ("rubber", BotKind::Squeeze, Route::Squeeze),
    ("biscuit", BotKind::Shave, Route::Shave),
];

/// How a bot's rounds of a level end, by seed, a round a thread.
fn outcomes(id: &str, kind: BotKind, seeds: u64, ticks: usize) -> Vec<Option<Outcome>> {
    let level = Arc::new(Level::open(id).unwrap());
    let play = |seed| {
        let mut round = Round::<Dim2>::new(level.clone());
        let mut bot = Bot::new(kind, seed);
        for _ in 0..ticks {
            let frame = bot.frame(&round);
            let report = round.step(frame);
            assert_eq!(report.quarantined, 0, "{id}, {kind:?}, seed {seed}");
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

/// That a bot wins all rounds of a level by a route.
fn wins(id: &str, kind: BotKind, route: Route, seeds: u64) {
    for (outcome, seed) in outcomes(id, kind, seeds, MINUTE).into_iter().zip(1..) {
        let found = outcome.map(|outcome| outcome.route);
        assert_eq!(
            found,
            Some(route),
            "{id}, {kind:?}, seed {seed}: {outcome:?}"
        );
    }
}

#[test]
fn squeezing_wins_twenty_of_twenty() {
    wins("classic", BotKind::Squeeze, Route::Squeeze, 20);
}

#[test]
fn shaving_wins_twenty_of_twenty() {
    wins("classic", BotKind::Shave, Route::Shave, 20);
}

#[test]
fn every_level_with_a_basket_can_be_won_as_it_is_meant() {
    for (id, _) in NAMED {
        let has_basket = Level::open(id).unwrap().game().basket.is_some();
        let is_listed = WINNERS.iter().any(|(known, ..)| *known == id);
        assert_eq!(has_basket, is_listed, "{id}");
    }
    for (id, kind, route) in WINNERS {
        wins(id, kind, route, 2);
    }
}

#[test]
fn who_does_nothing_never_wins_and_who_does_anything_rarely() {
    for (id, ..) in WINNERS {
        assert_eq!(outcomes(id, BotKind::Idle, 1, 600), [None], "{id}");
    }
    let won = outcomes("classic", BotKind::Random, 4, 1200);
    assert!(won.iter().flatten().count() <= 1, "{won:?}");
}
