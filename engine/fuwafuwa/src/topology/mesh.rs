//! Graded mesh: the elements and nodes that follow from the solid voxels and their connectivity.
//!
//! A node is a lattice point together with one group of voxels around the point. The node exists if the point
//! is a corner of an element's cell, and the element fills the child at this corner. Every element carries
//! all nodes that lie at corners of its filled children. Hanging nodes are therefore ordinary nodes of the
//! larger element.
//!
//! ```text
//!   ┌───┬─┬─┐     the level-1 element on the left carries five nodes: its four corners and the
//!   │   ├─┼─┤     middle of its right edge, which is a corner of its level-0 neighbours
//!   └───┴─┴─┘
//! ```

mod element_nodes;
mod mesh_validation;
mod remodel;

pub use remodel::{Inheritance, Remodelled};

use crate::foundation::dim::{Dim, Point, points_in, voxel_around};
use crate::foundation::hash::hash_state;
use crate::foundation::id_lists::IdLists;
use crate::foundation::ids::{ElementId, IndexVec, NodeId};
use crate::topology::cell_hierarchy::{Cell, CellHierarchy, CellIndexing, Grading, parts};
use crate::topology::connectivity::Connectivity;
use crate::topology::element_class::{ElementClass, MissingCorner};
use crate::topology::grid::VoxelGrid;
use std::collections::BTreeMap;
use std::fmt;

/// Elastic element: fills a cell, or a face-connected part of the children of a cell.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Element {
    /// Cell of the element.
    pub cell: Cell,
    /// Mask of the children of the cell that the element fills; all bits are set at level 0.
    pub children: u8,
    /// Index of the element class, see [`Mesh::element_class`].
    pub element_class: u32,
    /// Ids of the nodes, in the order of the slots of the class.
    pub nodes: Vec<NodeId>,
}

hash_state! { struct Element { cell, children, element_class, nodes } }

/// Mass point: a lattice point, and the group of voxels around the point that share the node.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Node {
    /// Lattice point of the node in the undeformed body.
    pub at: Point,
    /// Mask of the octants around the lattice point whose voxels share this node.
    pub group: u8,
}

hash_state! { struct Node { at, group } }

/// Elements of one body, and the nodes that they share.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Mesh<D: Dim> {
    elements: IndexVec<ElementId, Option<Element>>,
    nodes: IndexVec<NodeId, Node>,
    element_classes: Vec<ElementClass<D>>,
    /// Whether every lattice point of the surface is a node even if the elements at the surface are large:
    /// true for [`Grading::Coarse`] only.
    dense_surface: bool,
    cell_indexing: CellIndexing,
    /// Ids of the elements of each cell, by the index of the cell.
    by_cell: IdLists<ElementId>,
    /// Element that contains each voxel, as element id + 1, by the index of the voxel's level-0 cell; 0 = no
    /// element.
    owners: Vec<u32>,
    /// Ids of the nodes at each lattice point, by the index of the point.
    by_point: IdLists<NodeId>,
    classes: BTreeMap<(u8, u32), u32>,
    /// Number of elements that have each node, by node id; 0 = no node has the id.
    carriers: IndexVec<NodeId, u8>,
    free_elements: Vec<ElementId>,
    free_nodes: Vec<NodeId>,
}

hash_state! {
    [D: Dim] struct Mesh<D> {
        elements, nodes, element_classes, dense_surface, cell_indexing, by_cell, owners, by_point, classes, carriers,
        free_elements, free_nodes,
    }
}

/// Description of a violated invariant of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct InvariantViolation(String);

impl fmt::Display for InvariantViolation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl InvariantViolation {
    #[cfg(feature = "serde")]
    pub(crate) fn of(what: String) -> Self {
        Self(what)
    }
}

impl std::error::Error for InvariantViolation {}

impl From<MissingCorner> for InvariantViolation {
    fn from(missing: MissingCorner) -> Self {
        Self(missing.to_string())
    }
}

