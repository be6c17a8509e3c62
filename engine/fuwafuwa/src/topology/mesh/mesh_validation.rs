//! Invariants of a mesh, checked by [`Mesh::validate`].

#[cfg(feature = "serde")]
use super::{Element, Node};
use super::{InvariantViolation, Mesh};
use crate::foundation::dim::{Dim, Point, neighbourhood};
#[cfg(feature = "serde")]
use crate::foundation::ids::{ElementId, Id};
use crate::foundation::ids::{IndexVec, NodeId};
#[cfg(feature = "serde")]
use crate::topology::cell_hierarchy::Cell;
use crate::topology::connectivity::Connectivity;
#[cfg(feature = "serde")]
use crate::topology::element_class::ElementClass;
use crate::topology::grid::VoxelGrid;
#[cfg(feature = "serde")]
use std::collections::BTreeMap;

impl<D: Dim> Mesh<D> {
    /// Checks the mesh. Each solid voxel belongs to exactly one element. The levels of neighbouring elements
    /// differ by at most one. No element above level 0 has a node at a lattice point with several groups. The
    /// number of elements that have each node is recorded correctly. The gradients of the elements add up to
    /// 0 at inner nodes.
    ///
    /// # Errors
    /// The first [`InvariantViolation`] found.
    #[inline(never)]
    pub fn validate(
        &self,
        grid: &VoxelGrid<D>,
        connectivity: &Connectivity<D>,
    ) -> Result<(), InvariantViolation> {
        let levels = self.check_ownership(grid)?;
        check_grading(grid, &levels)?;
        self.check_split_points(connectivity)?;
        self.check_carriers()?;
        self.check_gradients(connectivity)
    }

    /// Checks that each solid voxel belongs to exactly one element. Returns the level of this element, by the
    /// index of the voxel; `u8::MAX` for empty voxels.
    fn check_ownership(&self, grid: &VoxelGrid<D>) -> Result<Vec<u8>, InvariantViolation> {
        let mut owners = vec![u8::MAX; grid.voxels().count()];
        for (id, element) in self.elements() {
            for voxel in self.voxels(element) {
                if self.owner(voxel) != Some(id) {
                    let other = self.owner(voxel);
                    return Err(InvariantViolation(format!(
                        "element {id} fills voxel {voxel:?}, which is listed for {other:?}"
                    )));
                }
                if !grid.is_present(voxel) {
                    let cell = element.cell;
                    return Err(InvariantViolation(format!(
                        "{cell:?} fills the empty voxel {voxel:?}"
                    )));
                }
                let owner = &mut owners[grid.index(voxel)];
                if *owner != u8::MAX {
                    return Err(InvariantViolation(format!(
                        "two elements own the voxel {voxel:?}"
                    )));
                }
                *owner = element.cell.level;
            }
        }
        let is_orphan =
            |&voxel: &Point| grid.is_present(voxel) && owners[grid.index(voxel)] == u8::MAX;
        match grid.voxels().find(is_orphan) {
            Some(voxel) => Err(InvariantViolation(format!(
                "no element owns the voxel {voxel:?}"
            ))),
            None => Ok(owners),
        }
    }

    /// Checks a mesh read from a file. Its lookup tables must be consistent. Except for the ids of elements
    /// and nodes, the mesh must equal `fresh`, which was built from scratch.
    ///
    /// # Errors
    /// The first [`InvariantViolation`] found.
    #[cfg(feature = "serde")]
    pub(crate) fn check_against(
        &self,
        fresh: &Self,
        connectivity: &Connectivity<D>,
    ) -> Result<(), InvariantViolation> {
        let ensure = |good: bool, what: &str| match good {
            true => Ok(()),
            false => Err(InvariantViolation(format!("inconsistent {what}"))),
        };
        let tables = self.cell_indexing == fresh.cell_indexing
            && self.dense_surface == fresh.dense_surface
            && self.carriers.len() == self.nodes.len()
            && self.owners.len() == fresh.owners.len();
        ensure(tables, "tables of the mesh")?;
        let is_class = |(&(children, slots), &class): (&(u8, u32), &u32)| {
            let known = children != 0 && children <= D::ALL_CORNERS && slots >> D::SLOTS == 0;
            let element_class = known
                .then(|| ElementClass::<D>::new(children, slots).ok())
                .flatten();
            element_class.is_some()
                && self.element_classes.get(class as usize) == element_class.as_ref()
        };
        let classes = self.classes.len() == self.element_classes.len();
        ensure(classes && self.classes.iter().all(is_class), "classes")?;
        let is_whole = |(_, element): (ElementId, &Element)| {
            let element_class = self.element_classes.get(element.element_class as usize);
            let nodes = element.nodes.iter();
            element_class
                .is_some_and(|element_class| element_class.slots.len() == element.nodes.len())
                && { nodes }.all(|&node| node.index() < self.nodes.len())
        };
        ensure(self.elements().all(is_whole), "elements")?;
        let shapes = self.by_shape();
        ensure(
            shapes.is_some()
                && shapes == fresh.by_shape()
                && self.node_count() == fresh.node_count(),
            "elements and voxels",
        )?;

        let gone = |&id: &ElementId| self.elements[id].is_none();
        let elements = self.elements.ids().filter(gone);
        let bare = |&id: &NodeId| self.carriers[id] == 0;
        let nodes = self.nodes.ids().filter(bare);
        ensure(
            are_just(&self.free_elements, elements) && are_just(&self.free_nodes, nodes),
            "free ids",
        )?;

        let ends = self
            .by_cell
            .is_valid(self.cell_indexing.count(), self.elements.len())
            && self
                .by_point
                .is_valid(connectivity.point_count(), self.nodes.len());
        ensure(ends, "lists of ids")?;
        let at = |cell| self.cell_indexing.index(cell).into_iter();
        let listed = |cell| at(cell).flat_map(|index| self.by_cell.at(index));
        let mut elements = self.elements();
        let found = elements.all(|(id, element)| listed(element.cell).any(|other| other == id));
        let count = (0..self.cell_indexing.count()).flat_map(|index| self.by_cell.at(index));
        ensure(
            found && count.count() == self.element_count(),
            "lists of elements",
        )?;
        let beside = |node: Node| self.by_point.at(connectivity.index(node.at));
        let found = self.nodes().all(|(id, node)| {
            connectivity.contains(node.at) && beside(node).any(|other| other == id)
        });
        let count = (0..connectivity.point_count()).flat_map(|index| self.by_point.at(index));
        ensure(
            found && count.count() == self.node_count(),
            "lists of nodes",
        )?;
        let owners = self.owners.iter().zip(&fresh.owners);
        let same = { owners }.all(|(own, fresh)| (*own == 0) == (*fresh == 0));
        ensure(same, "owners")
    }

