//! Nodes and elements: the graded mesh that follows from what is solid and what is connected.
//!
//! A node is a lattice point with one group of voxels there. It exists exactly when it is a corner
//! of some element's own cell, at a child that the element fills; an element carries every such
//! node in the closure of its children. Hanging nodes are true nodes of the bigger element.
//!
//! ```text
//!   ┌───┬─┬─┐     the level-1 element on the left carries five nodes: its four corners and the
//!   │   ├─┼─┤     middle of its right edge, which is a corner of its level-0 neighbours
//!   └───┴─┴─┘
//! ```

use crate::dim::{Dim, Point, add, corner, neighbourhood, points_in, scale, voxel_around};
use crate::grid::VoxelGrid;
use crate::pyramid::{Cell, Grading, Pyramid, parts};
use crate::sharing::Sharing;
use crate::stencil::{MissingCorner, Stencil, cell_corners, closure, slot_at, slot_index};
use crate::table::{Chains, Places};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// An elastic unit on a cell or on a face-connected part of one.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Element {
    /// Where it sits.
    pub cell: Cell,
    /// The children of the cell that it fills; every corner set at level 0.
    pub children: u8,
    /// Its class: see [`Mesh::stencil`].
    pub stencil: u32,
    /// Its nodes, in the order of the stencil's slots.
    pub nodes: Vec<u32>,
}

/// A mass point: a lattice point and the octants of the group that shares it.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Node {
    /// Lattice point at rest.
    pub at: Point,
    /// The voxels around the point that share this node, as a mask of octants.
    pub group: u8,
}

/// The elements of one body and the nodes they share.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Mesh<D: Dim> {
    elements: Vec<Option<Element>>,
    nodes: Vec<Node>,
    stencils: Vec<Stencil<D>>,
    /// Whether every lattice point of the surface is a node, whatever the size of its elements.
    dense_surface: bool,
    /// The places of the cells of each level, and the elements of each cell.
    cells: Vec<Places>,
    by_cell: Chains,
    /// The places of the lattice points, and the nodes of each point.
    points: Places,
    by_point: Chains,
    classes: BTreeMap<(u8, u32), u32>,
    /// How many elements carry each node; 0 = the id is free.
    carriers: Vec<u8>,
    free_elements: Vec<u32>,
    free_nodes: Vec<u32>,
}

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

/// A broken invariant of a mesh: what, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Defect(String);

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Defect {}

impl From<MissingCorner> for Defect {
    fn from(missing: MissingCorner) -> Self {
        Self(missing.to_string())
    }
}

impl<D: Dim> Mesh<D> {
    /// Places the elements of a body from scratch.
    ///
    /// # Errors
    /// A [`Defect`] when the pyramid does not belong to this grid and sharing.
    pub fn grade(
        grid: &VoxelGrid<D>,
        sharing: &Sharing<D>,
        pyramid: &Pyramid<D>,
    ) -> Result<Self, Defect> {
        let mut cells: Vec<Places> = Vec::new();
        for level in 0..pyramid.level_count() as u8 {
            let first = cells.last().map_or(0, Places::end);
            cells.push(Places::new(pyramid.size(level), first));
        }
        let points = Places::new(sharing.size(), 0);
        let mut mesh = Self {
            elements: Vec::new(),
            nodes: Vec::new(),
            stencils: Vec::new(),
            dense_surface: pyramid.grading() == Grading::Coarse,
            by_cell: Chains::new(cells.last().map_or(0, Places::end)),
            cells,
            by_point: Chains::new(points.end()),
            points,
            classes: BTreeMap::new(),
            carriers: Vec::new(),
            free_elements: Vec::new(),
            free_nodes: Vec::new(),
        };
        for level in 0..pyramid.level_count() as u8 {
            for cell in pyramid.cells(level) {
                for children in parts::<D>(pyramid.filled(grid, cell)) {
                    mesh.place(cell, children);
                }
            }
        }
        for id in 0..mesh.elements.len() as u32 {
            mesh.seat(id, sharing, None)?;
        }
        Ok(mesh)
    }

