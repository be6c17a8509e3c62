//! Keeping the mesh up to date while cracks grow, at a cost that goes with what they touch.

use super::{Defect, Element, Mesh, path};
use crate::dim::{Dim, Point, add, corner, scale, voxel_around};
use crate::grid::VoxelGrid;
use crate::pyramid::{Cell, Pyramid, parts};
use crate::sharing::Sharing;
use crate::stencil::{Stencil, slot_index};
use std::collections::{BTreeMap, BTreeSet};

/// What one remodelling changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Remodelled {
    /// Elements that are gone.
    pub removed: Vec<u32>,
    /// Elements that are new or carry other nodes than before, ascending.
    pub seated: Vec<u32>,
    /// Nodes that are new, and where their state comes from.
    pub inherited: Vec<Inheritance>,
    /// Nodes that no element carries any more.
    pub abandoned: Vec<u32>,
}

/// A new node and the old nodes whose state it takes, with weights that add up to 1.
///
/// The weights are those by which a slot without a node hands on its share, so that position,
/// velocity and linear momentum pass over exactly and both sides of a face agree. The old ids are
/// never among the new ones of the same remodelling.
#[derive(Clone, Debug, PartialEq)]
pub struct Inheritance {
    /// The new node.
    pub node: u32,
    /// Old nodes and their weights.
    pub from: Vec<(u32, f64)>,
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
        let mut past = Past::default();
        let mut remodelled = Remodelled::default();
        let mut points: BTreeSet<Point> = changed.iter().copied().collect();
        let refitted: BTreeSet<Cell> = born
            .iter()
            .flat_map(|&cell| [cell, cell.parent()])
            .collect();
        for &cell in &refitted {
            points.extend(
                (0..D::CORNERS).map(|vertex| scale(add(cell.at, corner(vertex)), cell.width())),
            );
            self.refit(
                cell,
                pyramid.filled(grid, cell),
                &mut past,
                &mut remodelled.removed,
            );
        }
        let touched: BTreeSet<u32> = points
            .iter()
            .flat_map(|&at| (0..D::CORNERS).map(move |octant| voxel_around::<D>(at, octant)))
            .filter(|&voxel| grid.is_solid(voxel))
            .filter_map(|voxel| self.owner(voxel))
            .collect();
        for &id in &touched {
            let element = self.elements[id as usize]
                .as_ref()
                .expect("owners are alive");
            past.keep(element);
        }
        for &id in &touched {
            if self.seat(id, sharing, Some((&past, &mut remodelled.inherited)))? {
                remodelled.seated.push(id);
            }
        }
        remodelled.abandoned = past.abandoned(&self.carriers);
        for &id in &remodelled.abandoned {
            let point = sharing.index(self.node(id).at);
            self.by_point.remove(point, id);
        }
        self.free_nodes.extend(&remodelled.abandoned);
        self.free_elements.extend(&remodelled.removed);
        Ok(remodelled)
    }

    /// Rebuilds the elements of a cell so that they fill `filled` [Endo 2004, §3.2, phase 2 d].
    fn refit(&mut self, cell: Cell, filled: u8, past: &mut Past, removed: &mut Vec<u32>) {
        let wanted: Vec<u8> = parts::<D>(filled).collect();
        let Some(place) = self.places.number(cell) else {
            return;
        };
        let (kept, outdated): (Vec<u32>, Vec<u32>) = self
            .by_cell
            .at(place)
            .partition(|&id| wanted.contains(&self.alive(id).children));
        let is_new = |children: &&u8| kept.iter().all(|&id| self.alive(id).children != **children);
        let new: Vec<u8> = wanted.iter().filter(is_new).copied().collect();
        for &id in kept.iter().chain(&outdated) {
            past.keep(self.alive(id));
        }
        for id in outdated {
            self.by_cell.remove(place, id);
            let element = self.elements[id as usize]
                .take()
                .expect("outdated elements were alive");
            element
                .nodes
                .iter()
                .for_each(|&node| self.carriers[node as usize] -= 1);
            removed.push(id);
        }
        for children in new {
            self.place(cell, children);
        }
    }
}

/// The elements of every cell that a remodelling touches, as they were before it.
#[derive(Default)]
pub struct Past {
    by_cell: BTreeMap<Cell, Vec<Element>>,
}

impl Past {
    /// Remembers an element; one that has no nodes yet has no past.
    fn keep(&mut self, element: &Element) {
        let known = self.by_cell.entry(element.cell).or_default();
        let is_new = known.iter().all(|old| old.children & element.children == 0);
        if is_new && !element.nodes.is_empty() {
            known.push(element.clone());
        }
    }

    /// The old nodes, with weights, that a new node at `at` next to `voxel` inherits from: the
    /// lattice of the voxel's old owner, completed where it carries no node, and interpolated
    /// linearly inside the child that holds the voxel.
    pub fn shares<D: Dim>(
        &self,
        mesh: &Mesh<D>,
        voxel: Point,
        at: Point,
    ) -> Result<Vec<(u32, f64)>, Defect> {
        let (owner, child) = self
            .owner(mesh, voxel)
            .ok_or_else(|| Defect(format!("the voxel {voxel:?} had no owner")))?;
        let cell = owner.cell;
        let mut shares = Vec::new();
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
                collect_shares(mesh.stencil(owner), &owner.nodes, slot, weight, &mut shares);
            }
        }
        Ok(shares)
    }

    /// The old owner of a voxel and the child it lies in.
    fn owner<'a, D: Dim>(
        &'a self,
        mesh: &'a Mesh<D>,
        voxel: Point,
    ) -> Option<(&'a Element, usize)> {
        path::<D>(voxel).find_map(|(cell, child)| {
            let fills = |element: &&Element| element.children >> child & 1 == 1;
            let found = match self.by_cell.get(&cell) {
                Some(old) => old.iter().find(fills),
                None => {
                    let ids = mesh.by_cell.at(mesh.places.number(cell)?);
                    ids.map(|id| mesh.alive(id)).find(fills)
                }
            };
            Some((found?, child))
        })
    }

    /// The old nodes that nobody carries any more, ascending.
    fn abandoned(&self, carriers: &[u8]) -> Vec<u32> {
        let old = self
            .by_cell
            .values()
            .flatten()
            .flat_map(|element| &element.nodes);
        let gone: BTreeSet<u32> = old
            .filter(|&&node| carriers[node as usize] == 0)
            .copied()
            .collect();
        gone.into_iter().collect()
    }
}

/// Adds `weight` of a slot to the nodes that stand for it: its own, or those it hands on to.
fn collect_shares<D: Dim>(
    stencil: &Stencil<D>,
    nodes: &[u32],
    slot: Point,
    weight: f64,
    shares: &mut Vec<(u32, f64)>,
) {
    let index = slot_index(slot) as u8;
    if let Ok(place) = stencil.slots.binary_search(&index) {
        match shares.iter_mut().find(|share| share.0 == nodes[place]) {
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
            collect_shares(stencil, nodes, next, weight / (2 * order) as f64, shares);
        }
    }
}
