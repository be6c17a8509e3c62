//! Sleeping, waking and quarantine of pieces.

use super::SoftBody;
use super::derived_caches::scaled_inverse;
use crate::foundation::dim::{Dim, Point};
use crate::foundation::ids::{IndexVec, NodeId, PieceId};
use crate::soft_body::element_forces::Row;
use crate::topology::mesh::Node;
use glam::Vec3;

impl<D: Dim> SoftBody<D> {
    /// Puts the pieces to sleep for which `marked` is true, or wakes them if `asleep` is false.
    pub(crate) fn set_asleep(&mut self, marked: &IndexVec<PieceId, bool>, asleep: bool) {
        let mut elements = Vec::new();
        for (id, element) in self.topology.mesh.elements() {
            if !marked[self.topology.pieces.of_element(id)] {
                continue;
            }
            elements.push(id);
            for &node in &element.nodes {
                if asleep {
                    self.state.velocity[node] = Row::ZERO;
                    self.state.ahead[node] = self.state.position[node];
                }
                let free = !asleep && !self.state.fixed[node];
                self.state.inverse_mass[node] = if free {
                    scaled_inverse(self.state.mass[node], self.topology.mass_scale)
                } else {
                    0.0
                };
            }
        }
        let batches = &mut self.state.batches;
        batches.set_asleep(&self.topology.mesh, &elements, asleep);
        let pieces = self.topology.pieces.list.iter_mut().zip(marked.iter());
        for (piece, _) in pieces.filter(|(_, marked)| **marked) {
            piece.asleep = asleep;
            piece.sleep_timer = 0.0;
        }
        self.cache.awake_is_stale = true;
    }

    /// Starts a tick: records the positions of all nodes.
    pub(crate) fn start_tick(&mut self) {
        let (mesh, before) = (&self.topology.mesh, &mut self.cache.before);
        let both = |(id, &row): (NodeId, &Row)| match mesh.is_alive(id) {
            true => (mesh.node(id).at, row),
            false => ([0; 3], Row::from_array([f32::NAN; 4])),
        };
        before.clear();
        before.extend(self.state.position.entries().map(both));
        self.cache.fastest = f32::INFINITY;
    }

    /// Quarantines each piece that has a node with a non-finite position or velocity, or with a speed above
    /// `top_speed` [m/s]. Resets the nodes of the piece to the positions recorded at the start of the tick,
    /// and puts the piece to sleep for good. Returns the numbers of these pieces.
    pub(crate) fn quarantine(&mut self, top_speed: f32) -> Vec<PieceId> {
        let mut marked: IndexVec<PieceId, _> = vec![false; self.topology.pieces.list.len()].into();
        for &id in &self.cache.awake {
            let velocity = self.state.velocity[id];
            let speed = velocity.dot(velocity);
            let sane = speed <= top_speed * top_speed && self.state.position[id].is_finite();
            marked[self.topology.pieces.of_node(id)] |= !sane;
        }
        if !marked.contains(&true) {
            return Vec::new();
        }
        let nodes: Vec<(NodeId, Node)> = self.topology.mesh.nodes().collect();
        let nodes = nodes.into_iter();
        for (id, node) in nodes.filter(|&(id, _)| marked[self.topology.pieces.of_node(id)]) {
            self.state.position[id] = self.position_before(id, node.at);
        }
        self.set_asleep(&marked, true);
        let numbers: Vec<PieceId> = marked.ids().filter(|&piece| marked[piece]).collect();
        for &piece in &numbers {
            self.topology.pieces.list[piece].quarantined = true;
        }
        numbers
    }

    /// Position of a node at the start of the tick. A node that is new has no recorded position. It is placed
    /// relative to the recorded position of the nearest node of its elements, or at its rest position if no
    /// such node is recorded. Nodes of other elements are not used, because lattice neighbours across a crack
    /// may be far apart.
    pub(super) fn position_before(&self, id: NodeId, at: Point) -> Row {
        let was = |id: NodeId, at: Point| {
            let known = self.cache.before.get(id.index());
            known.filter(|(point, row)| *point == at && row.is_finite())
        };
        let carriers = self.topology.mesh.carriers_of(id);
        let beside = carriers.flat_map(|(element, _)| element.nodes.iter());
        let beside = beside.filter_map(|&other| was(other, self.topology.mesh.node(other).at));
        let apart = |point: Point| [0, 1, 2].map(|axis: usize| at[axis] - point[axis]);
        let squared = |(point, _): &&(Point, Row)| apart(*point).map(|k| k * k).iter().sum::<i32>();
        let nearest = || beside.min_by_key(squared);
        let (point, row) = was(id, at).or_else(nearest).copied().unwrap_or_default();
        let apart = apart(point).map(|k| k as f32 * self.topology.grid.voxel_size());
        row + Row::from(Vec3::from(apart))
    }
}
