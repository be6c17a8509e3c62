//! Contact spheres of all bodies and their motion. The spheres are listed in the order in which they appeared
//! at the surface, so a tear never renumbers spheres.

use super::contact_sphere::{ContactSphere, NEAR, SphereId};
use crate::foundation::arena::BodySlot;
use crate::foundation::copy_on_write::CopyOnWrite;
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::foundation::ids::{ElementId, IndexVec, PieceId};
use crate::foundation::threads::{self, RowChunk};
use crate::soft_body::element_forces::Row;
use crate::soft_body::{SoftBodies, SoftBody};
use crate::topology::changes::{Bookmark, Changes};

/// Time constant of the low-pass filter of the velocities of spheres [s]. In a heap at rest, a surface element
/// oscillates at up to 0.3 m/s for a single substep.
const DRIFT_TIME: f32 = 0.008;

/// Contact spheres of all bodies.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Spheres {
    /// Body and element of each sphere in `list`, stored in files. If `list` is rebuilt, the spheres keep
    /// this order.
    keys: CopyOnWrite<IndexVec<SphereId, Key>>,
    /// Contact spheres: first those of the initial surface, by body and element, then those that appeared at
    /// the surface later.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub list: IndexVec<SphereId, ContactSphere>,
    /// Sphere of each voxel, by body and voxel index; [`SphereId::NONE`] for a voxel without a sphere.
    #[cfg_attr(feature = "serde", serde(skip))]
    by_voxel: IndexVec<BodySlot, CopyOnWrite<Vec<SphereId>>>,
    /// Pairs of spheres on opposite crack faces: neighbours in a piece that only contacts keep apart.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub crack_face_pairs: CopyOnWrite<Vec<[SphereId; 2]>>,
    /// For each body, bookmark of the last change of the body that `list` includes.
    #[cfg_attr(feature = "serde", serde(skip))]
    followed: IndexVec<BodySlot, Bookmark>,
    /// Awake spheres, ascending.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub awake: Vec<SphereId>,
    /// Centres of the spheres [m]; those of sleeping spheres are updated only at the start of a tick.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub centres: IndexVec<SphereId, Row>,
    /// Close spheres, ascending: awake spheres in a pair or in an escape contact. Only close spheres are updated in
    /// every substep.
    #[cfg_attr(feature = "serde", serde(skip))]
    close: Vec<SphereId>,
    /// Whether each sphere is in `close`.
    #[cfg_attr(feature = "serde", serde(skip))]
    is_close: IndexVec<SphereId, bool>,
    /// Velocity of each close sphere in this substep, before contacts are solved [m/s].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub velocities: IndexVec<SphereId, Row>,
    /// Velocity of each close sphere [m/s], low-pass filtered: see [`Spheres::follow`].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub drift: IndexVec<SphereId, Row>,
}

/// Spheres to follow in a substep.
pub enum Followed {
    /// All awake spheres.
    Awake,
    /// The close spheres only.
    Close,
}

hash_state! {
    struct Spheres { keys } skip {
        list, by_voxel, crack_face_pairs, followed, awake, centres, close, is_close, velocities, drift,
    }
}

/// Body and element of a sphere, which identify the sphere also after its number has changed.
type Key = (BodySlot, ElementId);

impl Spheres {
    /// Returns the number of spheres at the end of the last tick.
    #[cfg(feature = "serde")]
    pub fn count_keys(&self) -> usize {
        self.keys.len()
    }

    /// Returns the body slot of a sphere. Uses only `keys`, so it works also before a new tick rebuilds
    /// `list`.
    pub fn body_of(&self, sphere: SphereId) -> BodySlot {
        self.keys[sphere].0
    }

    /// Removes the spheres of a body, so that its slot may be reused.
    pub fn remove_body(&mut self, slot: BodySlot) {
        for key in self
            .keys
            .edit()
            .iter_mut()
            .filter(|(body, _)| *body == slot)
        {
            *key = (BodySlot::NONE, ElementId(u32::MAX));
        }
        self.followed.clear();
    }

