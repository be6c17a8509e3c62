//! Haptic feedback of the last tick, for each player: contact forces and tears.

use force_feedback::Stop;
use fuwafuwa::{DEFAULT_TICK, Vec3};
use tamaire_play::round::Hand;
use tamaire_play::{AnyRound, PLAYERS};

/// Time without feedback at the start of a round [s], because a restart moves the hands abruptly.
const BEGUN: f32 = 0.1;
/// Strength of the feedback for the first node split in a tick; 1 = full.
const TEAR: f32 = 0.2;
/// Additional strength for each further node split in the same tick.
const MORE: f32 = 0.05;

/// Contact force on a hand, averaged over the substeps of the last tick [N].
pub fn contact(hand: &Hand) -> Vec3 {
    let contacts = hand.reactions.iter().map(|reaction| reaction.contact);
    contacts.sum::<Vec3>() / hand.reactions.len().max(1) as f32
}

/// Strength of the feedback of tears in the last tick for each player, 0 to 1. Each tear counts for the
/// nearest hand that touches a body.
pub fn tears(round: &AnyRound) -> [f32; PLAYERS] {
    let mut counts = [0u32; PLAYERS];
    let mut hands = round.hands();
    hands.truncate(PLAYERS);
    for point in round.split_points() {
        let away = |hand: &Hand| hand.position.distance_squared(point);
        let touching = hands.iter().enumerate();
        let touching = touching.filter(|(_, hand)| contact(hand) != Vec3::ZERO);
        let nearest = touching.min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)));
        if let Some((player, _)) = nearest {
            counts[player] += 1;
        }
    }
    counts.map(|count| match count {
        0 => 0.0,
        count => (TEAR + MORE * (count - 1) as f32).min(1.0),
    })
}

/// Returns the reason why the round gives no feedback, if any.
pub fn silence(round: &AnyRound) -> Option<Stop> {
    if round.progress().outcome.is_some() {
        return Some(Stop::Won);
    }
    ((round.ticks() as f32) < BEGUN / DEFAULT_TICK).then_some(Stop::Reset)
}
