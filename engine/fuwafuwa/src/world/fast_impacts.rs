//! Impacts of more than a voxel per substep.

use super::World;
use crate::contact::broad_phase::{Nearby, NodePair};
use crate::event::{Event, StepReport};
use crate::foundation::arena::BodySlot;
use crate::foundation::dim::{Dim, inner};
use crate::foundation::ids::PieceId;
use crate::math::row::Row;
use crate::rigid_body::RigidBodies;
use crate::soft_body::SoftBodies;
use crate::soft_body::fast_motion::Pace;
use std::collections::BTreeMap;

/// Maximum approach of a piece and what it hits, per substep [voxels]. The limit for a thinner rigid body is half
/// its thickness, else nodes pass through plates thinner than a voxel.
const MAX_CLOSING: f32 = 1.0;

/// Pieces in fast impacts in a tick, with the smallest share of their velocity by which they moved.
pub(super) type SlowedPieces = BTreeMap<(BodySlot, PieceId), f32>;

impl<D: Dim> World<D> {
    /// Slows the pieces in impacts that are too fast for a substep of `duration` [s], and limits the
    /// deformation of fast pieces.
    pub(super) fn limit_fast_motion(&mut self, duration: f32, report: &mut StepReport) {
        self.bodies.iter_mut().for_each(|body| body.clear_paces());
        let voxels = self.bodies.iter().map(|body| body.grid().voxel_size());
        let solid = self.rigids.iter().filter(|rigid| !rigid.is_sensor);
        let thinnest = solid.map(|rigid| rigid.shape().inner_radius());
        let room = voxels.map(|voxel| MAX_CLOSING * voxel).chain(thinnest);
        let limit = room.fold(f32::INFINITY, f32::min) / duration;
        let rigids = self.rigids.iter().map(|rigid| rigid.top_speed());
        let fastest =
            { self.bodies.by_slot() }.map(|(slot, body)| (slot, body.fastest_node(limit)));
        let fastest: Vec<(BodySlot, f32)> = fastest.collect();
        if { fastest.iter() }
            .map(|&(_, speed)| speed)
            .chain(rigids)
            .all(|speed| speed <= limit)
        {
            return;
        }
        for &(slot, _) in fastest.iter().filter(|(_, speed)| *speed > limit) {
            self.bodies.at_mut(slot).mark_fast();
        }
        let mut slowed = node_impacts(&self.nearby, &self.bodies, &self.rigids, duration);
        slowed.extend(sphere_impacts(&self.nearby, &self.bodies, duration));
        for (body, piece, pace) in slowed {
            if self.bodies.at(body).pieces().list[piece].asleep {
                continue;
            }
            self.bodies.at_mut(body).slow_down(piece, pace);
            let least = self.slowed.entry((body, piece)).or_insert(1.0);
            *least = least.min(pace.share);
        }
        for (slot, speed) in fastest {
            let body = self.bodies.at_mut(slot);
            let limit = body.grid().voxel_size() / duration;
            if speed > limit {
                report.speed_limited += body.limit_deformation(limit);
            }
        }
    }

    /// Ends the fast impacts of the tick, and reports them.
    pub(super) fn end_fast_impacts(&mut self, report: &mut StepReport) {
        self.bodies.iter_mut().for_each(|body| body.clear_paces());
        for ((body, piece), share) in std::mem::take(&mut self.slowed) {
            report.slowed_impacts += 1;
            self.events.push(Event::ImpactSlowed {
                body: self.bodies.id(body),
                piece,
                share,
            });
        }
    }
}

/// Returns the paces of pieces that hit rigid bodies.
fn node_impacts<D: Dim>(
    nearby: &Nearby,
    bodies: &SoftBodies<D>,
    rigids: &RigidBodies,
    duration: f32,
) -> Vec<(BodySlot, PieceId, Pace)> {
    let pace = |pair: &NodePair| {
        let (body, rigid) = (bodies.at(pair.body), rigids.at(pair.rigid));
        let at = body.skin_position(pair.node);
        let least = MAX_CLOSING * body.grid().voxel_size();
        let least = least.min(rigid.shape().inner_radius());
        let frame = Row::from(rigid.velocity_near(at));
        let relative = body.skin_velocity(pair.node) - frame;
        if is_within::<D>(relative * duration, least) {
            return None;
        }
        let (gap, normal) = rigid.shape().distance(at);
        let closing = -inner::<D>(relative, Row::from(normal)) * duration;
        let share = share(closing, gap, least)?;
        Some((pair.body, pair.piece(bodies)?, Pace { share, frame }))
    };
    nearby.nodes.list.iter().filter_map(pace).collect()
}

/// Returns the paces of pieces that hit other pieces.
fn sphere_impacts<D: Dim>(
    nearby: &Nearby,
    bodies: &SoftBodies<D>,
    duration: f32,
) -> Vec<(BodySlot, PieceId, Pace)> {
    let spheres = &nearby.spheres;
    let mut paces = Vec::new();
    for pair in &nearby.pairs.list {
        let [a, b] = pair.spheres;
        let both = pair.both(&spheres.list);
        let touching = both[0].radius + both[1].radius;
        let least = MAX_CLOSING * touching;
        let velocities = pair.spheres.map(|sphere| spheres.velocities[sphere]);
        let is_slow = velocities.map(|velocity| is_within::<D>(velocity * duration, least));
        let is_one_piece = (both[0].body, both[0].piece) == (both[1].body, both[1].piece);
        if is_slow == [true; 2] || is_one_piece {
            continue;
        }
        let [own, other] = both.map(|sphere| bodies.at(sphere.body).layers());
        if !own.meet(other) || nearby.embedded.is_inside(pair.spheres, both) {
            continue;
        }
        let (apart, relative) = (
            spheres.centres[a] - spheres.centres[b],
            velocities[0] - velocities[1],
        );
        let distance = inner::<D>(apart, apart).sqrt().max(1e-9);
        let closing = -inner::<D>(relative, apart) / distance * duration;
        if let Some(share) = share(closing, distance - touching, least) {
            // A frame that moves with the other piece would push nodes at rest on a floor into the floor.
            let frame = Row::ZERO;
            let slowed = both
                .into_iter()
                .zip(is_slow)
                .filter(|(_, is_slow)| !is_slow);
            paces.extend(
                slowed.map(|(sphere, _)| (sphere.body, sphere.piece, Pace { share, frame })),
            );
        }
    }
    paces
}

/// Returns whether a motion is shorter than `length` [m].
fn is_within<D: Dim>(motion: Row, length: f32) -> bool {
    inner::<D>(motion, motion) <= length * length
}

/// Returns the share of a `closing` motion that fits into the larger of `gap` and `least` [m]; `None` if all of it
/// fits.
fn share(closing: f32, gap: f32, least: f32) -> Option<f32> {
    let room = gap.max(least);
    (closing > room).then(|| room / closing)
}
