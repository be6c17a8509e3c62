//! Objects that were placed inside each other.
//!
//! Contacts resolve overlaps of up to about a voxel. If two objects are deeper inside each other, their
//! surfaces have crossed, and contacts would pull some parts further in. The world therefore looks for such
//! pairs wherever a program has placed an object. It moves their two objects apart as rigid bodies and without
//! contacts between them, until contacts can take over. Pairs that were pressed into each other during the
//! simulation are left to the contacts.

use super::{BodyHandle, World};
use crate::contact::broad_phase::{ContactSphere, Overlapping};
use crate::event::Event;
use crate::foundation::arena::{RigidBodyHandle, SoftBodyHandle};
use crate::foundation::dim::{Dim, DimVector};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::PieceId;
use crate::object_ref::ObjectRef;
use crate::query::query_filter::QueryFilter;
use crate::rigid_body::solid::{Bounds, Solid};
use crate::soft_body::SoftBody;
use glam::Vec3;

/// Speed at which overlapping objects move apart [m/s], equal to the speed at which contacts resolve an
/// overlap. Only positions move; the objects keep their velocities.
const SPEED: f32 = 0.5;
/// Distance by which overlapping objects move apart in a tick, at most [voxels]. A longer way in one tick
/// would push an object through others beside it.
const LONGEST: f32 = 0.5;
/// Depth at which contacts take over [voxels]: half a voxel for contact spheres, whose centres are then on the
/// surface of the other piece, and less for rigid bodies, so that contacts throw nothing up.
const RESOLVED: f32 = 0.5;
/// Depth from which placed objects count as overlapping [voxels]. Up to there the normals of contacts are
/// right.
const ALLOWED: f32 = 0.75;
/// Alignment of the ways out of all overlapping points, from 0 to 1, above which their mean is the direction
/// of the separation. Below it, for example if two balls almost coincide, the objects move apart along the
/// line of their centres, which ends every overlap.
const ALIGNED: f32 = 0.5;

/// Pairs of objects that overlap since they were placed.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Overlaps {
    /// Bodies that were placed since the last tick.
    placed: Vec<BodyHandle>,
    /// Overlapping pairs, ascending. The first object is a piece.
    pub(super) pairs: Vec<[ObjectRef; 2]>,
}

hash_state! { struct Overlaps { placed, pairs } }

/// Overlap of two objects.
struct Overlap {
    /// Largest depth [m].
    depth: f32,
    /// Sum of the ways that lead overlapping points of the first object out of the second one, and points of
    /// the second object, in opposite direction, out of the first one [m].
    way: Vec3,
    /// Sum of the lengths of these ways [m].
    length: f32,
}

/// Object that overlaps: what is needed to move it.
struct Mover {
    /// Centre of mass, or of the bounding box of a rigid body [m]; `None` for a half-space.
    centre: Option<Vec3>,
    /// Velocity of the centre [m/s].
    velocity: Vec3,
    /// Inverse mass [1/kg]; 0 if the object cannot be moved.
    inverse_mass: f32,
}

impl Overlaps {
    /// Remembers that a body was placed.
    pub(super) fn place(&mut self, body: BodyHandle) {
        if !self.placed.contains(&body) {
            self.placed.push(body);
        }
    }
}

impl<D: Dim> World<D> {
    /// Finds overlapping objects among those that were placed, and moves overlapping objects apart.
    pub(super) fn separate_overlaps(&mut self) {
        self.nearby.overlapping = Overlapping::default();
        if self.overlaps.placed.is_empty() && self.overlaps.pairs.is_empty() {
            return;
        }
        let known = std::mem::take(&mut self.overlaps.pairs);
        let mut pairs = self.placed_pairs();
        pairs.extend(
            known
                .iter()
                .filter(|pair| self.exist(pair) && self.meet(pair)),
        );
        pairs.sort_unstable();
        pairs.dedup();
        for pair in pairs {
            let is_known = known.binary_search(&pair).is_ok();
            let Some(overlap) = self.overlap_of(pair, is_known) else {
                continue;
            };
            if !is_known {
                self.events.push(Event::Overlapped {
                    pair,
                    depth: overlap.depth,
                });
            }
            if self.move_apart(pair, &overlap) {
                self.overlaps.pairs.push(pair);
                self.nearby.overlapping.add(pair);
            }
        }
    }