impl<D: Dim> Mesh<D> {
    /// Builds the elements and the nodes of a body from scratch.
    ///
    /// # Errors
    /// An [`InvariantViolation`] if the cell hierarchy does not match this grid and connectivity.
    #[inline(never)]
    pub fn grade(
        grid: &VoxelGrid<D>,
        connectivity: &Connectivity<D>,
        hierarchy: &CellHierarchy<D>,
    ) -> Result<Self, InvariantViolation> {
        let mut mesh = Self {
            elements: IndexVec::default(),
            nodes: IndexVec::default(),
            element_classes: Vec::new(),
            dense_surface: hierarchy.grading() == Grading::Coarse,
            cell_indexing: hierarchy.cell_indexing().clone(),
            by_cell: IdLists::new(hierarchy.cell_indexing().count()),
            owners: vec![0; hierarchy.cell_indexing().count_of(0)],
            by_point: IdLists::new(connectivity.point_count()),
            classes: BTreeMap::new(),
            carriers: IndexVec::default(),
            free_elements: Vec::new(),
            free_nodes: Vec::new(),
        };
        for level in 0..hierarchy.level_count() as u8 {
            for cell in hierarchy.cells(level) {
                for children in parts::<D>(hierarchy.filled(grid, cell)) {
                    mesh.add_element(cell, children);
                }
            }
        }
        for id in mesh.elements.ids() {
            mesh.assign_nodes(id, connectivity, None)?;
        }
        Ok(mesh)
    }

    /// Returns the elements with their ids, ascending.
    pub fn elements(&self) -> impl Iterator<Item = (ElementId, &Element)> {
        let alive = self.elements.entries();
        alive.filter_map(|(id, element)| Some((id, element.as_ref()?)))
    }

    /// Returns the number of elements.
    pub fn element_count(&self) -> usize {
        self.elements.iter().flatten().count()
    }

