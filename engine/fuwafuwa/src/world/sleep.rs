//! Sleeping of pieces and rigid bodies that are at rest.
//!
//! Each piece sleeps and wakes on its own. For all other objects, a sleeping piece is as immovable as a wall.
//! A piece or rigid body falls asleep if, for half a second, it was slow and its centre did not drift. The limits
//! of both speeds are [`RestSpeeds`]. Support needs no search: a body under gravity that was slow for half a
//! second is carried by something, because otherwise it would have fallen. Without gravity, nothing that moves
//! falls asleep unless air drag has stopped it.
//!
//! A sleeper wakes when an object in contact with it moves fast, in any direction, or when an object that
//! presses on it was displaced slowly. A heap therefore falls asleep from the ground up while its top still
//! settles, and nothing stays suspended when its support is removed.

use crate::contact::broad_phase::Nearby;
use crate::contact::rest_speeds::RestSpeeds;
use crate::contact::solver::{Hit, Hits};
use crate::foundation::arena::{BodySlot, RigidSlot};
use crate::foundation::dim::Dim;
use crate::foundation::ids::{IndexVec, PieceId};
use crate::rigid_body::{RigidBodies, RigidState};
use crate::soft_body::damping::{PieceMotion, motions};
use crate::soft_body::{SoftBodies, for_each_body};
use glam::Vec3;
use std::collections::BTreeSet;

/// Time for which a piece or rigid body must be at rest until it sleeps [s], and time constant of the low-pass
/// filter of its centre. At the top of its flight or at the turning points of a vibration, a body is slow for a
/// shorter time, so it stays awake.
const SLEEP_TIME: f32 = 0.5;
/// Distance of an object from its low-pass filtered centre above which it wakes the sleepers on which it
/// presses, as a share of a size: the width of a voxel, or a quarter of the inradius of a rigid body. It bounds
/// the error of contact forces on sleepers, which do not yield.
const WAKE_STRAY: f32 = 0.15;
/// Maximum distance between an object and its low-pass filtered centre, as a share of the same size. It must
/// exceed [`WAKE_STRAY`]. After a jump, an object falls asleep a second later.
const MAX_STRAY: f32 = 0.2;

/// Motions of all pieces, by body slot and piece number.
pub type Motions = IndexVec<BodySlot, IndexVec<PieceId, PieceMotion>>;

/// Returns the motions of all pieces, zero for sleeping ones.
pub fn all_motions<D: Dim>(bodies: &mut SoftBodies<D>) -> Motions {
    let mut all: Motions = bodies.slots().map(|_| IndexVec::default()).collect();
    let found = for_each_body(bodies, |slot, body| {
        body.refresh_awake();
        (slot, motions(body))
    });
    for (slot, motions) in found {
        all[slot] = motions;
    }
    all
}

/// Advances the low-pass filters of all awake pieces and rigid bodies by `duration` [s].
pub fn filter_centres<D: Dim>(
    bodies: &mut SoftBodies<D>,
    motions: &Motions,
    rigids: &mut RigidBodies,
    duration: f32,
) {
    for (slot, body) in bodies.by_slot_mut() {
        let size = body.grid().voxel_size();
        let pieces = body.pieces_mut().list.iter_mut().zip(motions[slot].iter());
        for (piece, motion) in pieces.filter(|(_, motion)| motion.nodes > 0) {
            let centre = motion.mass_centre.as_vec3();
            piece.settled_at = filtered(piece.settled_at, centre, size, duration);
        }
    }
    let dynamic = rigids
        .iter_mut()
        .filter(|rigid| rigid.is_dynamic() && rigid.moves());
    for rigid in dynamic {
        let size = rigid.rest_size();
        rigid.settled_at = filtered(rigid.settled_at, rigid.position(), size, duration);
    }
}

/// Returns the low-pass filtered centre after `duration` [s], at most [`MAX_STRAY`] from the `centre`.
fn filtered(settled_at: Vec3, centre: Vec3, size: f32, duration: f32) -> Vec3 {
    let apart = (settled_at - centre) * (SLEEP_TIME / (SLEEP_TIME + duration));
    let (length, most) = (apart.length(), MAX_STRAY * size);
    if length <= most {
        centre + apart
    } else if length.is_finite() {
        centre + apart * (most / length)
    } else {
        centre
    }
}

