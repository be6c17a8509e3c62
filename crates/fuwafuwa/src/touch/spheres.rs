//! The contact spheres of all bodies: in the order in which they came to the surface, so that a tear
//! moves none; followed while they move.

use super::sphere::ContactSphere;
use crate::body::Body;
use crate::dim::Dim;
use crate::solve::Row;
use crate::vector::{dot, minus};

/// No place.
pub const NONE: u32 = u32::MAX;

/// The contact spheres of all bodies.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Spheres {
    /// Body and element of each: the order of the list, wherever it is made anew.
    keys: Vec<(u32, u32)>,
    /// Those that were first by body and element, then those that came to the surface since.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub list: Vec<ContactSphere>,
    /// The place in the list of each element's sphere, by body and element; [`NONE`] inside.
    #[cfg_attr(feature = "serde", serde(skip))]
    by_element: Vec<Vec<u32>>,
    /// Whether nothing but tears happened to bodies since it was made.
    #[cfg_attr(feature = "serde", serde(skip))]
    is_listed: bool,
    /// Places of those awake.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub awake: Vec<u32>,
    /// Where their middles are [m]; of sleepers as of the start of the tick.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub centres: Vec<Row>,
    /// Places of those that contact may ask for, and who they are.
    #[cfg_attr(feature = "serde", serde(skip))]
    close: Vec<u32>,
    #[cfg_attr(feature = "serde", serde(skip))]
    is_close: Vec<bool>,
    /// Of those: how fast they would go on if nothing touched them [m/s], and how far they came in the
    /// last substep, squared [m²].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub velocities: Vec<Row>,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub moved: Vec<f32>,
}

impl Spheres {
    /// Bodies may be anything since they were listed.
    pub fn forget(&mut self) {
        self.is_listed = false;
    }

    /// A tick begins: lists the spheres anew, where bodies may be anything, and returns then the place that
    /// each of those before has now, or [`NONE`]; else adds those that fell asleep to `changed`.
    pub fn start_tick<D: Dim>(
        &mut self,
        bodies: &[Body<D>],
        changed: &mut Vec<u32>,
    ) -> Option<Vec<u32>> {
        let places = (!self.is_listed).then(|| self.list_anew(bodies));
        self.is_listed = true;
        if places.is_some() {
            changed.clear();
        }
        let all = self.list.iter_mut().zip(&mut self.centres).zip(0..);
        for ((sphere, centre), place) in all {
            let body = &bodies[sphere.body as usize];
            let was_asleep = sphere.asleep;
            sphere.asleep = body.pieces.list[sphere.piece as usize].asleep;
            // Nobody looks after sleepers: this is where they stay.
            if sphere.asleep != was_asleep {
                changed.push(place);
            }
            if sphere.asleep && !was_asleep {
                *centre = sphere.mean::<D>(&body.position);
            }
        }
        // So that a world that was saved goes on as one that was not.
        self.close.clear();
        self.is_close.fill(false);
        self.velocities.fill([0.0; 4]);
        self.moved.fill(0.0);
        let all = 0..self.list.len() as u32;
        self.awake.clear();
        self.awake
            .extend(all.filter(|&place| !self.list[place as usize].asleep));
        places
    }

    /// Lists those known before that are there still, in their order, then the others by body and element.
    fn list_anew<D: Dim>(&mut self, bodies: &[Body<D>]) -> Vec<u32> {
        let known = std::mem::take(&mut self.keys);
        self.list.clear();
        let capacities = bodies.iter().map(|body| body.mesh.element_capacity());
        let by_element = capacities.clone().map(|capacity| vec![NONE; capacity]);
        self.by_element = by_element.collect();
        let all = (0..).zip(capacities);
        let all = all.flat_map(|(body, capacity)| (0..capacity as u32).map(move |id| (body, id)));
        for (body, id) in known.iter().copied().chain(all) {
            let by_element = self.by_element.get_mut(body as usize);
            let own = by_element.and_then(|places| places.get_mut(id as usize));
            let Some(own) = own.filter(|own| **own == NONE) else {
                continue;
            };
            if let Some(sphere) = ContactSphere::of(body, &bodies[body as usize], id) {
                *own = self.list.len() as u32;
                self.list.push(sphere);
            }
        }
        self.keys.extend(self.list.iter().map(ContactSphere::key));
        let centre = |sphere: &ContactSphere| {
            let body = &bodies[sphere.body as usize];
            sphere.mean::<D>(&body.position)
        };
        self.centres.clear();
        self.centres.extend(self.list.iter().map(centre));
        self.make_room();
        let places = known.iter().map(|&key| self.place(key));
        places.collect()
    }

