//! Assignment of nodes to elements. The nodes of an element follow from the connectivity and the neighbouring
//! elements; its class follows from its nodes.

use super::remodel::Past;
use super::{Element, InvariantViolation, Mesh, Node};
use crate::foundation::dim::{Dim, Point, add, corner, scale, voxel_around};
use crate::foundation::ids::{ElementId, NodeId};
use crate::topology::cell_hierarchy::Cell;
use crate::topology::connectivity::Connectivity;
use crate::topology::element_class::{ElementClass, cell_corners, slot_at};

impl<D: Dim> Mesh<D> {
    /// Gives an element the nodes and the class that follow from the connectivity and the neighbouring
    /// elements. Returns false if the nodes were the same before. If `past` is given, it receives for each
    /// new node the old nodes from which the state of the new node is interpolated.
    pub(super) fn assign_nodes(
        &mut self,
        id: ElementId,
        connectivity: &Connectivity<D>,
        mut past: Option<&mut Past>,
    ) -> Result<bool, InvariantViolation> {
        let (cell, children) = (self.alive(id).cell, self.alive(id).children);
        let corners = cell_corners::<D>();
        let (mut slots, mut nodes, mut count) = (0u32, [NodeId(0); 27], 0);
        for slot in 0..D::SLOTS {
            let is_corner = corners >> slot & 1 == 1;
            if !is_corner && cell.level == 0 {
                continue;
            }
            let Some((at, octant)) = slot_point::<D>(cell, children, slot) else {
                continue;
            };
            let node = Node {
                at,
                group: connectivity.groups(at).group_of(octant),
            };
            let on_surface = self.dense_surface && node.group != D::ALL_CORNERS;
            if !is_corner && !on_surface && !self.is_node_beside(id, node) {
                continue;
            }
            let (node, is_new) = self.node_id(node, connectivity.index(at));
            if let (true, Some(past)) = (is_new, &mut past) {
                past.inherit(self, node, voxel_around::<D>(at, octant), at)?;
            }
            slots |= 1 << slot;
            nodes[count] = node;
            count += 1;
        }
        let nodes = &nodes[..count];
        // Equal nodes have equal slots, so the class is the same, too.
        if self.alive(id).nodes == nodes {
            return Ok(false);
        }
        let element_class = self.class(children, slots)?;
        let element = Element {
            cell,
            children,
            element_class,
            nodes: nodes.to_vec(),
        };
        let old = self.elements[id].replace(element);
        let old = old.expect("changed elements are alive");
        for &node in nodes {
            self.carriers[node] += 1;
        }
        for &node in &old.nodes {
            self.carriers[node] -= 1;
        }
        if let Some(past) = past {
            past.replaced.push((id, old));
        }
        Ok(true)
    }

    /// Returns whether some element other than `id` has a cell with a corner at `node`. The node must not be
    /// a corner of the cell of `id`.
    fn is_node_beside(&self, id: ElementId, node: Node) -> bool {
        // Corners of a cell are multiples of its width, so only cells up to level `highest` can have a corner
        // at this lattice point.
        let [x, y, z] = node.at;
        let highest = (x | y | z).trailing_zeros();
        self.owners_around(node.at, node.group)
            .any(|owner| owner != id && u32::from(self.alive(owner).cell.level) <= highest)
    }

    /// Returns the id of `node`, and whether this call has created the node. `point` is the index of the
    /// node's lattice point.
    fn node_id(&mut self, node: Node, point: usize) -> (NodeId, bool) {
        let mut present = self.by_point.at(point);
        if let Some(id) = present.find(|&id| self.node(id).group == node.group) {
            return (id, false);
        }
        drop(present);
        let next = self.nodes.next_id();
        let id = self.free_nodes.pop().unwrap_or(next);
        if id == next {
            self.nodes.push(node);
            self.carriers.push(0);
        } else {
            self.nodes[id] = node;
        }
        self.by_point.append(point, id);
        (id, true)
    }

    fn class(&mut self, children: u8, slots: u32) -> Result<u32, InvariantViolation> {
        if let Some(&class) = self.classes.get(&(children, slots)) {
            return Ok(class);
        }
        let class = self.element_classes.len() as u32;
        self.element_classes
            .push(ElementClass::new(children, slots)?);
        self.classes.insert((children, slots), class);
        Ok(class)
    }
}

/// Returns the lattice point of a slot, and an octant around this point whose voxel the element contains.
/// `None` if the slot is not a corner of any filled child.
fn slot_point<D: Dim>(cell: Cell, children: u8, slot: usize) -> Option<(Point, usize)> {
    let steps = slot_at(slot);
    let touching = children & TOUCHING[slot];
    if touching == 0 {
        return None;
    }
    let low = corner(touching.trailing_zeros() as usize);
    let at = add(scale(cell.at, 2), steps).map(|k| (k << cell.level) / 2);
    let octant = (0..D::N).fold(0, |octant, axis| {
        octant | usize::from(steps[axis] == low[axis]) << axis
    });
    Some((at, octant))
}

/// For each slot, mask of the children of a cell that have the slot as a corner.
const TOUCHING: [u8; 27] = {
    // For each axis, masks of the children that touch the slot coordinates 0, 1 and 2: low children, all
    // children, high children.
    let along = [
        [0b0101_0101, 0b1111_1111, 0b1010_1010],
        [0b0011_0011, 0b1111_1111, 0b1100_1100],
        [0b0000_1111, 0b1111_1111, 0b1111_0000],
    ];
    let mut touching = [0; 27];
    let mut slot = 0;
    while slot < 27 {
        touching[slot] = along[0][slot % 3] & along[1][slot / 3 % 3] & along[2][slot / 9];
        slot += 1;
    }
    touching
};
