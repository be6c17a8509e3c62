//! Contact and sensor events of a tick.

use super::World;
use crate::error::Error;
use crate::event::{Contact, Event};
use crate::foundation::arena::RigidBodyHandle;
use crate::foundation::dim::{Dim, DimVector};
use crate::foundation::ids::{IndexVec, PieceId};
use crate::object_ref::{ObjectRef, ObjectSelector};
use crate::rigid_body::solid::{Bounds, Solid};
use crate::rigid_body::{MotionType, RigidState};
use crate::soft_body::SoftBody;
use glam::Vec3;
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
    /// Adds the normal impulse [N s] of a contact point to the sum of its pair, and keeps the highest
    /// approach speed [m/s]. `point_and_normal` returns the position [m] of the point, and the normal from
    /// the second object towards the first. It is called only if `impulse` is the largest of the pair so far.
    fn add(
        &mut self,
        objects: [ObjectRef; 2],
        impulse: f32,
        speed: f32,
        point_and_normal: impl FnOnce() -> [Vec3; 2],
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
                    },
                    largest: 0.0,
                });
                self.list.len() - 1
            }),
        };
        self.last = Some((pair, place));
        let ContactSum { contact, largest } = &mut self.list[place];
        contact.impulse += impulse;
        contact.speed = contact.speed.max(speed);
        if impulse > *largest {
            *largest = impulse;
            let [point, normal] = point_and_normal();
            let is_turned = first > second;
            contact.point = D::Vector::from_vec3(point);
            let normal = if is_turned { -normal } else { normal };
            contact.normal = D::Vector::from_vec3(normal);
        }
    }

    /// Returns all contacts, ascending by pair of objects.
    fn contacts(self) -> Vec<Contact<D>> {
        let places = self.places.into_values();
        places.map(|place| self.list[place].contact).collect()
    }
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
        let contacts = self.contacts_in_tick();
        self.events
            .extend(contacts.iter().copied().map(Event::ContactForce));
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
            sums.add(objects, pair.impulse.total, pair.impulse.speed, || {
                let point = body.skin_position(pair.node);
                [point, self.rigids[rigid].shape().distance(point).1]
            });
        }
        let spheres = &self.nearby.spheres;
        let pairs = self.nearby.pairs.list.iter();
        for pair in pairs.filter(|pair| pair.impulse.total > 0.0) {
            let objects = pair.both(&spheres.list).map(|sphere| ObjectRef::Piece {
                body: self.bodies.id(sphere.body),
                piece: sphere.piece,
            });
            sums.add(objects, pair.impulse.total, pair.impulse.speed, || {
                let [point, other] = pair.spheres.map(|sphere| spheres.centres[sphere].xyz());
                let apart = point - other;
                [point, apart * (1.0 / apart.length().max(1e-9))]
            });
        }
        for point in &self.nearby.rigids.pressed {
            let objects = { point.both }.map(|slot| ObjectRef::RigidBody(self.rigids.id(slot)));
            sums.add(objects, point.impulse, point.speed, || {
                [point.at, point.normal]
            });
        }
        sums.contacts()
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
    fn exists(&self, object: ObjectRef) -> bool {
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
