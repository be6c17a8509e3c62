//! Keeping the mesh up to date while cracks grow, at a cost that goes with what they touch.

use super::{Defect, Element, Mesh, path};
use crate::chains::ascending;
use crate::dim::{Dim, Point, add, corner, scale};
use crate::grid::VoxelGrid;
use crate::ids::{ElementId, NodeId, Table};
use crate::pyramid::{Cell, Pyramid, parts};
use crate::sharing::Sharing;
use crate::stencil::{Stencil, slot_index};
use std::ops::Range;

/// What one remodelling changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Remodelled {
    /// Elements that are gone.
    pub removed: Vec<ElementId>,
    /// Elements that are new or carry other nodes than before, ascending.
    pub seated: Vec<ElementId>,
    /// Nodes that are new, and where their state comes from.
    pub inherited: Vec<Inheritance>,
    /// Old nodes and their weights, for one new node after the other.
    pub shares: Vec<(NodeId, f64)>,
    /// Nodes that no element carries any more.
    pub abandoned: Vec<NodeId>,
    /// What the elements that are gone filled, in the order of their cells.
    gone: Vec<(Cell, u8, ElementId)>,
}

/// A new node and the old nodes whose state it takes, with weights that add up to 1.
///
/// The weights are those by which a slot without a node hands on its share, so that position,
/// velocity and linear momentum pass over exactly and both sides of a face agree. The old ids are
/// never among the new ones of the same remodelling.
#[derive(Clone, Debug, PartialEq)]
pub struct Inheritance {
    /// The new node.
    pub node: NodeId,
    /// Which of the shares are its own.
    pub from: Range<usize>,
}

impl Remodelled {
    /// The old nodes, and their weights, whose state a new one takes.
    pub fn from(&self, new: &Inheritance) -> &[(NodeId, f64)] {
        &self.shares[new.from.clone()]
    }

    /// The element that is gone and filled a voxel before.
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
    /// Brings the mesh up to date after the groups at `changed` points have changed and the cells
    /// `born` have come into being [Endo 2004, §3.2, Fig. 3]: children are generated, parents
    /// rebuilt around what is left, and nodes split, made or abandoned. What it costs goes with
    /// the elements it touches.
    ///
    /// # Errors
    /// A [`Defect`] when sharing and pyramid do not follow from one another; the mesh must then be
    /// graded anew.
    #[inline(never)]
    pub fn remodel(
        &mut self,
        grid: &VoxelGrid<D>,
        sharing: &Sharing<D>,
        pyramid: &Pyramid<D>,
        changed: &[Point],
        born: &[Cell],
    ) -> Result<Remodelled, Defect> {
        let parent_too = |&cell: &Cell| [cell, cell.parent()];
        let mut refitted: Vec<Cell> = born.iter().flat_map(parent_too).collect();
        refitted.sort_unstable();
        refitted.dedup();
        let mut past = Past::default();
        let mut removed = Vec::new();
        for &cell in &refitted {
            self.refit(cell, pyramid.filled(grid, cell), &mut past, &mut removed);
        }
        let filled = { past.removed.iter() }.map(|element| (element.cell, element.children));
        let gone = filled.zip(&removed);
        let mut gone: Vec<_> = gone
            .map(|((cell, children), &id)| (cell, children, id))
            .collect();
        gone.sort_unstable();
        past.removed.sort_unstable_by_key(|element| element.cell);
        let mut seated = Vec::new();
        for id in self.elements_touched(sharing, changed, born, &refitted) {
            if self.seat(id, sharing, Some(&mut past))? {
                seated.push(id);
            }
        }
        let abandoned = past.abandoned(&self.carriers);
        for &id in &abandoned {
            let point = sharing.index(self.node(id).at);
            self.by_point.remove(point, id);
        }
        self.free_nodes.extend(&abandoned);
        self.free_elements.extend(&removed);
        Ok(Remodelled {
            gone,
            removed,
            seated,
            inherited: past.inherited,
            shares: past.shares,
            abandoned,
        })
    }

