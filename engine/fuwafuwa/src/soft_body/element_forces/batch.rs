//! Batches of elements, and the evaluation of groups of batches in three loops: gradients, stresses, forces.

use super::force_kernel::{
    BatchView, PerLane, Scratch, Uniform, forces, gradient, plain_forces, plain_gradient, stress,
};
use super::internal_state::InternalLanes;
use super::material_constants::MaterialConstants;
use super::stress_kernel::unusual_stress;
use crate::foundation::dim::Dim;
use crate::math::lanes::{Eight, LANES, on_widest_lanes};
use crate::math::row::Row;
use crate::soft_body::element_law::Law;
use fearless_simd::Simd;
use std::cell::RefCell;
use std::ops::Range;

/// Number of batches in a [`Share`].
pub const BATCHES_PER_SHARE: usize = 8 * GROUP;

/// Number of batches that pass together through the loops for gradients, stresses and forces. The scratch
/// memory of these batches, 28 KB, fits into an L1 cache of 32 KB.
pub const GROUP: usize = 8;

pub const VACANT: u32 = u32::MAX;
pub const ALL_LANES: u8 = u8::MAX;

/// Batch: up to eight elements, one in each SIMD lane, with the indices of their nodes, forces and class
/// data.
#[derive(Clone, Debug)]
pub struct Batch {
    pub key: BatchKey,
    pub elements: [u32; LANES],
    /// Mask of the lanes without an element.
    pub vacant: u8,
    /// Mask of the lanes whose element had negative volume in the last evaluation.
    pub inverted: u8,
    pub half_size: Eight,
    /// Rotation of the element in each lane: a quaternion in 3D, cosine and sine in 2D.
    pub rotation: [Eight; 4],
    /// Internal state of the element in each lane; `None` if the material has none.
    pub internal: Option<Box<InternalLanes>>,
    pub node_count: u32,
    /// Index of the first node of the batch in `ElementBatches::nodes`. The forces of the batch begin at D::N
    /// times this index in `ElementBatches::forces`.
    pub first_node: u32,
    /// Start of the class data in `ElementBatches::class_data`, or in `ElementBatches::pooled_class_data` for
    /// a pooled batch.
    pub class_data_start: u32,
    /// Number of values in the class data.
    pub class_data_len: u32,
}

/// Properties that the elements of a batch have in common.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct BatchKey {
    pub kind: BatchKind,
    /// Number of the material, 1 to 255.
    pub material: u8,
    /// Whether the elements sleep; then their rotations and forces are not updated.
    pub asleep: bool,
}

/// Kind of a batch: which element classes it may contain.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum BatchKind {
    /// Elements that are whole cells with nodes only at their corners.
    Plain,
    /// Elements of the class with this index.
    Class(u32),
    /// Elements of any class, each with this number of nodes.
    Pool(u32),
}

impl BatchKey {
    pub fn is_pool(self) -> bool {
        matches!(self.kind, BatchKind::Pool(_))
    }
}

/// Read-only data that all batches use.
#[derive(Copy, Clone)]
pub struct Shared<'a> {
    pub law: Law,
    /// Constants of each material, by material number − 1.
    pub materials: &'a [MaterialConstants],
    /// Length of the substep [s].
    pub duration: f32,
    pub class_data: &'a [f32],
    pub pooled_class_data: &'a [Eight],
    pub nodes: &'a [u32],
}

/// Several batches that one thread evaluates, and the forces that they write. `first` is the index of the
/// share's first node in `ElementBatches::nodes`.
pub struct Share<'a> {
    pub batches: &'a mut [Batch],
    pub forces: &'a mut [f32],
    pub first: usize,
    pub shared: Shared<'a>,
}

impl Batch {
    /// Returns the index in `ElementBatches::nodes` after the last node of the batch.
    pub fn end(&self) -> usize {
        self.first_node as usize + self.node_count as usize * LANES
    }

    /// Returns whether the batch needs no evaluation, because its elements sleep or because it has no
    /// elements.
    #[inline(always)]
    pub fn is_idle(&self) -> bool {
        self.key.asleep || self.vacant == ALL_LANES
    }

    /// Returns the range of the batch's forces within the forces of its share. `first` is the index of the
    /// share's first node in `ElementBatches::nodes`.
    #[inline(always)]
    fn forces<D: Dim>(&self, first: usize) -> Range<usize> {
        (self.first_node as usize - first) * D::N..(self.end() - first) * D::N
    }

