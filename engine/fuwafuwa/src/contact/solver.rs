//! Contact solver: non-penetration and Coulomb friction.
//!
//! Each contact is a solver row. Along its normal the two sides may not approach faster than their gap
//! allows; tangentially they exchange friction within Coulomb's cone. The rows are solved by sequential
//! impulses, once forwards and once backwards, with a warm start from the last substep. The many small
//! substeps serve as the iterations [Macklin 2019]. Resolving an overlap adds no velocity: after the position
//! update the same rows are solved again without the push-out velocity [Catto 2023].

mod contact_row;
mod contact_sides;
mod escape_contact;
mod rigid_contact_rows;
mod scaled_pieces;
mod solver_velocities;

use crate::contact::broad_phase::{ContactSphere, MARGIN, Nearby};
use crate::contact::rest_speeds::RestSpeeds;
use crate::foundation::arena::{BodySlot, RigidSlot};
use crate::foundation::dim::{Dim, inner};
use crate::foundation::ids::{IndexVec, PieceId};
use crate::foundation::threads::{self, CHUNK_SIZE, SEARCHES_PER_CHUNK};
use crate::rigid_body::RigidBodies;
use crate::rigid_body::layers::Layers;
use crate::soft_body::element_forces::Row;
use crate::soft_body::skin_point::SkinPoint;
use crate::soft_body::{SoftBodies, SoftBody};
use contact_row::{AHEAD, CLOSE, Contact, is_close};
use contact_sides::{DynamicContact, KinematicContact, NodeContact, SphereContact};
use escape_contact::EscapeContact;
use rigid_contact_rows::{find_dynamic, find_kinematic};
use scaled_pieces::inverse_masses_of_spheres;
use solver_velocities::SolverVelocities;
use std::collections::BTreeSet;

/// Cosine above which a crumb counts as behind a contact sphere of a surface. It is the cosine of the angle
/// between the inward normal and the direction from the contact sphere to the crumb. A smaller limit would
/// include crumbs that lie on the surface: a crumb in the hollow between four spheres, beside a corner of a
/// 3D body, has a cosine of 0.17. If it is pressed in by a sixth of a voxel, its cosine is 0.3.
const MIN_BEHIND_COSINE: f32 = 0.3;
/// Minimum length of a contact sphere's outward vector, as a share of the sphere's radius. If the vector is
/// shorter, no crumb counts as behind the sphere, because the direction is unreliable. At an undeformed flat
/// face the vector is as long as the radius, so the limit excludes elements pressed to a fifth of their
/// height.
const MIN_OUTWARD_LENGTH: f32 = 0.2;
/// Number of times that the contacts are solved forwards and backwards if pieces have scaled mass. All contacts
/// of such a piece act on the same mass, and converge more slowly than contacts of single nodes. With half as
/// many, balls 2 mm wide blew up in impacts at 150 m/s.
const SCALED_SWEEPS: usize = 4;
/// The same number while such a body is in an impact of more than a voxel per substep. With [`SCALED_SWEEPS`],
/// balls 2 mm wide blew up in impacts at 250 m/s.
const FAST_SCALED_SWEEPS: usize = 16;
/// Distance by which a node may be outside the smooth surface in contact, as a multiple of that at rest. Beyond it,
/// the node itself is the contact point. In impacts at 10 m/s and more, nodes would otherwise pass a plate. The
/// distance is also limited to half the radius of the largest ball in the rigid shape: on shapes thinner than about
/// two voxels, contacts are at the nodes.
const NODE_OUTSIDE: f32 = 1.25;
/// Gap between a node and a rigid body below which one can wake the other [voxels].
const WAKING_NODE: f32 = 2.0 * CLOSE;
/// Gap between two contact spheres below which one can wake the other, as a share of the sum of their radii.
const WAKING_SPHERE: f32 = CLOSE;

/// Contacts of one substep.
#[derive(Clone, Debug, Default)]
pub struct Contacts {
    nodes: Vec<NodeContact>,
    spheres: Vec<SphereContact>,
    exits: Vec<EscapeContact>,
    kinematic: Vec<KinematicContact>,
    dynamic: Vec<DynamicContact>,
    velocities: SolverVelocities,
}

