//! What stands in a world: put in, taken out, changed and looked at from outside.

use super::{Refused, Settings, World};
use crate::blade::{Blade, CutReport};
use crate::body::{Bodies, Body};
use crate::changes::History;
use crate::contact::Hit;
use crate::dim::Dim;
use crate::event::Event;
use crate::handle::{BodyId, Gone, RigidId, RigidSlot};
use crate::hash::Hash;
#[cfg(feature = "serde")]
use crate::joint::Joint;
#[cfg(feature = "serde")]
use crate::knife::Knife;
use crate::rigid::{Drive, Rigid, Rigids};
use crate::rotation::Rotation;
use crate::shape::{Bounds, Vector};
use crate::touch::{bounds_of, leaning_on_body, leaning_on_rigid, sleeping_in};

/// A world that was saved is no older than this: none lives for a thousand million years.
#[cfg(feature = "serde")]
const MOST_TICKS: u64 = 1 << 60;

impl<D: Dim> World<D> {
    /// Puts a body into the world. One that is too stiff for the most substeps allowed is softened: see
    /// [`Body::stiffness_scale`].
    #[inline(never)]
    pub fn add_body(&mut self, mut body: Body<D>) -> BodyId {
        body.scale_stiffness_for(self.settings.shortest_substep());
        let id = self.bodies.insert(body);
        // It may have fallen asleep elsewhere.
        self.wake_body(id);
        id
    }

    /// Puts a hand, an obstacle or something free into the world. In the plane its third coordinates do not count.
    ///
    /// # Errors
    /// [`Refused::Rigid`] when a field of it is out of range.
    #[inline(never)]
    pub fn add_rigid(&mut self, rigid: Rigid) -> Result<RigidId, Refused> {
        let rigid = rigid.seen_in::<D>();
        rigid.check()?;
        Ok(self.rigids.insert(rigid))
    }

    /// Sends a hand to a goal [m], where it is to be at the end of the next tick.
    ///
    /// # Errors
    /// [`Refused`], and the goal stays as it was, when that is not finite or beyond
    /// [`FARTHEST`](crate::rigid::FARTHEST), or when there is no such hand.
    pub fn set_goal(&mut self, hand: RigidId, goal: Vector) -> Result<(), Refused> {
        Ok(self.rigids.get_mut(hand)?.send::<D>(goal)?)
    }

    /// Lets what follows a goal turn, too, until it is at the end of the next tick as `rotation` says; in the plane about
    /// the third axis alone.
    ///
    /// # Errors
    /// [`Refused`], and the goal stays as it was, when there is no such thing or its drive is another one.
    pub fn set_goal_rotation(&mut self, rigid: RigidId, rotation: Rotation) -> Result<(), Refused> {
        Ok(self.rigids.get_mut(rigid)?.turn_to::<D>(rotation)?)
    }

    /// Cuts a body along a blade at once, whatever it bears; returns how many nodes were released.
    /// They and what came off stand among the events until the next tick.
    ///
    /// # Errors
    /// [`Gone`] when there is no such body.
    #[inline(never)]
    pub fn cut(&mut self, body: BodyId, blade: &Blade) -> Result<usize, Gone> {
        self.bodies.get(body)?;
        self.wake_body(body);
        let cut = self.bodies.get_mut(body)?.cut(blade);
        let CutReport { released, parted } = cut.expect("a release leaves the mesh whole");
        let energy = 0.0;
        let positions = released.iter();
        let releases = positions.map(|&at| Event::Released { body, at, energy });
        self.events.extend(releases);
        self.events.extend(Event::parted(body, &parted));
        Ok(released.len())
    }

    /// A body, to be changed from outside: held, placed, cut. All of it wakes, and who follows it by a bookmark begins
    /// anew. Another body in its
    /// place would not be softened: remove the one and add the other.
    ///
    /// # Errors
    /// [`Gone`] when there is no such body.
    #[inline(never)]
    pub fn body_mut(&mut self, body: BodyId) -> Result<&mut Body<D>, Gone> {
        self.bodies.get(body)?;
        self.wake_body(body);
        let body = self.bodies.get_mut(body)?;
        // More may happen to it than tears.
        body.cache.history = History::default();
        Ok(body)
    }

    /// Takes a body out of the world. All others stay as and what they are; those that leant on it wake.
    ///
    /// # Errors
    /// [`Gone`] when there is no such body.
    #[inline(never)]
    pub fn remove_body(&mut self, body: BodyId) -> Result<Body<D>, Gone> {
        let removed = self.bodies.remove(body)?;
        self.nearby.remove_body(body.slot());
        let leaning = leaning_on_body(&removed, &self.bodies);
        self.wake_leaning(leaning, bounds_of(&removed, |_| true));
        Ok(removed)
    }

    /// Takes a hand or an obstacle out of the world, as [`World::remove_body`].
    ///
    /// # Errors
    /// [`Gone`] when there is no such thing.
    #[inline(never)]
    pub fn remove_rigid(&mut self, rigid: RigidId) -> Result<Rigid, Gone> {
        let removed = self.rigids.remove(rigid)?;
        self.nearby.remove_rigid(rigid.slot());
        let leaning = leaning_on_rigid(&removed, &self.bodies);
        self.wake_leaning(leaning, vec![removed.shape().bounds()]);
        Ok(removed)
    }

    /// Its settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Its bodies.
    pub fn bodies(&self) -> &Bodies<D> {
        &self.bodies
    }

