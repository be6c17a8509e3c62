//! Bots use the same input as human players, so whatever they achieve is possible for a player.

use fuwafuwa::{Dim, Dim2, Dim3};
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::thread;
use tamaire_play::level::{NAMED, NAMED_3D};
use tamaire_play::{Bot, BotKind, Level, Outcome, Round, Route};

/// Time limit of a round: a minute [ticks].
const MINUTE: usize = 60 * 60;

/// Bot and route that win each level as intended.
const WINNERS: [(&str, BotKind, Route); 12] = [
    ("classic", BotKind::Squeeze, Route::Squeeze),
    ("gravity", BotKind::Squeeze, Route::Squeeze),
    ("neck", BotKind::Squeeze, Route::Squeeze),
    ("twins", BotKind::Squeeze, Route::Squeeze),
    ("core", BotKind::Squeeze, Route::Squeeze),
    ("donut", BotKind::Squeeze, Route::Squeeze),
    ("cat", BotKind::Squeeze, Route::Squeeze),
    ("rubber", BotKind::Squeeze, Route::Squeeze),
    ("biscuit", BotKind::Shave, Route::Shave),
    ("classic-3d", BotKind::Squeeze, Route::Squeeze),
    ("hoop", BotKind::Squeeze, Route::Squeeze),
    ("pudding", BotKind::Squeeze, Route::Squeeze),
];

/// Returns the outcomes of a bot's rounds of a level, by seed. Each round has its own thread.
fn outcomes(
    id: &str,
    kind: BotKind,
    seeds: RangeInclusive<u64>,
    ticks: usize,
) -> Vec<Option<Outcome>> {
    let level = Arc::new(Level::open(id).unwrap());
    let play = match level.scene().dim {
        2 => outcome::<Dim2>,
        _ => outcome::<Dim3>,
    };
    thread::scope(|scope| {
        let start = |seed| {
            let level = level.clone();
            scope.spawn(move || play(level, kind, seed, ticks))
        };
        let threads: Vec<_> = seeds.map(start).collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .collect()
    })
}

fn outcome<D: Dim>(level: Arc<Level>, kind: BotKind, seed: u64, ticks: usize) -> Option<Outcome> {
    let mut round = Round::<D>::new(level);
    let mut bot = Bot::new(kind, seed);
    for _ in 0..ticks {
        let frame = bot.frame(&round);
        let report = round.step(frame);
        let id = &round.level().id;
        assert_eq!(report.quarantined, 0, "{id}, {kind:?}, seed {seed}");
        if round.progress().outcome.is_some() {
            break;
        }
    }
    round.progress().outcome
}

/// Checks that a bot wins all rounds of a level by a route.
fn wins(id: &str, kind: BotKind, route: Route, seeds: RangeInclusive<u64>) {
    let outcomes = outcomes(id, kind, seeds.clone(), MINUTE);
    let others: Vec<_> = seeds
        .zip(outcomes)
        .filter(|(_, outcome)| outcome.map(|outcome| outcome.route) != Some(route))
        .collect();
    assert!(others.is_empty(), "{id}, {kind:?}, by seed: {others:?}");
}

#[test]
fn squeezing_wins_twenty_of_twenty_rounds() {
    wins("classic", BotKind::Squeeze, Route::Squeeze, 1..=20);
}

#[test]
fn shaving_wins_twenty_of_twenty_rounds() {
    wins("classic", BotKind::Shave, Route::Shave, 1..=20);
}

#[test]
fn both_routes_win_twenty_of_twenty_rounds_in_3d() {
    wins("classic-3d", BotKind::Squeeze, Route::Squeeze, 1..=20);
    wins("classic-3d", BotKind::Shave, Route::Shave, 1..=20);
}

/// Returns the names of the levels that offer shaving.
fn shaved(named: &[(&'static str, &str)]) -> Vec<&'static str> {
    let offers = |id: &&str| Level::open(id).unwrap().routes().contains(&Route::Shave);
    named.iter().map(|(id, _)| *id).filter(offers).collect()
}

/// Checks that the shaving bot wins at least `least` rounds of a level by shaving.
fn is_shaved(id: &str, seeds: RangeInclusive<u64>, least: usize) {
    let outcomes = outcomes(id, BotKind::Shave, seeds, MINUTE);
    let won = outcomes.iter().flatten();
    let count = won.filter(|won| won.route == Route::Shave).count();
    assert!(count >= least, "{id}: {count}, {outcomes:?}");
}

/// Levels on which the shaving bot may win fewer than eighteen of twenty rounds, with the required number of
/// wins.
const FALLS_SHORT: [(&str, usize); 1] = [("twins", 12)];

#[test]
fn shaving_wins_every_2d_level_that_offers_it() {
    for id in shaved(&NAMED) {
        is_shaved(id, 2..=3, 2);
    }
}

#[test]
#[ignore = "takes minutes: cargo test --release -p tamaire_play --test bots -- --ignored"]
fn shaving_wins_eighteen_of_twenty_rounds_on_every_level_that_offers_it() {
    for id in shaved(&NAMED).into_iter().chain(shaved(&NAMED_3D)) {
        let short = FALLS_SHORT.iter().find(|(known, _)| *known == id);
        is_shaved(id, 1..=20, short.map_or(18, |(_, least)| *least));
    }
}

#[test]
fn every_level_with_a_basket_is_won_as_intended() {
    for (id, _) in NAMED.iter().chain(&NAMED_3D) {
        let has_basket = Level::open(id).unwrap().game().basket.is_some();
        let is_listed = WINNERS.iter().any(|(known, ..)| known == id);
        assert_eq!(has_basket, is_listed, "{id}");
    }
    for (id, kind, route) in WINNERS {
        let is_flat = NAMED.iter().any(|(known, _)| *known == id);
        wins(id, kind, route, if is_flat { 1..=2 } else { 1..=1 });
    }
}

#[test]
fn idle_bot_never_wins_and_random_bot_rarely() {
    for (id, ..) in WINNERS {
        assert_eq!(outcomes(id, BotKind::Idle, 1..=1, 600), [None], "{id}");
    }
    let won = outcomes("classic", BotKind::Random, 1..=4, 1200);
    assert!(won.iter().flatten().count() <= 1, "{won:?}");
}
