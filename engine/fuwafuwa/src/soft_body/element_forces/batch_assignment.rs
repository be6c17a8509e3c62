//! Assignment of elements to batches and lanes, and its update after a remodelling.

use super::batch::{ALL_LANES, Batch, BatchKey, BatchKind, VACANT};
use super::force_kernel::{class_data_len, class_data_per_node, symmetric};
use super::internal_state::{InternalLanes, InternalState};
use super::{ElementBatches, PAD};
use crate::foundation::dim::Dim;
use crate::foundation::id_lists::ascending;
use crate::foundation::ids::{ElementId, NodeId};
use crate::math::lanes::LANES;
use crate::soft_body::element_law::Law;
use crate::topology::element_class::ElementClass;
use crate::topology::grid::VoxelGrid;
use crate::topology::mesh::{Element, Mesh};
use std::collections::BTreeMap;
use std::ops::Range;

impl<D: Dim> ElementBatches<D> {
    /// Updates the batches after a remodelling. Removes the elements `removed`. Adds `changed_elements`,
    /// or assigns them again if a batch already contains them. `asleep` returns whether an element sleeps.
    /// The cost is proportional to the number of these elements.
    pub fn update(
        &mut self,
        mesh: &Mesh<D>,
        grid: &VoxelGrid<D>,
        removed: &[ElementId],
        changed_elements: &[ElementId],
        asleep: impl Fn(ElementId) -> bool,
    ) {
        let pending = |&id: &ElementId| {
            let element = mesh.element(id).expect("changed elements are alive");
            let material = grid.material(mesh.first_voxel(element));
            self.pending(id, element, material, asleep(id))
        };
        let pending_elements: Vec<PendingElement> = changed_elements.iter().map(pending).collect();
        for &id in removed.iter().chain(changed_elements) {
            self.vacate(id);
        }
        self.insert_pending(mesh, pending_elements);
    }

    /// Puts elements to sleep, or wakes them if `asleep` is false. A batch is evaluated as a whole, so its
    /// elements must sleep or be awake together. A batch that is more than half full keeps its elements if
    /// all of them change. Otherwise the elements that change move to other batches. So do the elements that
    /// do not change, if they are at most half of the lanes.
    pub fn set_asleep(&mut self, mesh: &Mesh<D>, elements: &[ElementId], asleep: bool) {
        let mut changing: BTreeMap<u32, u8> = BTreeMap::new();
        for &id in elements {
            let (index, lane) = self.assigned[id];
            if self.batches[index as usize].key.asleep != asleep {
                *changing.entry(index).or_default() |= 1 << lane;
            }
        }
        let is_few = |lanes: u8| lanes.count_ones() as usize <= LANES / 2;
        let mut movers = Vec::new();
        for (index, lanes) in changing {
            let batch = &self.batches[index as usize];
            let rest = !(lanes | batch.vacant);
            if rest == 0 && !is_few(lanes) {
                self.change_key(index, asleep);
                continue;
            }
            let rest = if is_few(rest) { rest } else { 0 };
            for (lanes, asleep) in [(lanes, asleep), (rest, !asleep)] {
                let lanes = (0..LANES).filter(|lane| lanes >> lane & 1 == 1);
                movers.extend(lanes.map(|lane| (ElementId(batch.elements[lane]), asleep)));
            }
        }
        self.relocate(mesh, &movers);
    }

    /// Sets whether all elements of a batch sleep.
    fn change_key(&mut self, index: u32, asleep: bool) {
        let batch = &mut self.batches[index as usize];
        let key = BatchKey {
            asleep,
            ..batch.key
        };
        let before = std::mem::replace(&mut batch.key, key);
        let open = self.open.get_mut(&before);
        if open.is_some_and(|open| open.remove(&index)) {
            self.open.entry(key).or_default().insert(index);
        }
    }

