//! What contacts do to velocities: nothing goes through, and friction holds.
//!
//! Each contact is a *row*: along its normal the two sides may not approach faster than their gap
//! allows, across it they drag on each other within Coulomb's cone. Rows are solved one after the
//! other, forwards and backwards, starting from the impulses of the last substep; the many small
//! substeps are the iterations [Macklin 2019]. What is pushed out of an overlap gains no speed by it:
//! after the move the same rows are solved again without the push [Catto 2023].

mod exit;
mod motion;
mod row;
mod sides;

use crate::body::{Bodies, Body};
use crate::dim::Dim;
use crate::handle::BodySlot;
use crate::ids::{PieceId, Table};
use crate::rigid::Rigids;
use crate::solve::Row;
use crate::threads;
use crate::touch::{ContactSphere, Impulse, MARGIN, Nearby, NodePairs};
use crate::vector::{as_row, cross, minus, scaled, three};
use exit::Exit;
use motion::Motion;
use row::{Contact, inner};
use sides::{HandContact, NodeContact, SphereContact};

/// A crumb is behind a sphere when the way to it goes this far inwards (cosine).
const BEHIND: f32 = 0.3;
/// A sleeper wakes when what touches it moves at this speed [m/s]: what it did move, since deep in
/// a heap the forces of a substep alone would give as much to what rests. Five times as fast as what falls
/// asleep: less, and a heap would keep itself awake.
const WAKE_SPEED: f32 = 0.15;
/// A contact matters when the gap closes to so many voxels within so many substeps: one, and half of another, for
/// other contacts may make it close faster.
const CLOSE: f32 = 0.05;
const AHEAD: f32 = 1.5;

/// The contacts of one substep.
#[derive(Clone, Debug, Default)]
pub struct Contacts {
    nodes: Vec<NodeContact>,
    spheres: Vec<SphereContact>,
    exits: Vec<Exit>,
    hands: Vec<HandContact>,
    motion: Motion,
}

/// A sleeping piece that was hit: body and piece number.
pub type Hit = (BodySlot, PieceId);

impl Contacts {
    /// Finds the contacts of this substep among what is nearby. Returns the sleepers that were hit.
    pub fn find<D: Dim>(
        &mut self,
        bodies: &Bodies<D>,
        rigids: &Rigids,
        nearby: &mut Nearby,
        duration: f32,
    ) -> Vec<Hit> {
        let mut hits = Vec::new();
        self.motion.clear(bodies);
        self.find_nodes(bodies, rigids, &mut nearby.nodes, duration, &mut hits);
        self.find_spheres(bodies, nearby, duration, &mut hits);
        self.exits.clear();
        let (spheres, motion) = (&nearby.spheres, &mut self.motion);
        let exits = nearby.captives.list.iter();
        let exits =
            exits.filter_map(|captive| Exit::new(captive, bodies, spheres, motion, duration));
        self.exits.extend(exits);
        self.find_hands(rigids, duration);
        hits.sort_unstable();
        hits.dedup();
        hits
    }

