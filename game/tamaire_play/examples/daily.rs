//! Finds the pairs of a level and a twist that are fair levels of the day.
//!
//! `cargo run --release -p tamaire_play --example daily > game/tamaire_play/levels/daily.txt` prints a line for each pair
//! in which both straight bots lose for a minute at 0.7 m/s, and a way of the level wins, as stated and with a
//! hand that trembles by each of two seeds. With the names of levels as arguments it tries only these levels. The reasons why
//! other pairs are refused go to the error output.

use std::sync::Arc;
use tamaire_play::bot::StraightPush;
use tamaire_play::daily::Twist;
use tamaire_play::level::{PATH, PathLevel};
use tamaire_play::{AnyRound, Level};

/// Time limit of a round of a bot [ticks].
const MINUTE: usize = 60 * 60;
/// Speed of the bots [m/s].
const SPEED: f32 = 0.7;
/// Seeds of the trembling hands. The tests use other ones.
const SHAKES: [Option<u64>; 3] = [None, Some(21), Some(22)];
/// Seed of the bots.
const SEED: u64 = 5;

fn main() {
    let chosen: Vec<String> = std::env::args().skip(1).collect();
    let is_chosen =
        |level: &&PathLevel| chosen.is_empty() || chosen.iter().any(|id| id == level.id);
    for level in PATH.iter().filter(is_chosen) {
        for twist in Twist::ALL {
            match refused(level, twist) {
                None => println!("{} {}", level.id, twist.name()),
                Some(reason) => eprintln!("{} {}: {reason}", level.id, twist.name()),
            }
        }
    }
}

/// Returns why a pair is refused; `None` if it is fair.
fn refused(plain: &PathLevel, twist: Twist) -> Option<String> {
    let Some(level) = twist.of(&plain.open()) else {
        return Some("changes nothing".into());
    };
    let level = Arc::new(level);
    let ways: Vec<_> = plain.ways().way.iter().map(|way| twist.way(way)).collect();
    for shake in SHAKES {
        let wins =
            |way: &tamaire_play::Way| way.play(&mut AnyRound::new(level.clone()), shake).is_some();
        if !ways.iter().any(wins) {
            return Some(format!("no way wins, shake {shake:?}"));
        }
    }
    let is_won = [false, true]
        .into_iter()
        .any(|chases| is_won_by_bot(&level, chases));
    is_won.then(|| "a straight push wins".into())
}

fn is_won_by_bot(level: &Arc<Level>, chases: bool) -> bool {
    let mut round = AnyRound::new(level.clone());
    round.push_straight(&mut StraightPush::new(chases, SPEED, SEED), MINUTE);
    round.progress().outcome.is_some()
}