    /// Removes the spheres of `elements` of a body, given in ascending order, so that these ids may be
    /// reused.
    pub fn remove_elements(&mut self, slot: BodySlot, elements: &[ElementId]) {
        for key in self
            .keys
            .edit()
            .iter_mut()
            .filter(|(body, _)| *body == slot)
        {
            if elements.binary_search(&key.1).is_ok() {
                *key = (BodySlot::NONE, ElementId(u32::MAX));
            }
        }
        self.followed.clear();
    }

    /// Starts a tick: applies the tears since the last tick, and adds spheres that fell asleep or woke to
    /// `changed`. If a body may have changed in another way, rebuilds the list and returns the new number of
    /// each old sphere: [`SphereId::NONE`] if the sphere is gone.
    pub fn start_tick<D: Dim>(
        &mut self,
        bodies: &SoftBodies<D>,
        changed: &mut Vec<SphereId>,
    ) -> Option<IndexVec<SphereId, SphereId>> {
        let numbers = (!self.catch_up(bodies, changed)).then(|| {
            changed.clear();
            self.list_anew(bodies)
        });
        let all = self.list.entries_mut().zip(&mut self.centres);
        for ((id, sphere), centre) in all {
            let body = bodies.at(sphere.body);
            let was_asleep = sphere.asleep;
            sphere.asleep = body.pieces().list[sphere.piece].asleep;
            // Pairs of two sleeping spheres are not listed. So the pairs of a sphere that fell asleep or woke
            // are searched again.
            if sphere.asleep != was_asleep {
                changed.push(id);
            }
            // The centres of sleeping spheres are not updated during the tick, so they are computed here.
            if sphere.asleep && !was_asleep {
                *centre = sphere.mean::<D>(body.positions());
            }
        }
        // Resets the values that a file does not contain, so that a world read from a file behaves like the
        // original.
        self.close.clear();
        self.is_close.fill(false);
        self.velocities.fill(Row::ZERO);
        self.drift.fill(Row::ZERO);
        self.awake.clear();
        let all = self.list.ids();
        self.awake.extend(all.filter(|&id| !self.list[id].asleep));
        numbers
    }

    /// Updates the spheres for the tears since the last tick, and adds the affected spheres to `changed`.
    /// Returns false if a body changed in another way; the caller must then rebuild all spheres.
    fn catch_up<D: Dim>(&mut self, bodies: &SoftBodies<D>, changed: &mut Vec<SphereId>) -> bool {
        if self.followed.len() != bodies.slot_count() {
            return false;
        }
        for (slot, body) in bodies.by_slot() {
            match body.changes_since(&mut self.followed[slot]) {
                Some(changes) if changes == Changes::default() => {}
                Some(changes) => self.tear(slot, body, &changes, changed),
                None => return false,
            }
        }
        true
    }

    /// Rebuilds the list: spheres that still exist keep their order, and new spheres follow by body and
    /// element. Returns the new number of each old sphere.
    fn list_anew<D: Dim>(&mut self, bodies: &SoftBodies<D>) -> IndexVec<SphereId, SphereId> {
        let known = std::mem::take(&mut self.keys);
        self.list.clear();
        self.followed = vec![Bookmark::default(); bodies.slot_count()].into();
        for (slot, body) in bodies.by_slot() {
            self.followed[slot] = body.bookmark();
        }
        let none = |body: Option<&SoftBody<D>>| {
            let size = body.map_or([0; 3], |body| body.grid().size());
            let voxels = size.map(|extent| extent as usize);
            CopyOnWrite::from(vec![SphereId::NONE; voxels.iter().product()])
        };
        self.by_voxel = bodies.slots().map(none).collect();
        let all = bodies.by_slot().flat_map(|(slot, body)| {
            let ids = body.mesh().elements().map(|(id, _)| id);
            ids.map(move |id| (slot, id))
        });
        for (slot, id) in known.iter().copied().chain(all) {
            let body = bodies.find(slot);
            let sphere = body.and_then(|body| ContactSphere::of(slot, body, id));
            let Some((sphere, body)) = sphere.zip(body) else {
                continue;
            };
            let own = &mut self.by_voxel[slot].edit()[body.grid().index(sphere.voxel())];
            if *own == SphereId::NONE {
                *own = self.list.next_id();
                self.list.push(sphere);
            }
        }
        self.keys
            .edit()
            .extend(self.list.iter().map(ContactSphere::key));
        let centre = |sphere: &ContactSphere| {
            let body = bodies.at(sphere.body);
            sphere.mean::<D>(body.positions())
        };
        self.centres.clear();
        self.centres.extend(self.list.iter().map(centre));
        self.make_room();
        self.crack_face_pairs.edit().clear();
        for own in self.list.ids() {
            let body = bodies.at(self.list[own].body);
            self.find_crack_face_pairs(own, body, |other| other > own);
        }
        let number = |&(slot, id): &Key| {
            let (body, by_voxel) = (bodies.find(slot)?, &self.by_voxel[slot]);
            let voxel = ContactSphere::of(slot, body, id)?.voxel();
            Some(by_voxel[body.grid().index(voxel)])
        };
        let numbers = known.iter().map(number);
        numbers.map(|own| own.unwrap_or(SphereId::NONE)).collect()
    }