    /// Brings the mesh up to date after the groups at `changed` points have changed and the cells
    /// `born` have come into being [Endo 2004, §3.2, Fig. 3]: children are generated, parents
    /// rebuilt around what is left, and nodes split, made or abandoned. What it costs goes with
    /// the elements it touches.
    ///
    /// # Errors
    /// A [`Defect`] when sharing and pyramid do not follow from one another; the mesh must then be
    /// graded anew.
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
            let place = self.place_of_point(self.nodes[id as usize].at);
            self.by_point.remove(place, id);
        }
        self.free_nodes.extend(&remodelled.abandoned);
        self.free_elements.extend(&remodelled.removed);
        Ok(remodelled)
    }

    /// The elements with their ids, ascending.
    pub fn elements(&self) -> impl Iterator<Item = (u32, &Element)> {
        let alive = self.elements.iter().enumerate();
        alive.filter_map(|(id, element)| Some((id as u32, element.as_ref()?)))
    }

    /// Number of elements.
    pub fn element_count(&self) -> usize {
        self.elements.iter().flatten().count()
    }

    /// The nodes with their ids, ascending.
    pub fn nodes(&self) -> impl Iterator<Item = (u32, Node)> + '_ {
        let alive = self.nodes.iter().zip(&self.carriers).enumerate();
        alive.filter_map(|(id, (&node, &carriers))| (carriers > 0).then_some((id as u32, node)))
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.len() - self.free_nodes.len()
    }

    /// One more than the highest node id ever used: the length of an array indexed by node.
    pub fn node_capacity(&self) -> usize {
        self.nodes.len()
    }

    /// One more than the highest element id ever used: the length of an array indexed by element.
    pub fn element_capacity(&self) -> usize {
        self.elements.len()
    }

    /// Whether some element carries the node with this id.
    pub fn is_alive(&self, id: u32) -> bool {
        self.carriers[id as usize] > 0
    }

    /// The node with an id.
    ///
    /// # Panics
    /// When the id was never used.
    pub fn node(&self, id: u32) -> Node {
        self.nodes[id as usize]
    }

    /// The element with an id, if it is alive.
    pub fn element(&self, id: u32) -> Option<&Element> {
        self.elements.get(id as usize)?.as_ref()
    }

    /// The elements that carry a node, each with the node's place among its own, in the order of
    /// the octants around the node: an order that no numbering can change.
    pub fn carriers_of(&self, id: u32) -> impl Iterator<Item = (&Element, usize)> {
        self.carrier_ids(id).into_iter().map(move |owner| {
            let element = self.alive(owner);
            let place = element.nodes.iter().position(|&node| node == id);
            (
                element,
                place.expect("an element in a node's group carries it"),
            )
        })
    }

    /// The ids of the elements that carry a node, in the order of the octants around it.
    pub fn carrier_ids(&self, id: u32) -> Vec<u32> {
        let node = self.node(id);
        let mut owners: Vec<u32> = Vec::with_capacity(D::CORNERS);
        for octant in (0..D::CORNERS).filter(|octant| node.group >> octant & 1 == 1) {
            let owner = self.owner(voxel_around::<D>(node.at, octant));
            owners.extend(owner.filter(|owner| !owners.contains(owner)));
        }
        owners
    }

    /// Number of elements on each level, finest first.
    pub fn elements_per_level(&self) -> Vec<usize> {
        let mut counts = Vec::new();
        for (_, element) in self.elements() {
            let level = element.cell.level as usize;
            counts.resize(counts.len().max(level + 1), 0);
            counts[level] += 1;
        }
        counts
    }

    /// Number of vertices when each element counts its own, as the paper does in §3.1.
    pub fn independent_vertex_count(&self) -> usize {
        self.elements()
            .map(|(_, element)| element.nodes.len())
            .sum()
    }

    /// The stencil of an element.
    pub fn stencil(&self, element: &Element) -> &Stencil<D> {
        &self.stencils[element.stencil as usize]
    }

    /// The element that owns a solid voxel; `None` for an empty one.
    pub fn owner(&self, voxel: Point) -> Option<u32> {
        path::<D>(voxel).find_map(|(cell, child)| {
            let fills = |id: &u32| self.alive(*id).children >> child & 1 == 1;
            self.elements_of(cell).find(fills)
        })
    }

    /// A voxel that an element fills.
    pub fn first_voxel(&self, element: &Element) -> Point {
        let child = element.children.trailing_zeros() as usize;
        match element.cell.level {
            0 => element.cell.at,
            _ => element.cell.child(child).first_voxel(),
        }
    }

    /// The voxels that an element fills.
    pub fn voxels(&self, element: &Element) -> Vec<Point> {
        if element.cell.level == 0 {
            return vec![element.cell.at];
        }
        let reach = element.cell.width() / 2 - 1;
        (0..D::CORNERS)
            .filter(|child| element.children >> child & 1 == 1)
            .flat_map(|child| {
                let low = element.cell.child(child).first_voxel();
                let mut high = low;
                high.iter_mut().take(D::N).for_each(|k| *k += reach);
                points_in(low, high)
            })
            .collect()
    }

    /// Whether two meshes are the same but for the numbering of their elements and nodes.
    pub fn is_same_as(&self, other: &Self) -> bool {
        self.canonical() == other.canonical()
    }

    /// Checks that every solid voxel is owned once, that neighbours differ by at most one level,
    /// that no coarse element meets a split point, that every node has the carriers it counts,
    /// and that gradients balance at inner nodes.
    ///
    /// # Errors
    /// The first [`Defect`] found.
    pub fn validate(&self, grid: &VoxelGrid<D>, sharing: &Sharing<D>) -> Result<(), Defect> {
        let levels = self.check_ownership(grid)?;
        check_grading(grid, &levels)?;
        self.check_split_points(sharing)?;
        self.check_carriers()?;
        self.check_gradients(sharing)
    }

    fn alive(&self, id: u32) -> &Element {
        self.elements[id as usize]
            .as_ref()
            .expect("a cell lists live elements only")
    }

    /// Every element as what it fills and whom it touches, in the order of the cells.
    fn canonical(&self) -> Vec<(Cell, u8, Vec<Node>)> {
        let mut all: Vec<_> = self
            .elements()
            .map(|(_, element)| {
                let nodes = element.nodes.iter().map(|&id| self.node(id)).collect();
                (element.cell, element.children, nodes)
            })
            .collect();
        all.sort();
        all
    }

    /// Adds an element without nodes.
    fn place(&mut self, cell: Cell, children: u8) {
        let element = Element {
            cell,
            children,
            stencil: u32::MAX,
            nodes: Vec::new(),
        };
        let id = self
            .free_elements
            .pop()
            .unwrap_or(self.elements.len() as u32);
        if id as usize == self.elements.len() {
            self.elements.push(Some(element));
        } else {
            self.elements[id as usize] = Some(element);
        }
        let place = self.place_of_cell(cell).expect("elements lie in the grid");
        self.by_cell.insert(place, id);
    }

    /// The elements of a cell.
    #[inline]
    fn elements_of(&self, cell: Cell) -> impl Iterator<Item = u32> + '_ {
        let place = self.place_of_cell(cell);
        place.into_iter().flat_map(|place| self.by_cell.at(place))
    }

    #[inline]
    fn place_of_cell(&self, cell: Cell) -> Option<usize> {
        self.cells.get(cell.level as usize)?.number(cell.at)
    }

    fn place_of_point(&self, at: Point) -> usize {
        let number = self.points.number(at);
        number.expect("nodes are lattice points")
    }

    /// Rebuilds the elements of a cell so that they fill `filled` [Endo 2004, §3.2, phase 2 d].
    fn refit(&mut self, cell: Cell, filled: u8, past: &mut Past, removed: &mut Vec<u32>) {
        let wanted: Vec<u8> = parts::<D>(filled).collect();
        let (kept, outdated): (Vec<u32>, Vec<u32>) = self
            .elements_of(cell)
            .partition(|&id| wanted.contains(&self.alive(id).children));
        let is_new = |children: &&u8| kept.iter().all(|&id| self.alive(id).children != **children);
        let new: Vec<u8> = wanted.iter().filter(is_new).copied().collect();
        for &id in kept.iter().chain(&outdated) {
            past.keep(self.alive(id));
        }
        for id in outdated {
            let element = self.elements[id as usize]
                .take()
                .expect("outdated elements were alive");
            element
                .nodes
                .iter()
                .for_each(|&node| self.carriers[node as usize] -= 1);
            let place = self.place_of_cell(cell).expect("elements lie in the grid");
            self.by_cell.remove(place, id);
            removed.push(id);
        }
        for children in new {
            self.place(cell, children);
        }
    }

    /// Gives an element the nodes and the class that its surroundings ask for; false when it has
    /// them already. A new node inherits from the past, where there is one.
    fn seat(
        &mut self,
        id: u32,
        sharing: &Sharing<D>,
        mut past: Option<(&Past, &mut Vec<Inheritance>)>,
    ) -> Result<bool, Defect> {
        let (cell, children) = (self.alive(id).cell, self.alive(id).children);
        let whole = cell.level == 0;
        let candidates = if whole {
            cell_corners::<D>()
        } else {
            closure::<D>(children)
        };
        let mut slots = 0u32;
        let mut wanted = Vec::new();
        for slot in (0..D::SLOTS).filter(|slot| candidates >> slot & 1 == 1) {
            let (at, octant) = seat_of::<D>(cell, children, slot);
            let node = Node {
                at,
                group: sharing.groups(at).group_of(octant),
            };
            let on_surface = self.dense_surface && node.group != D::ALL_CORNERS;
            if whole || on_surface || self.is_node(node) {
                slots |= 1 << slot;
                wanted.push((node, voxel_around::<D>(at, octant)));
            }
        }
        let mut nodes = Vec::with_capacity(wanted.len());
        for (node, voxel) in wanted {
            let (node_id, is_new) = self.node_id(node);
            if let (true, Some((past, inherited))) = (is_new, &mut past) {
                let from = past.shares(self, voxel, node.at)?;
                inherited.push(Inheritance {
                    node: node_id,
                    from,
                });
            }
            nodes.push(node_id);
        }
        let stencil = self.class(children, slots)?;
        let element = self.elements[id as usize]
            .as_mut()
            .expect("seated elements are alive");
        let changed = element.nodes != nodes || element.stencil != stencil;
        nodes
            .iter()
            .for_each(|&node| self.carriers[node as usize] += 1);
        element
            .nodes
            .iter()
            .for_each(|&node| self.carriers[node as usize] -= 1);
        element.nodes = nodes;
        element.stencil = stencil;
        Ok(changed)
    }

    /// Whether a (point, group) is a corner of some owner's own cell.
    fn is_node(&self, node: Node) -> bool {
        (0..D::CORNERS)
            .filter(|octant| node.group >> octant & 1 == 1)
            .filter_map(|octant| self.owner(voxel_around::<D>(node.at, octant)))
            .any(|owner| {
                let width = self.alive(owner).cell.width();
                (0..D::N).all(|axis| node.at[axis] % width == 0)
            })
    }

    /// The id of a node, and whether it was made just now.
    fn node_id(&mut self, node: Node) -> (u32, bool) {
        let place = self.place_of_point(node.at);
        let known = |id: &u32| self.nodes[*id as usize].group == node.group;
        if let Some(id) = self.by_point.at(place).find(known) {
            return (id, false);
        }
        let id = self.free_nodes.pop().unwrap_or(self.nodes.len() as u32);
        if id as usize == self.nodes.len() {
            self.nodes.push(node);
            self.carriers.push(0);
        } else {
            self.nodes[id as usize] = node;
        }
        self.by_point.insert(place, id);
        (id, true)
    }

    fn class(&mut self, children: u8, slots: u32) -> Result<u32, Defect> {
        if let Some(&class) = self.classes.get(&(children, slots)) {
            return Ok(class);
        }
        let class = self.stencils.len() as u32;
        self.stencils.push(Stencil::new(children, slots)?);
        self.classes.insert((children, slots), class);
        Ok(class)
    }

    /// The level that owns each voxel; `u8::MAX` where there is none.
    fn check_ownership(&self, grid: &VoxelGrid<D>) -> Result<Vec<u8>, Defect> {
        let mut owners = vec![u8::MAX; grid.voxels().count()];
        for (_, element) in self.elements() {
            for voxel in self.voxels(element) {
                if !grid.is_solid(voxel) {
                    let cell = element.cell;
                    return Err(Defect(format!("{cell:?} fills the empty voxel {voxel:?}")));
                }
                let owner = &mut owners[grid.index(voxel)];
                if *owner != u8::MAX {
                    return Err(Defect(format!("two elements own the voxel {voxel:?}")));
                }
                *owner = element.cell.level;
            }
        }
        let is_orphan =
            |&voxel: &Point| grid.is_solid(voxel) && owners[grid.index(voxel)] == u8::MAX;
        match grid.voxels().find(is_orphan) {
            Some(voxel) => Err(Defect(format!("no element owns the voxel {voxel:?}"))),
            None => Ok(owners),
        }
    }

    fn check_split_points(&self, sharing: &Sharing<D>) -> Result<(), Defect> {
        for (_, element) in self
            .elements()
            .filter(|(_, element)| element.cell.level > 0)
        {
            for &node in &element.nodes {
                let at = self.node(node).at;
                if sharing.groups(at).iter().count() > 1 {
                    let cell = element.cell;
                    return Err(Defect(format!("{cell:?} meets the split point {at:?}")));
                }
            }
        }
        Ok(())
    }

    fn check_carriers(&self) -> Result<(), Defect> {
        let mut counts = vec![0u8; self.nodes.len()];
        for (_, element) in self.elements() {
            element
                .nodes
                .iter()
                .for_each(|&node| counts[node as usize] += 1);
        }
        match (0..counts.len()).find(|&node| counts[node] != self.carriers[node]) {
            Some(node) => Err(Defect(format!(
                "{:?} has {} carriers and counts {}",
                self.nodes[node], counts[node], self.carriers[node]
            ))),
            None => Ok(()),
        }
    }

    fn check_gradients(&self, sharing: &Sharing<D>) -> Result<(), Defect> {
        let mut sums = vec![[0.0; 3]; self.nodes.len()];
        for (_, element) in self.elements() {
            let half = element.cell.width() as f64 * 0.5;
            let scale = (1..D::N).fold(1.0, |scale, _| scale * half);
            for (&node, gradient) in element.nodes.iter().zip(&self.stencil(element).gradients) {
                for axis in 0..3 {
                    sums[node as usize][axis] += gradient[axis] * scale;
                }
            }
        }
        for (id, node) in self.nodes() {
            let inner = node.group == D::ALL_CORNERS && !sharing.is_front(node.at);
            let sum = sums[id as usize];
            if inner && sum.iter().any(|&component: &f64| component.abs() > 1e-9) {
                let at = node.at;
                return Err(Defect(format!(
                    "gradients do not balance at {at:?}: {sum:?}"
                )));
            }
        }
        Ok(())
    }
}