    fn find_nodes<D: Dim>(
        &mut self,
        bodies: &Bodies<D>,
        rigids: &Rigids,
        pairs: &mut NodePairs,
        duration: f32,
        hits: &mut Vec<Hit>,
    ) {
        self.nodes.clear();
        let travel = pairs.travel;
        let shares = threads::shares(&mut pairs.list);
        let found = threads::map(shares, |(first, pairs)| {
            let (mut contacts, mut hits) = (Vec::new(), Vec::new());
            for (pair, index) in pairs.iter_mut().zip(first..) {
                let body = bodies.at(pair.body);
                let rigid = rigids.at(pair.rigid);
                let node = pair.node;
                // What sleeps is touched by hands alone.
                if body.state.inverse_mass[node] == 0.0 && !rigid.is_driven() {
                    pair.impulse.release();
                    continue;
                }
                let (at, velocity) = (body.state.position[node], body.state.velocity[node]);
                // Most are so far from a wall that they could not come to it at any direction.
                let reachable = (pair.clear - travel).max(0.0) / (AHEAD * duration);
                if !rigid.is_driven() && inner::<D>(velocity, velocity) < reachable * reachable {
                    continue;
                }
                let (gap, normal) = rigid.shape().distance(three(at));
                let normal = as_row(normal);
                let relative = minus(velocity, as_row(rigid.velocity()));
                let size = body.truth.grid.voxel_size();
                if !is_close(gap, inner::<D>(relative, normal), size, duration) {
                    pair.impulse.release();
                    // With a little for rounding.
                    pair.clear = travel + gap - 1.1 * CLOSE * size;
                    continue;
                }
                pair.clear = 0.0;
                if rigid.is_driven() && gap < 0.1 * size && body.truth.pieces.sleeps(pair.node) {
                    hits.push((pair.body, body.truth.pieces.of_node(pair.node)));
                }
                let inverse_mass = body.state.inverse_mass[node] + rigid.inverse_mass();
                if body.state.inverse_mass[node] == 0.0 {
                    continue;
                }
                let friction = rigid.friction;
                let contact = Contact::new(normal, gap, duration, 1.0 / inverse_mass, friction);
                contacts.push((contact.known_as::<D>(index, &pair.impulse), &*pair));
            }
            (contacts, hits)
        });
        for (contacts, hit) in found {
            hits.extend(hit);
            self.nodes
                .extend(contacts.into_iter().map(|(contact, pair)| NodeContact {
                    contact,
                    node: self.motion.row(pair.body, pair.node),
                    hand: rigids.at(pair.rigid).is_driven().then(|| {
                        let at = bodies.at(pair.body).state.position[pair.node];
                        let lever = minus(three(at), rigids.at(pair.rigid).position());
                        (pair.rigid, lever)
                    }),
                }));
        }
    }

    fn find_spheres<D: Dim>(
        &mut self,
        bodies: &Bodies<D>,
        nearby: &mut Nearby,
        duration: f32,
        hits: &mut Vec<Hit>,
    ) {
        self.spheres.clear();
        let waking = WAKE_SPEED * duration;
        let friction = |body: Option<&Body<D>>| body.map_or(0.0, Body::friction);
        let frictions: Table<BodySlot, f32> = bodies.slots().map(friction).collect();
        let (all, captives) = (&nearby.spheres, &nearby.captives);
        let widths = bodies.iter().map(|body| body.truth.grid.voxel_size());
        let widest = widths.fold(0.0, f32::max);
        let shares = threads::shares(&mut nearby.pairs.list);
        let found = threads::map(shares, |(first, pairs)| {
            let (mut contacts, mut hits) = (Vec::new(), Vec::new());
            for (pair, index) in pairs.iter_mut().zip(first..) {
                let [a, b] = pair.spheres;
                let apart = minus(all.centres[a], all.centres[b]);
                let squared = inner::<D>(apart, apart);
                let is_beyond = |touching: f32| {
                    let furthest = (1.0 + MARGIN) * touching;
                    squared > furthest * furthest
                };
                let both = pair.both(&all.list);
                // Most are so far apart that nothing more need be read of them.
                if is_beyond(widest) || is_beyond(both[0].radius + both[1].radius) {
                    pair.met_in_front = false;
                    pair.impulse.release();
                    continue;
                }
                let touching = both[0].radius + both[1].radius;
                if captives.is_inside(pair.spheres, both) {
                    // What came out is not to be drawn in again.
                    pair.met_in_front = true;
                    pair.impulse.release();
                    continue;
                }
                let distance = squared.sqrt().max(1e-9);
                let (mut normal, mut gap) = (scaled(apart, 1.0 / distance), distance - touching);
                if gap < 0.0 {
                    let behind = behind_surface(bodies, both, scaled(normal, distance));
                    pair.met_in_front |= behind.is_none();
                    if let Some((out, ahead)) = behind.filter(|_| pair.met_in_front) {
                        (normal, gap) = (out, ahead - touching);
                    }
                }
                let relative = minus(all.velocities[a], all.velocities[b]);
                if !is_close(gap, inner::<D>(relative, normal), touching, duration) {
                    pair.impulse.release();
                    continue;
                }
                let moved = all.moved[a].max(all.moved[b]);
                if gap < 0.05 * touching && moved > waking * waking {
                    let sleepers = both.into_iter().filter(|sphere| sphere.asleep);
                    hits.extend(sleepers.map(|sphere| (sphere.body, sphere.piece)));
                }
                let [first, second] = both.map(|sphere| sphere.inverse_mass(bodies));
                if first + second == 0.0 {
                    continue;
                }
                let inertia = 1.0 / (first + second);
                let [first, second] = both.map(|sphere| frictions[sphere.body]);
                let friction = 0.5 * (first + second);
                let contact = Contact::new(normal, gap, duration, inertia, friction);
                contacts.push((contact.known_as::<D>(index, &pair.impulse), both));
            }
            (contacts, hits)
        });
        for (contacts, hit) in found {
            hits.extend(hit);
            self.spheres
                .extend(contacts.into_iter().map(|(contact, both)| SphereContact {
                    contact,
                    grips: both.map(|sphere| self.motion.grip::<D>(sphere)),
                }));
        }
    }