/// Sleeping piece that was hit: body slot and piece number.
pub type Hit = (BodySlot, PieceId);

/// Sleepers that were hit in a substep, each once, in ascending order.
#[derive(Clone, Debug, Default)]
pub struct Hits {
    pub pieces: Vec<Hit>,
    pub rigids: Vec<RigidSlot>,
}

impl Contacts {
    /// Selects the contacts of this substep from the pairs of the broad phase. Returns the sleepers that must
    /// wake.
    pub fn find<D: Dim>(
        &mut self,
        bodies: &SoftBodies<D>,
        rigids: &RigidBodies,
        nearby: &mut Nearby,
        rest: RestSpeeds,
        duration: f32,
    ) -> Hits {
        let mut hits = Hits::default();
        self.velocities.clear(bodies);
        self.find_nodes(bodies, rigids, nearby, rest, duration, &mut hits);
        self.find_spheres(bodies, nearby, rest, duration, &mut hits.pieces);
        self.exits.clear();
        let (spheres, velocities) = (&nearby.spheres, &mut self.velocities);
        let overlapping = &nearby.overlapping;
        let has_overlaps = !overlapping.is_empty();
        let exits = nearby.embedded.list.iter().filter(|embedded| {
            let both = [embedded.sphere, embedded.exit].map(|sphere| &spheres.list[sphere]);
            !has_overlaps || !overlapping.has_spheres(both)
        });
        let exits = exits.filter_map(|embedded| {
            EscapeContact::new(embedded, bodies, spheres, velocities, duration)
        });
        self.exits.extend(exits);
        find_kinematic(rigids, duration, &mut self.kinematic);
        let woken = find_dynamic::<D>(rigids, &nearby.rigids, rest, duration, &mut self.dynamic);
        hits.rigids.extend(woken);
        hits.sort();
        hits
    }

