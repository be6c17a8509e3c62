//! Finds the sleeping pieces and rigid bodies that rest on an object, directly or through other sleepers.
//! They must wake when the object is removed or moved. Contacts alone would not wake them: a contact wakes a
//! sleeper only if the touching object is fast, and bodies that lose their support are slow at first.

use super::bins::Bins;
use super::contact_sphere::ContactSphere;
use super::sphere_pair::MARGIN;
use crate::foundation::arena::{BodySlot, RigidSlot};
use crate::foundation::dim::Dim;
use crate::foundation::ids::{NodeId, PieceId};
use crate::math::lanes::on_widest_lanes;
use crate::rigid_body::solid::Bounds;
use crate::rigid_body::{RigidBodies, RigidState};
use crate::soft_body::element_forces::Row;
use crate::soft_body::{SoftBodies, SoftBody};
use glam::Vec3;
use std::collections::{BTreeMap, BTreeSet};
use std::marker::PhantomData;

/// Sleeping piece: body and piece number.
pub type Sleeper = (BodySlot, PieceId);

/// Returns the boxes [m] around those pieces of a body for which `is_one` is true, enlarged by the contact
/// margin.
pub fn bounds_of<D: Dim>(body: &SoftBody<D>, is_one: impl Fn(PieceId) -> bool) -> Vec<Bounds> {
    let margin = Vec3::splat(MARGIN * body.grid().voxel_size());
    let pieces = body.piece_views().into_iter();
    let pieces = pieces.filter(|piece| !piece.removed && is_one(piece.number));
    let bounds = pieces.map(|piece| [piece.low - margin, piece.high + margin]);
    bounds.collect()
}

/// Returns the sleeping dynamic rigid bodies with a bounding box that overlaps one of the boxes `places` [m].
pub fn sleeping_in<D: Dim>(places: &[Bounds], rigids: &RigidBodies) -> Vec<RigidSlot> {
    let is_there = |rigid: &RigidState| {
        let [low, high] = rigid.shape().bounds();
        let margin = MARGIN * rigid.shape().inner_radius().min(1.0);
        places.iter().any(|[from, to]| {
            (0..D::N)
                .all(|axis| low[axis] - margin <= to[axis] && from[axis] <= high[axis] + margin)
        })
    };
    let sleepers = { rigids.by_slot() }.filter(|(_, rigid)| rigid.is_asleep() && is_there(rigid));
    sleepers.map(|(slot, _)| slot).collect()
}

/// Returns the sleeping pieces in contact with a rigid body, directly or through other sleeping pieces. The
/// result ascends by body and piece number.
pub fn supported_by_rigid<D: Dim>(rigid: &RigidState, bodies: &SoftBodies<D>) -> Vec<Sleeper> {
    let mut supported = BTreeSet::new();
    for (slot, body) in bodies.by_slot() {
        let reach = MARGIN * body.grid().voxel_size();
        let is_near = |node: NodeId| {
            // On thin shapes and in hard impacts, the node itself is the contact point.
            let places = [body.skin_position(node), body.positions()[node].xyz()];
            let is_close = |at: Vec3| rigid.shape().distance(at).0 <= reach;
            body.pieces().sleeps(node) && places.into_iter().any(is_close)
        };
        let nodes = body.mesh().nodes().map(|(node, _)| node);
        let nodes = nodes.filter(|&node| is_near(node));
        supported.extend(nodes.map(|node| (slot, body.pieces().of_node(node))));
    }
    Sleepers::of(bodies).with_those_on(supported)
}

/// Returns the sleeping pieces in contact with a soft body, directly or through other sleeping pieces. If the
/// body itself is in `bodies`, this includes its own sleeping pieces. The result ascends by body and piece
/// number.
pub fn supported_by_body<D: Dim>(body: &SoftBody<D>, bodies: &SoftBodies<D>) -> Vec<Sleeper> {
    let sleepers = Sleepers::of(bodies);
    let mut supported = BTreeSet::new();
    for sphere in spheres_of(BodySlot::NONE, body) {
        let at = sphere.mean::<D>(body.positions());
        supported.extend(sleepers.touching(at, sphere.radius));
    }
    sleepers.with_those_on(supported)
}

