//! A block of elements, and how a group of them goes through the three loops of the kernel.

use super::kernel::{
    BlockView, Moduli, PerLane, Scratch, Uniform, forces, gradient, plain_forces, plain_gradient,
    stress,
};
use super::plastic::{Flow, Undone, plastic_stress};
use crate::dim::Dim;
use crate::lanes::{Eight, LANES, Row, on_widest_lanes};
use crate::law::Law;
use fearless_simd::Simd;
use std::ops::Range;

/// Blocks that go through the three loops of the kernel together: their scratch, 28 KB, fits an L1 cache of 32 KB.
pub const GROUP: usize = 8;

pub const VACANT: u32 = u32::MAX;
pub const ALL_LANES: u8 = u8::MAX;

/// Elements side by side, and where their nodes, forces and stencils stand.
#[derive(Clone, Debug)]
pub struct Block {
    pub home: Home,
    pub elements: [u32; LANES],
    /// The lanes without an element, as a mask.
    pub vacant: u8,
    /// The lanes that are inside out, as of the last evaluation.
    pub inverted: u8,
    pub half_size: Eight,
    /// In space a quaternion; in the plane cosine and sine.
    pub rotation: [Eight; 4],
    /// What was kneaded into each, where their material keeps dents.
    pub undone: Option<Box<Undone>>,
    pub node_count: u32,
    /// Where its nodes and forces begin.
    pub first: u32,
    /// Where its stencil begins, in `numbers` or in `pooled`, and how long it is.
    pub stencil: u32,
    pub numbers: u32,
}

/// What the elements of a block have in common.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Home {
    pub kind: Kind,
    /// The number of their material.
    pub material: u8,
    /// Whether they sleep: then they keep the rotation and the forces that they have.
    pub asleep: bool,
}

/// Of which classes the elements of a block are.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Whole cells with nodes in their corners only.
    Plain,
    /// One class.
    Class(u32),
    /// Any with this number of nodes.
    Pool(u32),
}

impl Home {
    pub fn is_pool(self) -> bool {
        matches!(self.kind, Kind::Pool(_))
    }
}

/// What all blocks read.
#[derive(Copy, Clone)]
pub struct Shared<'a> {
    pub law: Law,
    pub moduli: &'a [Moduli],
    pub flows: &'a [Option<Flow>],
    pub numbers: &'a [f32],
    pub pooled: &'a [Eight],
    pub nodes: &'a [u32],
}

/// Some blocks, and the forces that they write, the first of which has the number `first`.
pub struct Group<'a> {
    pub blocks: &'a mut [Block],
    pub forces: &'a mut [f32],
    pub first: usize,
    pub shared: Shared<'a>,
}

impl Block {
    /// Where its forces end.
    pub fn end(&self) -> usize {
        self.first as usize + self.node_count as usize * LANES
    }

    /// Whether nobody in it is awake.
    #[inline(always)]
    pub fn is_idle(&self) -> bool {
        self.home.asleep || self.vacant == ALL_LANES
    }

    /// Where its forces stand among those of a group, the first of which has the number `first`.
    #[inline(always)]
    fn forces<D: Dim>(&self, first: usize) -> Range<usize> {
        (self.first as usize - first) * D::N..(self.end() - first) * D::N
    }

    /// Its stencil: one for all lanes, or else one for each.
    #[inline(always)]
    fn stencil<'a>(&self, shared: &Shared<'a>) -> (&'a [f32], &'a [Eight]) {
        let places = self.stencil as usize..(self.stencil + self.numbers) as usize;
        match self.home.kind {
            Kind::Plain => (&[], &[]),
            Kind::Class(_) => (&shared.numbers[places], &[]),
            Kind::Pool(_) => (&[], &shared.pooled[places]),
        }
    }

    /// What the kernel works on; `first` is the number of the first of the forces.
    #[inline(always)]
    fn view<'a, D: Dim>(
        &'a mut self,
        shared: &Shared<'a>,
        forces: &'a mut [f32],
        first: usize,
    ) -> BlockView<'a> {
        let places = self.first as usize..self.end();
        let forces = &mut forces[self.forces::<D>(first)];
        BlockView {
            nodes: &shared.nodes[places.clone()],
            half_size: &self.half_size,
            rotation: &mut self.rotation,
            forces,
            inverted: &mut self.inverted,
        }
    }
}

/// The forces of the blocks of a group that are awake.
#[inline(always)]
pub fn evaluate_group<D: Dim, S: Simd>(
    simd: S,
    group: Group,
    position: &[Row],
    scratch: &mut [Scratch; GROUP],
) {
    let Group {
        blocks,
        forces: all,
        first,
        shared,
    } = group;
    let law = shared.law;
    for (block, scratch) in blocks.iter_mut().zip(&mut *scratch) {
        if block.is_idle() {
            continue;
        }
        let (home, stencil) = (block.home, block.stencil(&shared));
        let view = block.view::<D>(&shared, all, first);
        match (home.kind, stencil) {
            (Kind::Plain, _) => plain_gradient::<D, S>(simd, position, &view, scratch),
            (_, (one, [])) => gradient::<D, S>(simd, &Uniform(one), position, &view, scratch),
            (_, (_, each)) => gradient::<D, S>(simd, &PerLane(each), position, &view, scratch),
        }
    }
    for (block, scratch) in blocks.iter_mut().zip(&mut *scratch) {
        if block.is_idle() {
            continue;
        }
        let material = block.home.material as usize - 1;
        let moduli = &shared.moduli[material];
        let Some(Some(flow)) = shared.flows.get(material) else {
            let mut view = block.view::<D>(&shared, all, first);
            stress::<D, S>(simd, law, moduli, &mut view, scratch);
            continue;
        };
        let mut undone = block.undone.take();
        let mut view = block.view::<D>(&shared, all, first);
        match &mut undone {
            Some(undone) => {
                plastic_stress::<D, S>(simd, (moduli, flow), &mut view, undone, scratch);
            }
            None => stress::<D, S>(simd, law, moduli, &mut view, scratch),
        }
        block.undone = undone;
    }
    for (block, scratch) in blocks.iter_mut().zip(&*scratch) {
        if block.is_idle() {
            continue;
        }
        let (home, stencil) = (block.home, block.stencil(&shared));
        let moduli = &shared.moduli[home.material as usize - 1];
        let view = &mut block.view::<D>(&shared, all, first);
        match (home.kind, stencil) {
            (Kind::Plain, _) => plain_forces::<D, S>(simd, moduli, view, scratch),
            (_, (one, [])) => {
                forces::<D, S>(simd, law, moduli, &Uniform(one), view, scratch);
            }
            (_, (_, each)) => {
                forces::<D, S>(simd, law, moduli, &PerLane(each), view, scratch);
            }
        }
    }
}

/// The forces of a group, by the widest lanes the machine has.
pub fn evaluate_best<D: Dim>(group: Group, position: &[Row], scratch: &mut [Scratch; GROUP]) {
    on_widest_lanes!(simd => evaluate_group::<D, _>(simd, group, position, scratch));
}
