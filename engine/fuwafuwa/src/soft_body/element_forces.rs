//! Forces of all elements, evaluated eight at a time.
//!
//! Eight elements form a batch, one in each SIMD lane. Each lane performs the operations of the scalar
//! formula in the scalar order, and nothing is summed across lanes. Therefore the vector width of the machine
//! does not change the result. Tests compare the forces with [`crate::soft_body::element_law`].
//!
//! Each element writes its forces to entries that no other element writes. The force on a node is the sum of
//! the forces of its elements, in the order of the octants around the node. Therefore neither the number of
//! threads nor the numbering of elements changes the result.
//!
//! If an element class has enough elements, its batches contain no other class. The remaining elements are
//! pooled by their number of nodes; in a pooled batch, each lane has its own class data. About a fifth of a
//! body's elements, of about a hundred classes, are pooled.

mod batch;
mod batch_assignment;
mod force_kernel;
mod hashing;
mod internal_state;
mod material_constants;
mod plastic_kernel;
#[cfg(feature = "serde")]
mod restoring;
mod rotation_extraction;
#[cfg(feature = "serde")]
mod saved_states;
mod stress_kernel;
mod tension_kernel;
mod viscous_kernel;

pub use crate::math::row::Row;

use crate::foundation::copy_on_write::CopyOnWrite;
use crate::foundation::dim::Dim;
use crate::foundation::ids::{ElementId, IndexVec, NodeId};
use crate::foundation::threads::{self, RowChunk, Run};
use crate::material::Material;
use crate::math::lanes::{Eight, LANES, four, on_widest_lanes, sum, sum_of_squares};
use crate::math::rotation::Rotation;
use crate::soft_body::element_law::Law;
use batch::{BATCHES_PER_SHARE, Batch, BatchKey, Share, Shared, VACANT, evaluate_best};
use fearless_simd::prelude::*;
use glam::{Mat3, Quat, Vec3};
pub use internal_state::InternalState;
use material_constants::MaterialConstants;
use std::collections::{BTreeMap, BTreeSet};
use std::marker::PhantomData;

/// Number of padding entries after the last force. A load of four numbers that begins at the last force then
/// stays in bounds.
const PAD: usize = 4;

/// All elements of a body in batches, with their nodal forces.
#[derive(Clone, Debug)]
pub struct ElementBatches<D: Dim> {
    law: Law,
    /// Constants of each material, by material number − 1.
    materials: Vec<MaterialConstants>,
    voxel_size: f32,
    batches: Vec<Batch>,
    /// Indices of the batches that have both elements and vacant lanes, by the common properties of their
    /// elements.
    open: BTreeMap<BatchKey, BTreeSet<u32>>,
    /// Indices of the batches without elements. The key is the number of nodes per element, and whether each
    /// lane has class data of its own.
    empty: BTreeMap<(u32, bool), Vec<u32>>,
    /// Start in `class_data` of the data of each element class that has batches of its own, by the index of
    /// the class.
    class_data_starts: BTreeMap<u32, u32>,
    class_data: CopyOnWrite<Vec<f32>>,
    /// Class data of pooled batches; each value is stored once for each lane.
    pooled_class_data: CopyOnWrite<Vec<Eight>>,
    /// Index of the batch, and lane, of each element, by element id; the index is [`VACANT`] if no batch
    /// contains the element.
    assigned: CopyOnWrite<IndexVec<ElementId, (u32, u8)>>,
    /// For each node, the indices in `forces` at which the forces of its elements begin, in the order of the
    /// octants around the node. Unused entries are 0, where `forces` holds a zero force.
    slots: CopyOnWrite<IndexVec<NodeId, [u32; 8]>>,
    /// Node ids of all batches. The id of node k of the element in lane l is k · LANES + l entries after the
    /// first entry of the batch.
    nodes: CopyOnWrite<Vec<u32>>,
    /// Forces [N] of the elements on the nodes in `nodes`, in the same order, with D::N components each.
    /// Padding to four components would make up a quarter (3D) or half (2D) of the memory traffic of a
    /// substep.
    forces: Vec<f32>,
    /// State of the elements read from a snapshot, until [`ElementBatches::restore`] assigns the elements to
    /// batches.
    #[cfg(feature = "serde")]
    saved: Option<saved_states::SavedElementStates>,
    dim: PhantomData<D>,
}

/// Parameters of the velocity update in a substep.
#[derive(Copy, Clone, Debug)]
pub struct VelocityUpdate<'a> {
    /// Nodes to update, ascending.
    pub nodes: &'a [NodeId],
    /// Inverse mass of each node [1/kg], by id; 0 while the node is fixed or sleeps.
    pub inverse_mass: &'a [f32],
    /// Length of the substep [s].
    pub duration: f32,
    /// Gravity [m/s²], multiplied by the gravity scale of the body.
    pub gravity: Row,
}