    /// Returns the nodes of each element, by the cell and the children of the element. `None` if an element
    /// has the wrong class or two elements have the same cell and children.
    #[cfg(feature = "serde")]
    fn by_shape(&self) -> Option<BTreeMap<(Cell, u8), Vec<Node>>> {
        let mut shapes = BTreeMap::new();
        for (_, element) in self.elements() {
            let nodes = element.nodes.iter().map(|&id| self.node(id)).collect();
            let element_class = self.element_class(element);
            let is_class = self.classes.get(&(element.children, element_class.mask));
            if is_class != Some(&element.element_class) {
                return None;
            }
            if shapes
                .insert((element.cell, element.children), nodes)
                .is_some()
            {
                return None;
            }
        }
        Some(shapes)
    }

    fn check_split_points(&self, connectivity: &Connectivity<D>) -> Result<(), InvariantViolation> {
        for (_, element) in self
            .elements()
            .filter(|(_, element)| element.cell.level > 0)
        {
            for &node in &element.nodes {
                let at = self.node(node).at;
                if connectivity.groups(at).iter().count() > 1 {
                    let cell = element.cell;
                    return Err(InvariantViolation(format!(
                        "{cell:?} has a node at the split point {at:?}"
                    )));
                }
            }
        }
        Ok(())
    }

    fn check_carriers(&self) -> Result<(), InvariantViolation> {
        let mut counts: IndexVec<NodeId, u8> = vec![0; self.nodes.len()].into();
        for (_, element) in self.elements() {
            element.nodes.iter().for_each(|&node| counts[node] += 1);
        }
        match counts
            .ids()
            .find(|&node| counts[node] != self.carriers[node])
        {
            Some(node) => Err(InvariantViolation(format!(
                "{:?} has {} carriers, but counts {}",
                self.nodes[node], counts[node], self.carriers[node]
            ))),
            None => Ok(()),
        }
    }

    fn check_gradients(&self, connectivity: &Connectivity<D>) -> Result<(), InvariantViolation> {
        let mut sums: IndexVec<NodeId, _> = vec![[0.0; 3]; self.nodes.len()].into();
        for (_, element) in self.elements() {
            let half = element.cell.width() as f64 * 0.5;
            let scale = (1..D::N).fold(1.0, |scale, _| scale * half);
            for (&node, gradient) in element
                .nodes
                .iter()
                .zip(&self.element_class(element).gradients)
            {
                for axis in 0..3 {
                    sums[node][axis] += gradient[axis] * scale;
                }
            }
        }
        for (id, node) in self.nodes() {
            let inner = node.group == D::ALL_CORNERS && !connectivity.is_open(node.at);
            let sum = sums[id];
            if inner && sum.iter().any(|&component: &f64| component.abs() > 1e-9) {
                let at = node.at;
                return Err(InvariantViolation(format!(
                    "gradients do not balance at {at:?}: {sum:?}"
                )));
            }
        }
        Ok(())
    }
}

/// Returns whether `ids`, which may be in any order, are exactly the ids `expected`, which must ascend.
#[cfg(feature = "serde")]
fn are_just<I: Id + Ord>(ids: &[I], expected: impl Iterator<Item = I>) -> bool {
    let mut ids = ids.to_vec();
    ids.sort_unstable();
    ids.into_iter().eq(expected)
}

fn check_grading<D: Dim>(grid: &VoxelGrid<D>, levels: &[u8]) -> Result<(), InvariantViolation> {
    for voxel in grid.voxels().filter(|&voxel| grid.is_present(voxel)) {
        let level = levels[grid.index(voxel)];
        for near in neighbourhood::<D>(voxel, 1).filter(|&near| grid.is_present(near)) {
            if level.abs_diff(levels[grid.index(near)]) > 1 {
                return Err(InvariantViolation(format!(
                    "levels jump between {voxel:?} and {near:?}"
                )));
            }
        }
    }
    Ok(())
}