    fn find_nodes<D: Dim>(
        &mut self,
        bodies: &SoftBodies<D>,
        rigids: &RigidBodies,
        nearby: &mut Nearby,
        rest: RestSpeeds,
        duration: f32,
        hits: &mut Hits,
    ) {
        self.nodes.clear();
        let (pairs, overlapping) = (&mut nearby.nodes, &nearby.overlapping);
        let has_overlaps = !overlapping.is_empty();
        let travel = pairs.travel;
        let shares = threads::chunks(&mut pairs.list, SEARCHES_PER_CHUNK);
        let found = threads::map(shares, move |(first, pairs)| {
            let (mut contacts, mut hits) = (Vec::new(), Hits::default());
            for (pair, index) in pairs.iter_mut().zip(first..) {
                let body = bodies.at(pair.body);
                let rigid = rigids.at(pair.rigid);
                let (node, moves) = (pair.node, rigid.moves());
                // Sleeping nodes have contacts with moving rigid bodies only.
                if body.inverse_masses()[node] == 0.0 && !moves {
                    pair.impulse.clear();
                    continue;
                }
                let piece = || (pair.body, body.pieces().of_node(node));
                if has_overlaps && overlapping.has_rigid(piece(), pair.rigid) {
                    pair.impulse.clear();
                    continue;
                }
                let mut point = *body.skin_point(node);
                let (mut at, mut velocity) = (body.skin_row(node), body.skin_velocity(node));
                let stretch = point.stretch();
                // Skips nodes that are too slow to reach a resting rigid shape in this substep, in any
                // direction: most nodes.
                let reachable = (pair.clear - stretch * travel).max(0.0) / (AHEAD * duration);
                let of_node = body.velocities()[node];
                let fastest = inner::<D>(velocity, velocity).max(inner::<D>(of_node, of_node));
                if !moves && fastest < reachable * reachable {
                    continue;
                }
                let size = body.grid().voxel_size();
                let (mut gap, mut normal) = rigid.shape().distance(at.xyz());
                if !point.is_node() {
                    // The contact at the skin point holds only the mean of the node and its neighbours.
                    let outside = (NODE_OUTSIDE * point.reach() * size)
                        .min(0.5 * rigid.shape().inner_radius());
                    let (own_gap, own_normal) =
                        rigid.shape().distance(body.positions()[node].xyz());
                    if own_gap + outside < gap {
                        point = SkinPoint::at(node);
                        (gap, normal) = (own_gap + outside, own_normal);
                        (at, velocity) = (body.positions()[node], body.velocities()[node]);
                    }
                }
                let normal = Row::from(normal);
                let own = match moves {
                    true => Row::from(rigid.velocity_near(at.xyz())),
                    false => Row::ZERO,
                };
                let relative = velocity - own;
                let approach = inner::<D>(relative, normal);
                let share = body.pace_share(body.pieces().of_node(node));
                let duration = duration * share;
                let is_close =
                    is_close(gap, approach, size, duration) || body.is_fast() && gap < size;
                if !is_close {
                    pair.impulse.clear();
                    // A contact becomes active below a gap of `CLOSE` voxels. The factor 1.1 allows for
                    // rounding.
                    pair.clear = stretch * travel + gap - 1.1 * CLOSE * size;
                    continue;
                }
                pair.clear = 0.0;
                pair.impulse.speed = pair.impulse.speed.max(-approach);
                let may_wake = moves || rigid.is_asleep();
                if may_wake && gap < WAKING_NODE * size {
                    let waking = rest.wake_speed(size);
                    let is_fast = |speed: Row| inner::<D>(speed, speed) > waking * waking;
                    let wakes = rigid.pushes() || moves && is_fast(own);
                    if wakes && body.pieces().sleeps(pair.node) {
                        let piece = body.pieces().of_node(pair.node);
                        hits.pieces.push((pair.body, piece));
                    }
                    if rigid.is_asleep() && is_fast(velocity) {
                        hits.rigids.push(pair.rigid);
                    }
                }
                let inverse_mass = point.inverse_mass(node, body.inverse_masses())
                    + rigid.max_inverse_effective_mass(at.xyz());
                // A sleeping node acts as a fixed obstacle for a dynamic rigid body. Skips the node's contacts
                // with all other rigid bodies.
                let is_held = body.inverse_masses()[node] == 0.0 && !rigid.is_dynamic();
                if is_held || inverse_mass == 0.0 {
                    continue;
                }
                let friction = rigid.friction;
                let mut contact = Contact::new(normal, gap, duration, 1.0 / inverse_mass, friction);
                if let Some(response) = body.response(body.pieces().of_node(node)) {
                    let (along, most) = response.inverse_masses_at(response.offset(at), normal);
                    contact.effective_mass = 1.0 / (inverse_mass + along);
                    contact.tangent_mass = 1.0 / (inverse_mass + most);
                }
                let contact = contact.with_warm_start::<D>(index, &pair.impulse);
                contacts.push((contact, &*pair, point));
            }
            (contacts, hits)
        });
        for (contacts, hit) in found {
            hits.pieces.extend(hit.pieces);
            hits.rigids.extend(hit.rigids);
            self.nodes
                .extend(contacts.into_iter().map(|(contact, pair, point)| {
                    let body = bodies.at(pair.body);
                    let mut row = |node| self.velocities.row(pair.body, node);
                    NodeContact {
                        contact,
                        node: row(pair.node),
                        point: point.map(row),
                        mover: rigids.at(pair.rigid).moves().then(|| {
                            let at = point.mean(pair.node, body.positions());
                            let lever = at.xyz() - rigids.at(pair.rigid).position();
                            (pair.rigid, lever)
                        }),
                    }
                }));
        }
    }

