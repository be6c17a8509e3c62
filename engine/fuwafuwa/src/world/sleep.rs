//! Sleeping of pieces and rigid bodies that have been slow for a while.
//!
//! Each piece sleeps and wakes on its own. For all other objects, a sleeping piece is as immovable as a wall.
//! A sleeping piece wakes when an object in contact with it moves, in any direction. A heap therefore falls
//! asleep from the ground up while its top still settles, and nothing stays suspended when its support is
//! removed.

use crate::contact::solver::Hit;
use crate::foundation::arena::{BodySlot, RigidSlot};
use crate::foundation::dim::Dim;
use crate::foundation::ids::{IndexVec, PieceId};
use crate::rigid_body::RigidBodies;
use crate::soft_body::SoftBodies;
use crate::soft_body::damping::PieceMotion;
use std::collections::BTreeSet;

/// Speed below which an object counts as slow [m/s]: root mean square over the nodes of a piece, or upper
/// bound over all points of a rigid body. An object that starts to fall exceeds it after 3 ms. At higher
/// values, bodies sleep before contact forces have settled; at lower values, piles take longer to sleep.
const SLEEP_SPEED: f64 = 0.03;
/// Time for which a piece or rigid body must stay slow until it sleeps [s]. At the top of its flight or at
/// the turning points of a vibration, a body is slow for a shorter time, so it stays awake.
const SLEEP_TIME: f32 = 0.5;

/// Updates the sleep timers of all pieces, and puts those that reach [`SLEEP_TIME`] to sleep. Pieces in
/// `kept_awake` stay awake, because they are embedded in another piece, or because a kinematic or coupled body
/// pushes or cuts them. Returns the pieces that fell asleep.
pub fn fall_asleep<D: Dim>(
    bodies: &mut SoftBodies<D>,
    motions: &[IndexVec<PieceId, PieceMotion>],
    kept_awake: &[Hit],
    duration: f32,
) -> Vec<Hit> {
    for (body, motions) in bodies.iter_mut().zip(motions) {
        for (piece, motion) in body.pieces_mut().list.iter_mut().zip(motions.iter()) {
            let slow = motion.speed_squared < SLEEP_SPEED * SLEEP_SPEED && !motion.is_driven;
            piece.sleep_timer = if slow {
                piece.sleep_timer + duration
            } else {
                0.0
            };
        }
    }
    for &(body, piece) in kept_awake {
        bodies.at_mut(body).pieces_mut().list[piece].sleep_timer = 0.0;
    }
    change(bodies, true, |_, _, piece| {
        !piece.asleep && piece.sleep_timer >= SLEEP_TIME
    })
}

/// Updates the sleep timers of dynamic rigid bodies, and puts those that reach [`SLEEP_TIME`] to sleep. Rigid
/// bodies in `kept_awake` stay awake, because a moving kinematic or coupled body presses on them.
pub fn fall_asleep_rigid(
    rigids: &mut RigidBodies,
    kept_awake: &BTreeSet<RigidSlot>,
    duration: f32,
) {
    for (slot, rigid) in rigids.by_slot_mut() {
        if !rigid.is_dynamic() || rigid.asleep {
            continue;
        }
        let slow = f64::from(rigid.top_speed()) < SLEEP_SPEED && !kept_awake.contains(&slot);
        rigid.sleep_timer = if slow {
            rigid.sleep_timer + duration
        } else {
            0.0
        };
        if rigid.sleep_timer >= SLEEP_TIME {
            rigid.fall_asleep();
        }
    }
}

/// Wakes the sleeping pieces among `hits`, and returns them.
pub fn wake<D: Dim>(bodies: &mut SoftBodies<D>, hits: &[Hit]) -> Vec<Hit> {
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

/// Puts pieces to sleep if `asleep` is true, otherwise wakes them. Changes only the pieces for which
/// `applies` returns true, given the body's arena slot, the piece number and the piece. Returns the changed
/// pieces.
fn change<D: Dim>(
    bodies: &mut SoftBodies<D>,
    asleep: bool,
    applies: impl Fn(BodySlot, PieceId, &crate::topology::pieces::Piece) -> bool,
) -> Vec<Hit> {
    let mut changed = Vec::new();
    for (slot, body) in bodies.by_slot_mut() {
        let pieces = body.pieces().list.entries();
        let marked = pieces.map(|(number, piece)| applies(slot, number, piece));
        let marked: IndexVec<PieceId, bool> = marked.collect();
        let numbers = marked.ids().filter(|&piece| marked[piece]);
        changed.extend(numbers.map(|piece| (slot, piece)));
        if marked.contains(&true) {
            body.set_asleep(&marked, asleep);
        }
    }
    changed
}
