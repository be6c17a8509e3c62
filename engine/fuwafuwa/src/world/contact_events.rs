//! Contact and sensor events of a tick.

use super::{ReactionForce, World};
use crate::contact::broad_phase::Impulse;
use crate::error::Error;
use crate::event::{Contact, Event};
use crate::foundation::arena::RigidBodyHandle;
use crate::foundation::dim::{Dim, DimAngular, DimVector};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::{IndexVec, PieceId};
use crate::object_ref::{ObjectRef, ObjectSelector};
use crate::rigid_body::solid::{Bounds, Solid};
use crate::rigid_body::{MotionType, RigidState};
use crate::soft_body::SoftBody;
use glam::{DVec3, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// Contacts of a tick, summed by pair of objects.
struct ContactSums<D: Dim> {
    /// Index in `list` of each pair.
    places: BTreeMap<[ObjectRef; 2], usize>,
    list: Vec<ContactSum<D>>,
    /// Pair of the last added contact point, and its index in `list`. Consecutive contact points mostly
    /// belong to the same pair, so this index saves a look-up.
    last: Option<([ObjectRef; 2], usize)>,
}

/// Contact of a pair, summed over the contact points added so far.
struct ContactSum<D: Dim> {
    contact: Contact<D>,
    /// Largest normal impulse among the added contact points [N s].
    largest: f32,
    /// Sum of the impulses on the first object [N s].
    linear: DVec3,
    /// Sum of the moments of these impulses about the origin [N m s].
    angular: DVec3,
}

impl<D: Dim> Default for ContactSums<D> {
    fn default() -> Self {
        Self {
            places: BTreeMap::new(),
            list: Vec::new(),
            last: None,
        }
    }
}

impl<D: Dim> ContactSums<D> {
    /// Adds a contact point at the position `at` [m] to the sum of its pair: the normal impulse [N s] and the
    /// whole impulse `sum` on the first object [N s]. Keeps the highest approach speed [m/s]. `normal` returns
    /// the normal from the second object towards the first. It is called only if `impulse` is the largest of
    /// the pair so far.
    fn add(
        &mut self,
        objects: [ObjectRef; 2],
        (impulse, sum, speed): (f32, Vec3, f32),
        at: Vec3,
        normal: impl FnOnce() -> Vec3,
    ) {
        let [first, second] = objects;
        let pair = [first.min(second), first.max(second)];
        let place = match self.last {
            Some((last, place)) if last == pair => place,
            _ => *self.places.entry(pair).or_insert_with(|| {
                self.list.push(ContactSum {
                    contact: Contact {
                        pair,
                        point: D::Vector::ZERO,
                        normal: D::Vector::ZERO,
                        speed: 0.0,
                        impulse: 0.0,
                        force: D::Vector::ZERO,
                        torque: D::Angular::default(),
                    },
                    largest: 0.0,
                    linear: DVec3::ZERO,
                    angular: DVec3::ZERO,
                });
                self.list.len() - 1
            }),
        };
        self.last = Some((pair, place));
        let own = &mut self.list[place];
        let contact = &mut own.contact;
        let sign = if first > second { -1.0 } else { 1.0 };
        let sum = (sum * sign).as_dvec3();
        own.linear += sum;
        own.angular += at.as_dvec3().cross(sum);
        contact.impulse += impulse;
        contact.speed = contact.speed.max(speed);
        if impulse > own.largest {
            own.largest = impulse;
            contact.point = D::Vector::from_vec3(at);
            contact.normal = D::Vector::from_vec3(normal() * sign);
        }
    }

    /// Returns all contacts of a tick of `duration` [s], ascending by pair of objects.
    fn contacts(self, duration: f32) -> Vec<Contact<D>> {
        let places = self.places.into_values();
        let contacts = places.map(|place| {
            let own = &self.list[place];
            let (share, mut contact) = (1.0 / f64::from(duration), own.contact);
            let point = contact.point.to_vec3().as_dvec3();
            let torque = own.angular - point.cross(own.linear);
            contact.force = D::Vector::from_vec3((own.linear * share).as_vec3());
            contact.torque = D::Angular::from_vec3((torque * share).as_vec3());
            contact
        });
        contacts.collect()
    }
}

/// Mean force of a contact while its objects settle: all objects that can move have been slow for some time.
/// It becomes the force of the contact when they fall asleep, because the force in a single tick contains the
/// rest of their vibration.
#[derive(Copy, Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub(super) struct SettlingContact<D: Dim> {
    pub(super) pair: [ObjectRef; 2],
    /// Mean force on the first object.
    mean: ReactionForce<D>,
    /// Number of ticks in the mean.
    ticks: u32,
}

hash_state! { [D: Dim] struct SettlingContact<D> { pair, mean, ticks } }

