//! What contacts do to velocities: nothing goes through, and friction holds.
//!
//! Each contact is a *row*: along its normal the two sides may not approach faster than their gap
//! allows, across it they drag on each other within Coulomb's cone. Rows are solved one after the
//! other, forwards and backwards, starting from the impulses of the last substep; the many small
//! substeps are the iterations [Macklin 2019]. What is pushed out of an overlap gains no speed by it:
//! after the move the same rows are solved again without the push [Catto 2023].

use crate::body::Body;
use crate::dim::Dim;
use crate::manipulator::Manipulator;
use crate::solve::Row;
use crate::touch::{Collider, Impulse, MARGIN, Nearby, NodePair, Skin};
use crate::vector::{dot, length, minus, plus, scaled};

/// How much of the last substep's impulse a row starts from: 1 is unstable, 0 never comes to rest.
const WARM_START: f32 = 0.9;
/// How much of an overlap is pushed out in a substep, and how fast at most [m/s].
const PUSH_OUT: f32 = 0.2;
const PUSH_OUT_SPEED: f32 = 0.5;
/// A sleeper wakes when what touches it moves at this speed [m/s].
const WAKE_SPEED: f32 = 0.15;

/// One contact in one substep.
#[derive(Copy, Clone, Debug)]
struct Contact {
    normal: Row,
    /// [m]
    gap: f32,
    /// The approach along the normal may not be less than this [m/s].
    least: f32,
    /// One over the speed that a unit of impulse gives [kg].
    inertia: f32,
    friction: f32,
    pressed: f32,
    dragged: Row,
    /// Place of its pair in the list.
    pair: u32,
}

/// A manipulator against an obstacle or against another manipulator.
#[derive(Copy, Clone, Debug)]
struct HandContact {
    contact: Contact,
    hand: usize,
    other: Option<usize>,
}

/// The contacts of one substep.
#[derive(Clone, Debug, Default)]
pub struct Contacts {
    nodes: Vec<Contact>,
    skins: Vec<Contact>,
    hands: Vec<HandContact>,
}

/// A sleeping piece that was hit: body and piece number.
pub type Hit = (u32, u32);

impl Contact {
    fn new(normal: Row, gap: f32, duration: f32, inertia: f32, friction: f32) -> Self {
        let least = if gap > 0.0 {
            -gap / duration
        } else {
            (-PUSH_OUT * gap / duration).min(PUSH_OUT_SPEED)
        };
        Self {
            normal,
            gap,
            least,
            inertia,
            friction,
            pressed: 0.0,
            dragged: [0.0; 4],
            pair: 0,
        }
    }

    fn known_as(mut self, pair: usize, impulse: &Impulse) -> Self {
        self.pair = pair as u32;
        self.pressed = WARM_START * impulse.pressed;
        let along = dot(impulse.dragged, self.normal);
        let dragged = minus(impulse.dragged, scaled(self.normal, along));
        self.dragged = scaled(dragged, WARM_START);
        self
    }

    /// What it starts from.
    fn start(&self) -> Row {
        plus(scaled(self.normal, self.pressed), self.dragged)
    }

    /// The change of impulse on the first side [N s], which moves at `relative` [m/s] as seen from
    /// the second.
    #[inline(always)]
    fn solve(&mut self, relative: Row) -> Row {
        let approach = dot(relative, self.normal);
        let pressed = (self.pressed + (self.least - approach) * self.inertia).max(0.0);
        let slip = minus(relative, scaled(self.normal, approach));
        let mut dragged = minus(self.dragged, scaled(slip, self.inertia));
        let (held, wanted) = (self.friction * pressed, dot(dragged, dragged));
        if wanted > held * held {
            dragged = scaled(dragged, held / wanted.sqrt());
        }
        let press = scaled(self.normal, pressed - self.pressed);
        let change = plus(press, minus(dragged, self.dragged));
        self.pressed = pressed;
        self.dragged = dragged;
        change
    }