/// Returns the sleepers on which a piece or rigid body presses that was displaced by more than [`WAKE_STRAY`].
pub fn pressed_sleepers<D: Dim>(
    bodies: &SoftBodies<D>,
    motions: &Motions,
    rigids: &RigidBodies,
    nearby: &Nearby,
) -> Hits {
    let piece_strays = |(slot, piece): Hit| {
        let motion = motions[slot].get(piece.index());
        motion.is_some_and(|motion| {
            let body = bodies.at(slot);
            let apart = motion.mass_centre.as_vec3() - body.pieces().list[piece].settled_at;
            motion.nodes > 0 && apart.length() > WAKE_STRAY * body.grid().voxel_size()
        })
    };
    let piece_sleeps = |(slot, piece): Hit| {
        let body = bodies.find(slot);
        let piece = body.and_then(|body| body.pieces().list.get(piece.index()));
        piece.is_some_and(|piece| piece.asleep)
    };
    let rigid_strays = |rigid: &RigidState| {
        let apart = rigid.position() - rigid.settled_at;
        let moves = rigid.is_dynamic() && rigid.moves();
        moves && apart.length() > WAKE_STRAY * rigid.rest_size()
    };
    let mut hits = Hits::default();
    let pairs = nearby.pairs.list.iter();
    for pair in pairs.filter(|pair| pair.impulse.normal_impulse > 0.0) {
        let both = pair.both(&nearby.spheres.list);
        let [a, b] = both.map(|sphere| (sphere.body, sphere.piece));
        for (own, other) in [(a, b), (b, a)] {
            if piece_sleeps(own) && piece_strays(other) {
                hits.pieces.push(own);
            }
        }
    }
    let pairs = nearby.nodes.list.iter();
    for pair in pairs.filter(|pair| pair.impulse.normal_impulse > 0.0) {
        let (rigid, piece) = (rigids.at(pair.rigid), pair.piece(bodies));
        let Some(piece) = piece.map(|piece| (pair.body, piece)) else {
            continue;
        };
        if piece_sleeps(piece) && rigid_strays(rigid) {
            hits.pieces.push(piece);
        }
        if rigid.is_asleep() && piece_strays(piece) {
            hits.rigids.push(pair.rigid);
        }
    }
    let points = nearby.rigids.list.iter();
    for point in points.filter(|point| point.impulse.normal_impulse > 0.0) {
        let [a, b] = point.both;
        for (own, other) in [(a, b), (b, a)] {
            if rigids.at(own).is_asleep() && rigid_strays(rigids.at(other)) {
                hits.rigids.push(own);
            }
        }
    }
    hits.add(Vec::new(), Vec::new());
    hits
}

/// Updates the sleep timers of all pieces, and puts those that reach [`SLEEP_TIME`] to sleep. Pieces in
/// `kept_awake` stay awake, because they are embedded in another piece, or because a kinematic or coupled body
/// pushes or cuts them. Returns the pieces that fell asleep.
pub fn fall_asleep<D: Dim>(
    bodies: &mut SoftBodies<D>,
    motions: &Motions,
    kept_awake: &[Hit],
    rest: RestSpeeds,
    duration: f32,
) -> Vec<Hit> {
    for (slot, body) in bodies.by_slot_mut() {
        let (size, gravity_scale) = (body.grid().voxel_size(), body.gravity_scale());
        let mass_scale = body.mass_scale() as f32;
        let pieces = body.pieces_mut().list.iter_mut();
        for (piece, motion) in pieces.zip(motions[slot].iter()) {
            // A piece with fixed nodes whose mass is scaled accelerates and swings more slowly.
            let slowdown = if motion.has_fixed_nodes() {
                mass_scale
            } else {
                1.0
            };
            let gravity_scale = gravity_scale / slowdown;
            let duration = duration / slowdown.sqrt();
            let speed = f64::from(rest.sleep_speed(gravity_scale, size));
            let stray = SLEEP_TIME * rest.drift_speed(gravity_scale, size);
            let is_slow = motion.speed_squared < speed * speed && !motion.is_driven;
            let strayed = (motion.mass_centre.as_vec3() - piece.settled_at).length();
            piece.sleep_timer = if is_slow && strayed < stray {
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
    rest: RestSpeeds,
    duration: f32,
) {
    for (slot, rigid) in rigids.by_slot_mut() {
        if !rigid.is_dynamic() || rigid.asleep {
            continue;
        }
        let size = rigid.rest_size();
        let strayed = (rigid.position() - rigid.settled_at).length();
        let is_slow = rigid.top_speed() < rest.sleep_speed(1.0, size)
            && strayed < SLEEP_TIME * rest.drift_speed(1.0, size);
        rigid.sleep_timer = if is_slow && !kept_awake.contains(&slot) {
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