    /// Everything rigid: obstacles and hands.
    pub fn rigids(&self) -> &Rigids {
        &self.rigids
    }

    /// What is rigid and stands still.
    pub fn obstacles(&self) -> impl Iterator<Item = &Rigid> + Clone {
        self.rigids
            .iter()
            .filter(|rigid| rigid.drive == Drive::Fixed)
    }

    /// What is rigid and follows goals, by handle.
    pub fn hands(&self) -> impl Iterator<Item = (RigidId, &Rigid)> + Clone {
        self.rigids.entries().filter(|(_, rigid)| rigid.is_driven())
    }

    /// The handle of the body that is so many after the first one.
    pub fn nth_body(&self, n: usize) -> Option<BodyId> {
        self.bodies.ids().nth(n)
    }

    /// The handle of the hand that is so many after the first one.
    pub fn nth_hand(&self, n: usize) -> Option<RigidId> {
        self.hands().map(|(id, _)| id).nth(n)
    }

    /// What happened in the last tick.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Ticks since the beginning.
    pub fn ticks(&self) -> u64 {
        self.ticks
    }

    /// A number that two worlds share only when every node and hand of them is in the same state,
    /// to the last bit.
    #[inline(never)]
    pub fn hash(&self) -> u64 {
        let mut hash = Hash::NONE;
        hash.add(self.ticks);
        for body in self.bodies.iter() {
            for (id, _) in body.truth.mesh.nodes() {
                let (at, speed) = (body.state.position[id], body.state.velocity[id]);
                hash.add(u64::from(body.truth.pieces.of_node(id).0));
                for value in at.iter().chain(&speed) {
                    hash.add(u64::from(value.to_bits()));
                }
            }
        }
        for rigid in self
            .rigids
            .iter()
            .filter(|rigid| rigid.drive != Drive::Fixed)
        {
            for value in rigid.position.iter().chain(&rigid.velocity) {
                hash.add(u64::from(value.to_bits()));
            }
            if rigid.is_free() {
                let turned = rigid.rotation.quaternion();
                for value in turned.iter().chain(&rigid.spin) {
                    hash.add(u64::from(value.to_bits()));
                }
            }
        }
        hash.number()
    }

    /// What could not have come about by [`World::new`] and by adding things, if anything.
    #[cfg(feature = "serde")]
    pub(crate) fn defect(&self) -> Option<&'static str> {
        let is_sound =
            |rigid: &Rigid| rigid.check().is_ok() && rigid.clone().seen_in::<D>() == *rigid;
        let checks = [
            (
                "its settings are out of range",
                Self::new(self.settings).is_ok(),
            ),
            (
                "something rigid in it cannot be",
                self.rigids.iter().all(is_sound),
            ),
            (
                "a joint in it cannot be",
                self.joints.iter().all(Joint::is_sound::<D>),
            ),
            (
                "a knife in it cannot be",
                self.knives.iter().all(Knife::is_sound::<D>),
            ),
            ("it is older than can be", self.ticks <= MOST_TICKS),
        ];
        let wrong = checks.into_iter().find(|(_, is_good)| !is_good);
        wrong.map(|(defect, _)| defect)
    }

    /// Works out what is not saved.
    #[cfg(feature = "serde")]
    pub(crate) fn rebuild(&mut self) {
        self.bodies.iter_mut().for_each(Body::restore);
        self.nearby.keep_known(&self.bodies, &self.rigids);
        self.touching.sort_unstable();
        self.touching.dedup();
        self.inside.sort_unstable();
        self.inside.dedup();
    }

    /// Wakes pieces that leant on something, given in ascending order, and what is free and rigid where it was or where they
    /// are, and so on: of those the boxes tell, so that some may wake who only were near.
    pub(super) fn wake_leaning(&mut self, leaning: Vec<Hit>, was: Vec<Bounds>) {
        let (mut pieces, mut places) = (leaning, was);
        loop {
            for (slot, body) in self.bodies.by_slot() {
                let is_one = |piece| pieces.binary_search(&(slot, piece)).is_ok();
                if pieces.iter().any(|&(own, _)| own == slot) {
                    places.extend(bounds_of(body, is_one));
                }
            }
            self.wake(&pieces);
            let woken = sleeping_in::<D>(&places, &self.rigids);
            if woken.is_empty() {
                return;
            }
            self.wake_rigids(&woken);
            let woken = woken.iter().map(|&slot| self.rigids.at(slot));
            places = woken.clone().map(|rigid| rigid.shape().bounds()).collect();
            let leaning = woken.map(|rigid| leaning_on_rigid(rigid, &self.bodies));
            pieces = leaning.flatten().collect();
            pieces.sort_unstable();
        }
    }

    /// Wakes whatever is free.
    pub(super) fn wake_all_rigids(&mut self) {
        let sleepers = self.rigids.by_slot().filter(|(_, rigid)| rigid.is_asleep());
        let sleepers: Vec<RigidSlot> = sleepers.map(|(slot, _)| slot).collect();
        self.wake_rigids(&sleepers);
        // What is soft and lies on them may be left hanging.
        for slot in sleepers {
            let leaning = leaning_on_rigid(self.rigids.at(slot), &self.bodies);
            self.wake(&leaning);
        }
    }

    /// Wakes all pieces of a body.
    pub(super) fn wake_body(&mut self, body: BodyId) {
        let pieces = self.bodies[body].truth.pieces.list.ids();
        let pieces: Vec<Hit> = pieces.map(|piece| (body.slot(), piece)).collect();
        self.wake(&pieces);
    }
}