    /// Applies a tear of a body to the list. Adds to `changed` the spheres of elements that are new, or whose
    /// nodes or bare faces changed.
    pub fn tear<D: Dim>(
        &mut self,
        slot: BodySlot,
        body: &SoftBody<D>,
        changes: &Changes,
        changed: &mut Vec<SphereId>,
    ) {
        self.followed[slot] = body.bookmark();
        let mut touched = Vec::new();
        for &id in &changes.elements {
            let Some(sphere) = ContactSphere::of(slot, body, id) else {
                continue;
            };
            // A tear never removes a voxel from the surface. So the sphere of a voxel keeps its number if
            // another element fills the voxel.
            let own = &mut self.by_voxel[slot].edit()[body.grid().index(sphere.voxel())];
            if *own == SphereId::NONE {
                *own = self.list.next_id();
                if !sphere.asleep {
                    self.awake.push(*own);
                }
                self.keys.edit().push(sphere.key());
                self.list.push(sphere);
                self.centres.push(sphere.mean::<D>(body.positions()));
            } else {
                self.list[*own] = sphere;
            }
            touched.push(*own);
        }
        self.make_room();
        touched.sort_unstable();
        touched.dedup();
        changed.extend(&touched);
        let mut is_touched: IndexVec<SphereId, bool> = vec![false; self.list.len()].into();
        touched.iter().for_each(|&own| is_touched[own] = true);
        let is_known = |pair: &[SphereId; 2]| pair.iter().all(|&own| !is_touched[own]);
        self.crack_face_pairs.edit().retain(is_known);
        if !changes.detached.is_empty() {
            for sphere in self.list.iter_mut().filter(|sphere| sphere.body == slot) {
                sphere.piece = body.pieces().of_element(sphere.element);
            }
            let list = &self.list;
            let piece = |own: SphereId| (list[own].body, list[own].piece);
            self.crack_face_pairs
                .edit()
                .retain(|&[a, b]| piece(a) == piece(b));
        }
        for own in touched {
            self.find_crack_face_pairs(own, body, |other| !is_touched[other] || other > own);
        }
    }