/// Number of components of a stored rotation: cosine and sine in 2D, a quaternion in 3D.
const fn parts<D: Dim>() -> usize {
    match D::N {
        2 => 2,
        _ => 4,
    }
}

impl<D: Dim> ElementBatches<D> {
    /// Creates batches without elements. `materials[number - 1]` belongs to material `number`; `voxel_size` is
    /// in metres.
    pub fn new(law: Law, materials: &[Material], voxel_size: f32) -> Self {
        Self {
            law,
            materials: MaterialConstants::of_all::<D>(law, materials, 1.0),
            voxel_size,
            batches: Vec::new(),
            open: BTreeMap::new(),
            empty: BTreeMap::new(),
            class_data_starts: BTreeMap::new(),
            class_data: CopyOnWrite::default(),
            pooled_class_data: CopyOnWrite::default(),
            assigned: CopyOnWrite::default(),
            slots: CopyOnWrite::default(),
            nodes: vec![VACANT; LANES].into(),
            forces: vec![0.0; LANES * D::N + PAD],
            #[cfg(feature = "serde")]
            saved: None,
            dim: PhantomData,
        }
    }

    /// Law of the elastic forces.
    pub fn law(&self) -> Law {
        self.law
    }

    /// Sets the constants of the materials, with Young's modulus multiplied by `stiffness_scale`.
    pub fn set_materials(&mut self, materials: &[Material], stiffness_scale: f64) {
        self.materials = MaterialConstants::of_all::<D>(self.law, materials, stiffness_scale);
    }

    /// Returns the internal state of an element; `None` if its material has none.
    pub fn internal_state(&self, id: ElementId) -> Option<InternalState> {
        let &(batch, lane) = self.assigned.get(id.index())?;
        let internal = self.batches.get(batch as usize)?.internal.as_ref()?;
        Some(internal.get(lane as usize))
    }

    /// Returns the rows of the plastic inverse G of an element ([`crate::soft_body::plasticity`]); `None` if
    /// the material of the element is elastic.
    pub fn plastic_inverse(&self, id: ElementId) -> Option<[Vec3; 3]> {
        let &(batch, _) = self.assigned.get(id.index())?;
        let material = self.batches.get(batch as usize)?.key.material;
        self.materials[material as usize - 1].flow.as_ref()?;
        Some(self.internal_state(id)?.plastic_inverse)
    }

    /// Sets the internal state of an element, if its material has one.
    pub fn set_internal_state(&mut self, id: ElementId, state: InternalState) {
        let (batch, lane) = self.assigned[id];
        if let Some(internal) = &mut self.batches[batch as usize].internal {
            internal.set(lane as usize, state);
        }
    }

    /// Returns whether the elements of any material have an internal state.
    pub fn has_internal_state(&self) -> bool {
        self.materials
            .iter()
            .any(MaterialConstants::has_internal_state)
    }

    /// Computes the forces of all awake elements, and advances their internal state by a substep of `duration`
    /// [s]. `positions[number - 1]` are the node positions [m] for the elements of material `number`.
    pub fn evaluate(&mut self, positions: &[&[Row]], duration: f32) {
        let shares = self.shares(duration);
        threads::map(shares, |share| evaluate_best::<D>(share, positions));
    }