    /// Finds the contacts of the hands with what is fixed, and with each other.
    fn find_hands(&mut self, rigids: &Rigids, duration: f32) {
        self.hands.clear();
        for (own, hand) in rigids.by_slot().filter(|(_, rigid)| rigid.is_driven()) {
            let others = rigids.by_slot();
            for (other, rigid) in others.filter(|&(at, rigid)| at < own || !rigid.is_driven()) {
                let inverse_mass = hand.inverse_mass() + rigid.inverse_mass();
                let relative = minus(as_row(hand.velocity()), as_row(rigid.velocity()));
                if inverse_mass == 0.0 || !relative.iter().all(|k| k.is_finite()) {
                    continue;
                }
                let (gap, normal) = hand.shape().gap(rigid.shape());
                // What is not finite touches nothing.
                if gap.is_nan() || gap >= hand.shape().inradius() {
                    continue;
                }
                let friction = match rigid.is_driven() {
                    true => 0.5 * (hand.friction + rigid.friction),
                    false => hand.friction,
                };
                let (normal, inertia) = (as_row(normal), 1.0 / inverse_mass);
                self.hands.push(HandContact {
                    contact: Contact::new(normal, gap, duration, inertia, friction),
                    both: [own, other],
                });
            }
        }
    }

    /// Changes velocities so that the contacts hold.
    pub fn solve<D: Dim>(
        &mut self,
        bodies: &mut Bodies<D>,
        rigids: &mut Rigids,
        nearby: &mut Nearby,
        duration: f32,
    ) {
        let motion = &mut self.motion;
        motion.load(bodies);
        for row in &self.nodes {
            motion.push_node(row, rigids, row.contact.start(), duration);
        }
        for row in self.spheres.iter().filter(|row| row.contact.pressed > 0.0) {
            motion.push_spheres::<D>(&row.grips, row.contact.start());
        }
        // Once only: what is held fast inside must not pull its way out.
        for exit in &self.exits {
            exit.solve::<D>(motion);
        }
        for backwards in [false, true] {
            for_each(&mut self.spheres, backwards, |row| {
                let relative = motion.between::<D>(&row.grips);
                if !row.contact.is_idle::<D>(relative) {
                    let change = row.contact.solve::<D>(relative);
                    motion.push_spheres::<D>(&row.grips, change);
                }
            });
            for_each(&mut self.nodes, backwards, |row| {
                let change = row.contact.solve::<D>(motion.of_node(row, rigids));
                motion.push_node(row, rigids, change, duration);
            });
            for_each(&mut self.hands, backwards, |row| {
                let [own, other] = row.both.map(|slot| as_row(rigids.at(slot).velocity()));
                let change = row.contact.solve::<D>(minus(own, other));
                rigids.at_mut(row.both[0]).push(three(change), duration);
                let other = rigids.at_mut(row.both[1]);
                other.push(three(scaled(change, -1.0)), duration);
            });
        }
        motion.store(bodies);
        for NodeContact { contact, .. } in &self.nodes {
            nearby.nodes.list[contact.pair as usize]
                .impulse
                .note(contact);
        }
        for SphereContact { contact, .. } in &self.spheres {
            nearby.pairs.list[contact.pair as usize]
                .impulse
                .note(contact);
        }
    }

