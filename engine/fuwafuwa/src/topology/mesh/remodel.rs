//! Update of the mesh after cracks, at a cost proportional to the number of changed elements.

use super::{Element, InvariantViolation, Mesh, path};
use crate::foundation::dim::{Dim, Point, add, corner, scale};
use crate::foundation::id_lists::ascending;
use crate::foundation::ids::{ElementId, IndexVec, NodeId};
use crate::topology::cell_hierarchy::{Cell, CellHierarchy, parts};
use crate::topology::connectivity::Connectivity;
use crate::topology::element_class::{ElementClass, slot_index};
use crate::topology::grid::VoxelGrid;
use std::ops::Range;

/// Changes of a mesh in one remodelling.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Remodelled {
    /// Ids of the removed elements.
    pub removed: Vec<ElementId>,
    /// Ids of the elements that are new or whose nodes have changed, ascending.
    pub changed_elements: Vec<ElementId>,
    /// New nodes, each with the range in `shares` of the old nodes from which it inherits its state.
    pub inherited: Vec<Inheritance>,
    /// Ids of old nodes with interpolation weights, for all entries of `inherited` in turn.
    pub shares: Vec<(NodeId, f64)>,
    /// Ids of the nodes that were removed, because no element has them any more.
    pub abandoned: Vec<NodeId>,
    /// Cell, children and id of each removed element, sorted by cell.
    gone: Vec<(Cell, u8, ElementId)>,
}

/// New node, and the old nodes from which its state is interpolated, with weights that add up to 1.
///
/// The weights are those of the old element for a point without a node. Therefore position, velocity and
/// linear momentum are transferred exactly, and the elements on both sides of a face give the new node the
/// same state. Ids of removed nodes are not used for new nodes in the same remodelling.
#[derive(Clone, Debug, PartialEq)]
pub struct Inheritance {
    /// Id of the new node.
    pub node: NodeId,
    /// Range in [`Remodelled::shares`] of the old nodes and their weights.
    pub from: Range<usize>,
}

impl Remodelled {
    /// Returns the ids of the old nodes from which the state of a new node is interpolated, with their
    /// weights.
    pub fn from(&self, new: &Inheritance) -> &[(NodeId, f64)] {
        &self.shares[new.from.clone()]
    }

    /// Returns the removed element that contained a voxel before the remodelling; `None` if that element was
    /// not removed.
    pub fn origin<D: Dim>(&self, voxel: Point) -> Option<ElementId> {
        path::<D>(voxel).find_map(|(cell, child)| {
            let first = self.gone.partition_point(|gone| gone.0 < cell);
            let mut here = self.gone[first..].iter().take_while(|gone| gone.0 == cell);
            let own = here.find(|(_, children, _)| children >> child & 1 == 1);
            own.map(|&(.., id)| id)
        })
    }
}

impl<D: Dim> Mesh<D> {
    /// Updates the mesh after the groups at the lattice points `changed` were split and the cells `born` were
    /// created [Endo 2004, §3.2, Fig. 3]. Creates the elements of the new cells, rebuilds the elements of
    /// their parents from the remaining children, and splits, creates or removes nodes. The cost is
    /// proportional to the number of affected elements.
    ///
    /// # Errors
    /// An [`InvariantViolation`] if connectivity and cell hierarchy do not match; the mesh must then be
    /// graded from scratch.
    #[inline(never)]
    pub fn remodel(
        &mut self,
        grid: &VoxelGrid<D>,
        connectivity: &Connectivity<D>,
        hierarchy: &CellHierarchy<D>,
        changed: &[Point],
        born: &[Cell],
    ) -> Result<Remodelled, InvariantViolation> {
        let parent_too = |&cell: &Cell| [cell, cell.parent()];
        let mut refitted: Vec<Cell> = born.iter().flat_map(parent_too).collect();
        refitted.sort_unstable();
        refitted.dedup();
        let mut past = Past::default();
        let mut removed = Vec::new();
        for &cell in &refitted {
            self.refit(cell, hierarchy.filled(grid, cell), &mut past, &mut removed);
        }
        let filled = { past.removed.iter() }.map(|element| (element.cell, element.children));
        let gone = filled.zip(&removed);
        let mut gone: Vec<_> = gone
            .map(|((cell, children), &id)| (cell, children, id))
            .collect();
        gone.sort_unstable();
        past.removed.sort_unstable_by_key(|element| element.cell);
        let mut changed_elements = Vec::new();
        for id in self.elements_touched(connectivity, changed, born, &refitted) {
            if self.assign_nodes(id, connectivity, Some(&mut past))? {
                changed_elements.push(id);
            }
        }
        let abandoned = past.abandoned(&self.carriers);
        for &id in &abandoned {
            let point = connectivity.index(self.node(id).at);
            self.by_point.remove(point, id);
        }
        self.free_nodes.extend(&abandoned);
        self.free_elements.extend(&removed);
        Ok(Remodelled {
            gone,
            removed,
            changed_elements,
            inherited: past.inherited,
            shares: past.shares,
            abandoned,
        })
    }