    /// Returns the class data of the batch: a slice with one value for all lanes, and a slice with a value
    /// for each lane. At least one of these slices is empty; both are empty for plain elements.
    #[inline(always)]
    fn class_data<'a>(&self, shared: &Shared<'a>) -> (&'a [f32], &'a [Eight]) {
        let places =
            self.class_data_start as usize..(self.class_data_start + self.class_data_len) as usize;
        match self.key.kind {
            BatchKind::Plain => (&[], &[]),
            BatchKind::Class(_) => (&shared.class_data[places], &[]),
            BatchKind::Pool(_) => (&[], &shared.pooled_class_data[places]),
        }
    }

    /// Returns the data of the batch for the kernel. `forces` holds the forces of the whole share; `first` is
    /// the index of the share's first node in `ElementBatches::nodes`.
    #[inline(always)]
    fn view<'a, D: Dim>(
        &'a mut self,
        shared: &Shared<'a>,
        forces: &'a mut [f32],
        first: usize,
    ) -> BatchView<'a> {
        let places = self.first_node as usize..self.end();
        let forces = &mut forces[self.forces::<D>(first)];
        BatchView {
            nodes: &shared.nodes[places.clone()],
            half_size: &self.half_size,
            rotation: &mut self.rotation,
            forces,
            inverted: &mut self.inverted,
        }
    }
}

/// Evaluates the forces of the awake batches of a share. `positions[number - 1]` are the node positions [m]
/// for the elements of material `number`.
#[inline(always)]
pub fn evaluate_share<D: Dim, S: Simd>(
    simd: S,
    share: Share,
    positions: &[&[Row]],
    scratch: &mut [Scratch; GROUP],
) {
    let Share {
        batches,
        forces: all,
        first,
        shared,
    } = share;
    let law = shared.law;
    for batches in batches.chunks_mut(GROUP) {
        for (batch, scratch) in batches.iter_mut().zip(&mut *scratch) {
            if batch.is_idle() {
                continue;
            }
            let (key, class_data) = (batch.key, batch.class_data(&shared));
            let position = positions[key.material as usize - 1];
            let view = batch.view::<D>(&shared, all, first);
            match (key.kind, class_data) {
                (BatchKind::Plain, _) => plain_gradient::<D, S>(simd, position, &view, scratch),
                (_, (one, [])) => gradient::<D, S>(simd, &Uniform(one), position, &view, scratch),
                (_, (_, each)) => gradient::<D, S>(simd, &PerLane(each), position, &view, scratch),
            }
        }
        for (batch, scratch) in batches.iter_mut().zip(&mut *scratch) {
            if batch.is_idle() {
                continue;
            }
            let material = &shared.materials[batch.key.material as usize - 1];
            if material.is_usual() {
                let mut view = batch.view::<D>(&shared, all, first);
                stress::<D, S>(simd, law, &material.moduli, &mut view, scratch);
                continue;
            }
            let mut internal = batch.internal.take();
            let mut view = batch.view::<D>(&shared, all, first);
            unusual_stress::<D, S>(
                simd,
                (material, shared.duration),
                &mut view,
                internal.as_deref_mut(),
                scratch,
            );
            batch.internal = internal;
        }
        for (batch, scratch) in batches.iter_mut().zip(&*scratch) {
            if batch.is_idle() {
                continue;
            }
            let (key, class_data) = (batch.key, batch.class_data(&shared));
            let material = &shared.materials[key.material as usize - 1];
            let moduli = &material.moduli;
            let constants = (moduli, material.hyperelastic.as_ref());
            let view = &mut batch.view::<D>(&shared, all, first);
            match (key.kind, class_data) {
                (BatchKind::Plain, _) => plain_forces::<D, S>(simd, moduli, view, scratch),
                (_, (one, [])) => {
                    forces::<D, S>(simd, law, constants, &Uniform(one), view, scratch);
                }
                (_, (_, each)) => {
                    forces::<D, S>(simd, law, constants, &PerLane(each), view, scratch);
                }
            }
        }
    }
}

thread_local! {
    /// Scratch memory of the kernel.
    static SCRATCH: RefCell<Box<[Scratch; GROUP]>> =
        RefCell::new(Box::new([Scratch::EMPTY; GROUP]));
}

/// Evaluates the forces of the awake batches of a share on the widest lanes of this machine.
pub fn evaluate_best<D: Dim>(share: Share, positions: &[&[Row]]) {
    SCRATCH.with_borrow_mut(|scratch| {
        on_widest_lanes!(simd => evaluate_share::<D, _>(simd, share, positions, scratch));
    });
}
