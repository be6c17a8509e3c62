//! What stands in a world: put in, taken out, changed and looked at from outside.

use super::{Obstacle, Refused, Settings, TICK, World};
use crate::blade::{Blade, CutReport};
use crate::body::Body;
use crate::contact::Hit;
use crate::dim::Dim;
use crate::event::Event;
use crate::fracture::Cooldowns;
use crate::hash::Hash;
use crate::manipulator::{Manipulator, is_place};
use crate::shape::{Shape, Vector};
use crate::touch::Nearby;

impl<D: Dim> World<D> {
    /// Puts a body into the world; returns its place among the bodies. A body that is too stiff
    /// for the most substeps allowed is softened: see [`Body::stiffness_scale`].
    #[inline(never)]
    pub fn add_body(&mut self, mut body: Body<D>) -> usize {
        let shortest = f64::from(TICK) / f64::from(self.settings.most_substeps);
        body.scale_stiffness_for(shortest);
        self.bodies.push(body);
        self.nearby.spheres.forget();
        self.cooldowns.push(Cooldowns::default());
        let place = self.bodies.len() - 1;
        // It may have fallen asleep elsewhere.
        let pieces = self.pieces_of(place);
        self.wake(&pieces);
        place
    }

    /// Puts a rigid shape into the world; returns its place among the obstacles. In the plane its
    /// third coordinates do not count.
    ///
    /// # Errors
    /// [`Refused`] when the shape is not one, or friction is negative or not finite.
    #[inline(never)]
    pub fn add_obstacle(&mut self, shape: Shape, friction: f32) -> Result<usize, Refused> {
        let shape = shape.seen_in::<D>();
        shape.check().map_err(Refused::Shape)?;
        if !(0.0..=f32::MAX).contains(&friction) {
            return Err(Refused::Friction(friction));
        }
        self.obstacles.push(Obstacle { shape, friction });
        // Places of the hands among the colliders move up.
        self.nearby.nodes.list.clear();
        Ok(self.obstacles.len() - 1)
    }

    /// Puts a hand into the world; returns its place among the manipulators.
    ///
    /// # Errors
    /// [`Refused::Manipulator`] when a field of it is out of range.
    #[inline(never)]
    pub fn add_manipulator(&mut self, mut manipulator: Manipulator) -> Result<usize, Refused> {
        manipulator.check().map_err(Refused::Manipulator)?;
        let hand = &mut manipulator;
        let places = [&mut hand.position, &mut hand.goal, &mut hand.goal_before];
        let others = [&mut hand.position_before, &mut hand.velocity];
        for vector in places.into_iter().chain(others) {
            vector[D::N..].fill(0.0);
        }
        self.manipulators.push(manipulator);
        Ok(self.manipulators.len() - 1)
    }

    /// Sends a hand to a goal [m], where it is to be at the end of the next tick. Returns false,
    /// and leaves the goal as it is, when that is no place or one beyond
    /// [`FARTHEST`](crate::manipulator::FARTHEST).
    ///
    /// # Panics
    /// When there is no such manipulator.
    pub fn set_goal(&mut self, manipulator: usize, goal: Vector) -> bool {
        let good = is_place(goal);
        if good {
            let hand = &mut self.manipulators[manipulator];
            hand.goal[..D::N].copy_from_slice(&goal[..D::N]);
        }
        good
    }

    /// Cuts a body along a blade at once, whatever it bears; returns how many nodes were released.
    /// They and what came off stand among the events until the next tick.
    ///
    /// # Panics
    /// When there is no such body.
    #[inline(never)]
    pub fn cut(&mut self, body: usize, blade: &Blade) -> usize {
        let pieces = self.pieces_of(body);
        self.wake(&pieces);
        self.nearby.spheres.forget();
        let cut = self.bodies[body].cut(blade);
        let CutReport { released, parted } = cut.expect("a release leaves the mesh whole");
        let (body, energy) = (body as u32, 0.0);
        let places = released.iter();
        let releases = places.map(|&at| Event::Released { body, at, energy });
        self.events.extend(releases);
        let parts = parted.iter().map(|&piece| Event::Parted { body, piece });
        self.events.extend(parts);
        released.len()
    }