    /// Moves elements with their state to other batches. The flag of each element says whether the element
    /// sleeps from now on.
    fn relocate(&mut self, mesh: &Mesh<D>, movers: &[(ElementId, bool)]) {
        let state = |&(id, asleep): &(ElementId, bool)| {
            let element = mesh.element(id).expect("only live elements sleep or wake");
            let (index, lane) = self.assigned[id];
            let batch = &self.batches[index as usize];
            let pending = self.pending(id, element, batch.key.material, asleep);
            let forces = (0..element.nodes.len()).map(|node| self.force_range(index, lane, node));
            let forces: Vec<f32> = forces
                .flat_map(|place| &self.forces[place])
                .copied()
                .collect();
            (pending, batch.inverted >> lane & 1, forces)
        };
        let states: Vec<(PendingElement, u8, Vec<f32>)> = movers.iter().map(state).collect();
        movers.iter().for_each(|&(id, _)| self.vacate(id));
        let pending_elements = states.iter().map(|(pending, ..)| *pending);
        self.insert_pending(mesh, pending_elements.collect());
        for (PendingElement { id, .. }, inverted, forces) in states {
            let (index, lane) = self.assigned[id];
            self.batches[index as usize].inverted |= inverted << lane;
            for (node, force) in forces.chunks_exact(D::N).enumerate() {
                let place = self.force_range(index, lane, node);
                self.forces[place].copy_from_slice(force);
            }
        }
    }

