//! Broad phase: finds pairs of objects that may touch soon. A margin covers the motion of the objects until
//! their pairs are searched again.
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
mod overlapping;
mod piece_neighbours;
mod rigid_contacts;
mod slack;
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
pub use embedded_spheres::{EmbeddedSphere, EmbeddedSpheres};
pub use known_impulse::Impulse;
pub use node_pairs::{NodePair, NodePairs};
pub use overlapping::Overlapping;
pub use rigid_contacts::{PressedContact, RigidContactPoint, RigidContactPoints};
pub use sphere_pair::MARGIN;
use sphere_pair::renumber;
pub use sphere_pairs::SpherePairs;
pub use supported_bodies::{
    bounds_of, sleeping_in, supported_by_body, supported_by_pieces, supported_by_rigid,
};

/// Results of the broad phase: objects that may touch. A new tick reuses only the contact impulses, the
/// `met_in_front` flags and the order of the contact spheres from the last tick. It rebuilds everything else.
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
    pub rigids: RigidContactPoints,
    /// Spheres embedded in another piece.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub embedded: EmbeddedSpheres,
    /// Pairs of objects without contacts, because they overlap and are moved apart.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub overlapping: Overlapping,
    /// Remaining time of the tick [s].
    #[cfg_attr(feature = "serde", serde(skip))]
    remaining_time: f32,
    /// Whether `embedded` is up to date: embedded spheres are searched once per tick.
    #[cfg_attr(feature = "serde", serde(skip))]
    knows_embedded: bool,
}

hash_state! {
    struct Nearby { nodes, spheres, pairs, rigids } skip {
        embedded, overlapping, remaining_time, knows_embedded,
    }
}

impl Nearby {
    /// Starts a tick of `duration` [s]: clears the impulse sums of the last tick. The caller may have changed
    /// the bodies in any way since the last tick.
    pub fn start_tick<D: Dim>(&mut self, bodies: &SoftBodies<D>, duration: f32) {
        self.nodes.start_tick();
        self.rigids.start_tick();
        let numbers = self.spheres.start_tick(bodies, &mut self.pairs.changed);
        self.pairs.start_tick(numbers.is_some());
        if let Some(numbers) = numbers {
            renumber(&mut self.pairs.list, &numbers);
        }
        self.embedded = EmbeddedSpheres::default();
        (self.remaining_time, self.knows_embedded) = (duration, false);
    }

    /// Updates the lists after a tear of a body. `changes` holds the nodes and elements that the tear added,
    /// removed or altered.
    pub fn tear<D: Dim>(&mut self, slot: BodySlot, body: &SoftBody<D>, changes: &Changes) {
        self.nodes.tear(slot, &changes.nodes);
        let changed = &mut self.pairs.changed;
        self.spheres.tear(slot, body, changes, changed);
        self.embedded.tear(&self.spheres);
    }

    /// Removes a soft body from all lists, so that another body may take its slot.
    pub fn remove_body(&mut self, slot: BodySlot) {
        let is_of_it = |&sphere: &SphereId| self.spheres.body_of(sphere) == slot;
        self.pairs
            .list
            .retain(|pair| !pair.spheres.iter().any(is_of_it));
        self.nodes.list.retain(|pair| pair.body != slot);
        self.spheres.remove_body(slot);
    }

    /// Removes from all lists the `elements` of a body, given in ascending order, and the nodes that the mesh
    /// no longer has.
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

    /// Discards pairs of objects that do not exist. Required after a world was read from a file, which may
    /// contain any numbers. Only the pairs need this check, because a new tick rebuilds everything else.
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

    /// Marks the nodes and contact spheres of woken pieces, so that their pairs are searched again. `pieces`
    /// holds body slots and piece numbers in ascending order.
    pub fn wake<D: Dim>(&mut self, pieces: &[(BodySlot, PieceId)], bodies: &SoftBodies<D>) {
        self.nodes.wake(pieces, bodies);
        self.spheres.wake(pieces, &mut self.pairs.changed);
    }

    /// Subtracts a substep of `duration` [s] from the remaining time of the tick, and the motion in that
    /// substep from the search margins. No node moved farther than `distance` [m] in the substep.
    pub fn pass(&mut self, duration: f32, distance: f32) {
        self.remaining_time -= duration;
        self.nodes.pass(distance);
        self.pairs.pass(duration, distance);
    }

    /// Updates all lists to the present positions, for a substep of `duration` [s].
    pub fn follow<D: Dim>(&mut self, bodies: &SoftBodies<D>, rigids: &RigidBodies, duration: f32) {
        self.nodes
            .follow(bodies, rigids, duration, self.remaining_time);
        let changed = self.pairs.follow(&mut self.spheres, bodies, duration);
        if !self.knows_embedded {
            self.embedded.find(&self.spheres, &self.pairs.list, bodies);
            self.knows_embedded = true;
        }
        if changed {
            let paired = self.pairs.list.iter().flat_map(|pair| pair.spheres);
            let embedded = self.embedded.list.iter();
            let embedded = embedded.flat_map(|embedded| [embedded.sphere, embedded.exit]);
            self.spheres.set_close(paired.chain(embedded));
        }
        self.spheres.take_velocities(bodies);
    }

    /// Iterates over the pieces on which a contact presses, that is, with a normal impulse above 0. Each item
    /// is a body slot and a piece number. A piece may occur several times.
    pub fn pressed_pieces<D: Dim>(
        &self,
        bodies: &SoftBodies<D>,
    ) -> impl Iterator<Item = (BodySlot, PieceId)> {
        let nodes = { self.nodes.list.iter() }.filter(|pair| pair.impulse.normal_impulse > 0.0);
        let nodes = nodes.filter_map(|pair| Some((pair.body, pair.piece(bodies)?)));
        let pairs = { self.pairs.list.iter() }.filter(|pair| pair.impulse.normal_impulse > 0.0);
        let pairs = pairs.flat_map(|pair| pair.both(&self.spheres.list));
        nodes.chain(pairs.map(|sphere| (sphere.body, sphere.piece)))
    }
}
