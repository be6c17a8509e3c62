//! Contacts between rigid bodies. A contact of a dynamic body has a manifold of several points. All other
//! contacts, of kinematic or coupled bodies with each other or with fixed bodies, have one point.

use super::contact_row::{AHEAD, CLOSE, Contact, is_close};
use super::contact_sides::{DynamicContact, KinematicContact};
use crate::contact::broad_phase::{Impulse, PressedContact, RigidContactPoint, RigidContactPoints};
use crate::contact::rest_speeds::RestSpeeds;
use crate::foundation::arena::RigidSlot;
use crate::foundation::dim::{Dim, inner};
use crate::math::vector::perpendiculars;
use crate::rigid_body::{MotionType, RigidBodies, RigidState};
use crate::soft_body::element_forces::Row;
use glam::Vec3;

/// Approach speed below which contacts do not bounce [m/s], so that bodies can fall asleep. A body reaches
/// this speed in a fall by 13 mm. Gravity adds a fiftieth of this speed in a substep.
const BOUNCE_SPEED: f32 = 0.5;

/// Finds the contacts of kinematic and coupled bodies with fixed bodies and with each other. Replaces the
/// contents of `found`.
pub fn find_kinematic(rigids: &RigidBodies, duration: f32, found: &mut Vec<KinematicContact>) {
    found.clear();
    let hands = rigids
        .by_slot()
        .filter(|(_, rigid)| rigid.follows_target() && !rigid.is_sensor);
    for (own, hand) in hands {
        let others = rigids
            .by_slot()
            .filter(|(_, rigid)| !rigid.is_dynamic() && hand.meets_rigid(rigid));
        for (other, rigid) in others.filter(|&(at, rigid)| at < own || !rigid.follows_target()) {
            let inverse_mass = hand.inverse_mass() + rigid.inverse_mass();
            let relative = Row::from(hand.velocity()) - Row::from(rigid.velocity());
            if inverse_mass == 0.0 || !relative.is_finite() {
                continue;
            }
            let (gap, normal) = hand.shape().gap(rigid.shape());
            // A non-finite gap gives no contact.
            if gap.is_nan() || gap >= hand.shape().inner_radius() {
                continue;
            }
            let friction = match rigid.follows_target() {
                true => 0.5 * (hand.friction + rigid.friction),
                false => hand.friction,
            };
            let (normal, effective_mass) = (Row::from(normal), 1.0 / inverse_mass);
            found.push(KinematicContact {
                contact: Contact::new(normal, gap, duration, effective_mass, friction),
                both: [own, other],
            });
        }
    }
}

/// Finds the contacts of dynamic bodies with all rigid bodies, and replaces the contents of `found`. Returns
/// the sleepers that must wake, possibly repeated.
pub fn find_dynamic<D: Dim>(
    rigids: &RigidBodies,
    known: &RigidContactPoints,
    rest: RestSpeeds,
    duration: f32,
    found: &mut Vec<DynamicContact>,
) -> Vec<RigidSlot> {
    found.clear();
    let mut hits = Vec::new();
    if !rigids.iter().any(RigidState::is_dynamic) {
        return hits;
    }
    let boxes = rigids.by_slot().map(|(slot, rigid)| {
        let [low, high] = rigid.shape().bounds();
        let margin = margin(rigid, duration);
        let by = Vec3::splat(margin);
        (slot, rigid, [low - by, high + by])
    });
    let boxes: Vec<(RigidSlot, &RigidState, [Vec3; 2])> = boxes.collect();
    for &(own, rigid, [low, high]) in boxes.iter().filter(|(_, rigid, _)| rigid.is_dynamic()) {
        for &(other, against, [others_low, others_high]) in &boxes {
            let is_once = other < own || !against.is_dynamic();
            let is_apart = (0..D::N)
                .any(|axis| low[axis] > others_high[axis] || high[axis] < others_low[axis]);
            let is_idle = !rigid.moves() && !against.moves();
            if !is_once || is_apart || other == own || is_idle || !rigid.meets_rigid(against) {
                continue;
            }
            let (slots, both) = ([own, other], [rigid, against]);
            touch::<D>(slots, both, known, rest, duration, found, &mut hits);
        }
    }
    hits
}

/// Returns the distance from a rigid body within which a contact with a body at rest may become active in
/// this substep [m].
fn margin(rigid: &RigidState, duration: f32) -> f32 {
    CLOSE * rigid.shape().inner_radius().min(1.0) + motion_margin(rigid, duration)
}

fn motion_margin(rigid: &RigidState, duration: f32) -> f32 {
    AHEAD * duration * rigid.top_speed()
}