    /// As [`Contact::solve`], along the normal only, and without the push out of an overlap.
    #[inline(always)]
    fn relax(&mut self, relative: Row) -> Row {
        let approach = dot(relative, self.normal);
        let pressed = (self.pressed - approach * self.inertia).max(0.0);
        let change = scaled(self.normal, pressed - self.pressed);
        self.pressed = pressed;
        change
    }

    fn was_pushed_out(&self) -> bool {
        self.gap < 0.0 && self.pressed > 0.0
    }
}

impl Contacts {
    /// Finds the contacts of this substep among what is nearby. Returns the sleepers that were hit.
    pub fn find<D: Dim>(
        &mut self,
        bodies: &[Body<D>],
        colliders: &[Collider],
        nearby: &mut Nearby,
        duration: f32,
    ) -> Vec<Hit> {
        let mut hits = Vec::new();
        self.find_nodes(bodies, colliders, nearby, duration, &mut hits);
        self.find_skins(bodies, nearby, duration, &mut hits);
        hits.sort_unstable();
        hits.dedup();
        hits
    }

    fn find_nodes<D: Dim>(
        &mut self,
        bodies: &[Body<D>],
        colliders: &[Collider],
        nearby: &mut Nearby,
        duration: f32,
        hits: &mut Vec<Hit>,
    ) {
        self.nodes.clear();
        for (place, pair) in nearby.node_pairs.iter_mut().enumerate() {
            let body = &bodies[pair.body as usize];
            let collider = &colliders[pair.collider as usize];
            let node = pair.node as usize;
            let at = body.position[node];
            let (gap, normal) = collider.shape.distance([at[0], at[1], at[2]]);
            let normal = [normal[0], normal[1], normal[2], 0.0];
            let relative = minus(body.velocity[node], collider.velocity);
            let size = body.grid.voxel_size();
            if !is_close(gap, dot(relative, normal), size, duration) {
                pair.impulse.pressed = 0.0;
                continue;
            }
            if collider.is_hand && gap < 0.1 * size && body.pieces.sleeps(pair.node) {
                hits.push((pair.body, body.pieces.of_node(pair.node)));
            }
            let lightness = body.lightness[node] + collider.lightness;
            if body.lightness[node] == 0.0 {
                continue;
            }
            let friction = collider.friction;
            let contact = Contact::new(normal, gap, duration, 1.0 / lightness, friction);
            self.nodes.push(contact.known_as(place, &pair.impulse));
        }
    }

    fn find_skins<D: Dim>(
        &mut self,
        bodies: &[Body<D>],
        nearby: &mut Nearby,
        duration: f32,
        hits: &mut Vec<Hit>,
    ) {
        self.skins.clear();
        let (skins, centres) = (&nearby.skins, &nearby.centres);
        for (place, pair) in nearby.skin_pairs.iter_mut().enumerate() {
            let [a, b] = pair.skins.map(|skin| skin as usize);
            let apart = minus(centres[a], centres[b]);
            let touching = skins[a].radius + skins[b].radius;
            let squared = dot(apart, apart);
            let reach = touching * (1.0 + MARGIN);
            if squared > reach * reach {
                pair.impulse.pressed = 0.0;
                continue;
            }
            let distance = squared.sqrt().max(1e-9);
            let (normal, gap) = (scaled(apart, 1.0 / distance), distance - touching);
            let relative = minus(velocity(bodies, &skins[a]), velocity(bodies, &skins[b]));
            if !is_close(gap, dot(relative, normal), touching, duration) {
                pair.impulse.pressed = 0.0;
                continue;
            }
            let (light_a, light_b) = (lightness(bodies, &skins[a]), lightness(bodies, &skins[b]));
            if light_a + light_b == 0.0 {
                continue;
            }
            if gap < 0.05 * touching && length(relative) > WAKE_SPEED {
                for skin in [&skins[a], &skins[b]] {
                    let pieces = &bodies[skin.body as usize].pieces;
                    if pieces.list[skin.piece as usize].asleep {
                        hits.push((skin.body, skin.piece));
                    }
                }
            }
            let friction = bodies[skins[a].body as usize].friction();
            let friction = 0.5 * (friction + bodies[skins[b].body as usize].friction());
            let inertia = 1.0 / (light_a + light_b);
            let contact = Contact::new(normal, gap, duration, inertia, friction);
            self.skins.push(contact.known_as(place, &pair.impulse));
        }
    }

