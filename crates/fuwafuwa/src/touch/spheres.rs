//! The contact spheres of all bodies: in the order in which they came to the surface, so that a tear
//! moves none; followed while they move.

use super::sphere::{ContactSphere, NEAR};
use crate::body::{Bodies, Body};
use crate::changes::{Bookmark, Changes};
use crate::dim::Dim;
use crate::ids::{ElementId, PieceId};
use crate::solve::Row;
use crate::vector::{dot, minus};

/// No place.
pub const NONE: u32 = u32::MAX;

/// The contact spheres of all bodies.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Spheres {
    /// Body and element of each: the order of the list, wherever it is made anew.
    keys: Vec<(u32, ElementId)>,
    /// Those that were first by body and element, then those that came to the surface since.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub list: Vec<ContactSphere>,
    /// The place in the list of each voxel's sphere, by body and place of the voxel; [`NONE`] inside.
    #[cfg_attr(feature = "serde", serde(skip))]
    by_voxel: Vec<Vec<u32>>,
    /// The pairs that are lips of a crack: neighbours in one piece, and yet not held by it.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub lips: Vec<[u32; 2]>,
    /// Up to where the body at each place has been followed.
    #[cfg_attr(feature = "serde", serde(skip))]
    followed: Vec<Bookmark>,
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
    /// How many were known at the end of the last tick.
    #[cfg(feature = "serde")]
    pub fn count_keys(&self) -> usize {
        self.keys.len()
    }

    /// The place of the body of a sphere; also while they are not listed.
    pub fn body_of(&self, sphere: u32) -> u32 {
        self.keys[sphere as usize].0
    }

    /// A body was taken out: who comes to its place is somebody else.
    pub fn remove_body(&mut self, place: u32) {
        for key in self.keys.iter_mut().filter(|(body, _)| *body == place) {
            *key = (NONE, ElementId(NONE));
        }
        self.followed.clear();
    }

    /// A tick begins: keeps up with what tore since the last one, and adds who fell asleep to `changed`; where bodies
    /// may be anything, lists the spheres anew, and returns then the place that each of those before has now, or
    /// [`NONE`].
    pub fn start_tick<D: Dim>(
        &mut self,
        bodies: &Bodies<D>,
        changed: &mut Vec<u32>,
    ) -> Option<Vec<u32>> {
        let places = (!self.catch_up(bodies, changed)).then(|| {
            changed.clear();
            self.list_anew(bodies)
        });
        let all = self.list.iter_mut().zip(&mut self.centres).zip(0..);
        for ((sphere, centre), place) in all {
            let body = bodies.at(sphere.body);
            let was_asleep = sphere.asleep;
            sphere.asleep = body.truth.pieces.list[sphere.piece].asleep;
            // Nobody looks after sleepers: this is where they stay.
            if sphere.asleep != was_asleep {
                changed.push(place);
            }
            if sphere.asleep && !was_asleep {
                *centre = sphere.mean::<D>(&body.state.position);
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

    /// Keeps up with what tore between two ticks; returns false where that is not all that happened.
    fn catch_up<D: Dim>(&mut self, bodies: &Bodies<D>, changed: &mut Vec<u32>) -> bool {
        if self.followed.len() != bodies.place_count() {
            return false;
        }
        for (place, body) in bodies.placed() {
            match body.changes_since(&mut self.followed[place as usize]) {
                Some(changes) if changes == Changes::default() => {}
                Some(changes) => self.tear(place, body, &changes, changed),
                None => return false,
            }
        }
        true
    }

    /// Lists those known before that are there still, in their order, then the others by body and element.
    fn list_anew<D: Dim>(&mut self, bodies: &Bodies<D>) -> Vec<u32> {
        let known = std::mem::take(&mut self.keys);
        self.list.clear();
        self.followed = vec![Bookmark::default(); bodies.place_count()];
        for (place, body) in bodies.placed() {
            self.followed[place as usize] = body.bookmark();
        }
        let none = |body: Option<&Body<D>>| {
            let size = body.map_or([0; 3], |body| body.truth.grid.size());
            let voxels = size.map(|extent| extent as usize);
            vec![NONE; voxels.iter().product()]
        };
        self.by_voxel = bodies.places().map(none).collect();
        let all = bodies.placed().flat_map(|(place, body)| {
            let ids = body.truth.mesh.elements().map(|(id, _)| id);
            ids.map(move |id| (place, id))
        });
        for (place, id) in known.iter().copied().chain(all) {
            let body = bodies.find(place);
            let sphere = body.and_then(|body| ContactSphere::of(place, body, id));
            let Some((sphere, body)) = sphere.zip(body) else {
                continue;
            };
            let own = &mut self.by_voxel[place as usize][body.truth.grid.index(sphere.voxel())];
            if *own == NONE {
                *own = self.list.len() as u32;
                self.list.push(sphere);
            }
        }
        self.keys.extend(self.list.iter().map(ContactSphere::key));
        let centre = |sphere: &ContactSphere| {
            let body = bodies.at(sphere.body);
            sphere.mean::<D>(&body.state.position)
        };
        self.centres.clear();
        self.centres.extend(self.list.iter().map(centre));
        self.make_room();
        self.lips.clear();
        for place in 0..self.list.len() as u32 {
            let body = bodies.at(self.list[place as usize].body);
            self.find_lips(place, body, |other| other > place);
        }
        let place = |&(body, id): &(u32, ElementId)| {
            let (at, by_voxel) = (bodies.find(body)?, &self.by_voxel[body as usize]);
            Some(
                by_voxel[at
                    .truth
                    .grid
                    .index(ContactSphere::of(body, at, id)?.voxel())],
            )
        };
        let places = known.iter().map(|key| place(key).unwrap_or(NONE));
        places.collect()
    }

    /// Keeps up with a tear of a body; adds the places of the spheres whose elements are new, or have other
    /// nodes or other bare faces, to `changed`.
    pub fn tear<D: Dim>(
        &mut self,
        place: u32,
        body: &Body<D>,
        changes: &Changes,
        changed: &mut Vec<u32>,
    ) {
        self.followed[place as usize] = body.bookmark();
        let mut touched = Vec::new();
        for &id in &changes.elements {
            let Some(sphere) = ContactSphere::of(place, body, id) else {
                continue;
            };
            // What has once come to the surface stays there.
            let own = &mut self.by_voxel[place as usize][body.truth.grid.index(sphere.voxel())];
            if *own == NONE {
                *own = self.list.len() as u32;
                if !sphere.asleep {
                    self.awake.push(*own);
                }
                self.keys.push(sphere.key());
                self.list.push(sphere);
                self.centres.push(sphere.mean::<D>(&body.state.position));
            } else {
                self.list[*own as usize] = sphere;
            }
            touched.push(*own);
        }
        self.make_room();
        touched.sort_unstable();
        touched.dedup();
        changed.extend(&touched);
        let mut is_touched = vec![false; self.list.len()];
        touched
            .iter()
            .for_each(|&own| is_touched[own as usize] = true);
        let is_known = |lips: &[u32; 2]| lips.iter().all(|&own| !is_touched[own as usize]);
        self.lips.retain(is_known);
        if !changes.parted.is_empty() {
            for sphere in self.list.iter_mut().filter(|sphere| sphere.body == place) {
                sphere.piece = body.truth.pieces.of_element(sphere.element);
            }
            let list = &self.list;
            let piece = |own: u32| (list[own as usize].body, list[own as usize].piece);
            self.lips.retain(|&[a, b]| piece(a) == piece(b));
        }
        for own in touched {
            self.find_lips(own, body, |other| {
                !is_touched[other as usize] || other > own
            });
        }
    }

    /// Adds the lips that a sphere is one of, with those others that a condition holds for.
    fn find_lips<D: Dim>(&mut self, place: u32, body: &Body<D>, applies: impl Fn(u32) -> bool) {
        let own = &self.list[place as usize];
        let (site, voxel, size) = (own.site(), own.voxel(), body.truth.grid.size());
        let by_voxel = &self.by_voxel[own.body as usize];
        let near = i32::from(NEAR);
        let low = [0, 1, 2].map(|axis: usize| (voxel[axis] - near).max(0));
        let high = [0, 1, 2].map(|axis: usize| (voxel[axis] + near).min(size[axis] - 1));
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                let row =
                    body.truth.grid.index([low[0], y, z])..=body.truth.grid.index([high[0], y, z]);
                let others = by_voxel[row].iter().copied();
                for other in others.filter(|&other| other != NONE && applies(other)) {
                    let sphere = &self.list[other as usize];
                    let is_held = other == place || site.is_held_to(&sphere.site());
                    if !is_held && sphere.piece == own.piece {
                        self.lips.push([place, other]);
                    }
                }
            }
        }
    }

    /// Wakes the spheres of pieces, given by body and number in ascending order; adds their places to
    /// `changed`.
    pub fn wake(&mut self, pieces: &[(u32, PieceId)], changed: &mut Vec<u32>) {
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
        close.for_each(|place| self.is_close[place as usize] = true);
        self.close.clear();
        let all = self
            .is_close
            .iter_mut()
            .zip(&self.list)
            .zip(&mut self.moved);
        for (place, ((is_close, sphere), moved)) in all.enumerate().filter(|(_, all)| *all.0.0) {
            *is_close = !sphere.asleep;
            if *is_close {
                self.close.push(place as u32);
            }
            if *is_close && !was_close[place] {
                *moved = 0.0;
            }
        }
    }

    /// Moves all that are awake along with the bodies.
    pub fn move_all<D: Dim>(&mut self, bodies: &Bodies<D>) {
        for at in 0..self.awake.len() {
            self.follow::<D>(self.awake[at], bodies);
        }
    }

    /// Moves those that contact may ask for along with the bodies.
    pub fn move_close<D: Dim>(&mut self, bodies: &Bodies<D>) {
        for at in 0..self.close.len() {
            self.follow::<D>(self.close[at], bodies);
        }
    }

    /// Takes the velocities of those that contact may ask for from the bodies.
    pub fn take_velocities<D: Dim>(&mut self, bodies: &Bodies<D>) {
        for &place in &self.close {
            self.velocities[place as usize] = self.velocity(place, bodies);
        }
    }

    /// How fast one moves [m/s].
    pub fn velocity<D: Dim>(&self, place: u32, bodies: &Bodies<D>) -> Row {
        let sphere = &self.list[place as usize];
        sphere.mean::<D>(&bodies.at(sphere.body).state.velocity)
    }

    /// Whether their body itself holds two at their distance.
    pub fn holds(&self, a: u32, b: u32) -> bool {
        let [a, b] = [a, b].map(|place| self.list[place as usize].site());
        a.is_held_to(&b)
    }

    fn follow<D: Dim>(&mut self, place: u32, bodies: &Bodies<D>) {
        let place = place as usize;
        let sphere = &self.list[place];
        let centre = sphere.mean::<D>(&bodies.at(sphere.body).state.position);
        if self.is_close[place] {
            let moved = minus(centre, self.centres[place]);
            self.moved[place] = dot(moved, moved);
        }
        self.centres[place] = centre;
    }

    fn make_room(&mut self) {
        self.is_close.resize(self.list.len(), false);
        self.velocities.resize(self.list.len(), [0.0; 4]);
        self.moved.resize(self.list.len(), 0.0);
    }
}