    /// Adds to `crack_face_pairs` the pairs of a sphere with those near spheres of its piece that no elastic
    /// force keeps apart from it. Tests only spheres for which `applies` is true.
    fn find_crack_face_pairs<D: Dim>(
        &mut self,
        id: SphereId,
        body: &SoftBody<D>,
        applies: impl Fn(SphereId) -> bool,
    ) {
        let own = &self.list[id];
        let (site, voxel, size) = (own.site(), own.voxel(), body.grid().size());
        let by_voxel = &self.by_voxel[own.body];
        let near = i32::from(NEAR);
        let low = [0, 1, 2].map(|axis: usize| (voxel[axis] - near).max(0));
        let high = [0, 1, 2].map(|axis: usize| (voxel[axis] + near).min(size[axis] - 1));
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                let row = body.grid().index([low[0], y, z])..=body.grid().index([high[0], y, z]);
                let others = by_voxel[row].iter().copied();
                for other in others.filter(|&other| other != SphereId::NONE && applies(other)) {
                    let sphere = &self.list[other];
                    let is_held = other == id || site.is_held_to(&sphere.site());
                    if !is_held && sphere.piece == own.piece {
                        self.crack_face_pairs.edit().push([id, other]);
                    }
                }
            }
        }
    }

    /// Wakes the spheres of `pieces` and adds them to `changed`. `pieces` holds body slots and piece numbers
    /// in ascending order.
    pub fn wake(&mut self, pieces: &[(BodySlot, PieceId)], changed: &mut Vec<SphereId>) {
        for (id, sphere) in self.list.entries_mut() {
            if sphere.asleep && pieces.binary_search(&(sphere.body, sphere.piece)).is_ok() {
                sphere.asleep = false;
                self.awake.push(id);
                changed.push(id);
            }
        }
        self.awake.sort_unstable();
    }

    /// Sets the close spheres: those in pairs or escape contacts, whose centres and velocities are updated in
    /// each substep.
    pub fn set_close(&mut self, close: impl Iterator<Item = SphereId>) {
        let was_close = self.is_close.clone();
        self.is_close.fill(false);
        close.for_each(|id| self.is_close[id] = true);
        self.close.clear();
        let all = { self.is_close.entries_mut() }
            .zip(&self.list)
            .zip(&mut self.drift);
        for (((id, is_close), sphere), drift) in all.filter(|all| *all.0.0.1) {
            *is_close = !sphere.asleep;
            if *is_close {
                self.close.push(id);
            }
            if *is_close && !was_close[id] {
                *drift = Row::ZERO;
            }
        }
    }

    /// Updates the centres of the `followed` spheres after a substep of `duration` [s], and the filtered velocities of those
    /// that are close. The filter uses displacements: velocities at this time have not yet been corrected by contacts.
    pub fn follow<D: Dim>(&mut self, followed: Followed, bodies: &SoftBodies<D>, duration: f32) {
        let (list, is_close) = (&self.list, &self.is_close);
        let spheres = match followed {
            Followed::Awake => &self.awake,
            Followed::Close => &self.close,
        };
        let lists = [&mut self.centres, &mut self.drift].map(|rows| rows.as_mut_slice());
        let rows = threads::rows(spheres, lists);
        threads::map(rows, |RowChunk { ids, first, lists }| {
            let [centres, drifts] = lists;
            for &id in ids {
                let (sphere, row) = (&list[id], id.index() - first);
                let centre = sphere.mean::<D>(bodies.at(sphere.body).positions());
                if is_close[id] {
                    let drift = &mut drifts[row];
                    let moved = centre - centres[row];
                    *drift += (moved - *drift * duration) * (1.0 / (DRIFT_TIME + duration));
                }
                centres[row] = centre;
            }
        });
    }

    /// Copies the velocities of the close spheres from the bodies.
    pub fn take_velocities<D: Dim>(&mut self, bodies: &SoftBodies<D>) {
        let list = &self.list;
        let rows = threads::rows(&self.close, [self.velocities.as_mut_slice()]);
        threads::map(rows, |RowChunk { ids, first, lists }| {
            let [velocities] = lists;
            for &id in ids {
                velocities[id.index() - first] = list[id].velocity(bodies);
            }
        });
    }

    /// Returns the velocity of a sphere [m/s]: the mean velocity of its corner nodes.
    pub fn velocity<D: Dim>(&self, id: SphereId, bodies: &SoftBodies<D>) -> Row {
        self.list[id].velocity(bodies)
    }

    /// Returns whether elastic forces keep two spheres apart, so that no contact is required.
    pub fn holds(&self, a: SphereId, b: SphereId) -> bool {
        let [a, b] = [a, b].map(|id| self.list[id].site());
        a.is_held_to(&b)
    }

    fn make_room(&mut self) {
        self.is_close.resize(self.list.len(), false);
        self.velocities.resize(self.list.len(), Row::ZERO);
        self.drift.resize(self.list.len(), Row::ZERO);
    }
}