    fn exist(&self, pair: &[ObjectRef; 2]) -> bool {
        pair.iter().all(|&object| self.exists(object))
    }

    /// Returns whether the layers of two existing objects meet, and neither is a sensor.
    fn meet(&self, pair: &[ObjectRef; 2]) -> bool {
        let layers = |object: ObjectRef| Some(self.bodies[object.soft_body()?].layers());
        match (layers(pair[0]), layers(pair[1]), pair[1].rigid_body()) {
            (Some(own), Some(other), _) => own.meet(other),
            (Some(own), None, Some(rigid)) => self.rigids[rigid].meets(own),
            _ => false,
        }
    }

    /// Returns the pairs of a placed object and another one whose boxes overlap.
    fn placed_pairs(&mut self) -> Vec<[ObjectRef; 2]> {
        let placed = std::mem::take(&mut self.overlaps.placed);
        let mut pairs = Vec::new();
        for body in placed {
            match body {
                BodyHandle::Soft(body) => self.pairs_of_soft(body, &mut pairs),
                BodyHandle::Rigid(rigid) => {
                    for (body, _) in self.bodies.entries() {
                        self.pairs_of_rigid(body, rigid, &mut pairs);
                    }
                }
            }
        }
        pairs
    }

    fn pairs_of_soft(&self, own: SoftBodyHandle, pairs: &mut Vec<[ObjectRef; 2]>) {
        let Ok(body) = self.bodies.get(own) else {
            return;
        };
        for (rigid, _) in self.rigids.entries() {
            self.pairs_of_rigid(own, rigid, pairs);
        }
        let own_boxes = piece_boxes(body);
        let around = around_all(&own_boxes);
        for (other, others) in self.bodies.entries() {
            if other == own || !body.layers().meet(others.layers()) {
                continue;
            }
            let other_boxes = piece_boxes(others);
            let near = other_boxes.iter();
            for &(piece, bounds) in near.filter(|(_, bounds)| overlap::<D>(bounds, &around)) {
                let met = own_boxes
                    .iter()
                    .filter(|(_, own)| overlap::<D>(own, &bounds));
                for &(own_piece, _) in met {
                    let [a, b] = [(own, own_piece), (other, piece)]
                        .map(|(body, piece)| ObjectRef::Piece { body, piece });
                    pairs.push([a.min(b), a.max(b)]);
                }
            }
        }
    }

    fn pairs_of_rigid(
        &self,
        body: SoftBodyHandle,
        rigid: RigidBodyHandle,
        pairs: &mut Vec<[ObjectRef; 2]>,
    ) {
        let (Ok(soft), Ok(solid)) = (self.bodies.get(body), self.rigids.get(rigid)) else {
            return;
        };
        if !solid.meets(soft.layers()) {
            return;
        }
        let bounds = solid.shape().bounds();
        for (piece, own) in piece_boxes(soft) {
            if overlap::<D>(&own, &bounds) {
                pairs.push([
                    ObjectRef::Piece { body, piece },
                    ObjectRef::RigidBody(rigid),
                ]);
            }
        }
    }

    /// Returns the overlap of a pair; `None` if contacts can resolve the overlap. A pair that is known to
    /// overlap does so until it is resolved.
    fn overlap_of(&self, [first, second]: [ObjectRef; 2], is_known: bool) -> Option<Overlap> {
        let ObjectRef::Piece { body, piece } = first else {
            return None;
        };
        let size = self.bodies[body].grid().voxel_size();
        let least = if is_known { RESOLVED } else { ALLOWED };
        let mut overlap = Overlap {
            depth: 0.0,
            way: Vec3::ZERO,
            length: 0.0,
        };
        match second {
            ObjectRef::RigidBody(rigid) => {
                self.overlap_with_rigid((body, piece), rigid, &mut overlap);
            }
            ObjectRef::Piece {
                body: other,
                piece: others,
            } => {
                self.add_points_inside((body, piece), second, 1.0, &mut overlap);
                self.add_points_inside((other, others), first, -1.0, &mut overlap);
            }
        }
        (overlap.depth > least * size).then_some(overlap)
    }

