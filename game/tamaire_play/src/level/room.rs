//! Checks that a level can be played from its start.

use super::Level;
use fuwafuwa::inspect::is_hand;
use fuwafuwa::{Dim, DimVector, SoftBody, Vec3, World};

/// Checks that hands can move in the arena and can reach the bodies. If not, returns the invalid field and
/// the expected value.
pub(super) fn check<D: Dim>(
    world: &World<D>,
    [low, high]: [Vec3; 2],
) -> Result<(), (&'static str, String)> {
    let room = (0..D::N).map(|axis| high[axis] - low[axis]);
    let room = room.fold(f32::INFINITY, f32::min);
    if widest_hand(world) > 0.9 * room {
        let reason = format!("expected hands that fit into the view, which is {room} m wide");
        return Err(("hand", reason));
    }
    // Accepts a body that starts outside the arena if gravity pulls it in.
    let fall = world.config().gravity;
    let is_out = |middle: D::Vector, k: usize| {
        middle[k] < low[k] && fall[k] <= 0.0 || middle[k] > high[k] && fall[k] >= 0.0
    };
    let is_within = |middle: D::Vector| !(0..D::N).any(|k| is_out(middle, k));
    let mut middles = world.soft_bodies().map(|(_, body)| middle(body));
    match middles.position(|middle| !is_within(middle)) {
        None => Ok(()),
        Some(index) => {
            let reason = format!(
                "expected all bodies in the view; the centre of body {} is outside",
                index + 1
            );
            Err(("body", reason))
        }
    }
}

/// Checks that the first move that a level shows stays in the arena. If not, returns the field and the expected value.
pub(super) fn check_hint(level: &Level) -> Result<(), (&'static str, String)> {
    let [low, high] = level.arena();
    let is_out = |point: &[f32; 4]| {
        let axes = 0..usize::from(level.scene().dim);
        { axes }.any(|axis| !(low[axis]..=high[axis]).contains(&point[axis + 1]))
    };
    match level.game().hint.iter().position(is_out) {
        None => Ok(()),
        Some(index) => {
            let reason = format!(
                "expected positions in the view; point {} is outside",
                index + 1
            );
            Err(("game.hint", reason))
        }
    }
}

/// Returns the mean position of the nodes of a body [m].
fn middle<D: Dim>(body: &SoftBody<D>) -> D::Vector {
    let positions = body.mesh().nodes().map(|(id, _)| body.node_state(id).0);
    let (sum, count) = positions.fold((D::Vector::ZERO, 0.0), |(sum, count), at| {
        (sum + at, count + 1.0)
    });
    sum * (1.0 / count)
}

/// Returns the width of the widest hand on any axis [m].
fn widest_hand<D: Dim>(world: &World<D>) -> f32 {
    let bodies = world.rigid_bodies();
    let hands = bodies.filter(|&(_, body)| is_hand(body));
    let widths = hands.flat_map(|(_, hand)| {
        let [low, high] = hand.local_shape().bounds();
        (0..D::N).map(move |axis| high[axis] - low[axis])
    });
    widths.fold(0.0, f32::max)
}