    /// Keeps up with a tear of a body at elements that are gone or new, or have other nodes or other
    /// bare faces; adds the places of their spheres to `changed`.
    pub fn tear<D: Dim>(
        &mut self,
        place: u32,
        body: &Body<D>,
        elements: &[u32],
        changed: &mut Vec<u32>,
    ) {
        let by_element = &mut self.by_element[place as usize];
        by_element.resize(body.mesh.element_capacity(), NONE);
        for &id in elements {
            let Some(sphere) = ContactSphere::of(place, body, id) else {
                // What has once come to the surface stays there.
                debug_assert_eq!(by_element[id as usize], NONE);
                continue;
            };
            let own = &mut by_element[id as usize];
            if *own == NONE {
                *own = self.list.len() as u32;
                if !sphere.asleep {
                    self.awake.push(*own);
                }
                self.keys.push(sphere.key());
                self.list.push(sphere);
                self.centres.push(sphere.mean::<D>(&body.position));
            } else {
                self.list[*own as usize] = sphere;
            }
            changed.push(*own);
        }
        self.make_room();
        for sphere in self.list.iter_mut().filter(|sphere| sphere.body == place) {
            sphere.piece = body.pieces.of_element(sphere.element);
        }
    }

    /// Wakes the spheres of pieces, given by body and number in ascending order; adds their places to
    /// `changed`.
    pub fn wake(&mut self, pieces: &[(u32, u32)], changed: &mut Vec<u32>) {
        for (sphere, place) in self.list.iter_mut().zip(0..) {
            if sphere.asleep && pieces.binary_search(&(sphere.body, sphere.piece)).is_ok() {
                sphere.asleep = false;
                self.awake.push(place);
                changed.push(place);
            }
        }
    }

    /// Notes which contact may ask for in the next substeps.
    pub fn note_close(&mut self, close: impl Iterator<Item = u32>) {
        let was_close = self.is_close.clone();
        self.is_close.fill(false);
        self.close.clear();
        for place in close {
            let is_close = &mut self.is_close[place as usize];
            if !*is_close && !self.list[place as usize].asleep {
                *is_close = true;
                self.close.push(place);
            }
        }
        for &place in &self.close {
            if !was_close[place as usize] {
                self.moved[place as usize] = 0.0;
            }
        }
        self.close.sort_unstable();
    }

    /// Moves all that are awake along with the bodies.
    pub fn move_all<D: Dim>(&mut self, bodies: &[Body<D>]) {
        for at in 0..self.awake.len() {
            self.follow::<D>(self.awake[at], bodies);
        }
    }

    /// Moves those that contact may ask for along with the bodies.
    pub fn move_close<D: Dim>(&mut self, bodies: &[Body<D>]) {
        for at in 0..self.close.len() {
            self.follow::<D>(self.close[at], bodies);
        }
    }

    /// Takes the velocities of those that contact may ask for from the bodies.
    pub fn take_velocities<D: Dim>(&mut self, bodies: &[Body<D>]) {
        for &place in &self.close {
            self.velocities[place as usize] = self.velocity(place, bodies);
        }
    }

    /// How fast one moves [m/s].
    pub fn velocity<D: Dim>(&self, place: u32, bodies: &[Body<D>]) -> Row {
        let sphere = &self.list[place as usize];
        sphere.mean::<D>(&bodies[sphere.body as usize].velocity)
    }

    /// Whether their body itself holds two at their distance.
    pub fn holds(&self, a: u32, b: u32) -> bool {
        let [a, b] = [a, b].map(|place| self.list[place as usize].site());
        a.is_held_to(&b)
    }

    fn follow<D: Dim>(&mut self, place: u32, bodies: &[Body<D>]) {
        let place = place as usize;
        let sphere = &self.list[place];
        let centre = sphere.mean::<D>(&bodies[sphere.body as usize].position);
        if self.is_close[place] {
            let moved = minus(centre, self.centres[place]);
            self.moved[place] = dot(moved, moved);
        }
        self.centres[place] = centre;
    }

    fn place(&self, (body, element): (u32, u32)) -> u32 {
        let by_element = self.by_element.get(body as usize);
        let place = by_element.and_then(|places| places.get(element as usize));
        place.copied().unwrap_or(NONE)
    }

    fn make_room(&mut self) {
        self.is_close.resize(self.list.len(), false);
        self.velocities.resize(self.list.len(), [0.0; 4]);
        self.moved.resize(self.list.len(), 0.0);
    }
}