    /// Its settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Its bodies.
    pub fn bodies(&self) -> &[Body<D>] {
        &self.bodies
    }

    /// A body, to be changed from outside: held, placed, cut. All of it wakes. Another body in its
    /// place would not be softened: remove the one and add the other.
    ///
    /// # Panics
    /// When there is no such body.
    #[inline(never)]
    pub fn body_mut(&mut self, body: usize) -> &mut Body<D> {
        let pieces = self.pieces_of(body);
        self.wake(&pieces);
        self.nearby.spheres.forget();
        &mut self.bodies[body]
    }

    /// Takes a body out of the world; the places of those after it move down by one. Everything
    /// wakes: it may have leant on it.
    ///
    /// # Panics
    /// When there is no such body.
    #[inline(never)]
    pub fn remove_body(&mut self, body: usize) -> Body<D> {
        self.cooldowns.remove(body);
        let removed = self.bodies.remove(body);
        self.start_contacts_anew();
        removed
    }

    /// Takes a rigid shape out of the world, as [`World::remove_body`].
    ///
    /// # Panics
    /// When there is no such obstacle.
    #[inline(never)]
    pub fn remove_obstacle(&mut self, obstacle: usize) -> Obstacle {
        let removed = self.obstacles.remove(obstacle);
        self.start_contacts_anew();
        removed
    }

    /// Takes a hand out of the world, as [`World::remove_body`].
    ///
    /// # Panics
    /// When there is no such manipulator.
    #[inline(never)]
    pub fn remove_manipulator(&mut self, manipulator: usize) -> Manipulator {
        let removed = self.manipulators.remove(manipulator);
        self.start_contacts_anew();
        removed
    }

    /// The rigid shapes.
    pub fn obstacles(&self) -> &[Obstacle] {
        &self.obstacles
    }

    /// The hands.
    pub fn manipulators(&self) -> &[Manipulator] {
        &self.manipulators
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
        for body in &self.bodies {
            for (id, _) in body.mesh.nodes() {
                let (at, speed) = (body.position[id as usize], body.velocity[id as usize]);
                hash.add(u64::from(body.pieces.of_node(id)));
                for value in at.iter().chain(&speed) {
                    hash.add(u64::from(value.to_bits()));
                }
            }
        }
        for hand in &self.manipulators {
            for value in hand.position.iter().chain(&hand.velocity) {
                hash.add(u64::from(value.to_bits()));
            }
        }
        hash.number()
    }

    /// What could not have come about by [`World::new`] and by adding things, if anything.
    #[cfg(feature = "serde")]
    pub(crate) fn defect(&self) -> Option<&'static str> {
        let are_sound = { self.obstacles.iter() }.all(|obstacle| {
            obstacle.shape.check().is_ok() && (0.0..=f32::MAX).contains(&obstacle.friction)
        });
        let checks = [
            (
                "its settings are out of range",
                Self::new(self.settings).is_ok(),
            ),
            ("an obstacle cannot be", are_sound),
            (
                "a hand cannot be",
                { self.manipulators.iter() }.all(|hand| hand.check().is_ok()),
            ),
            (
                "it has cooldowns for other bodies",
                self.cooldowns.len() == self.bodies.len(),
            ),
        ];
        let wrong = checks.into_iter().find(|(_, is_good)| !is_good);
        wrong.map(|(defect, _)| defect)
    }

    /// Works out what is not saved.
    #[cfg(feature = "serde")]
    pub(crate) fn rebuild(&mut self) {
        self.bodies.iter_mut().for_each(Body::rebuild);
    }

    /// All pieces of a body.
    fn pieces_of(&self, body: usize) -> Vec<Hit> {
        let pieces = 0..self.bodies[body].pieces.list.len() as u32;
        pieces.map(|piece| (body as u32, piece)).collect()
    }

    /// Forgets what touched what, for things have other places now, and wakes all.
    fn start_contacts_anew(&mut self) {
        self.nearby = Nearby::default();
        let all: Vec<Hit> = (0..self.bodies.len())
            .flat_map(|body| self.pieces_of(body))
            .collect();
        self.wake(&all);
    }
}