/// Returns the normal impulse [N s], the whole impulse [N s] and the approach speed [m/s] of a pair in a tick.
fn parts_of(impulse: &Impulse) -> (f32, Vec3, f32) {
    (impulse.total, impulse.sum.xyz(), impulse.speed)
}

impl<D: Dim> World<D> {
    /// Returns the contacts of a rigid body, of a piece, or of a whole soft body with all its pieces, in the
    /// order of their pairs, as of the end of the last tick. A contact between two pieces of the selected body
    /// is listed once; a piece that folds onto itself is not listed. While both objects sleep or stand still,
    /// the contact keeps the values of the last tick in which one of them moved.
    ///
    /// ```
    /// use fuwafuwa::{Dim2, ObjectRef, RigidBody, Shape, Vec2, World, WorldConfig};
    ///
    /// let mut world = World::<Dim2>::new(WorldConfig::default())?;
    /// let floor = Shape::half_space(Vec2::Y, Vec2::ZERO);
    /// let floor = world.add_rigid_body(RigidBody::fixed(floor))?;
    /// let ball = RigidBody::dynamic(Shape::ball(0.1), 1.0).at(Vec2::new(0.0, 0.1));
    /// let ball = world.add_rigid_body(ball)?;
    /// world.step();
    /// let contact = world.contacts_of(ball)?.next().expect("the ball lies on the floor");
    /// assert_eq!(contact.other(ball), Some(ObjectRef::RigidBody(floor)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the body does not exist, [`Error::InvalidParameter`] if it has no such piece.
    pub fn contacts_of(
        &self,
        object: impl Into<ObjectSelector>,
    ) -> Result<impl Iterator<Item = &Contact<D>>, Error> {
        let selector = object.into();
        match selector {
            ObjectSelector::SoftBody(body) => {
                self.bodies.get(body)?;
            }
            ObjectSelector::Object(ObjectRef::RigidBody(rigid)) => {
                self.rigids.get(rigid)?;
            }
            ObjectSelector::Object(ObjectRef::Piece { body, piece }) => {
                if !self.bodies.get(body)?.has_piece(piece) {
                    let expected = "the number of a piece that the body still has";
                    return Err(Error::parameter("piece", expected, piece.0));
                }
            }
        }
        let contacts = self.touching.iter();
        Ok(contacts.filter(move |contact| {
            let pair = contact.pair;
            pair.iter().any(|&object| selector.contains(object))
                // Skips contacts with objects that were removed since the last tick.
                && pair.iter().all(|&object| self.exists(object))
        }))
    }

    /// Reports the contact and sensor events of the tick.
    pub(super) fn report_contacts(&mut self) {
        let mut contacts = self.contacts_in_tick();
        self.events
            .extend(contacts.iter().copied().map(Event::ContactForce));
        self.settle_contacts(&mut contacts);
        self.report_contact_changes(contacts);
        self.report_sensors();
    }

    /// Returns the contacts of the tick, ascending by pair.
    fn contacts_in_tick(&self) -> Vec<Contact<D>> {
        let mut sums = ContactSums::default();
        let pairs = self.nearby.nodes.list.iter();
        for pair in pairs.filter(|pair| pair.impulse.total > 0.0) {
            let id = self.bodies.id(pair.body);
            let body = &self.bodies[id];
            let piece = body.pieces().of_node(pair.node);
            let rigid = self.rigids.id(pair.rigid);
            let objects = [
                ObjectRef::Piece { body: id, piece },
                ObjectRef::RigidBody(rigid),
            ];
            let at = body.skin_position(pair.node);
            sums.add(objects, parts_of(&pair.impulse), at, || {
                self.rigids[rigid].shape().distance(at).1
            });
        }
        let spheres = &self.nearby.spheres;
        let pairs = self.nearby.pairs.list.iter();
        for pair in pairs.filter(|pair| pair.impulse.total > 0.0) {
            let objects = pair.both(&spheres.list).map(|sphere| ObjectRef::Piece {
                body: self.bodies.id(sphere.body),
                piece: sphere.piece,
            });
            let [at, other] = pair.spheres.map(|sphere| spheres.centres[sphere].xyz());
            sums.add(objects, parts_of(&pair.impulse), at, || {
                let apart = at - other;
                apart * (1.0 / apart.length().max(1e-9))
            });
        }
        for point in &self.nearby.rigids.pressed {
            let objects = { point.both }.map(|slot| ObjectRef::RigidBody(self.rigids.id(slot)));
            let parts = (point.impulse, point.sum, point.speed);
            sums.add(objects, parts, point.at, || point.normal);
        }
        sums.contacts(self.config.tick)
    }

