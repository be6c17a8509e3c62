//! Contact and sensor events of a tick.

use super::World;
use crate::error::Error;
use crate::event::{Contact, Event};
use crate::foundation::arena::{RigidBodyHandle, SoftBodyHandle};
use crate::foundation::dim::Dim;
use crate::math::vector::{length, minus, scaled, three};
use crate::object_ref::{ObjectRef, ObjectSelector};
use crate::rigid_body::shape::Vector;
use crate::rigid_body::{MotionType, RigidBody};
use crate::soft_body::SoftBody;
use std::collections::{BTreeMap, BTreeSet};

/// Contacts of a tick, summed by pair. Neighbours in a pair list mostly belong to the same pair of objects, so
/// the place of the last pair is cached.
#[derive(Default)]
struct ContactSums {
    places: BTreeMap<[ObjectRef; 2], usize>,
    list: Vec<ContactSum>,
    last: Option<([ObjectRef; 2], usize)>,
}

/// Sum of a contact, and the largest normal impulse in it [N s].
struct ContactSum {
    contact: Contact,
    largest: f32,
}

impl ContactSums {
    /// Adds the normal impulse [N s] and the approach speed [m/s] of a contact point. The closure returns the
    /// position [m], and the normal from the second object towards the first; it is called only if the
    /// impulse is the largest of the pair up to now.
    fn add(
        &mut self,
        objects: [ObjectRef; 2],
        impulse: f32,
        speed: f32,
        point_and_normal: impl FnOnce() -> [Vector; 2],
    ) {
        let [first, second] = objects;
        let pair = [first.min(second), first.max(second)];
        let place = match self.last {
            Some((last, place)) if last == pair => place,
            _ => *self.places.entry(pair).or_insert_with(|| {
                self.list.push(ContactSum {
                    contact: Contact {
                        pair,
                        point: [0.0; 3],
                        normal: [0.0; 3],
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
            contact.point = point;
            contact.normal = scaled(normal, if is_turned { -1.0 } else { 1.0 });
        }
    }

    /// Returns all contacts, ascending by pair.
    fn contacts(self) -> Vec<Contact> {
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
    /// use fuwafuwa::{Dim2, ObjectRef, RigidBody, Shape, World, WorldConfig};
    ///
    /// let mut world = World::<Dim2>::new(WorldConfig::default())?;
    /// let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
    /// let floor = world.add_rigid_body(RigidBody::fixed(floor, 0.5))?;
    /// let ball = Shape::Ball { centre: [0.0, 0.1, 0.0], radius: 0.1 };
    /// let ball = world.add_rigid_body(RigidBody::dynamic(ball, 1.0))?;
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
    ) -> Result<impl Iterator<Item = &Contact>, Error> {
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
                // Objects removed since the last tick are in the list until the next one.
                && pair.iter().all(|&object| self.exists(object))
        }))
    }

    /// Reports the contact and sensor events of the tick.
    pub(super) fn note_touches(&mut self) {
        let contacts = self.contacts_in_tick();
        self.events
            .extend(contacts.iter().copied().map(Event::ContactForce));
        self.note_changes(contacts);
        self.note_sensors();
    }

    /// Returns the contacts of the tick, ascending by pair.
    fn contacts_in_tick(&self) -> Vec<Contact> {
        let mut sums = ContactSums::default();
        let pairs = self.nearby.nodes.list.iter();
        for pair in pairs.filter(|pair| pair.impulse.total > 0.0) {
            let id = self.bodies.id(pair.body);
            let body = &self.bodies[id];
            let piece = body.topology.pieces.of_node(pair.node);
            let rigid = self.rigids.id(pair.rigid);
            let objects = [
                ObjectRef::Piece { body: id, piece },
                ObjectRef::RigidBody(rigid),
            ];
            sums.add(objects, pair.impulse.total, pair.impulse.speed, || {
                let point = three(body.state.position[pair.node]);
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
                let [point, other] = pair.spheres.map(|sphere| three(spheres.centres[sphere]));
                let apart = minus(point, other);
                [point, scaled(apart, 1.0 / length(apart).max(1e-9))]
            });
        }
        for touch in &self.nearby.rigids.passed {
            let objects = { touch.both }.map(|slot| ObjectRef::RigidBody(self.rigids.id(slot)));
            sums.add(objects, touch.impulse, touch.speed, || {
                [touch.at, touch.normal]
            });
        }
        sums.contacts()
    }

    /// Compares the contacts, in ascending order, with those of the last tick, and reports beginnings and
    /// ends. Pairs at rest still touch.
    fn note_changes(&mut self, contacts: Vec<Contact>) {
        let mut before = std::mem::take(&mut self.touching).into_iter().peekable();
        let mut touching = Vec::with_capacity(contacts.len());
        let (mut started, mut ended) = (Vec::new(), Vec::new());
        let mut leave = |old: Contact, touching: &mut Vec<Contact>| match self.rest(old.pair) {
            true => touching.push(old),
            false => ended.push(Event::ContactEnded { pair: old.pair }),
        };
        for contact in contacts {
            let pair = contact.pair;
            // A folded piece always touches itself.
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
            ObjectRef::RigidBody(id) => self.rigids.get(id).is_ok_and(|rigid| !rigid.moves()),
            ObjectRef::Piece { body, piece } => self.bodies.get(body).is_ok_and(|body| {
                let piece = body.topology.pieces.list.get(piece.index());
                piece.is_some_and(|piece| piece.asleep && !piece.removed)
            }),
        }
    }

    /// Compares the contents of the sensors with those of the last tick, and reports entries and exits.
    fn note_sensors(&mut self) {
        let sensors = self.rigids.entries().filter(|(_, rigid)| rigid.is_sensor);
        let mut inside: BTreeSet<(RigidBodyHandle, ObjectRef)> = BTreeSet::new();
        for (sensor, rigid) in sensors {
            inside.extend(self.within(sensor, rigid).map(|object| (sensor, object)));
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

    /// Returns the objects inside a sensor, possibly repeated.
    fn within(&self, own: RigidBodyHandle, sensor: &RigidBody) -> impl Iterator<Item = ObjectRef> {
        let shape = sensor.shape();
        let bodies = self.bodies.entries();
        let bodies = bodies.filter(|(_, body)| sensor.layers.meet(body.state.layers));
        let pieces = bodies.flat_map(move |(id, body): (SoftBodyHandle, &SoftBody<D>)| {
            let nodes = body.topology.mesh.nodes().map(|(node, _)| node);
            let inside =
                nodes.filter(|&node| shape.distance(three(body.state.position[node])).0 < 0.0);
            inside.map(move |node| ObjectRef::Piece {
                body: id,
                piece: body.topology.pieces.of_node(node),
            })
        });
        let rigids = self.rigids.entries().filter(move |&(id, rigid)| {
            let counts = id != own && rigid.motion_type != MotionType::Fixed && !rigid.is_sensor;
            counts && sensor.layers.meet(rigid.layers) && rigid.shape().gap(shape).0 < 0.0
        });
        pieces.chain(rigids.map(|(id, _)| ObjectRef::RigidBody(id)))
    }
}