    /// Removes elements, and the nodes that no other element has. Returns the ids of these nodes. The caller
    /// must update grid, connectivity and cell hierarchy.
    pub(crate) fn remove_elements(
        &mut self,
        connectivity: &Connectivity<D>,
        elements: &[ElementId],
    ) -> Vec<NodeId> {
        let mut nodes = Vec::new();
        for &id in elements {
            let Some(element) = self.elements[id].take() else {
                continue;
            };
            if let Some(index) = self.cell_indexing.index(element.cell) {
                self.by_cell.remove(index, id);
            }
            for voxel in self.voxels(&element) {
                if let Some(index) = self.cell_indexing.index(Cell::of(voxel)) {
                    self.owners[index] = 0;
                }
            }
            for &node in &element.nodes {
                self.carriers[node] -= 1;
            }
            self.free_elements.push(id);
            nodes.extend(element.nodes);
        }
        nodes.retain(|&node| self.carriers[node] == 0);
        let gone = ascending(nodes.into_iter(), self.carriers.len());
        for &id in &gone {
            let point = connectivity.index(self.node(id).at);
            self.by_point.remove(point, id);
        }
        self.free_nodes.extend(&gone);
        gone
    }

    /// Returns the elements whose nodes may change, ascending. These are the elements in `refitted` cells,
    /// around the `changed` lattice points, and around the corners of `born` cells.
    fn elements_touched(
        &self,
        connectivity: &Connectivity<D>,
        changed: &[Point],
        born: &[Cell],
        refitted: &[Cell],
    ) -> Vec<ElementId> {
        let corners = |&cell: &Cell| {
            let corner_of = move |vertex| scale(add(cell.at, corner(vertex)), cell.width());
            (0..D::CORNERS).map(corner_of)
        };
        let corners = born.iter().flat_map(corners);
        // Lists each lattice point once, because neighbouring cells have common corners.
        let points = connectivity.each_once(changed.iter().copied().chain(corners));
        let around = |at| self.owners_around(at, D::ALL_CORNERS);
        let indices = refitted
            .iter()
            .filter_map(|&cell| self.cell_indexing.index(cell));
        let inside = indices.flat_map(|index| self.by_cell.at(index));
        let touched = points.into_iter().flat_map(around).chain(inside);
        ascending(touched, self.elements.len())
    }

    /// Rebuilds the elements of a cell so that together they fill the children in the mask `filled` [Endo
    /// 2004, §3.2, phase 2 d].
    fn refit(&mut self, cell: Cell, filled: u8, past: &mut Past, removed: &mut Vec<ElementId>) {
        let Some(index) = self.cell_indexing.index(cell) else {
            return;
        };
        let mut left = filled;
        let present: Vec<ElementId> = self.by_cell.at(index).collect();
        for id in present {
            let children = self.alive(id).children;
            if parts::<D>(filled).any(|part| part == children) {
                left &= !children;
                continue;
            }
            self.by_cell.remove(index, id);
            let element = self.elements[id].take();
            let element = element.expect("a cell lists live elements only");
            for &node in &element.nodes {
                self.carriers[node] -= 1;
            }
            past.removed.push(element);
            removed.push(id);
        }
        for part in parts::<D>(left) {
            self.add_element(cell, part);
        }
    }
}

/// Elements before a remodelling, as far as they have changed, and the new nodes that inherit state from
/// them.
#[derive(Default)]
pub struct Past {
    /// Removed elements. Sorted by cell before the first call of [`Past::inherit`].
    removed: Vec<Element>,
    /// Elements whose nodes have changed, as they were before, by ascending id. An element without nodes was
    /// created by the remodelling.
    pub replaced: Vec<(ElementId, Element)>,
    /// New nodes, each with the range in `shares` of the old nodes from which it inherits its state.
    pub inherited: Vec<Inheritance>,
    /// Ids of old nodes with interpolation weights, for all entries of `inherited` in turn.
    shares: Vec<(NodeId, f64)>,
}