    /// Returns an element with its rotation and internal state, ready to be added to a batch.
    fn pending<'a>(
        &self,
        id: ElementId,
        element: &'a Element,
        material: u8,
        asleep: bool,
    ) -> PendingElement<'a> {
        PendingElement {
            id,
            element,
            material,
            asleep,
            rotation: self.rotation_of(id),
            internal: self.internal_state(id).unwrap_or(InternalState::NONE),
        }
    }

    /// Adds elements that no batch contains, and updates for each of their nodes where the forces on the node
    /// are stored.
    fn insert_pending(&mut self, mesh: &Mesh<D>, pending_elements: Vec<PendingElement>) {
        let nodes = pending_elements
            .iter()
            .flat_map(|pending| pending.element.nodes.iter().copied());
        let nodes = ascending(nodes, mesh.node_capacity());
        let mut classes: BTreeMap<(bool, u8, u32), Vec<PendingElement>> = BTreeMap::new();
        for pending in pending_elements {
            let PendingElement {
                asleep,
                material,
                element,
                ..
            } = pending;
            let class = classes
                .entry((asleep, material, element.element_class))
                .or_default();
            class.push(pending);
        }
        for pending_elements in classes.values() {
            self.insert_class(
                mesh.element_class(pending_elements[0].element),
                pending_elements,
            );
        }
        self.slots.edit().resize(mesh.node_capacity(), [0; 8]);
        for node in nodes {
            let mut slots = [0; 8];
            for (place, id) in slots.iter_mut().zip(mesh.carrier_ids(node)) {
                *place = self.force_index(id, node);
            }
            self.slots.edit()[node] = slots;
        }
    }

    /// Returns the range of `forces` that holds the force of an element on one of its nodes. The element is
    /// given by the index of its batch and its lane; `node` is the number of the node within the element.
    pub(super) fn force_range(&self, index: u32, lane: u8, node: usize) -> Range<usize> {
        let first = self.batches[index as usize].first_node as usize;
        let place = (first + node * LANES + lane as usize) * D::N;
        place..place + D::N
    }

    /// Returns the index in `forces` at which the force of an element on a node begins.
    pub(super) fn force_index(&self, id: ElementId, node: NodeId) -> u32 {
        let (batch, lane) = self.assigned[id];
        let batch = &self.batches[batch as usize];
        let first = batch.first_node as usize + lane as usize;
        let mut lane_nodes = self.nodes[first..].iter().step_by(LANES);
        let place = lane_nodes
            .position(|&other| other == node.0)
            .expect("the element carries the node");
        ((first + place * LANES) * D::N) as u32
    }

    fn vacate(&mut self, id: ElementId) {
        let Some(&(index, lane)) = self.assigned.get(id.index()) else {
            return;
        };
        if index == VACANT {
            return;
        }
        self.assigned.edit()[id] = (VACANT, 0);
        let batch = &mut self.batches[index as usize];
        batch.elements[lane as usize] = VACANT;
        batch.vacant |= 1 << lane;
        let open = self.open.entry(batch.key).or_default();
        if batch.vacant == ALL_LANES {
            open.remove(&index);
            let kind = (batch.node_count, batch.key.is_pool());
            self.empty.entry(kind).or_default().push(index);
        } else {
            open.insert(index);
        }
    }

    /// Adds elements of one class and material that are all asleep or all awake. They first fill vacant lanes
    /// in batches of the class. Then each eight elements get a new batch of the class. The last elements,
    /// fewer than eight, join pooled batches, except plain elements, which are never pooled.
    fn insert_class(
        &mut self,
        element_class: &ElementClass<D>,
        mut pending_elements: &[PendingElement],
    ) {
        let PendingElement {
            element,
            material,
            asleep,
            ..
        } = pending_elements[0];
        let class = element.element_class;
        let is_plain = element_class.is_plain() && self.law == Law::CorotationalVem;
        let key = |kind: BatchKind| BatchKey {
            kind,
            material,
            asleep,
        };
        let own = key(match is_plain {
            true => BatchKind::Plain,
            false => BatchKind::Class(class),
        });
        let count = element_class.slots.len() as u32;
        let class_data = class_data_of(self.law, element_class);
        while let Some((pending, others)) = pending_elements.split_first() {
            let open = self.open.get(&own).and_then(|open| open.first().copied());
            let index = match open {
                Some(index) => index,
                None if is_plain || pending_elements.len() >= LANES => {
                    let index = self.empty_batch(own, count);
                    self.batches[index as usize].class_data_start =
                        self.class_data_start(class, &class_data);
                    index
                }
                None => {
                    let pool = key(BatchKind::Pool(count));
                    let open = self.open.get(&pool).and_then(|open| open.first().copied());
                    open.unwrap_or_else(|| self.empty_batch(pool, count))
                }
            };
            self.assign(index, pending, &class_data);
            pending_elements = others;
        }
    }

    /// Returns the index of a batch without elements, for elements with `count` nodes. Reuses such a batch or
    /// creates one.
    fn empty_batch(&mut self, key: BatchKey, count: u32) -> u32 {
        let kind = (count, key.is_pool());
        if let Some(index) = self.empty.get_mut(&kind).and_then(Vec::pop) {
            let internal = self.new_internal(key);
            let batch = &mut self.batches[index as usize];
            (batch.key, batch.internal) = (key, internal);
            return index;
        }
        let first = self.nodes.len() as u32;
        let class_data_start = self.pooled_class_data.len() as u32;
        let rows = self.nodes.len() + count as usize * LANES;
        self.nodes.edit().resize(rows, VACANT);
        self.forces.resize(rows * D::N + PAD, 0.0);
        if key.is_pool() {
            let length = self.pooled_class_data.len() + class_data_len::<D>(count as usize);
            self.pooled_class_data.edit().resize(length, [0.0; LANES]);
        }
        let internal = self.new_internal(key);
        self.batches.push(Batch {
            key,
            internal,
            elements: [VACANT; LANES],
            vacant: ALL_LANES,
            inverted: 0,
            half_size: [self.voxel_size; LANES],
            rotation: [[0.0; LANES]; 4],
            node_count: count,
            first_node: first,
            class_data_start,
            class_data_len: class_data_len::<D>(count as usize) as u32,
        });
        self.batches.len() as u32 - 1
    }

    /// Returns the internal state of a new batch; `None` if the material has none.
    fn new_internal(&self, key: BatchKey) -> Option<Box<InternalLanes>> {
        let material = self.materials.get(key.material as usize - 1)?;
        material.has_internal_state().then(InternalLanes::none)
    }

    /// Returns the start in `self.class_data` of the data of an element class. Appends `class_data` if the
    /// class has none there yet.
    fn class_data_start(&mut self, class: u32, class_data: &[f32]) -> u32 {
        let all = &mut self.class_data;
        *self.class_data_starts.entry(class).or_insert_with(|| {
            all.edit().extend_from_slice(class_data);
            (all.len() - class_data.len()) as u32
        })
    }

    /// Puts an element into a vacant lane of a batch.
    fn assign(&mut self, index: u32, pending: &PendingElement, class_data: &[f32]) {
        let batch = &mut self.batches[index as usize];
        let is_first = batch.vacant == ALL_LANES;
        assert_ne!(batch.vacant, 0, "open batches have vacant lanes");
        let lane = batch.vacant.trailing_zeros() as usize;
        batch.vacant &= !(1 << lane);
        let is_last = batch.vacant == 0;
        // The first element of a batch is copied into all lanes. The vacant lanes, which are computed but not
        // used, then have finite values.
        let lanes = if is_first { 0..LANES } else { lane..lane + 1 };
        let half_size = 0.5 * self.voxel_size * pending.element.cell.width() as f32;
        let first = batch.first_node as usize;
        for lane in lanes {
            batch.half_size[lane] = half_size;
            for part in 0..4 {
                batch.rotation[part][lane] = pending.rotation[part];
            }
            if let Some(internal) = &mut batch.internal {
                internal.set(lane, pending.internal);
            }
            for (place, &node) in pending.element.nodes.iter().enumerate() {
                self.nodes.edit()[first + place * LANES + lane] = node.0;
            }
            if batch.key.is_pool() {
                let pooled_class_data =
                    &mut self.pooled_class_data.edit()[batch.class_data_start as usize..];
                for (all, &number) in pooled_class_data.iter_mut().zip(class_data) {
                    all[lane] = number;
                }
            }
        }
        // Clears the forces that the previous element of this lane has left, because fracture may read them
        // before the next evaluation.
        for place in 0..pending.element.nodes.len() {
            let force = (first + place * LANES + lane) * D::N;
            self.forces[force..][..D::N].fill(0.0);
        }
        batch.elements[lane] = pending.id.0;
        batch.inverted &= !(1 << lane);
        let open = self.open.entry(batch.key).or_default();
        if is_last {
            open.remove(&index);
        } else {
            open.insert(index);
        }
        let id = pending.id;
        let capacity = self.assigned.len().max(id.index() + 1);
        let assigned = self.assigned.edit();
        assigned.resize(capacity, (VACANT, 0));
        assigned[id] = (index, lane as u8);
    }
}