    /// Updates the mean forces of contacts between objects that settle. Contacts between objects that fell
    /// asleep in this tick get their mean force.
    fn settle_contacts(&mut self, contacts: &mut [Contact<D>]) {
        let before = std::mem::take(&mut self.settling);
        for contact in contacts {
            let pair = contact.pair;
            if !pair.iter().all(|&object| self.settles(object)) {
                continue;
            }
            let now = ReactionForce {
                point: contact.point,
                force: contact.force,
                torque: contact.torque,
            };
            let known = before.binary_search_by_key(&pair, |settling| settling.pair);
            let (mean, ticks) = match known {
                Ok(place) => {
                    let ticks = before[place].ticks.saturating_add(1);
                    (before[place].mean.mean_with(now, ticks), ticks)
                }
                Err(_) => (now, 1),
            };
            if self.rest(pair) {
                (contact.force, contact.torque) = (mean.force, mean.torque);
            } else {
                self.settling.push(SettlingContact { pair, mean, ticks });
            }
        }
    }

    /// Returns whether an object rests, or has been slow since an earlier tick.
    fn settles(&self, object: ObjectRef) -> bool {
        self.rests(object)
            || match object {
                ObjectRef::RigidBody(id) => self.rigids[id].sleep_timer > 0.0,
                ObjectRef::Piece { body, piece } => {
                    self.bodies[body].pieces().list[piece].sleep_timer > 0.0
                }
            }
    }

    /// Compares the contacts of this tick, in ascending order, with those of the previous tick, and reports
    /// which contacts started or ended. A pair without contact impulses still touches as long as both objects
    /// are at rest.
    fn report_contact_changes(&mut self, contacts: Vec<Contact<D>>) {
        let mut before = std::mem::take(&mut self.touching).into_iter().peekable();
        let mut touching = Vec::with_capacity(contacts.len());
        let (mut started, mut ended) = (Vec::new(), Vec::new());
        let mut leave = |old: Contact<D>, touching: &mut Vec<Contact<D>>| match self.rest(old.pair)
        {
            true => touching.push(old),
            false => ended.push(Event::ContactEnded { pair: old.pair }),
        };
        for contact in contacts {
            let pair = contact.pair;
            // A piece in contact with itself gives no event, because a folded piece always touches itself.
            if pair[0] == pair[1] {
                continue;
            }
            while let Some(old) = before.next_if(|old| old.pair < pair) {
                leave(old, &mut touching);
            }
            touching.push(contact);
            if before.next_if(|old| old.pair == pair).is_none() {
                started.push(Event::ContactStarted(contact));
            }
        }
        before.for_each(|old| leave(old, &mut touching));
        self.touching = touching;
        self.events.extend(started.into_iter().chain(ended));
    }

    /// Returns whether an object exists.
    pub(super) fn exists(&self, object: ObjectRef) -> bool {
        match object {
            ObjectRef::RigidBody(rigid) => self.rigids.get(rigid).is_ok(),
            ObjectRef::Piece { body, piece } => self
                .bodies
                .get(body)
                .is_ok_and(|body| body.has_piece(piece)),
        }
    }

    /// Returns whether both objects exist and neither moves.
    fn rest(&self, pair: [ObjectRef; 2]) -> bool {
        pair.into_iter().all(|object| self.rests(object))
    }

    fn rests(&self, object: ObjectRef) -> bool {
        match object {
            ObjectRef::RigidBody(id) => self.rigids.get(id).is_ok_and(RigidState::rests),
            ObjectRef::Piece { body, piece } => self.bodies.get(body).is_ok_and(|body| {
                let piece = body.pieces().list.get(piece.index());
                piece.is_some_and(|piece| piece.asleep && !piece.removed)
            }),
        }
    }

    /// Compares the objects inside each sensor with those in the previous tick, and reports entries and
    /// exits.
    fn report_sensors(&mut self) {
        let sensors = self.rigids.entries().filter(|(_, rigid)| rigid.is_sensor);
        let sensors: Vec<(RigidBodyHandle, &RigidState)> = sensors.collect();
        let mut inside: BTreeSet<(RigidBodyHandle, ObjectRef)> = BTreeSet::new();
        for &(sensor, rigid) in &sensors {
            inside.extend(self.rigids_within(sensor, rigid).map(|who| (sensor, who)));
        }
        for (body, soft) in self.bodies.entries() {
            let meets = |(_, rigid): &&(_, &RigidState)| rigid.layers.meet(soft.layers());
            let mut met = sensors.iter().filter(meets).peekable();
            // Bounding boxes of the pieces, shared by all sensors; computed only if at least one sensor may
            // detect the body.
            let bounds = met.peek().map(|_| piece_bounds(soft));
            for (&(sensor, rigid), bounds) in met.zip(bounds.iter().cycle()) {
                let found = pieces_within(soft, bounds, rigid.shape());
                let found = found
                    .into_iter()
                    .map(|piece| ObjectRef::Piece { body, piece });
                inside.extend(found.map(|who| (sensor, who)));
            }
        }
        let before: BTreeSet<(RigidBodyHandle, ObjectRef)> =
            std::mem::take(&mut self.inside).into_iter().collect();
        let entered = inside.difference(&before);
        let left = before.difference(&inside);
        self.events
            .extend(entered.map(|&(sensor, object)| Event::SensorEntered { sensor, object }));
        self.events
            .extend(left.map(|&(sensor, object)| Event::SensorExited { sensor, object }));
        self.inside = inside.into_iter().collect();
    }