    /// After the move: takes back the speed of what was pushed out.
    pub fn relax<D: Dim>(&mut self, bodies: &mut Bodies<D>, rigids: &mut Rigids, duration: f32) {
        let motion = &mut self.motion;
        motion.load(bodies);
        for exit in &self.exits {
            exit.relax::<D>(motion);
        }
        for row in &mut self.spheres {
            if row.contact.was_pushed_out() {
                let change = row.contact.relax::<D>(motion.between::<D>(&row.grips));
                motion.push_spheres::<D>(&row.grips, change);
            }
        }
        for row in &mut self.nodes {
            if row.contact.was_pushed_out() {
                let change = row.contact.relax::<D>(motion.of_node(row, rigids));
                motion.push_node(row, rigids, change, duration);
            }
        }
        motion.store(bodies);
        for row in &self.nodes {
            if let Some((hand, lever)) = row.hand {
                let impulse = scaled(three(row.contact.start()), -1.0 / duration);
                rigids.at_mut(hand).twist(cross(lever, impulse));
            }
        }
    }
}

impl Impulse {
    /// They do not touch any more.
    #[inline(always)]
    fn release(&mut self) {
        // Most never did; what does not press does not drag.
        if self.pressed > 0.0 {
            (self.pressed, self.dragged) = (0.0, [0.0; 4]);
        }
    }

    fn note(&mut self, contact: &Contact) {
        self.pressed = contact.pressed;
        self.dragged = contact.dragged;
        self.total += contact.pressed;
    }
}

/// For a crumb whose middle is behind a sphere of a surface: the direction out of the surface, as it
/// pushes the first of both, and how far in front of it the crumb is [m], less than 0.
fn behind_surface<D: Dim>(
    bodies: &Bodies<D>,
    [a, b]: [&ContactSphere; 2],
    apart: Row,
) -> Option<(Row, f32)> {
    let (wall, sign) = match (a.is_crumb::<D>(), b.is_crumb::<D>()) {
        (true, false) => (b, 1.0),
        (false, true) => (a, -1.0),
        _ => return None,
    };
    let out = wall.outward::<D>(&bodies.at(wall.body).state.position);
    let length = inner::<D>(out, out).sqrt();
    let normal = scaled(out, sign / length.max(1e-9));
    let ahead = inner::<D>(apart, normal);
    let is_behind = ahead < -BEHIND * inner::<D>(apart, apart).sqrt();
    (is_behind && length > 0.2 * wall.radius).then_some((normal, ahead))
}

/// Whether a contact may matter in this substep: it overlaps, or will if nothing is done. What is not
/// finite touches nothing, so that it spoils nothing else.
fn is_close(gap: f32, approach: f32, size: f32, duration: f32) -> bool {
    approach.is_finite() && gap + AHEAD * duration * approach.min(0.0) < CLOSE * size
}

fn for_each<T>(rows: &mut [T], backwards: bool, mut solve: impl FnMut(&mut T)) {
    if backwards {
        rows.iter_mut().rev().for_each(&mut solve);
    } else {
        rows.iter_mut().for_each(&mut solve);
    }
}
