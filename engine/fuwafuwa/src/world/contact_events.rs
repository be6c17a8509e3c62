//! Contact and sensor events of a tick.

use super::World;
use crate::event::{Event, ObjectRef, With};
use crate::foundation::arena::{RigidBodyHandle, SoftBodyHandle};
use crate::foundation::dim::Dim;
use crate::foundation::ids::PieceId;
use crate::rigid_body::shape::Vector;
use crate::rigid_body::{MotionType, RigidBody};
use crate::soft_body::SoftBody;
use std::collections::{BTreeMap, BTreeSet};

/// Contact between two participants, accumulated over a tick.
#[derive(Copy, Clone, Debug, Default)]
struct Press {
    /// Normal impulse: sum over the tick, and that of the strongest contact [N s].
    impulse: f32,
    strongest: f32,
    /// Position of the strongest contact [m], and the normal from the second participant towards the first.
    at: Vector,
    normal: Vector,
    /// Highest approach speed [m/s].
    speed: f32,
}

impl Press {
    /// Adds a contact. The closure for its position and normal is called only if the contact is the strongest
    /// up to now.
    fn add(&mut self, impulse: f32, speed: f32, at_and_normal: impl FnOnce() -> [Vector; 2]) {
        self.impulse += impulse;
        self.speed = self.speed.max(speed);
        if impulse > self.strongest {
            self.strongest = impulse;
            [self.at, self.normal] = at_and_normal();
        }
    }

    /// Returns the contact with the participants swapped.
    fn turned(mut self) -> Self {
        self.normal = -self.normal;
        self
    }

    /// Adds the contacts of `other` between the same participants.
    fn join(&mut self, other: Self) {
        self.impulse += other.impulse;
        self.speed = self.speed.max(other.speed);
        if other.strongest > self.strongest {
            (self.strongest, self.at, self.normal) = (other.strongest, other.at, other.normal);
        }
    }
}

/// Accumulated contacts by key. Neighbours in a pair list mostly have the same key, so the last one is
/// cached.
struct Presses<K> {
    places: BTreeMap<K, usize>,
    list: Vec<Press>,
    last: Option<(K, usize)>,
}

impl<K> Default for Presses<K> {
    fn default() -> Self {
        Self {
            places: BTreeMap::new(),
            list: Vec::new(),
            last: None,
        }
    }
}

impl<K: Copy + Ord> Presses<K> {
    /// Returns the contact of a key, inserting an empty one if it is new.
    fn of(&mut self, key: K) -> &mut Press {
        let place = match self.last {
            Some((last, place)) if last == key => place,
            _ => *self.places.entry(key).or_insert_with(|| {
                self.list.push(Press::default());
                self.list.len() - 1
            }),
        };
        self.last = Some((key, place));
        &mut self.list[place]
    }

    /// Returns all contacts, ascending by key.
    fn all(self) -> Vec<(K, Press)> {
        let of = |(key, place): (K, usize)| (key, self.list[place]);
        self.places.into_iter().map(of).collect()
    }
}

impl<D: Dim> World<D> {
    /// Reports the contact and sensor events of the tick.
    pub(super) fn note_touches(&mut self) {
        let soft = self.soft_presses();
        let rigid = self.rigid_presses();
        let known = rigid.iter();
        let known = known.map(|(&both, press)| (both.map(ObjectRef::RigidBody), *press));
        let mut presses: Vec<([ObjectRef; 2], Press)> = known.collect();
        for ((body, piece, with), press) in soft {
            self.events.push(Event::Pressed {
                body,
                piece,
                with,
                at: press.at,
                normal: press.normal,
                impulse: press.impulse,
            });
            let (first, second) = (ObjectRef::Piece { body, piece }, with.into());
            // Ignores contacts within a piece: a folded piece always touches itself. Two pieces can press on
            // each other from either side of the pair, so the order is normalised.
            match (first, second) {
                _ if first == second => {}
                (_, ObjectRef::Piece { .. }) if second < first => {
                    presses.push(([second, first], press.turned()));
                }
                _ => presses.push(([first, second], press)),
            }
        }
        presses.sort_by_key(|&(both, _)| both);
        presses.dedup_by(|(both, press), (known, sum)| {
            let is_same = both == known;
            if is_same {
                sum.join(*press);
            }
            is_same
        });
        for ([rigid, with], press) in rigid {
            self.events.push(Event::RigidPressed {
                rigid,
                with,
                at: press.at,
                normal: press.normal,
                impulse: press.impulse,
            });
        }
        self.note_changes(&presses);
        self.note_sensors();
    }

