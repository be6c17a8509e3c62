//! Who sleeps: pieces that have been slow for a while, until something moves against them.
//!
//! Each piece sleeps and wakes on its own. What sleeps is as good as a wall to the rest. A
//! neighbour that moves wakes it, whichever way it goes: so a heap freezes from the ground up
//! while its top still settles, and nothing is left hanging when its support is pulled away.

use crate::body::Bodies;
use crate::contact::Hit;
use crate::damping::PieceMotion;
use crate::dim::Dim;
use crate::handle::{BodySlot, RigidSlot};
use crate::ids::{PieceId, Table};
use crate::rigid::Rigids;
use std::collections::BTreeSet;

/// Pieces slower than this [m/s], on the average over their nodes, are on their way to sleep: what falls is
/// faster after 3 ms. With half of it towers of ten boxes lean by a fifth of a box and `pile` sleeps after 6.8 s in place of
/// 4.9; with twice as much a nail on which a ball hangs tells 11 % more than its weight.
const SLOW: f64 = 0.03;
/// How long they must have been [s]: what turns back at the top of its flight, or of a swing, is not for so long.
/// With half of it a box whose foot was pulled away does not get to lie flat; with twice as much `pile` takes 7.6 s to sleep.
const STILL_TIME: f32 = 0.5;

/// Counts for how long each piece has been slow, and puts to sleep those that have been long
/// enough. Pieces in `handled`, which a hand touches, stay awake. Returns who fell asleep.
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

/// The same for what is free of the rigid things; `handled` are those that a hand presses on.
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

/// Wakes the pieces that were hit; returns who woke.
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

/// Puts to sleep or wakes all pieces that a condition on body, number and piece holds for.
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