    /// Returns the nodes with their ids, ascending.
    pub fn nodes(&self) -> impl Iterator<Item = (NodeId, Node)> + '_ {
        let alive = self.nodes.entries().zip(self.carriers.iter());
        alive.filter_map(|((id, &node), &carriers)| (carriers > 0).then_some((id, node)))
    }

    /// Returns the number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.len() - self.free_nodes.len()
    }

    /// Returns the highest node id ever used plus one: the length of an array indexed by node.
    pub fn node_capacity(&self) -> usize {
        self.nodes.len()
    }

    /// Returns the highest element id ever used plus one: the length of an array indexed by element.
    pub fn element_capacity(&self) -> usize {
        self.elements.len()
    }

    /// Returns whether at least one element has the node with this id; otherwise the node was removed.
    pub fn is_alive(&self, id: NodeId) -> bool {
        self.carriers[id] > 0
    }

    /// Returns the node with an id.
    ///
    /// # Panics
    /// If the id was never used.
    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id]
    }

    /// Returns the nodes at a lattice point; none if the point is outside the grid.
    pub(crate) fn nodes_at(&self, at: Point, connectivity: &Connectivity<D>) -> impl Iterator<Item = NodeId> {
        let is_inside = connectivity.contains(at);
        let nodes = is_inside.then(|| self.by_point.at(connectivity.index(at)));
        nodes.into_iter().flatten()
    }

    /// Returns the element with an id, if it is alive.
    pub fn element(&self, id: ElementId) -> Option<&Element> {
        self.elements.get(id.index())?.as_ref()
    }

    /// Returns the elements that have a node, each with the index of the node in the element's list of nodes.
    /// The order is that of the octants around the node, so it does not depend on the ids of elements.
    pub fn carriers_of(&self, id: NodeId) -> impl Iterator<Item = (&Element, usize)> {
        self.carrier_ids(id).map(move |owner| {
            let element = self.alive(owner);
            let place = element.nodes.iter().position(|&node| node == id);
            (
                element,
                place.expect("every element in a node's group carries the node"),
            )
        })
    }

    /// Returns the ids of the elements that have a node, in the order of the octants around the node.
    pub fn carrier_ids(&self, id: NodeId) -> impl Iterator<Item = ElementId> + use<D> {
        let node = self.node(id);
        let (mut carriers, mut count) = ([ElementId(0); 8], 0);
        for owner in self.owners_around(node.at, node.group) {
            if !carriers[..count].contains(&owner) {
                carriers[count] = owner;
                count += 1;
            }
        }
        carriers.into_iter().take(count)
    }

    /// Returns the number of elements on each level, level 0 first.
    #[inline(never)]
    pub fn elements_per_level(&self) -> Vec<usize> {
        let mut counts = Vec::new();
        for (_, element) in self.elements() {
            let level = element.cell.level as usize;
            counts.resize(counts.len().max(level + 1), 0);
            counts[level] += 1;
        }
        counts
    }

    /// Returns the number of vertices that the mesh would have if no elements shared vertices, as counted in
    /// [Endo 2004, §3.1].
    #[inline(never)]
    pub fn independent_vertex_count(&self) -> usize {
        self.elements()
            .map(|(_, element)| element.nodes.len())
            .sum()
    }

    /// Returns the element class of an element.
    pub fn element_class(&self, element: &Element) -> &ElementClass<D> {
        &self.element_classes[element.element_class as usize]
    }

    /// Returns the id of the element that contains a solid voxel; `None` for an empty voxel.
    pub fn owner(&self, voxel: Point) -> Option<ElementId> {
        owner(self.owners[self.cell_indexing.index(Cell::of(voxel))?])
    }

    /// Returns the element that contains a solid voxel; `None` for an empty voxel.
    pub(crate) fn element_at(&self, voxel: Point) -> Option<&Element> {
        self.element(self.owner(voxel)?)
    }

    /// Returns the element that contains the voxel in each of the given octants around a lattice point, in
    /// the order of the octants. An element that contains several of these voxels occurs several times.
    pub fn owners_around(
        &self,
        at: Point,
        octants: u8,
    ) -> impl Iterator<Item = ElementId> + use<D> {
        let mut owners = [0; 8];
        match self.cell_indexing.voxels_around::<D>(at) {
            Some(places) => {
                for octant in 0..D::CORNERS {
                    owners[octant] = self.owners[places[octant]];
                }
            }
            None => {
                for octant in 0..D::CORNERS {
                    let voxel = Cell::of(voxel_around::<D>(at, octant));
                    let place = self.cell_indexing.index(voxel);
                    owners[octant] = place.map_or(0, |place| self.owners[place]);
                }
            }
        }
        let asked = (0..D::CORNERS).filter(move |octant| octants >> octant & 1 == 1);
        asked.filter_map(move |octant| owner(owners[octant]))
    }

    /// Returns the voxel at the low corner of the first child that an element fills.
    pub fn first_voxel(&self, element: &Element) -> Point {
        let child = element.children.trailing_zeros() as usize;
        match element.cell.level {
            0 => element.cell.at,
            _ => element.cell.child(child).first_voxel(),
        }
    }

    /// Returns all voxels that an element fills.
    pub fn voxels(&self, element: &Element) -> impl Iterator<Item = Point> + use<D> {
        let cell = element.cell;
        let is_voxel = cell.level == 0;
        let reach = cell.width() / 2 - i32::from(!is_voxel);
        let children = if is_voxel { 1 } else { element.children };
        let filled = (0..D::CORNERS).filter(move |child| children >> child & 1 == 1);
        filled.flat_map(move |child| {
            let low = if is_voxel {
                cell.at
            } else {
                cell.child(child).first_voxel()
            };
            let mut high = low;
            high.iter_mut().take(D::N).for_each(|k| *k += reach);
            points_in(low, high)
        })
    }

    /// Returns whether two meshes are equal except for the ids of elements and nodes.
    #[inline(never)]
    pub fn is_same_as(&self, other: &Self) -> bool {
        self.canonical() == other.canonical()
    }

    fn alive(&self, id: ElementId) -> &Element {
        self.elements[id]
            .as_ref()
            .expect("a cell lists live elements only")
    }

    /// Returns the cell, children and nodes of every element, sorted, without ids.
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

    /// Adds an element without nodes, and records in `owners` that the element contains its voxels.
    fn add_element(&mut self, cell: Cell, children: u8) {
        let element = Element {
            cell,
            children,
            element_class: u32::MAX,
            nodes: Vec::new(),
        };
        let next = self.elements.next_id();
        let id = self.free_elements.pop().unwrap_or(next);
        if id == next {
            self.elements.push(Some(element));
        } else {
            self.elements[id] = Some(element);
        }
        let place = |cell| {
            self.cell_indexing
                .index(cell)
                .expect("cells lie in the grid")
        };
        self.by_cell.append(place(cell), id);
        for voxel in self.voxels(self.alive(id)) {
            self.owners[place(Cell::of(voxel))] = id.0 + 1;
        }
    }
}

/// Returns the element id that an entry of `owners` stands for; `None` for the entry 0.
fn owner(listed: u32) -> Option<ElementId> {
    listed.checked_sub(1).map(ElementId)
}

/// Returns the cells that contain a voxel, from level 0 up. Each cell comes with the index of its child that
/// contains the voxel.
fn path<D: Dim>(voxel: Point) -> impl Iterator<Item = (Cell, usize)> {
    // Ends at level 10, because the largest grid has 2^10 voxels on an axis.
    std::iter::successors(Some((Cell::of(voxel), 0)), |(cell, _)| {
        (cell.level < 10).then(|| (cell.parent(), cell.child_index::<D>()))
    })
}