    /// Returns the contacts of soft pieces, by piece and by the object that it presses on.
    fn soft_presses(&self) -> Vec<((SoftBodyHandle, PieceId, With), Press)> {
        let mut presses = Presses::default();
        let pairs = self.nearby.nodes.list.iter();
        for pair in pairs.filter(|pair| pair.impulse.total > 0.0) {
            let id = self.rigids.id(pair.rigid);
            let rigid = &self.rigids[id];
            let with = match rigid.motion_type {
                MotionType::Fixed => With::Obstacle(id),
                MotionType::Dynamic { .. } => With::Free(id),
                _ => With::Hand(id),
            };
            let id = self.bodies.id(pair.body);
            let body = &self.bodies[id];
            let piece = body.topology.pieces.of_node(pair.node);
            let press = presses.of((id, piece, with));
            press.add(pair.impulse.total, pair.impulse.speed, || {
                let at = body.state.position[pair.node].xyz();
                [at, rigid.shape().distance(at).1]
            });
        }
        let spheres = &self.nearby.spheres;
        let pairs = self.nearby.pairs.list.iter();
        for pair in pairs.filter(|pair| pair.impulse.total > 0.0) {
            let [a, b] = pair.both(&spheres.list);
            let (body, piece) = (self.bodies.id(b.body), b.piece);
            let with = With::Piece { body, piece };
            let press = presses.of((self.bodies.id(a.body), a.piece, with));
            press.add(pair.impulse.total, pair.impulse.speed, || {
                let [at, other] = pair.spheres.map(|sphere| spheres.centres[sphere].xyz());
                let apart = at - other;
                [at, apart * (1.0 / apart.length().max(1e-9))]
            });
        }
        presses.all()
    }

    /// Returns the contacts between rigid bodies, by handles.
    fn rigid_presses(&self) -> BTreeMap<[RigidBodyHandle; 2], Press> {
        let mut presses: BTreeMap<_, Press> = BTreeMap::new();
        for touch in &self.nearby.rigids.passed {
            let both = touch.both.map(|slot| self.rigids.id(slot));
            let press = presses.entry(both).or_default();
            press.add(touch.impulse, touch.speed, || [touch.at, touch.normal]);
        }
        presses
    }

    /// Compares the contact pairs, in ascending order, with those of the last tick, and reports beginnings
    /// and ends. Pairs at rest still touch.
    fn note_changes(&mut self, presses: &[([ObjectRef; 2], Press)]) {
        let mut before = std::mem::take(&mut self.touching).into_iter().peekable();
        let (mut touching, mut ended) = (Vec::with_capacity(presses.len()), Vec::new());
        let mut leave = |both: [ObjectRef; 2], touching: &mut Vec<_>| match self.rest(both) {
            true => touching.push(both),
            false => ended.push(Event::ContactEnded { both }),
        };
        let mut began = Vec::new();
        for (both, press) in presses {
            while let Some(old) = before.next_if(|old| old < both) {
                leave(old, &mut touching);
            }
            touching.push(*both);
            if before.next_if_eq(both).is_none() {
                began.push(Event::ContactStarted {
                    both: *both,
                    at: press.at,
                    normal: press.normal,
                    speed: press.speed,
                });
            }
        }
        before.for_each(|old| leave(old, &mut touching));
        self.touching = touching;
        self.events.extend(began.into_iter().chain(ended));
    }

    /// Returns whether both participants exist and neither moves.
    fn rest(&self, both: [ObjectRef; 2]) -> bool {
        both.into_iter().all(|party| self.rests(party))
    }

    fn rests(&self, party: ObjectRef) -> bool {
        match party {
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
            inside.extend(self.within(sensor, rigid).map(|party| (sensor, party)));
        }
        let before: BTreeSet<(RigidBodyHandle, ObjectRef)> =
            std::mem::take(&mut self.inside).into_iter().collect();
        let entered = inside.difference(&before);
        let left = before.difference(&inside);
        self.events
            .extend(entered.map(|&(sensor, who)| Event::SensorEntered { sensor, who }));
        self.events
            .extend(left.map(|&(sensor, who)| Event::SensorExited { sensor, who }));
        self.inside = inside.into_iter().collect();
    }

    /// Returns the participants inside a sensor, possibly repeated.
    fn within(&self, own: RigidBodyHandle, sensor: &RigidBody) -> impl Iterator<Item = ObjectRef> {
        let shape = sensor.shape();
        let bodies = self.bodies.entries();
        let bodies = bodies.filter(|(_, body)| sensor.layers.meet(body.state.layers));
        let pieces = bodies.flat_map(move |(id, body): (SoftBodyHandle, &SoftBody<D>)| {
            let nodes = body.topology.mesh.nodes().map(|(node, _)| node);
            let inside =
                nodes.filter(|&node| shape.distance(body.state.position[node].xyz()).0 < 0.0);
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