    fn find_spheres<D: Dim>(
        &mut self,
        bodies: &SoftBodies<D>,
        nearby: &mut Nearby,
        rest: RestSpeeds,
        duration: f32,
        hits: &mut Vec<Hit>,
    ) {
        self.spheres.clear();
        let friction = |body: Option<&SoftBody<D>>| body.map_or(0.0, SoftBody::friction);
        let frictions: &IndexVec<BodySlot, f32> = &bodies.slots().map(friction).collect();
        let has_layers = bodies.iter().any(|body| body.layers() != Layers::default());
        let layers = |sphere: &ContactSphere| bodies.at(sphere.body).layers();
        let meet = |both: [&ContactSphere; 2]| layers(both[0]).meet(layers(both[1]));
        let (all, embedded) = (&nearby.spheres, &nearby.embedded);
        let overlapping = &nearby.overlapping;
        let has_overlaps = !overlapping.is_empty();
        // Borrows the centres as a slice: indexing the `IndexVec` would load its pointer again for each pair.
        let centres = all.centres.as_slice();
        let is_scaled = bodies.iter().any(|body| !body.responses().is_empty());
        let widths = bodies.iter().map(|body| body.grid().voxel_size());
        let widest = widths.fold(0.0, f32::max);
        let shares = threads::chunks(&mut nearby.pairs.list, CHUNK_SIZE);
        let found = threads::map(shares, move |(first, pairs)| {
            let (mut contacts, mut hits) = (Vec::new(), Vec::new());
            for (pair, index) in pairs.iter_mut().zip(first..) {
                let [a, b] = pair.spheres;
                let apart = centres[a.index()] - centres[b.index()];
                let squared = inner::<D>(apart, apart);
                let is_beyond = |touching: f32| {
                    let furthest = (1.0 + MARGIN) * touching;
                    squared > furthest * furthest
                };
                let both = pair.both(&all.list);
                // Skips pairs that are too far apart, which are most pairs, before any more of their data is
                // read.
                if is_beyond(widest) || is_beyond(both[0].radius + both[1].radius) {
                    // Writes only on a change: a write sends the cache line back to memory.
                    if pair.met_in_front {
                        pair.met_in_front = false;
                    }
                    pair.impulse.clear();
                    continue;
                }
                let is_excluded =
                    has_layers && !meet(both) || has_overlaps && overlapping.has_spheres(both);
                if is_excluded {
                    pair.met_in_front = false;
                    pair.impulse.clear();
                    continue;
                }
                let touching = both[0].radius + both[1].radius;
                if embedded.is_inside(pair.spheres, both) {
                    // Treats an embedded sphere as having met the surface from outside. So once the sphere
                    // has escaped, contacts push it away and do not pull it in again.
                    pair.met_in_front = true;
                    pair.impulse.clear();
                    continue;
                }
                let distance = squared.sqrt().max(1e-9);
                let (mut normal, mut gap) = (apart * (1.0 / distance), distance - touching);
                if gap < 0.0 {
                    let behind = behind_surface(bodies, both, normal * distance);
                    pair.met_in_front |= behind.is_none();
                    if let Some((out, ahead)) = behind.filter(|_| pair.met_in_front) {
                        (normal, gap) = (out, ahead - touching);
                    }
                }
                let relative = all.velocities[a] - all.velocities[b];
                let approach = inner::<D>(relative, normal);
                let shares = both.map(|sphere| bodies.at(sphere.body).pace_share(sphere.piece));
                let share = shares[0].min(shares[1]);
                let duration = duration * share;
                let is_close =
                    is_close(gap, approach, touching, duration) || share < 1.0 && gap < touching;
                if !is_close {
                    pair.impulse.clear();
                    continue;
                }
                pair.impulse.speed = pair.impulse.speed.max(-approach);
                if gap < WAKING_SPHERE * touching && (both[0].asleep || both[1].asleep) {
                    let waking = rest.wake_speed(touching);
                    let drifts = [a, b].map(|sphere| all.drift[sphere]);
                    let drifts = drifts.map(|drift| inner::<D>(drift, drift));
                    let is_fast = drifts[0].max(drifts[1]) > waking * waking;
                    if is_fast {
                        let sleepers = both.into_iter().filter(|sphere| sphere.asleep);
                        hits.extend(sleepers.map(|sphere| (sphere.body, sphere.piece)));
                    }
                }
                let [first, second] = both.map(|sphere| sphere.inverse_mass(bodies));
                if first + second == 0.0 {
                    continue;
                }
                let inverse_mass = first + second;
                let [first, second] = both.map(|sphere| frictions[sphere.body]);
                let friction = 0.5 * (first + second);
                let mut contact = Contact::new(normal, gap, duration, 1.0 / inverse_mass, friction);
                if is_scaled {
                    let centres = [a, b].map(|sphere| centres[sphere.index()]);
                    let (along, most) = inverse_masses_of_spheres(bodies, both, centres, normal);
                    contact.effective_mass = 1.0 / (inverse_mass + along);
                    contact.tangent_mass = 1.0 / (inverse_mass + most);
                }
                contacts.push((contact.with_warm_start::<D>(index, &pair.impulse), both));
            }
            (contacts, hits)
        });
        for (contacts, hit) in found {
            hits.extend(hit);
            self.spheres
                .extend(contacts.into_iter().map(|(contact, both)| SphereContact {
                    contact,
                    node_rows: both.map(|sphere| self.velocities.sphere_rows::<D>(sphere)),
                }));
        }
    }

