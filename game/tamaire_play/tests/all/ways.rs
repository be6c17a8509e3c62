//! The levels of the path: their ways win, a straight push does not.

use fuwafuwa::{Dim2, Dim3};
use std::sync::Arc;
use std::thread;
use tamaire_play::bot::StraightPush;
use tamaire_play::level::{PATH, PathLevel};
use tamaire_play::{AnyRound, InputFrame, Level, Replay};

/// Time limit of a round: a minute [ticks].
const MINUTE: usize = 60 * 60;

/// Runs a check for each level of the path, each on its own thread.
fn for_each_level(check: impl Fn(&PathLevel, Arc<Level>) + Sync) {
    let check = &check;
    thread::scope(|scope| {
        for level in &PATH {
            scope.spawn(move || check(level, Arc::new(level.open())));
        }
    });
}

#[test]
fn every_level_has_two_ways_that_win_as_stated() {
    for_each_level(|known, level| {
        let ways = known.ways().way;
        assert!(ways.len() >= 2, "{}", known.id);
        for (index, way) in ways.iter().enumerate() {
            let id = format!("{}, way {}", known.id, index + 1);
            let mut round = AnyRound::new(level.clone());
            let won = way.play(&mut round, None).unwrap_or_else(|| panic!("{id}"));
            assert_eq!(won.route, way.route, "{id}");
            let wishes = level.game().wish.iter().zip(1..);
            let wishes = wishes.filter(|(wish, _)| won.fulfils(wish));
            let numbers: Vec<usize> = wishes.map(|(_, number)| number).collect();
            assert_eq!(numbers, way.wishes, "{id}: {won:?}");
            let replay = Replay::read(&round.replay().text()).unwrap();
            assert_eq!(replay.outcome, Some(won), "{id}");
        }
        let different = |[a, b]: [usize; 2]| {
            let [a, b] = [&ways[a], &ways[b]];
            a.route != b.route || a.wishes != b.wishes
        };
        assert!(different([0, 1]), "{}: both ways are alike", known.id);
    });
}

#[test]
fn a_way_wins_with_a_trembling_hand() {
    for_each_level(|known, level| {
        let wins = |seed| {
            known.ways().way.iter().any(|way| {
                let mut round = AnyRound::new(level.clone());
                way.play(&mut round, Some(seed)).is_some()
            })
        };
        assert!((11..13).all(wins), "{}", known.id);
    });
}

/// Plays a straight bot for a minute. Returns whether it wins.
fn straight_push_wins(level: &Arc<Level>, chases: bool, speed: f32, seed: u64) -> bool {
    let mut bot = StraightPush::new(chases, speed, seed);
    let mut round = AnyRound::new(level.clone());
    for _ in 0..MINUTE {
        let frame: InputFrame = match &round {
            AnyRound::Plane(round) => bot.frame::<Dim2>(round),
            AnyRound::Space(round) => bot.frame::<Dim3>(round),
        };
        round.step(frame);
        if round.progress().outcome.is_some() {
            return true;
        }
    }
    false
}

/// Rounds of 3D levels take ten times as long, so the ignored test plays them.
#[test]
fn straight_push_wins_no_2d_level() {
    for_each_level(|known, level| {
        if level.scene().dim == 2 {
            for (chases, speed) in [(false, 0.7), (true, 0.7)] {
                assert!(
                    !straight_push_wins(&level, chases, speed, 101),
                    "{}, {chases}",
                    known.id
                );
            }
        }
    });
}

#[test]
#[ignore = "takes half an hour: cargo test --release -p tamaire_play --test all ways -- --ignored --nocapture"]
fn straight_push_wins_no_level_at_three_speeds_from_twenty_starts() {
    for_each_level(|known, level| {
        for chases in [false, true] {
            for speed in [0.3, 0.7, 3.0] {
                let won = |&seed: &u64| straight_push_wins(&level, chases, speed, seed);
                let won: Vec<u64> = (0..20).filter(won).collect();
                println!(
                    "{}, chases: {chases}, {speed} m/s: won with {won:?}",
                    known.id
                );
                assert!(won.is_empty(), "{}", known.id);
            }
        }
    });
}

#[test]
fn basket_counts_only_while_no_hand_touches_its_content() {
    let known = PATH.iter().find(|level| level.id == "under-the-table");
    let (known, level) = { known.map(|level| (level, level.open())) }.expect("a 3D level");
    assert!(level.game().alone);
    let mut round = AnyRound::new(Arc::new(level));
    let way = &known.ways().way[0];
    let mut waited = 0;
    for tick in 0..600 {
        round.step(way.frame(tick));
        let progress = round.progress();
        if progress.waits_for_hand(round.level().game()) {
            waited += 1;
            assert_eq!(progress.held, 0.0);
        }
        if progress.outcome.is_some() {
            assert!(!progress.touched);
            break;
        }
    }
    assert!(
        waited > 10,
        "the hand never touched enough of the ball in the basket: {waited}"
    );
    assert!(round.progress().outcome.is_some());
}