/// Returns the sleeping pieces in contact with any of `pieces`, directly or through other sleeping pieces,
/// except `pieces` themselves. Both lists ascend by body and piece number.
pub fn supported_by_pieces<D: Dim>(pieces: &[Sleeper], bodies: &SoftBodies<D>) -> Vec<Sleeper> {
    let sleepers = Sleepers::of(bodies);
    let is_one = |piece: &Sleeper| pieces.binary_search(piece).is_ok();
    let mut supported = BTreeSet::new();
    for (slot, body) in bodies.by_slot() {
        if pieces.iter().all(|&(body, _)| body != slot) {
            continue;
        }
        let own = spheres_of(slot, body).filter(|own| is_one(&(slot, own.piece)));
        for sphere in own {
            let at = sphere.mean::<D>(body.positions());
            supported.extend(sleepers.touching(at, sphere.radius));
        }
    }
    supported.retain(|piece| !is_one(piece));
    let mut supported = sleepers.with_those_on(supported);
    supported.retain(|piece| !is_one(piece));
    supported
}

/// Contact spheres of all sleeping pieces.
struct Sleepers<D: Dim> {
    spheres: Vec<ContactSphere>,
    centres: Vec<Row>,
    bins: Bins,
    /// Largest radius of the contact spheres [m].
    largest: f32,
    dim: PhantomData<D>,
}

impl<D: Dim> Sleepers<D> {
    fn of(bodies: &SoftBodies<D>) -> Self {
        let (mut spheres, mut centres) = (Vec::new(), Vec::new());
        for (slot, body) in bodies.by_slot() {
            for sphere in spheres_of(slot, body).filter(|sphere| sphere.asleep) {
                centres.push(sphere.mean::<D>(body.positions()));
                spheres.push(sphere);
            }
        }
        let radii = spheres.iter().map(|sphere| sphere.radius);
        let largest = radii.fold(0.0, f32::max);
        Self {
            bins: Bins::new::<D>(&centres, reach(largest, largest)),
            spheres,
            centres,
            largest,
            dim: PhantomData,
        }
    }

    /// Returns the sleeping pieces that touch a ball at the position `at` [m] with a `radius` [m]. A piece
    /// may occur several times.
    fn touching(&self, at: Row, radius: f32) -> Vec<Sleeper> {
        let (mut near, furthest) = (Vec::new(), reach(radius, self.largest));
        on_widest_lanes!(simd => self.bins.near::<D, _>(simd, at, furthest, |_| 0, &mut near));
        let spheres = near.iter().map(|&near| {
            let number = self.bins.numbers()[near as usize];
            &self.spheres[number as usize]
        });
        let pieces = spheres.map(|sphere| (sphere.body, sphere.piece));
        pieces.collect()
    }

    /// Returns the pieces `some` and all sleeping pieces in contact with them, directly or through other
    /// sleeping pieces, ascending.
    fn with_those_on(&self, some: BTreeSet<Sleeper>) -> Vec<Sleeper> {
        let mut own: BTreeMap<Sleeper, Vec<usize>> = BTreeMap::new();
        for (number, sphere) in self.spheres.iter().enumerate() {
            let piece = (sphere.body, sphere.piece);
            own.entry(piece).or_default().push(number);
        }
        let mut work: Vec<Sleeper> = some.iter().copied().collect();
        let mut all = some;
        while let Some(piece) = work.pop() {
            for &number in own.get(&piece).into_iter().flatten() {
                let radius = self.spheres[number].radius;
                let others = self.touching(self.centres[number], radius).into_iter();
                work.extend(others.filter(|&other| all.insert(other)));
            }
        }
        all.into_iter().collect()
    }
}

/// Returns the distance within which the centres of two spheres with these radii count as in contact [m].
fn reach(first: f32, second: f32) -> f32 {
    (1.0 + MARGIN) * (first + second)
}

fn spheres_of<D: Dim>(slot: BodySlot, body: &SoftBody<D>) -> impl Iterator<Item = ContactSphere> {
    let ids = body.mesh().elements().map(|(id, _)| id);
    ids.filter_map(move |id| ContactSphere::of(slot, body, id))
}