/// The elements of every cell that a remodelling touches, as they were before it.
#[derive(Default)]
struct Past {
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
    fn shares<D: Dim>(
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
                None => mesh.elements_of(cell).map(|id| mesh.alive(id)).find(fills),
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

/// The cells that contain a voxel, finest first, each with the child that holds the voxel.
fn path<D: Dim>(voxel: Point) -> impl Iterator<Item = (Cell, usize)> {
    let finest = Cell {
        level: 0,
        at: voxel,
    };
    // The widest grid has 2^10 voxels on an axis.
    std::iter::successors(Some((finest, 0)), |(cell, _)| {
        (cell.level < 10).then(|| (cell.parent(), cell.child_index::<D>()))
    })
}

/// The lattice point of a slot, and an octant there that belongs to the element.
fn seat_of<D: Dim>(cell: Cell, children: u8, slot: usize) -> (Point, usize) {
    let steps = slot_at(slot);
    let (at, low) = if cell.level == 0 {
        (add(cell.at, steps.map(|k| k / 2)), [0; 3])
    } else {
        let touches = |&child: &usize| {
            let step = |axis: usize| steps[axis] - (child >> axis & 1) as i32;
            children >> child & 1 == 1 && (0..D::N).all(|axis| (0..=1).contains(&step(axis)))
        };
        let child = (0..D::CORNERS)
            .find(touches)
            .expect("the slot lies in the closure");
        let at = scale(add(scale(cell.at, 2), steps), cell.width() / 2);
        (at, corner(child))
    };
    let octant = (0..D::N).fold(0, |octant, axis| {
        octant | usize::from(steps[axis] == low[axis]) << axis
    });
    (at, octant)
}

fn check_grading<D: Dim>(grid: &VoxelGrid<D>, levels: &[u8]) -> Result<(), Defect> {
    for voxel in grid.voxels().filter(|&voxel| grid.is_solid(voxel)) {
        let level = levels[grid.index(voxel)];
        for near in neighbourhood::<D>(voxel, 1).filter(|&near| grid.is_solid(near)) {
            if level.abs_diff(levels[grid.index(near)]) > 1 {
                return Err(Defect(format!(
                    "levels jump between {voxel:?} and {near:?}"
                )));
            }
        }
    }
    Ok(())
}