    /// Finds the contacts of the hands with obstacles, the first `obstacles` of the colliders, and
    /// with each other.
    pub fn find_hands(&mut self, hands: &[Manipulator], obstacles: &[Collider], duration: f32) {
        self.hands.clear();
        for (index, hand) in hands.iter().enumerate() {
            let mut add = |gap: f32, normal: [f32; 3], lightness: f32, other: Option<usize>| {
                if lightness > 0.0 && gap < hand.radius {
                    let normal = [normal[0], normal[1], normal[2], 0.0];
                    let friction = hand.friction;
                    let contact = Contact::new(normal, gap, duration, 1.0 / lightness, friction);
                    let hand = index;
                    self.hands.push(HandContact {
                        contact,
                        hand,
                        other,
                    });
                }
            };
            for obstacle in obstacles {
                let (gap, normal) = obstacle.shape.distance(hand.position);
                add(gap - hand.radius, normal, hand.lightness(), None);
            }
            for (other, second) in hands.iter().enumerate().take(index) {
                let (gap, normal) = second.shape().distance(hand.position);
                let lightness = hand.lightness() + second.lightness();
                add(gap - hand.radius, normal, lightness, Some(other));
            }
        }
    }

    /// Changes velocities so that the contacts hold. `first_hand` is the place of the first hand
    /// among the colliders.
    pub fn solve<D: Dim>(
        &mut self,
        bodies: &mut [Body<D>],
        hands: &mut [Manipulator],
        nearby: &mut Nearby,
        first_hand: usize,
        duration: f32,
    ) {
        let (pairs, skin_pairs) = (&nearby.node_pairs, &nearby.skin_pairs);
        for contact in &self.nodes {
            let pair = &pairs[contact.pair as usize];
            push_node(bodies, hands, pair, first_hand, contact.start(), duration);
        }
        for contact in &self.skins {
            let [a, b] = skin_pairs[contact.pair as usize].skins;
            push_skin(bodies, &nearby.skins[a as usize], contact.start());
            push_skin(
                bodies,
                &nearby.skins[b as usize],
                scaled(contact.start(), -1.0),
            );
        }
        for backwards in [false, true] {
            for_each(&mut self.skins, backwards, |contact| {
                let [a, b] = skin_pairs[contact.pair as usize].skins;
                let (a, b) = (&nearby.skins[a as usize], &nearby.skins[b as usize]);
                let change = contact.solve(minus(velocity(bodies, a), velocity(bodies, b)));
                push_skin(bodies, a, change);
                push_skin(bodies, b, scaled(change, -1.0));
            });
            for_each(&mut self.nodes, backwards, |contact| {
                let pair = &pairs[contact.pair as usize];
                let relative = node_velocity(bodies, hands, pair, first_hand);
                let change = contact.solve(relative);
                push_node(bodies, hands, pair, first_hand, change, duration);
            });
            for_each(&mut self.hands, backwards, |row| {
                let relative = match row.other {
                    Some(other) => {
                        minus(four(hands[row.hand].velocity), four(hands[other].velocity))
                    }
                    None => four(hands[row.hand].velocity),
                };
                let change = row.contact.solve(relative);
                push_hand(&mut hands[row.hand], change, duration);
                if let Some(other) = row.other {
                    push_hand(&mut hands[other], scaled(change, -1.0), duration);
                }
            });
        }
        for contact in &self.nodes {
            nearby.node_pairs[contact.pair as usize]
                .impulse
                .note(contact);
        }
        for contact in &self.skins {
            nearby.skin_pairs[contact.pair as usize]
                .impulse
                .note(contact);
        }
    }