    /// Adds the points of the smooth surface at the nodes of a piece that are inside a rigid body. If there is no such
    /// point, but the centre of the rigid body is in the piece, adds the way of that centre out of the piece.
    fn overlap_with_rigid(
        &self,
        (body, piece): (SoftBodyHandle, PieceId),
        rigid: RigidBodyHandle,
        overlap: &mut Overlap,
    ) {
        let soft = &self.bodies[body];
        let shape = self.rigids[rigid].shape();
        let nodes = soft.mesh().nodes().map(|(node, _)| node);
        for node in nodes.filter(|&node| soft.pieces().of_node(node) == piece) {
            let (gap, normal) = shape.distance(soft.skin_position(node));
            if gap < 0.0 {
                overlap.add(normal * -gap, -gap);
            }
        }
        let Some(centre) = centre_of(shape) else {
            return;
        };
        let object = ObjectRef::Piece { body, piece };
        if let Some(way) = self.way_out(centre, object) {
            let depth = way.length() + shape.inner_radius();
            overlap.add(-way, depth);
        }
    }

    /// Adds the centres of the surface elements of a piece that are inside another piece. `sign` is 1 if the
    /// piece is the first object of the pair, otherwise −1.
    fn add_points_inside(
        &self,
        (body, piece): (SoftBodyHandle, PieceId),
        other: ObjectRef,
        sign: f32,
        overlap: &mut Overlap,
    ) {
        let soft = &self.bodies[body];
        let elements = soft.mesh().elements().map(|(id, _)| id);
        let spheres = elements.filter_map(|id| ContactSphere::of(body.slot(), soft, id));
        for sphere in spheres.filter(|sphere| sphere.piece == piece && !sphere.is_crumb::<D>()) {
            let centre = sphere.mean::<D>(soft.positions()).xyz();
            if let Some(way) = self.way_out(centre, other) {
                overlap.add(way * sign, way.length() + sphere.radius);
            }
        }
    }

    /// Returns the shortest way out of a piece, from a point to the surface [m]; `None` if the point is
    /// outside.
    fn way_out(&self, point: Vec3, piece: ObjectRef) -> Option<Vec3> {
        let is_piece = |object| object == piece;
        let filter = || QueryFilter::default().with_predicate(&is_piece);
        let at = D::Vector::from_vec3(point);
        if self.objects_at(at, filter()).is_empty() {
            return None;
        }
        let nearest = self.closest_point(at, f32::INFINITY, filter())?;
        Some(nearest.point.to_vec3() - point)
    }

    /// Wakes the objects of an overlapping pair, moves them apart, and removes the speed at which they approach
    /// each other. Returns false if neither object can be moved.
    fn move_apart(&mut self, pair: [ObjectRef; 2], overlap: &Overlap) -> bool {
        let movers = pair.map(|object| self.mover(object));
        let total = movers[0].inverse_mass + movers[1].inverse_mass;
        let ObjectRef::Piece { body, .. } = pair[0] else {
            return false;
        };
        if total <= 0.0 {
            return false;
        }
        let longest = LONGEST * self.bodies[body].grid().voxel_size();
        let length = overlap.depth.min(longest).min(SPEED * self.config.tick);
        let way = overlap.direction(&movers);
        let approach = (movers[0].velocity - movers[1].velocity).dot(way).min(0.0);
        for ((object, mover), sign) in pair.into_iter().zip(&movers).zip([1.0, -1.0]) {
            let share = sign * mover.inverse_mass / total;
            self.wake_object(object);
            self.shift_object(object, way * (share * length), way * (-share * approach));
        }
        true
    }