    /// Returns the dynamic rigid bodies that a moving kinematic or coupled body presses on.
    pub fn pushed_bodies(&self, rigids: &RigidBodies) -> BTreeSet<RigidSlot> {
        let pressed = self
            .dynamic
            .iter()
            .filter(|row| row.contact.normal_impulse > 0.0);
        let pushed = pressed.filter(|row| rigids.at(row.both[1]).pushes());
        pushed.map(|row| row.both[0]).collect()
    }

    /// Solves the contacts: applies their impulses to the velocities of nodes and rigid bodies.
    pub fn solve<D: Dim>(
        &mut self,
        bodies: &mut SoftBodies<D>,
        rigids: &mut RigidBodies,
        nearby: &mut Nearby,
        duration: f32,
    ) {
        let velocities = &mut self.velocities;
        velocities.load(bodies);
        for row in &self.nodes {
            velocities.apply_to_node::<D>(row, rigids, row.contact.start(), duration);
        }
        for row in self
            .spheres
            .iter()
            .filter(|row| row.contact.normal_impulse > 0.0)
        {
            velocities.apply_to_spheres::<D>(&row.node_rows, row.contact.start());
        }
        for row in &self.dynamic {
            row.start(rigids, duration);
        }
        // Escape contacts are solved only once, and before all other contacts. So a sphere that is stuck
        // inside a piece does not force its way out.
        for exit in &self.exits {
            exit.solve::<D>(velocities);
        }
        let is_fast = |body: &SoftBody<D>| body.is_fast() && !body.responses().is_empty();
        let sweeps = match () {
            () if velocities.scaled.is_empty() => 1,
            () if bodies.iter().any(is_fast) => FAST_SCALED_SWEEPS,
            () => SCALED_SWEEPS,
        };
        for backwards in [false, true].repeat(sweeps) {
            for_each(&mut self.spheres, backwards, |row| {
                let relative = velocities.relative_of_spheres::<D>(&row.node_rows);
                if !row.contact.is_idle::<D>(relative) {
                    let change = row.contact.solve::<D>(relative);
                    velocities.apply_to_spheres::<D>(&row.node_rows, change);
                }
            });
            for_each(&mut self.nodes, backwards, |row| {
                let change = row
                    .contact
                    .solve::<D>(velocities.relative_of_node::<D>(row, rigids));
                velocities.apply_to_node::<D>(row, rigids, change, duration);
            });
            for_each(&mut self.kinematic, backwards, |row| {
                let [own, other] = row.both.map(|slot| Row::from(rigids.at(slot).velocity()));
                let change = row.contact.solve::<D>(own - other);
                rigids
                    .at_mut(row.both[0])
                    .apply_contact_impulse(change.xyz(), duration);
                let other = rigids.at_mut(row.both[1]);
                other.apply_contact_impulse((-change).xyz(), duration);
            });
            for_each(&mut self.dynamic, backwards, |row| {
                row.solve::<D>(rigids, duration)
            });
        }
        velocities.store(bodies);
        for NodeContact { contact, .. } in &self.nodes {
            let impulse = &mut nearby.nodes.list[contact.pair as usize].impulse;
            impulse.store(contact);
            // Non-finite velocities leave NaN in unused components, which a loaded world would not have.
            impulse.flatten::<D>();
        }
        for SphereContact { contact, .. } in &self.spheres {
            let impulse = &mut nearby.pairs.list[contact.pair as usize].impulse;
            impulse.store(contact);
            impulse.flatten::<D>();
        }
        for row in &mut self.dynamic {
            row.pressing = row.contact.normal_impulse;
        }
        nearby
            .rigids
            .renew(self.dynamic.iter().map(DynamicContact::touch));
    }

