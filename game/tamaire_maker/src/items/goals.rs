//! Goals that can hold.

use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{MAX_TOLD_BODIES, WishText};

/// Returns whether a level with this scene may have a goal: it has a condition, its numbers are in range, and the bodies
/// and joints that it is about are in the scene.
pub(super) fn is_possible(scene: &Scene, wish: &WishText) -> bool {
    let is_share = |share: f32| (0.0..=1.0).contains(&share);
    let least = wish.pieces.unwrap_or(1).max(1);
    let bodies = scene.body.len().min(MAX_TOLD_BODIES);
    let is_named_once = |index: usize| {
        let number = wish.whole[index];
        (1..=bodies).contains(&number) && !wish.whole[..index].contains(&number)
    };
    *wish != WishText::default()
        && wish
            .seconds
            .is_none_or(|time| time > 0.0 && time.is_finite())
        && wish.kept.is_none_or(is_share)
        && wish.inside.is_none_or(is_share)
        && wish.max_pieces.is_none_or(|most| most >= least)
        && (wish.joints.is_none() || has_breakable_joint(scene))
        && (0..wish.whole.len()).all(is_named_once)
}

/// Returns whether a scene has a joint that can break or that a switch opens.
fn has_breakable_joint(scene: &Scene) -> bool {
    let mut joints = scene.joint.iter();
    joints.any(|joint| joint.breaking_force.is_some() || joint.switch.is_some())
}