    /// Takes out elements, and the nodes that no other carries, which it returns; grid, sharing and
    /// pyramid have them no more.
    pub(crate) fn take_out(&mut self, sharing: &Sharing<D>, elements: &[ElementId]) -> Vec<NodeId> {
        let mut nodes = Vec::new();
        for &id in elements {
            let Some(element) = self.elements[id].take() else {
                continue;
            };
            if let Some(place) = self.places.number(element.cell) {
                self.by_cell.remove(place, id);
            }
            for voxel in self.voxels(&element) {
                if let Some(place) = self.places.number(Cell::of(voxel)) {
                    self.owners[place] = 0;
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
            let point = sharing.index(self.node(id).at);
            self.by_point.remove(point, id);
        }
        self.free_nodes.extend(&gone);
        gone
    }

    /// The elements that may need other nodes, ascending: those in cells that were `refitted`, and those
    /// around points whose groups have changed or which are corners of cells that were `born`, for
    /// nodes come into being nowhere else.
    fn elements_touched(
        &self,
        sharing: &Sharing<D>,
        changed: &[Point],
        born: &[Cell],
        refitted: &[Cell],
    ) -> Vec<ElementId> {
        let corners = |&cell: &Cell| {
            let corner_of = move |vertex| scale(add(cell.at, corner(vertex)), cell.width());
            (0..D::CORNERS).map(corner_of)
        };
        let corners = born.iter().flat_map(corners);
        // Cells have their corners in common with others.
        let points = sharing.each_once(changed.iter().copied().chain(corners));
        let around = |at| self.owners_around(at, D::ALL_CORNERS);
        let places = refitted.iter().filter_map(|&cell| self.places.number(cell));
        let inside = places.flat_map(|place| self.by_cell.at(place));
        let touched = points.into_iter().flat_map(around).chain(inside);
        ascending(touched, self.elements.len())
    }

    /// Rebuilds the elements of a cell so that they fill `filled` [Endo 2004, §3.2, phase 2 d].
    fn refit(&mut self, cell: Cell, filled: u8, past: &mut Past, removed: &mut Vec<ElementId>) {
        let Some(place) = self.places.number(cell) else {
            return;
        };
        let mut left = filled;
        let present: Vec<ElementId> = self.by_cell.at(place).collect();
        for id in present {
            let children = self.alive(id).children;
            if parts::<D>(filled).any(|part| part == children) {
                left &= !children;
                continue;
            }
            self.by_cell.remove(place, id);
            let element = self.elements[id].take();
            let element = element.expect("a cell lists live elements only");
            for &node in &element.nodes {
                self.carriers[node] -= 1;
            }
            past.removed.push(element);
            removed.push(id);
        }
        for part in parts::<D>(left) {
            self.place(cell, part);
        }
    }
}

/// What a remodelling has changed so far, as it was before, and what came of it.
#[derive(Default)]
pub struct Past {
    /// Elements that are gone, in the order of their cells.
    removed: Vec<Element>,
    /// Elements that have other nodes now, by ascending id; those without any were not there before.
    pub replaced: Vec<(ElementId, Element)>,
    /// New nodes, and where their state comes from.
    pub inherited: Vec<Inheritance>,
    /// Old nodes and their weights, for one new node after the other.
    shares: Vec<(NodeId, f64)>,
}

impl Past {
    /// Adds a new node at `at` next to `voxel`, with the old nodes and weights that it inherits from: the
    /// lattice of the voxel's old owner, completed where it carries no node, and interpolated
    /// linearly inside the child that holds the voxel.
    pub fn inherit<D: Dim>(
        &mut self,
        mesh: &Mesh<D>,
        node: NodeId,
        voxel: Point,
        at: Point,
    ) -> Result<(), Defect> {
        let mut shares = std::mem::take(&mut self.shares);
        let first = shares.len();
        let (owner, child) = self
            .owner(mesh, voxel)
            .ok_or_else(|| Defect(format!("the voxel {voxel:?} had no owner")))?;
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
                collect_shares(mesh.stencil(owner), &owner.nodes, slot, weight, own);
            }
        }
        let from = first..shares.len();
        self.shares = shares;
        self.inherited.push(Inheritance { node, from });
        Ok(())
    }

    /// The old owner of a voxel and the child it lies in.
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
                    .at(mesh.places.number(cell)?)
                    .find_map(|id| self.was(mesh, id).filter(fills))
            };
            let found = removed.find(fills).or_else(here)?;
            Some((found, child))
        })
    }

    /// An element as it was, if it was there.
    fn was<'a, D: Dim>(&'a self, mesh: &'a Mesh<D>, id: ElementId) -> Option<&'a Element> {
        let place = self.replaced.binary_search_by_key(&id, |&(id, _)| id);
        let element = match place {
            Ok(place) => &self.replaced[place].1,
            Err(_) => mesh.alive(id),
        };
        (!element.nodes.is_empty()).then_some(element)
    }

    /// The old nodes that nobody carries any more, ascending.
    fn abandoned(&self, carriers: &Table<NodeId, u8>) -> Vec<NodeId> {
        let replaced = self.replaced.iter().map(|(_, element)| element);
        let old = self.removed.iter().chain(replaced);
        let old = old.flat_map(|element| element.nodes.iter().copied());
        ascending(old.filter(|&node| carriers[node] == 0), carriers.len())
    }
}

/// Adds `weight` of a slot to the nodes that stand for it: its own, or those it hands on to. Those of one new node
/// begin at a place of all shares.
fn collect_shares<D: Dim>(
    stencil: &Stencil<D>,
    nodes: &[NodeId],
    slot: Point,
    weight: f64,
    (first, shares): (usize, &mut Vec<(NodeId, f64)>),
) {
    if let Some(place) = stencil.node_at(slot_index(slot)) {
        let mut own = shares[first..].iter_mut();
        match own.find(|share| share.0 == nodes[place]) {
            Some(share) => share.1 += weight,
            None => shares.push((nodes[place], weight)),
        }
        return;
    }
    let order = slot.iter().filter(|&&k| k == 1).count();
    for axis in (0..D::N).filter(|&axis| slot[axis] == 1) {
        for end in [0, 2] {
            let mut next = slot;
            next[axis] = end;
            let weight = weight / (2 * order) as f64;
            collect_shares(stencil, nodes, next, weight, (first, &mut *shares));
        }
    }
}