    /// Returns whether [`Contacts::relax`] changes the velocities of soft bodies.
    pub fn relax_soft_bodies(&self) -> bool {
        let nodes = self.nodes.iter().map(|row| &row.contact);
        let mut contacts = nodes.chain(self.spheres.iter().map(|row| &row.contact));
        !self.exits.is_empty() || contacts.any(Contact::was_pushed_out)
    }

    /// Removes the velocity by which overlaps were resolved, and adds the impulses of the substep to the sums
    /// of the tick. Follows the position update.
    pub fn relax<D: Dim>(
        &mut self,
        bodies: &mut SoftBodies<D>,
        rigids: &mut RigidBodies,
        nearby: &mut Nearby,
        duration: f32,
    ) {
        let velocities = &mut self.velocities;
        velocities.load(bodies);
        for exit in &self.exits {
            exit.relax::<D>(velocities);
        }
        for row in &mut self.spheres {
            if row.contact.was_pushed_out() {
                let change = row
                    .contact
                    .relax::<D>(velocities.relative_of_spheres::<D>(&row.node_rows));
                velocities.apply_to_spheres::<D>(&row.node_rows, change);
            }
        }
        for row in &mut self.nodes {
            if row.contact.was_pushed_out() {
                let change = row
                    .contact
                    .relax::<D>(velocities.relative_of_node::<D>(row, rigids));
                velocities.apply_to_node::<D>(row, rigids, change, duration);
            }
        }
        for row in &mut self.dynamic {
            row.relax::<D>(rigids, duration);
        }
        velocities.store(bodies);
        for NodeContact { contact, mover, .. } in &self.nodes {
            let impulse = contact.start();
            nearby.nodes.list[contact.pair as usize].impulse.sum += impulse;
            if let Some((mover, lever)) = *mover {
                let impulse = impulse.xyz() * (-1.0 / duration);
                rigids.at_mut(mover).add_torque(lever.cross(impulse));
            }
        }
        for SphereContact { contact, .. } in &self.spheres {
            nearby.pairs.list[contact.pair as usize].impulse.sum += contact.start();
        }
        let pressed = self.dynamic.iter().filter_map(DynamicContact::pressed);
        nearby.rigids.pressed.extend(pressed);
    }
}

impl Hits {
    /// Adds sleepers that were hit; keeps both lists sorted and without duplicates.
    pub fn add(&mut self, pieces: Vec<Hit>, rigids: Vec<RigidSlot>) {
        if !pieces.is_empty() || !rigids.is_empty() {
            self.pieces.extend(pieces);
            self.rigids.extend(rigids);
            self.sort();
        }
    }

    fn sort(&mut self) {
        self.pieces.sort_unstable();
        self.pieces.dedup();
        self.rigids.sort_unstable();
        self.rigids.dedup();
    }
}

/// Returns a contact normal and a distance if one sphere is a crumb behind the other sphere, which belongs to
/// a surface; otherwise `None`. The unit normal gives the direction in which the first sphere is pushed: out
/// of the surface if the first sphere is the crumb, into the surface if the second one is. The distance is
/// that of the crumb from the surface sphere along the outward normal [m]; it is negative.
fn behind_surface<D: Dim>(
    bodies: &SoftBodies<D>,
    [a, b]: [&ContactSphere; 2],
    apart: Row,
) -> Option<(Row, f32)> {
    let (wall, sign) = match (a.is_crumb::<D>(), b.is_crumb::<D>()) {
        (true, false) => (b, 1.0),
        (false, true) => (a, -1.0),
        _ => return None,
    };
    let out = wall.outward::<D>(bodies.at(wall.body).positions());
    let length = inner::<D>(out, out).sqrt();
    let normal = out * (sign / length.max(1e-9));
    let ahead = inner::<D>(apart, normal);
    let is_behind = ahead < -MIN_BEHIND_COSINE * inner::<D>(apart, apart).sqrt();
    (is_behind && length > MIN_OUTWARD_LENGTH * wall.radius).then_some((normal, ahead))
}

fn for_each<T>(rows: &mut [T], backwards: bool, mut solve: impl FnMut(&mut T)) {
    if backwards {
        rows.iter_mut().rev().for_each(&mut solve);
    } else {
        rows.iter_mut().for_each(&mut solve);
    }
}