    /// After the move: takes back the speed of what was pushed out.
    pub fn relax<D: Dim>(
        &mut self,
        bodies: &mut [Body<D>],
        hands: &mut [Manipulator],
        nearby: &Nearby,
        first_hand: usize,
        duration: f32,
    ) {
        for contact in self.skins.iter_mut().filter(|row| row.was_pushed_out()) {
            let [a, b] = nearby.skin_pairs[contact.pair as usize].skins;
            let (a, b) = (&nearby.skins[a as usize], &nearby.skins[b as usize]);
            let change = contact.relax(minus(velocity(bodies, a), velocity(bodies, b)));
            push_skin(bodies, a, change);
            push_skin(bodies, b, scaled(change, -1.0));
        }
        for contact in self.nodes.iter_mut().filter(|row| row.was_pushed_out()) {
            let pair = &nearby.node_pairs[contact.pair as usize];
            let change = contact.relax(node_velocity(bodies, hands, pair, first_hand));
            push_node(bodies, hands, pair, first_hand, change, duration);
        }
    }
}

impl Impulse {
    fn note(&mut self, contact: &Contact) {
        self.pressed = contact.pressed;
        self.dragged = contact.dragged;
        self.total += contact.pressed;
    }
}

/// Whether a contact may matter in this substep: it overlaps, or will if nothing is done. What is not
/// finite touches nothing, so that it spoils nothing else.
fn is_close(gap: f32, approach: f32, size: f32, duration: f32) -> bool {
    approach.is_finite() && gap + 1.5 * duration * approach.min(0.0) < 0.05 * size
}

fn for_each<T>(rows: &mut [T], backwards: bool, mut solve: impl FnMut(&mut T)) {
    if backwards {
        rows.iter_mut().rev().for_each(&mut solve);
    } else {
        rows.iter_mut().for_each(&mut solve);
    }
}

#[inline]
fn velocity<D: Dim>(bodies: &[Body<D>], skin: &Skin) -> Row {
    skin.mean::<D>(&bodies[skin.body as usize].velocity)
}

/// One over the mass that a push on a skin meets [1/kg].
#[inline]
fn lightness<D: Dim>(bodies: &[Body<D>], skin: &Skin) -> f32 {
    let all = &bodies[skin.body as usize].lightness;
    let nodes = skin.nodes[..D::CORNERS].iter();
    let sum: f32 = nodes.map(|&node| all[node as usize]).sum();
    sum / (D::CORNERS * D::CORNERS) as f32
}

#[inline]
fn push_skin<D: Dim>(bodies: &mut [Body<D>], skin: &Skin, impulse: Row) {
    let body = &mut bodies[skin.body as usize];
    let share = scaled(impulse, 1.0 / D::CORNERS as f32);
    for &node in &skin.nodes[..D::CORNERS] {
        let node = node as usize;
        let change = scaled(share, body.lightness[node]);
        body.velocity[node] = plus(body.velocity[node], change);
    }
}

#[inline]
fn node_velocity<D: Dim>(
    bodies: &[Body<D>],
    hands: &[Manipulator],
    pair: &NodePair,
    first_hand: usize,
) -> Row {
    let velocity = bodies[pair.body as usize].velocity[pair.node as usize];
    match (pair.collider as usize).checked_sub(first_hand) {
        Some(hand) => minus(velocity, four(hands[hand].velocity)),
        None => velocity,
    }
}

#[inline]
fn push_node<D: Dim>(
    bodies: &mut [Body<D>],
    hands: &mut [Manipulator],
    pair: &NodePair,
    first_hand: usize,
    impulse: Row,
    duration: f32,
) {
    let body = &mut bodies[pair.body as usize];
    let node = pair.node as usize;
    let change = scaled(impulse, body.lightness[node]);
    body.velocity[node] = plus(body.velocity[node], change);
    if let Some(hand) = (pair.collider as usize).checked_sub(first_hand) {
        push_hand(&mut hands[hand], scaled(impulse, -1.0), duration);
    }
}

fn push_hand(hand: &mut Manipulator, impulse: Row, duration: f32) {
    let lightness = hand.lightness();
    for axis in 0..3 {
        hand.velocity[axis] += impulse[axis] * lightness;
        if let Some(reaction) = hand.reactions.last_mut() {
            reaction.contact[axis] += impulse[axis] / duration;
        }
    }
}

fn four(v: [f32; 3]) -> Row {
    [v[0], v[1], v[2], 0.0]
}
