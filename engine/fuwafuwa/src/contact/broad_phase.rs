//! Broad phase: finds pairs that may touch, ahead of time, with a margin for their motion.
//!
//! All nodes can touch rigid shapes (`node_pairs`). Soft bodies touch each other through *contact spheres*
//! (`contact_spheres`). Every surface element is one voxel wide, so a single ball of that width at the centre
//! of the element is enough. `sphere_pairs` finds the spheres that may meet soon. `embedded_spheres` finds
//! spheres that were forced into another piece. If an object moves farther than its margin, its pairs are
//! searched again.

mod bins;
mod contact_sphere;
mod contact_spheres;
mod embedded_spheres;
mod known_impulse;
mod node_pairs;
mod piece_neighbours;
mod rigid_contacts;
mod sphere_pair;
mod sphere_pairs;
mod supported_bodies;
mod swept_path;

use crate::foundation::arena::{BodySlot, RigidSlot};
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::foundation::ids::{ElementId, PieceId};
use crate::rigid_body::RigidBodies;
use crate::soft_body::{SoftBodies, SoftBody};
use crate::topology::changes::Changes;
pub use contact_sphere::{ContactSphere, SphereId, mean};
pub use contact_spheres::Spheres;
pub use embedded_spheres::{Captives, EmbeddedSphere};
pub use known_impulse::Impulse;
pub use node_pairs::{NodePair, NodePairs};
pub use rigid_contacts::{Passed, RigidTouch, RigidTouches};
pub use sphere_pair::MARGIN;
use sphere_pair::renumber;
pub use sphere_pairs::SpherePairs;
pub use supported_bodies::{
    bounds_of, leaning_on_body, leaning_on_pieces, leaning_on_rigid, sleeping_in,
};

/// Speed of a touching object above which a sleeper wakes [m/s]: five times the sleep speed threshold. With a
/// lower value, a heap would keep itself awake. Contact spheres are tested by their mean speed in the last
/// substep. Their present velocity does not yet include the contacts, so it can exceed this limit in a heap
/// at rest.
pub const WAKE_SPEED: f32 = 0.15;

/// Objects that may touch. A new tick takes only the impulses, the `met_in_front` flags and the order of the
/// spheres from the last tick, and rebuilds everything else.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Nearby {
    /// Pairs of nodes and rigid bodies.
    pub nodes: NodePairs,
    /// Contact spheres.
    pub spheres: Spheres,
    /// Pairs of contact spheres.
    pub pairs: SpherePairs,
    /// Contact points between rigid bodies.
    pub rigids: RigidTouches,
    /// Spheres embedded in another piece.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub captives: Captives,
    /// Remaining time of the tick [s].
    #[cfg_attr(feature = "serde", serde(skip))]
    left: f32,
    /// Whether embedded spheres were searched in this tick.
    #[cfg_attr(feature = "serde", serde(skip))]
    knows_captives: bool,
}

hash_state! {
    struct Nearby { nodes, spheres, pairs, rigids } skip { captives, left, knows_captives }
}

impl Nearby {
    /// Starts a tick of `duration` [s]: clears the impulse sums of the last tick. The caller may have changed
    /// the bodies in any way between the two ticks.
    pub fn start_tick<D: Dim>(&mut self, bodies: &SoftBodies<D>, duration: f32) {
        self.nodes.start_tick();
        self.rigids.start_tick();
        let numbers = self.spheres.start_tick(bodies, &mut self.pairs.changed);
        self.pairs.start_tick(numbers.is_some());
        if let Some(numbers) = numbers {
            renumber(&mut self.pairs.list, &numbers);
        }
        self.captives = Captives::default();
        (self.left, self.knows_captives) = (duration, false);
    }

    /// Updates nodes, contact spheres and embedded spheres after a tear of a body.
    pub fn tear<D: Dim>(&mut self, slot: BodySlot, body: &SoftBody<D>, changes: &Changes) {
        self.nodes.tear(slot, &changes.nodes);
        let changed = &mut self.pairs.changed;
        self.spheres.tear(slot, body, changes, changed);
        self.captives.tear(&self.spheres);
    }

    /// Removes a soft body from all lists; its slot may be reused.
    pub fn remove_body(&mut self, slot: BodySlot) {
        let is_of_it = |&sphere: &SphereId| self.spheres.body_of(sphere) == slot;
        self.pairs
            .list
            .retain(|pair| !pair.spheres.iter().any(is_of_it));
        self.nodes.list.retain(|pair| pair.body != slot);
        self.spheres.remove_body(slot);
    }