/// Adds to `found` the active contact points of a dynamic body with another rigid body, and to `hits` the
/// sleepers that must wake.
fn touch<D: Dim>(
    slots: [RigidSlot; 2],
    both: [&RigidState; 2],
    known: &RigidContactPoints,
    rest: RestSpeeds,
    duration: f32,
    found: &mut Vec<DynamicContact>,
    hits: &mut Vec<RigidSlot>,
) {
    let margin = margin(both[0], duration) + motion_margin(both[1], duration);
    let manifold = both[0].shape().manifold(both[1].shape(), margin);
    let size = both[0].shape().inner_radius().min(1.0);
    let waking = rest.wake_speed(both[0].rest_size());
    let friction = match both[1].motion_type {
        MotionType::Fixed => both[1].friction,
        _ => 0.5 * (both[0].friction + both[1].friction),
    };
    let restitution = both[0].restitution.max(both[1].restitution);
    let normal = Row::from(manifold.normal);
    for point in &manifold.points {
        let levers = both.map(|rigid| point.at - rigid.position());
        let [own, other] = [0, 1].map(|k: usize| both[k].velocity_at(levers[k]));
        let relative = Row::from(own) - Row::from(other);
        let approach = inner::<D>(relative, normal);
        if !is_close(point.gap, approach, size, duration) {
            continue;
        }
        let speed = own.length().max(other.length());
        if point.gap < CLOSE * size && (speed > waking || both[1].pushes()) {
            let sleepers = [0, 1].into_iter().filter(|&k: &usize| both[k].is_asleep());
            hits.extend(sleepers.map(|k| slots[k]));
        }
        let inverse_mass = |way: Vec3| {
            let each = [0, 1].map(|k: usize| both[k].inverse_effective_mass(levers[k], way));
            each[0] + each[1]
        };
        let normal_inverse_mass = inverse_mass(manifold.normal);
        if normal_inverse_mass <= 0.0 {
            continue;
        }
        let tangents = tangents::<D>(manifold.normal);
        let tangent_inverse_mass: f32 =
            tangents[..D::N - 1].iter().copied().map(inverse_mass).sum();
        let impulse = known.known(slots, point.key);
        let mut contact = Contact::new(
            normal,
            point.gap,
            duration,
            1.0 / normal_inverse_mass,
            friction,
        );
        contact = contact.with_tangent_mass(1.0 / tangent_inverse_mass);
        contact = contact.with_warm_start::<D>(0, &impulse);
        let is_new = impulse.normal_impulse == 0.0 && approach < -BOUNCE_SPEED;
        let bounce = if is_new { -restitution * approach } else { 0.0 };
        if bounce > 0.0 {
            contact.min_normal_velocity = contact.min_normal_velocity.max(bounce);
        }
        found.push(DynamicContact {
            contact,
            both: slots,
            levers,
            at: point.at,
            speed: -approach,
            bounce,
            pressing: 0.0,
            key: point.key,
        });
    }
}

/// Returns two unit tangents of a normal; in 2D the second one is 0.
fn tangents<D: Dim>(normal: Vec3) -> [Vec3; 2] {
    if D::N == 2 {
        return [Vec3::new(normal[1], -normal[0], 0.0), Vec3::ZERO];
    }
    perpendiculars(normal)
}

impl DynamicContact {
    /// Returns the impulse at the contact point, to be stored for the warm start in the next substep.
    pub fn touch(&self) -> RigidContactPoint {
        let mut impulse = Impulse::default();
        impulse.store(&self.contact);
        RigidContactPoint {
            both: self.both,
            key: self.key,
            impulse,
        }
    }

    /// Returns the contact for the events of the tick; `None` if it did not press in this substep.
    pub fn pressed(&self) -> Option<PressedContact> {
        let pressed = PressedContact {
            both: self.both,
            impulse: self.pressing,
            sum: self.contact.start().xyz(),
            speed: self.speed,
            at: self.at,
            normal: self.contact.normal.xyz(),
        };
        (pressed.impulse > 0.0).then_some(pressed)
    }

    /// Applies the warm-start impulse.
    pub fn start(&self, rigids: &mut RigidBodies, duration: f32) {
        self.push(rigids, self.contact.start(), duration);
    }

    pub fn solve<D: Dim>(&mut self, rigids: &mut RigidBodies, duration: f32) {
        let relative = self.relative(rigids);
        let change = self.contact.solve::<D>(relative);
        self.push(rigids, change, duration);
    }

    /// Removes the velocity by which an overlap was resolved, but keeps that of a bounce. Follows the
    /// position update.
    pub fn relax<D: Dim>(&mut self, rigids: &mut RigidBodies, duration: f32) {
        if self.contact.was_pushed_out() {
            let kept = self.contact.normal * self.bounce;
            let relative = self.relative(rigids) - kept;
            let change = self.contact.relax::<D>(relative);
            self.push(rigids, change, duration);
        }
    }

    /// Returns the velocity of the first body relative to the second at the contact point [m/s].
    fn relative(&self, rigids: &RigidBodies) -> Row {
        let [own, other] =
            [0, 1].map(|k: usize| rigids.at(self.both[k]).velocity_at(self.levers[k]));
        Row::from(own - other)
    }

    fn push(&self, rigids: &mut RigidBodies, impulse: Row, duration: f32) {
        let impulse = impulse.xyz();
        rigids
            .at_mut(self.both[0])
            .apply_contact_impulse_at(impulse, self.levers[0], duration);
        let back = -impulse;
        rigids
            .at_mut(self.both[1])
            .apply_contact_impulse_at(back, self.levers[1], duration);
    }
}