/// Element that is to be added to a batch.
#[derive(Copy, Clone)]
struct PendingElement<'a> {
    id: ElementId,
    element: &'a Element,
    material: u8,
    asleep: bool,
    rotation: [f32; 4],
    internal: InternalState,
}

/// Returns the data of an element class in single precision, in the order that the kernel reads.
fn class_data_of<D: Dim>(law: Law, element_class: &ElementClass<D>) -> Vec<f32> {
    let count = element_class.slots.len();
    let mut mean = [0.0; 3];
    for offset in &element_class.offsets {
        for axis in 0..3 {
            mean[axis] += offset[axis] / count as f64;
        }
    }
    let mut all = vec![0.0; class_data_len::<D>(count)];
    let mut total = 0.0;
    for k in 0..count {
        let node = &mut all[class_data_per_node::<D>() * k..][..class_data_per_node::<D>()];
        let w = element_class.volumes[k];
        for axis in 0..D::N {
            let centred = element_class.offsets[k][axis] - mean[axis];
            total += centred * centred;
            match law {
                Law::CorotationalVem => {
                    node[axis] = element_class.gradients[k][axis] as f32;
                    node[D::N + axis] = (w * element_class.offsets[k][axis]) as f32;
                }
                Law::Endo2004 => node[axis] = centred as f32,
            }
        }
        node[2 * D::N] = if law == Law::CorotationalVem {
            w as f32
        } else {
            1.0
        };
    }
    for i in 0..D::N {
        for j in i..D::N {
            let term = |k: usize| {
                element_class.volumes[k] * element_class.offsets[k][i] * element_class.offsets[k][j]
            };
            let spread: f64 = (0..count).map(term).sum();
            all[class_data_per_node::<D>() * count + symmetric::<D>(i, j)] = spread as f32;
        }
    }
    let volume = match law {
        Law::CorotationalVem => element_class.volume,
        Law::Endo2004 => count as f64,
    };
    let last = all.len() - 1;
    all[last - 1] = (1.0 / volume) as f32;
    let stiffness = match law {
        Law::CorotationalVem => element_class.hourglass,
        Law::Endo2004 => element_class.volume * D::N as f64 / total,
    };
    all[last] = stiffness as f32;
    all
}
