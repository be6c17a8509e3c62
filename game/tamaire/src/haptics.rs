//! What is felt of a tick, and by whom.

use force_feedback::Stop;
use fuwafuwa::TICK;
use fuwafuwa::{Event, RigidBody, Vector};
use tamaire_play::{AnyRound, PLAYERS};

/// A round has begun once it is so old [s]: until then hands are elsewhere.
const BEGUN: f32 = 0.1;
/// What one node that is released is felt like, and each further one adds.
const TEAR: f32 = 0.2;
const MORE: f32 = 0.05;

/// With what everything that a hand touches pushed it, averaged over the last tick [N].
pub fn contact(hand: &RigidBody) -> Vector {
    let all = hand.reactions();
    let mean = |axis: usize| {
        let sum: f32 = all.iter().map(|reaction| reaction.contact[axis]).sum();
        sum / all.len().max(1) as f32
    };
    [0, 1, 2].map(mean)
}

/// How strongly each player feels what tore in the last tick, 0 to 1: whoever's hand is nearest of those that touch something.
pub fn tears(round: &AnyRound) -> [f32; PLAYERS] {
    let mut counts = [0u32; PLAYERS];
    for event in round.events() {
        let Event::NodeSplit { point, .. } = *event else {
            continue;
        };
        let away = |hand: &RigidBody| {
            let square = |axis: usize| (hand.position()[axis] - point[axis]).powi(2);
            square(0) + square(1) + square(2)
        };
        let hands = round.hands().into_iter().take(PLAYERS).enumerate();
        let hands = hands.filter(|(_, hand)| contact(hand) != [0.0; 3]);
        let nearest = hands.min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)));
        if let Some((player, _)) = nearest {
            counts[player] += 1;
        }
    }
    counts.map(|count| match count {
        0 => 0.0,
        count => (TEAR + MORE * (count - 1) as f32).min(1.0),
    })
}

/// Why nobody feels anything in a round that goes on, if so.
pub fn silence(round: &AnyRound) -> Option<Stop> {
    if round.progress().outcome.is_some() {
        return Some(Stop::Won);
    }
    ((round.ticks() as f32) < BEGUN / TICK).then_some(Stop::Reset)
}