    /// Removes `elements` of a body, given in ascending order, and their nodes from all lists.
    pub fn remove_elements<D: Dim>(
        &mut self,
        slot: BodySlot,
        body: &SoftBody<D>,
        elements: &[ElementId],
    ) {
        self.spheres.remove_elements(slot, elements);
        let is_gone = |&sphere: &SphereId| self.spheres.body_of(sphere) == BodySlot::NONE;
        let pairs = &mut self.pairs.list;
        pairs.retain(|pair| !pair.spheres.iter().any(is_gone));
        let is_there = |node| body.mesh().is_alive(node);
        let nodes = &mut self.nodes.list;
        nodes.retain(|pair| pair.body != slot || is_there(pair.node));
    }

    /// After a world was read from a file, discards pairs of objects that do not exist. Other data needs no
    /// check, because a new tick rebuilds it.
    #[cfg(feature = "serde")]
    pub fn keep_known<D: Dim>(&mut self, bodies: &SoftBodies<D>, rigids: &RigidBodies) {
        self.nodes.keep_known(bodies, rigids);
        self.rigids.keep_known::<D>(rigids);
        let known = self.spheres.count_keys();
        let is_known = |pair: &sphere_pair::SpherePair| {
            let [a, b] = pair.spheres;
            a < b && b.index() < known
        };
        self.pairs.list.retain(is_known);
        self.pairs.list.sort_by_key(|pair| pair.spheres);
        self.pairs.list.dedup_by_key(|pair| pair.spheres);
        let nodes = self.nodes.list.iter_mut().map(|pair| &mut pair.impulse);
        let pairs = self.pairs.list.iter_mut().map(|pair| &mut pair.impulse);
        nodes.chain(pairs).for_each(Impulse::flatten::<D>);
    }

    /// Removes all pairs and contact points of a rigid body.
    pub fn remove_rigid(&mut self, slot: RigidSlot) {
        self.nodes.list.retain(|pair| pair.rigid != slot);
        self.rigids.remove(slot);
    }

    /// Marks the nodes and contact spheres of woken pieces for a new search. `pieces` holds body and piece
    /// number, ascending.
    pub fn wake<D: Dim>(&mut self, pieces: &[(BodySlot, PieceId)], bodies: &SoftBodies<D>) {
        self.nodes.wake(pieces, bodies);
        self.spheres.wake(pieces, &mut self.pairs.changed);
    }

    /// Reduces the remaining time and the margins by a substep of `duration` [s] in which no node moved
    /// farther than `distance` [m].
    pub fn pass(&mut self, duration: f32, distance: f32) {
        self.left -= duration;
        self.nodes.pass(distance);
        self.pairs.pass(duration, distance);
    }

    /// Updates the lists to the present positions; a substep takes `duration` [s].
    pub fn follow<D: Dim>(&mut self, bodies: &SoftBodies<D>, rigids: &RigidBodies, duration: f32) {
        self.nodes.follow(bodies, rigids, duration, self.left);
        let changed = self.pairs.follow(&mut self.spheres, bodies);
        if !self.knows_captives {
            self.captives.find(&self.spheres, &self.pairs.list, bodies);
            self.knows_captives = true;
        }
        if changed {
            let paired = self.pairs.list.iter().flat_map(|pair| pair.spheres);
            let captives = self.captives.list.iter();
            let captives = captives.flat_map(|captive| [captive.sphere, captive.exit]);
            self.spheres.note_close(paired.chain(captives));
        }
        self.spheres.take_velocities(bodies);
    }

    /// Iterates over the pieces with a contact that has a normal impulse, as body and piece number, possibly
    /// repeated.
    pub fn pressed<D: Dim>(
        &self,
        bodies: &SoftBodies<D>,
    ) -> impl Iterator<Item = (BodySlot, PieceId)> {
        let nodes = { self.nodes.list.iter() }.filter(|pair| pair.impulse.pressed > 0.0);
        let nodes = nodes.filter_map(|pair| Some((pair.body, pair.piece(bodies)?)));
        let pairs = { self.pairs.list.iter() }.filter(|pair| pair.impulse.pressed > 0.0);
        let pairs = pairs.flat_map(|pair| pair.both(&self.spheres.list));
        nodes.chain(pairs.map(|sphere| (sphere.body, sphere.piece)))
    }
}