    /// Splits the batches into shares that write disjoint data, so that the result is bitwise identical for
    /// any number of threads.
    fn shares(&mut self, duration: f32) -> impl Iterator<Item = Share<'_>> {
        let Self {
            law,
            materials,
            class_data,
            pooled_class_data,
            nodes,
            ..
        } = self;
        let shared = Shared {
            law: *law,
            materials,
            duration,
            class_data,
            pooled_class_data,
            nodes,
        };
        let mut forces = &mut self.forces[LANES * D::N..];
        let mut first = LANES;
        self.batches
            .chunks_mut(BATCHES_PER_SHARE)
            .map(move |batches| {
                // Forces are stored in the order of the batches, so the forces of the share end with those of its
                // last batch.
                let end = batches.last().map_or(first, Batch::end);
                let (own, others) = std::mem::take(&mut forces).split_at_mut((end - first) * D::N);
                let share = Share {
                    batches,
                    forces: own,
                    first,
                    shared,
                };
                (forces, first) = (others, end);
                share
            })
    }

    /// Elastic force [N] on a node in the last evaluation: the sum of the forces of its elements.
    #[inline]
    pub fn force_on(&self, node: NodeId) -> Row {
        on_widest_lanes!(simd => {
            let force = sum(simd, &self.forces, &self.slots[node], D::N);
            Row::from_array(force.to_array())
        })
    }

    /// Elastic force [N] of each element on a node in the last evaluation, in the order of the octants around
    /// the node.
    #[inline]
    pub fn parts_on(&self, node: NodeId) -> impl Iterator<Item = Row> + '_ {
        let places = self.slots[node].iter();
        let places = places.take_while(|&&place| place != 0);
        places.map(|&place| {
            let mut force = Row::ZERO;
            force[..D::N].copy_from_slice(&self.forces[place as usize..][..D::N]);
            force
        })
    }

    /// Sum of the squared forces [N²] of the elements on a node in the last evaluation.
    #[inline(always)]
    pub fn squares_on<S: Simd>(&self, simd: S, node: NodeId) -> f32 {
        let slots = &self.slots[node][..D::CORNERS];
        let squares = sum_of_squares(simd, &self.forces, slots);
        squares[..D::N].iter().sum()
    }

    /// Rotation matrix of an element in the last evaluation, by rows.
    pub fn rotation(&self, id: ElementId) -> [Vec3; 3] {
        let turned = self.rotation_of(id);
        // Rotations are stored as cosine and sine in 2D, as quaternions in 3D.
        if D::N == 2 {
            let [cosine, sine, ..] = turned;
            return [
                Vec3::new(cosine, -sine, 0.0),
                Vec3::new(sine, cosine, 0.0),
                Vec3::Z,
            ];
        }
        let columns = Mat3::from_quat(Quat::from_array(turned));
        [0, 1, 2].map(|row| columns.row(row))
    }

    /// Returns whether a batch contains the element.
    pub fn has(&self, id: ElementId) -> bool {
        let assigned = self.assigned.get(id.index());
        assigned.is_some_and(|&(batch, _)| batch != VACANT)
    }

    /// Sets the rotation of a 3D element to a unit quaternion (x, y, z, w). The iteration of the next
    /// evaluation starts from this rotation.
    pub fn set_rotation(&mut self, id: ElementId, turned: [f32; 4]) {
        let (batch, lane) = self.assigned[id];
        let rotation = &mut self.batches[batch as usize].rotation;
        for (all, part) in rotation.iter_mut().zip(turned) {
            all[lane as usize] = part;
        }
    }

    /// Turns the rotations of all elements, and the forces of the last evaluation, by `rotation`. Rotations
    /// of elements are stored as cosine and sine in 2D, as quaternions in 3D.
    pub fn rotate(&mut self, rotation: Rotation) {
        for batch in &mut self.batches {
            for lane in 0..LANES {
                let turned = match (D::N, batch.rotation.map(|part| part[lane])) {
                    (2, [cosine, sine, ..]) => {
                        let [x, y, _] = rotation.apply(Vec3::new(cosine, sine, 0.0)).to_array();
                        [x, y, 0.0, 0.0]
                    }
                    (_, turned) => rotation.after(turned),
                };
                for (all, part) in batch.rotation.iter_mut().zip(turned) {
                    all[lane] = part;
                }
            }
        }
        for force in self.forces.chunks_exact_mut(D::N) {
            let mut turned = Vec3::ZERO;
            turned.as_mut()[..D::N].copy_from_slice(force);
            let turned = rotation.apply(turned).to_array();
            force.copy_from_slice(&turned[..D::N]);
        }
    }

    /// Number of awake elements with negative volume, that is, turned inside out, in the last evaluation.
    /// Always 0 under [`Law::Endo2004`], which does not check for inversion.
    pub fn inverted_count(&self) -> u32 {
        let awake = self.batches.iter().filter(|batch| !batch.is_idle());
        let inverted = |batch: &Batch| (batch.inverted & !batch.vacant).count_ones();
        awake.map(inverted).sum()
    }

    /// Adds the velocity change of one substep by elastic forces and gravity to velocities [m/s].
    pub fn update_velocities(&self, update: &VelocityUpdate, velocity: &mut [Row]) {
        threads::map(threads::rows(update.nodes, [velocity]), |rows| {
            on_widest_lanes!(simd => self.update_velocities_by(simd, update, rows));
        });
    }

    #[inline(always)]
    fn update_velocities_by<S: Simd>(
        &self,
        simd: S,
        update: &VelocityUpdate,
        rows: RowChunk<NodeId, Row, 1>,
    ) {
        let RowChunk {
            ids: nodes,
            first,
            lists: [velocities],
        } = rows;
        let gravity = four(simd, update.gravity.to_array());
        for Run { ids, rows } in threads::runs(nodes, first) {
            let slots = &self.slots.as_slice()[ids.clone()];
            let nodes = slots.iter().zip(&update.inverse_mass[ids]);
            for (velocity, (slots, &inverse_mass)) in velocities[rows].iter_mut().zip(nodes) {
                if inverse_mass != 0.0 {
                    let force = sum(simd, &self.forces, slots, D::N);
                    let change = (force * inverse_mass + gravity) * update.duration;
                    let changed = four(simd, velocity.to_array()) + change;
                    *velocity = Row::from_array(changed.to_array());
                }
            }
        }
    }

    fn rotation_of(&self, id: ElementId) -> [f32; 4] {
        match self.assigned.get(id.index()) {
            Some(&(batch, lane)) if batch != VACANT => self.batches[batch as usize]
                .rotation
                .map(|part| part[lane as usize]),
            // Identity: (cosine, sine) in 2D, quaternion (x, y, z, w) in 3D.
            _ if D::N == 2 => [1.0, 0.0, 0.0, 0.0],
            _ => [0.0, 0.0, 0.0, 1.0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::batch::{GROUP, evaluate_share};
    use super::force_kernel::Scratch;
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};
    use crate::soft_body::hyperelasticity::StressLaw;
    use crate::soft_body::viscosity::PronyTerm;
    use crate::topology::cell_hierarchy::{CellHierarchy, Grading};
    use crate::topology::connectivity::Connectivity;
    use crate::topology::grid::VoxelGrid;
    use crate::topology::mesh::Mesh;

    /// Checks that the lanes of `simd` give the same bits as the widest lanes of this machine. The test body
    /// has batches of a single class and pooled batches.
    fn check_same_bits<D: Dim, S: Simd>(law: Law, material: &Material, simd: S) {
        let grid = VoxelGrid::<D>::ball(24, 1.0).unwrap();
        let connectivity = Connectivity::new(&grid);
        let hierarchy = CellHierarchy::new(&grid, &connectivity, Grading::Graded);
        let mesh = Mesh::grade(&grid, &connectivity, &hierarchy).unwrap();
        let mut wide = ElementBatches::new(law, &[*material], grid.voxel_size());
        let all: Vec<ElementId> = mesh.elements().map(|(id, _)| id).collect();
        wide.update(&mesh, &grid, &[], &all, |_| false);
        let mut other = wide.clone();
        let mut position = vec![Row::ZERO; mesh.node_capacity()];
        for (id, node) in mesh.nodes() {
            let [x, y, z] = node.at.map(|k| k as f32 / 24.0);
            let bent = [
                1.2 * x - 0.7 * y * y,
                0.6 * x + 0.8 * y,
                z + 0.3 * x * y,
                0.0,
            ];
            position[id.index()][..D::N].copy_from_slice(&bent[..D::N]);
        }
        let duration = 1e-3;
        for _ in 0..3 {
            wide.evaluate(&[&position], duration);
            let mut scratch = [Scratch::EMPTY; GROUP];
            for share in other.shares(duration) {
                let scratch = &mut scratch;
                simd.vectorize(|| evaluate_share::<D, _>(simd, share, &[&position], scratch));
            }
        }
        for (id, _) in mesh.nodes() {
            let bits =
                |batches: &ElementBatches<D>| batches.force_on(id).to_array().map(f32::to_bits);
            assert_eq!(bits(&wide), bits(&other));
        }
        let nodes: Vec<NodeId> = mesh.nodes().map(|(id, _)| id).collect();
        let inverse_mass: Vec<f32> = (0..position.len()).map(|id| (id % 7) as f32).collect();
        let update = VelocityUpdate {
            nodes: &nodes,
            inverse_mass: &inverse_mass,
            duration: 0.001,
            gravity: Row::from_array([0.0, -9.81, 0.0, 0.0]),
        };
        let mut velocities = [position.clone(), position];
        let [by_best, by_other] = &mut velocities;
        wide.update_velocities(&update, by_best);
        for rows in threads::rows(&nodes, [by_other]) {
            simd.vectorize(|| other.update_velocities_by(simd, &update, rows));
        }
        let [by_best, by_other] = velocities.map(|rows| {
            let bits = rows.iter().flat_map(|row| row.to_array().map(f32::to_bits));
            bits.collect::<Vec<u32>>()
        });
        assert_eq!(by_best, by_other);
    }

    /// Checks that sleeping elements keep their rotations and forces, and that an element added to a batch
    /// starts with zero forces. Regression test of two faults: a batch with both sleeping and awake elements
    /// evaluated all of them, and an added element kept the forces of the element that had used its lane
    /// before.
    fn check_sleepers<D: Dim>() {
        let grid = VoxelGrid::<D>::ball(16, 1.0).unwrap();
        let connectivity = Connectivity::new(&grid);
        let hierarchy = CellHierarchy::new(&grid, &connectivity, Grading::Graded);
        let mesh = Mesh::grade(&grid, &connectivity, &hierarchy).unwrap();
        let materials = [Material::default()];
        let mut batches =
            ElementBatches::<D>::new(Law::CorotationalVem, &materials, grid.voxel_size());
        let all: Vec<ElementId> = mesh.elements().map(|(id, _)| id).collect();
        batches.update(&mesh, &grid, &[], &all, |_| false);
        let mut position = vec![Row::ZERO; mesh.node_capacity()];
        let mut evaluate = |batches: &mut ElementBatches<D>, bend: f32| {
            for (id, node) in mesh.nodes() {
                let [x, y, z] = node.at.map(|k| k as f32 / 16.0);
                let bent = [x - bend * y * y, bend * x + y, z + bend * x * y, 0.0];
                position[id.index()][..D::N].copy_from_slice(&bent[..D::N]);
            }
            batches.evaluate(&[&position], 1e-3);
        };
        evaluate(&mut batches, 0.1);
        let sleeps = |id: &ElementId| id.0 % 4 < 3;
        let state = |batches: &ElementBatches<D>, id: ElementId| {
            let nodes = mesh.element(id).unwrap().nodes.iter();
            let forces = nodes.map(|&node| batches.force_index(id, node) as usize);
            let forces = forces.flat_map(|place| &batches.forces[place..][..D::N]);
            (batches.rotation(id), forces.copied().collect::<Vec<f32>>())
        };
        let states = |batches: &ElementBatches<D>| -> Vec<_> {
            all.iter().map(|&id| state(batches, id)).collect()
        };
        let evaluated = |batches: &ElementBatches<D>| {
            let awake = batches.batches.iter().filter(|batch| !batch.is_idle());
            awake.count()
        };
        let (when_awake, before) = (evaluated(&batches), states(&batches));
        // Puts elements to sleep one at a time, as when many single-voxel pieces fall asleep independently.
        let sleepers: Vec<ElementId> = all.iter().copied().filter(sleeps).collect();
        for &id in &sleepers {
            batches.set_asleep(&mesh, &[id], true);
        }
        assert!(
            2 * evaluated(&batches) < when_awake,
            "a quarter of the elements is awake, so most batches must be idle"
        );
        assert_eq!(states(&batches), before);
        evaluate(&mut batches, 0.2);
        let after = states(&batches);
        for (at, id) in all.iter().enumerate() {
            assert_eq!(after[at] == before[at], sleeps(id), "{id}");
        }
        batches.set_asleep(&mesh, &sleepers, false);
        assert_eq!(states(&batches), after);
        batches.update(&mesh, &grid, &[], &all, |id| sleeps(&id));
        for &id in &all {
            assert!(state(&batches, id).1.iter().all(|&force| force == 0.0));
        }
    }

    #[test]
    fn sleeping_elements_keep_state_beside_awake_ones() {
        check_sleepers::<Dim2>();
        check_sleepers::<Dim3>();
    }

    #[test]
    fn lanes_of_all_widths_give_same_bits() {
        let usual = Material::default();
        let yeoh = Material {
            stress_law: StressLaw::Yeoh {
                second: 0.1,
                third: -0.01,
            },
            ..usual
        };
        let viscous_clay = Material {
            prony: [PronyTerm::new(1.0, 0.01), PronyTerm::new(0.5, 1.0)],
            ..Material::clay()
        };
        for (law, material) in [
            (Law::CorotationalVem, usual),
            (Law::Endo2004, usual),
            (Law::CorotationalVem, yeoh),
            (Law::CorotationalVem, viscous_clay),
        ] {
            // Scalar lanes are not tested in debug builds, in which compiling them takes four minutes and
            // several gigabytes.
            #[cfg(not(debug_assertions))]
            {
                let plain = fearless_simd::Fallback::new();
                check_same_bits::<Dim2, _>(law, &material, plain);
                check_same_bits::<Dim3, _>(law, &material, plain);
            }
            // Tests only lanes narrower than the widest lanes of this machine, which give the reference
            // result.
            #[cfg(target_arch = "x86_64")]
            {
                let level = fearless_simd::Level::baseline();
                let sse2 = level.as_sse2().expect("every x86-64 has SSE2");
                check_same_bits::<Dim2, _>(law, &material, sse2);
                check_same_bits::<Dim3, _>(law, &material, sse2);
            }
        }
    }
}
