//! Sleeping of pieces and rigid bodies that have been slow for a while.
//!
//! Each piece sleeps and wakes on its own. To all others, a sleeping piece is as immovable as a wall. A
//! neighbour that moves wakes it, in either direction. So a heap falls asleep from the ground up while its
//! top still settles, and nothing stays suspended when its support is removed.

use crate::body::Bodies;
use crate::contact::Hit;
use crate::damping::PieceMotion;
use crate::dim::Dim;
use crate::handle::{BodySlot, RigidSlot};
use crate::ids::{PieceId, Table};
use crate::rigid::Rigids;
use std::collections::BTreeSet;

/// Sleep speed threshold [m/s], as root mean square over the nodes of a piece. A falling body exceeds it
/// after 3 ms. Higher values let bodies sleep before contact forces have settled; with lower ones, piles take
/// longer to sleep.
const SLOW: f64 = 0.03;
/// Time below the speed threshold until a piece sleeps [s]. Longer than the turning point of a flight or a
/// vibration.
const STILL_TIME: f32 = 0.5;

/// Updates the sleep timers of all pieces, and puts those to sleep that reach [`STILL_TIME`]. Pieces in `handled`,
/// which touch a coupled rigid body, stay awake. Returns the pieces that fell asleep.
pub fn fall_asleep<D: Dim>(
    bodies: &mut Bodies<D>,
    motions: &[Table<PieceId, PieceMotion>],
    handled: &[Hit],
    duration: f32,
) -> Vec<Hit> {
    for (body, motions) in bodies.iter_mut().zip(motions) {
        for (piece, motion) in body.truth.pieces.list.iter_mut().zip(motions.iter()) {
            let slow = motion.speed_squared < SLOW * SLOW && !motion.is_driven;
            piece.still = if slow { piece.still + duration } else { 0.0 };
        }
    }
    for &(body, piece) in handled {
        bodies.at_mut(body).truth.pieces.list[piece].still = 0.0;
    }
    change(bodies, true, |_, _, piece| {
        !piece.asleep && piece.still >= STILL_TIME
    })
}

/// Updates the sleep timers of dynamic rigid bodies, and puts those to sleep that reach [`STILL_TIME`].
/// Rigid bodies in `handled`, which touch a coupled rigid body, stay awake.
pub fn fall_asleep_rigid(rigids: &mut Rigids, handled: &BTreeSet<RigidSlot>, duration: f32) {
    for (slot, rigid) in rigids.by_slot_mut() {
        if !rigid.is_free() || rigid.asleep {
            continue;
        }
        let slow = f64::from(rigid.top_speed()) < SLOW && !handled.contains(&slot);
        rigid.still = if slow { rigid.still + duration } else { 0.0 };
        if rigid.still >= STILL_TIME {
            rigid.asleep = true;
            (rigid.velocity, rigid.spin) = ([0.0; 3], [0.0; 3]);
        }
    }
}

/// Wakes the pieces in `hits`; returns the pieces that woke.
pub fn wake<D: Dim>(bodies: &mut Bodies<D>, hits: &[Hit]) -> Vec<Hit> {
    if hits.is_empty() {
        return Vec::new();
    }
    change(bodies, false, |body, number, piece| {
        piece.asleep
            && !piece.quarantined
            && !piece.removed
            && hits.binary_search(&(body, number)).is_ok()
    })
}

/// Puts to sleep or wakes all pieces for which a condition on body, number and piece holds; returns them.
fn change<D: Dim>(
    bodies: &mut Bodies<D>,
    asleep: bool,
    applies: impl Fn(BodySlot, PieceId, &crate::piece::Piece) -> bool,
) -> Vec<Hit> {
    let mut changed = Vec::new();
    for (slot, body) in bodies.by_slot_mut() {
        let pieces = body.truth.pieces.list.entries();
        let marked = pieces.map(|(number, piece)| applies(slot, number, piece));
        let marked: Table<PieceId, bool> = marked.collect();
        let numbers = marked.ids().filter(|&piece| marked[piece]);
        changed.extend(numbers.map(|piece| (slot, piece)));
        if marked.contains(&true) {
            body.set_asleep(&marked, asleep);
        }
    }
    changed
}