    /// Returns the rigid bodies that overlap a sensor, except fixed bodies and other sensors.
    fn rigids_within(
        &self,
        own: RigidBodyHandle,
        sensor: &RigidState,
    ) -> impl Iterator<Item = ObjectRef> {
        let shape = sensor.shape();
        let rigids = self.rigids.entries().filter(move |&(id, rigid)| {
            let counts = id != own && rigid.motion_type != MotionType::Fixed && !rigid.is_sensor;
            counts && sensor.layers.meet(rigid.layers) && rigid.shape().gap(shape).0 < 0.0
        });
        rigids.map(|(id, _)| ObjectRef::RigidBody(id))
    }
}

/// Returns the bounding box of the nodes of each piece; the box of a piece without nodes overlaps nothing.
fn piece_bounds<D: Dim>(body: &SoftBody<D>) -> IndexVec<PieceId, Bounds> {
    let pieces = body.pieces();
    let nothing = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    let mut all: IndexVec<PieceId, Bounds> = vec![nothing; pieces.list.len()].into();
    for (node, _) in body.mesh().nodes() {
        let at = body.positions()[node].xyz();
        let [low, high] = &mut all[pieces.of_node(node)];
        for axis in 0..3 {
            low[axis] = low[axis].min(at[axis]);
            high[axis] = high[axis].max(at[axis]);
        }
    }
    all
}

/// Returns the pieces with a node inside a shape. Nodes are tested only for pieces with a bounding box that
/// overlaps the box of the shape.
fn pieces_within<D: Dim>(
    body: &SoftBody<D>,
    bounds: &IndexVec<PieceId, Bounds>,
    shape: &Solid,
) -> Vec<PieceId> {
    let pieces = body.pieces();
    let mut is_open = pieces_near::<D>(bounds, shape.bounds());
    let mut open = is_open.iter().filter(|&&is_open| is_open).count();
    let mut found = Vec::new();
    for (node, _) in body.mesh().nodes() {
        if open == 0 {
            break;
        }
        let piece = pieces.of_node(node);
        if is_open[piece] && shape.distance(body.positions()[node].xyz()).0 < 0.0 {
            found.push(piece);
            is_open[piece] = false;
            open -= 1;
        }
    }
    found
}

/// Returns for each piece whether its bounding box overlaps the box of a shape. The box of the shape is
/// enlarged slightly: because of rounding, a node just outside the box can have a negative distance from the
/// shape.
fn pieces_near<D: Dim>(
    bounds: &IndexVec<PieceId, Bounds>,
    [low, high]: Bounds,
) -> IndexVec<PieceId, bool> {
    let margin = |axis: usize| {
        1e-3 * (high[axis] - low[axis]) + 1e-5 * low[axis].abs().max(high[axis].abs())
    };
    let margins = [0, 1, 2].map(margin);
    let is_near = |[from, to]: &Bounds| {
        (0..D::N).all(|axis| {
            low[axis] - margins[axis] <= to[axis] && from[axis] <= high[axis] + margins[axis]
        })
    };
    bounds.iter().map(is_near).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::Dim3;
    use crate::material::Material;
    use crate::topology::grid::VoxelGrid;

    #[test]
    fn pieces_whose_box_misses_the_shape_are_skipped() {
        let grid = VoxelGrid::<Dim3>::ball(6, 1.0).expect("a ball");
        let mut body = SoftBody::new(grid, &[Material::default()]).expect("a body");
        body.crumble();
        let bounds = piece_bounds(&body);
        let shape = Solid::Ball {
            centre: Vec3::new(0.0, 0.5, 0.5),
            radius: 0.3,
        };
        let near = pieces_near::<Dim3>(&bounds, shape.bounds());
        let count = near.iter().filter(|&&is_near| is_near).count();
        assert!((1..bounds.len() / 2).contains(&count), "{count}");
        let inside = pieces_within(&body, &bounds, &shape);
        assert!(!inside.is_empty() && inside.iter().all(|&piece| near[piece]));
    }
}