impl Past {
    /// Adds a new node at the lattice point `at`, a corner of `voxel`. Computes the old nodes and weights
    /// from which the state of the new node is interpolated. These belong to the element that contained the
    /// voxel before the remodelling. The corners of the child that contained the voxel are interpolated
    /// linearly to `at`. A corner slot without a node is itself interpolated from adjacent slots.
    pub fn inherit<D: Dim>(
        &mut self,
        mesh: &Mesh<D>,
        node: NodeId,
        voxel: Point,
        at: Point,
    ) -> Result<(), InvariantViolation> {
        let mut shares = std::mem::take(&mut self.shares);
        let first = shares.len();
        let (owner, child) = self
            .owner(mesh, voxel)
            .ok_or_else(|| InvariantViolation(format!("the voxel {voxel:?} had no owner")))?;
        let cell = owner.cell;
        for vertex in 0..D::CORNERS {
            let (slot, weight) = if cell.level == 0 {
                let here = (0..D::N).all(|axis| at[axis] - cell.at[axis] == corner(vertex)[axis]);
                (scale(corner(vertex), 2), f64::from(u8::from(here)))
            } else {
                let low = cell.child(child).first_voxel();
                let weight = (0..D::N).fold(1.0, |weight, axis| {
                    let part = f64::from(at[axis] - low[axis]) / f64::from(cell.width() / 2);
                    weight
                        * if vertex >> axis & 1 == 1 {
                            part
                        } else {
                            1.0 - part
                        }
                });
                (add(corner(child), corner(vertex)), weight)
            };
            if weight != 0.0 {
                let own = (first, &mut shares);
                collect_shares(mesh.element_class(owner), &owner.nodes, slot, weight, own);
            }
        }
        let from = first..shares.len();
        self.shares = shares;
        self.inherited.push(Inheritance { node, from });
        Ok(())
    }

    /// Returns the element that contained a voxel before the remodelling, and the index of the child that
    /// contained the voxel.
    fn owner<'a, D: Dim>(
        &'a self,
        mesh: &'a Mesh<D>,
        voxel: Point,
    ) -> Option<(&'a Element, usize)> {
        path::<D>(voxel).find_map(|(cell, child)| {
            let fills = |element: &&Element| element.children >> child & 1 == 1;
            let first = self.removed.partition_point(|element| element.cell < cell);
            let removed = self.removed[first..].iter();
            let mut removed = removed.take_while(|element| element.cell == cell);
            let here = || {
                mesh.by_cell
                    .at(mesh.cell_indexing.index(cell)?)
                    .find_map(|id| self.was(mesh, id).filter(fills))
            };
            let found = removed.find(fills).or_else(here)?;
            Some((found, child))
        })
    }

    /// Returns an element as it was before the remodelling; `None` if the remodelling created the element.
    fn was<'a, D: Dim>(&'a self, mesh: &'a Mesh<D>, id: ElementId) -> Option<&'a Element> {
        let index = self.replaced.binary_search_by_key(&id, |&(id, _)| id);
        let element = match index {
            Ok(index) => &self.replaced[index].1,
            Err(_) => mesh.alive(id),
        };
        (!element.nodes.is_empty()).then_some(element)
    }

    /// Returns the ids of the old nodes that no element has any more, ascending.
    fn abandoned(&self, carriers: &IndexVec<NodeId, u8>) -> Vec<NodeId> {
        let replaced = self.replaced.iter().map(|(_, element)| element);
        let old = self.removed.iter().chain(replaced);
        let old = old.flat_map(|element| element.nodes.iter().copied());
        ascending(old.filter(|&node| carriers[node] == 0), carriers.len())
    }
}

/// Adds `weight` to the node on a slot. If the slot has no node, distributes the weight in equal parts to
/// adjacent slots, recursively. The entries of the current new node begin at index `first` of the list.
fn collect_shares<D: Dim>(
    element_class: &ElementClass<D>,
    nodes: &[NodeId],
    slot: Point,
    weight: f64,
    (first, shares): (usize, &mut Vec<(NodeId, f64)>),
) {
    if let Some(index) = element_class.node_at(slot_index(slot)) {
        let mut own = shares[first..].iter_mut();
        match own.find(|share| share.0 == nodes[index]) {
            Some(share) => share.1 += weight,
            None => shares.push((nodes[index], weight)),
        }
        return;
    }
    let order = slot.iter().filter(|&&k| k == 1).count();
    for axis in (0..D::N).filter(|&axis| slot[axis] == 1) {
        for end in [0, 2] {
            let mut next = slot;
            next[axis] = end;
            let weight = weight / (2 * order) as f64;
            collect_shares(element_class, nodes, next, weight, (first, &mut *shares));
        }
    }
}