    fn mover(&self, object: ObjectRef) -> Mover {
        match object {
            ObjectRef::Piece { body, piece } => {
                let motion = self.bodies[body].motion_of_piece(piece);
                let [centre, velocity] = [motion.centre, motion.velocity].map(|v| v.as_vec3());
                Mover {
                    centre: Some(centre),
                    velocity,
                    inverse_mass: if motion.is_held {
                        0.0
                    } else {
                        (1.0 / motion.mass) as f32
                    },
                }
            }
            ObjectRef::RigidBody(rigid) => {
                let rigid = &self.rigids[rigid];
                Mover {
                    centre: centre_of(rigid.shape()),
                    velocity: rigid.velocity(),
                    inverse_mass: rigid.dynamic_mass().map_or(0.0, |mass| 1.0 / mass),
                }
            }
        }
    }

    fn wake_object(&mut self, object: ObjectRef) {
        match object {
            ObjectRef::Piece { body, piece } => self.wake(&[(body.slot(), piece)]),
            ObjectRef::RigidBody(rigid) if self.rigids[rigid].is_asleep() => {
                self.wake_rigids(&[rigid.slot()]);
            }
            ObjectRef::RigidBody(_) => {}
        }
    }

    /// Translates an object by `by` [m], and adds a velocity [m/s].
    fn shift_object(&mut self, object: ObjectRef, by: Vec3, velocity: Vec3) {
        if by == Vec3::ZERO {
            return;
        }
        match object {
            ObjectRef::Piece { body, piece } => {
                self.bodies
                    .at_mut(body.slot())
                    .shift_piece(piece, by, velocity);
            }
            ObjectRef::RigidBody(rigid) => {
                self.rigids.at_mut(rigid.slot()).shift(by, velocity);
            }
        }
    }
}

impl Overlap {
    /// Adds a point of the first object with its way out of the second object [m], at a depth [m].
    fn add(&mut self, way: Vec3, depth: f32) {
        self.depth = self.depth.max(depth);
        self.way += way;
        self.length += way.length();
    }

    /// Returns the unit vector along which the first object leaves the second one.
    fn direction(&self, movers: &[Mover; 2]) -> Vec3 {
        let line = match [movers[0].centre, movers[1].centre] {
            [Some(first), Some(second)] => first - second,
            _ => self.way,
        };
        let is_aligned = self.way.length() >= ALIGNED * self.length && self.way.dot(line) >= 0.0;
        let way = if is_aligned { self.way } else { line };
        let length = way.length();
        match length > 1e-9 {
            true => way * (1.0 / length),
            // The centres coincide, and no direction is better than another one.
            false => Vec3::Y,
        }
    }
}

/// Returns the box around each piece that is neither removed nor a crumb. Crumbs inside another piece get out
/// on their own, see `embedded_spheres`.
fn piece_boxes<D: Dim>(body: &SoftBody<D>) -> Vec<(PieceId, Bounds)> {
    let pieces = body.piece_views().into_iter();
    let pieces = pieces.filter(|piece| !piece.removed && piece.element_count > 1);
    pieces
        .map(|piece| (piece.number, [piece.low, piece.high]))
        .collect()
}

fn around_all(boxes: &[(PieceId, Bounds)]) -> Bounds {
    let none = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    let boxes = boxes.iter().map(|&(_, bounds)| bounds);
    boxes.fold(none, |[low, high], [from, to]| {
        [low.min(from), high.max(to)]
    })
}

fn overlap<D: Dim>([low, high]: &Bounds, [from, to]: &Bounds) -> bool {
    (0..D::N).all(|axis| low[axis] <= to[axis] && from[axis] <= high[axis])
}

/// Returns the centre of a shape [m]; `None` for a half-space.
fn centre_of(shape: &Solid) -> Option<Vec3> {
    let [low, high] = shape.bounds();
    let centre = (low + high) * 0.5;
    centre.is_finite().then_some(centre)
}
