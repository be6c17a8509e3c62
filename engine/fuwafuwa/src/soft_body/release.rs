//! Effects of a release of shared nodes on a body: connectivity, cells, elements, state and pieces.

use crate::foundation::dim::{Dim, Point, voxel_around};
use crate::foundation::disjoint_sets::DisjointSets;
use crate::foundation::id_lists::ascending;
use crate::foundation::ids::{ElementId, IndexVec, NodeId, PieceId};
use crate::soft_body::SoftBody;
use crate::soft_body::element_forces::{InternalState, Row};
use crate::soft_body::momentum::{Momentum, RigidMotion, centre_of};
use crate::topology::cell_hierarchy::Grading;
use crate::topology::changes::Changes;
use crate::topology::mesh::{Inheritance, Remodelled};
use glam::DVec3;

impl<D: Dim> SoftBody<D> {
    /// Splits shared nodes. Each entry of `at` is a lattice point and a mask of octants: the voxels in these
    /// octants no longer share nodes with the other voxels around the point. Then remodels the elements
    /// around the points [Endo 2004, §3.2]. New nodes inherit positions and velocities from old nodes; linear
    /// and angular momentum are preserved. Returns the detached pieces. Has no effect on a body of
    /// [`Grading::Coarse`].
    #[inline(never)]
    pub fn release(&mut self, at: &[(Point, u8)]) -> Vec<PieceId> {
        self.tear(at).detached
    }

    /// Splits nodes like [`SoftBody::release`], and returns all changes.
    pub(crate) fn tear(&mut self, at: &[(Point, u8)]) -> Changes {
        if self.topology.hierarchy.grading() == Grading::Coarse {
            return Changes::default();
        }
        let mut changed: Vec<Point> = Vec::new();
        for &(point, side) in at {
            // `at` often has several consecutive entries for one point. `changed` lists such a point once.
            let connectivity = self.topology.connectivity.edit();
            if connectivity.release(point, side) && changed.last() != Some(&point) {
                changed.push(point);
            }
        }
        if changed.is_empty() {
            return Changes::default();
        }
        let around = self.topology.connectivity.all_around(&changed);
        changed.extend(self.topology.connectivity.edit().normalise(around));
        let near = self.topology.connectivity.all_around(&changed).into_iter();
        let born = self.topology.hierarchy.edit().refine(
            &self.topology.grid,
            &self.topology.connectivity,
            near,
        );
        let remodelled = self
            .topology
            .mesh
            .edit()
            .remodel(
                &self.topology.grid,
                &self.topology.connectivity,
                &self.topology.hierarchy,
                &changed,
                &born,
            )
            .expect(
                "the cell hierarchy follows the connectivity, so that the mesh can follow both",
            );
        let touched = self.nodes_of(&remodelled.changed_elements);
        self.pass_on(&remodelled, &touched);
        self.expose(&beside::<D>(&changed));
        let places = self.places_around(&changed);
        let beside = places.concat();
        let lists = [&touched, &self.nodes_of(&beside), &remodelled.abandoned];
        let nodes = lists.into_iter().flatten().copied();
        let nodes = ascending(nodes, self.topology.mesh.node_capacity());
        self.find_breakable(&nodes);
        self.forget_former_tips(&nodes);
        self.update_skin_points(&nodes);
        self.cache.awake_is_stale = true;
        let new = remodelled.inherited.iter().map(|new| new.node);
        let changes = Changes {
            detached: self.topology.pieces.detach(&self.topology.mesh, &places),
            nodes: new.chain(remodelled.abandoned).collect(),
            elements: [beside, remodelled.removed, remodelled.changed_elements].concat(),
            removed: Vec::new(),
        };
        let most = self.topology.mesh.element_capacity();
        self.cache.history.add(&changes, most);
        changes
    }

    /// Returns the elements around the given points, in clusters. Two points with a common element belong to
    /// one cluster, directly or through other points. Element ids ascend within each cluster.
    fn places_around(&self, points: &[Point]) -> Vec<Vec<ElementId>> {
        let around = |&at: &Point| self.topology.mesh.owners_around(at, D::ALL_CORNERS);
        let elements = points.iter().flat_map(around);
        let elements = ascending(elements, self.topology.mesh.element_capacity());
        let mut joined = DisjointSets::new(elements.len());
        for at in points {
            let mut places = around(at).filter_map(|id| elements.binary_search(&id).ok());
            if let Some(first) = places.next() {
                places.for_each(|place| joined.join(first, place));
            }
        }
        joined.sort(&elements)
    }

    /// Transfers the state of old nodes and elements to new ones. `touched` are the nodes of all new or
    /// changed elements.
    fn pass_on(&mut self, remodelled: &Remodelled, touched: &[NodeId]) {
        let Remodelled {
            removed,
            changed_elements,
            inherited,
            abandoned,
            ..
        } = remodelled;
        let new = ascending(
            inherited.iter().map(|new| new.node),
            self.topology.mesh.node_capacity(),
        );
        let is_old = |id: &NodeId| new.binary_search(id).is_err();
        let old = touched.iter().copied().filter(is_old);
        let old = self.free_by_piece(old.chain(abandoned.iter().copied()));
        let momentum = |nodes: &[NodeId]| {
            let centre = centre_of(self.states(nodes).map(|(x, _, mass)| (x, mass)));
            let piece = self.topology.pieces.of_node(nodes[0]);
            (piece, centre, Momentum::of(self.states(nodes), centre))
        };
        let before: Vec<_> = self.pieces_in(&old).into_iter().map(momentum).collect();

        self.inherit(remodelled);
        let new = changed_elements
            .iter()
            .copied()
            .filter(|&id| !self.state.batches.has(id));
        let new: Vec<ElementId> = new.collect();
        for &id in changed_elements {
            let element = self
                .topology
                .mesh
                .element(id)
                .expect("changed elements are alive");
            self.topology.pieces.adopt(id, &element.nodes);
            self.cache.exposed_faces.edit()[id] = 0;
        }
        let internal_states = self.internal_states_of(remodelled, &new);
        let (batches, pieces) = (&mut self.state.batches, &self.topology.pieces);
        let asleep = |id: ElementId| pieces.list[pieces.of_element(id)].asleep;
        let (mesh, grid) = (&self.topology.mesh, &self.topology.grid);
        batches.update(mesh, grid, removed, changed_elements, asleep);
        for (id, state) in internal_states {
            batches.set_internal_state(id, state);
        }
        self.reset_rotations(&new);
        let changed_elements = changed_elements
            .iter()
            .filter_map(|&id| self.topology.mesh.element(id));
        let fresh = changed_elements.filter(|element| element.cell.level == 0);
        let fresh: Vec<Point> = fresh.map(|element| element.cell.at).collect();
        self.expose(&fresh);
        self.weigh(touched);
        self.update_mass_damping(touched);
        let now = self.free_by_piece(touched.iter().copied());
        for nodes in self.pieces_in(&now) {
            let piece = self.topology.pieces.of_node(nodes[0]);
            let known = before.binary_search_by_key(&piece, |&(piece, ..)| piece);
            if let Ok(place) = known {
                let (_, centre, momentum) = before[place];
                self.restore_momentum(nodes, momentum, centre);
            }
        }
    }

    /// Returns the internal state of each new element, taken from the removed element that contained its first
    /// voxel.
    fn internal_states_of(
        &self,
        remodelled: &Remodelled,
        new: &[ElementId],
    ) -> Vec<(ElementId, InternalState)> {
        let batches = &self.state.batches;
        if !batches.has_internal_state() {
            return Vec::new();
        }
        let of = |&id: &ElementId| {
            let voxel = self
                .topology
                .mesh
                .first_voxel(self.topology.mesh.element(id)?);
            let origin = remodelled.origin::<D>(voxel)?;
            Some((id, batches.internal_state(origin)?))
        };
        new.iter().filter_map(of).collect()
    }

    /// Returns the given nodes without those that are fixed or asleep, sorted by piece.
    fn free_by_piece(&self, nodes: impl Iterator<Item = NodeId>) -> Vec<NodeId> {
        // Only free nodes take part in the correction of momentum, because fixed nodes keep their velocity.
        let free = |id: &NodeId| self.state.inverse_mass[*id] > 0.0;
        let mut nodes: Vec<NodeId> = nodes.filter(free).collect();
        nodes.sort_by_key(|&id| self.topology.pieces.of_node(id));
        nodes
    }

    /// Splits nodes that are sorted by piece into one slice per piece.
    fn pieces_in<'a>(&self, nodes: &'a [NodeId]) -> Vec<&'a [NodeId]> {
        let of_node = |id| self.topology.pieces.of_node(id);
        nodes.chunk_by(|&a, &b| of_node(a) == of_node(b)).collect()
    }

    /// Interpolates the state of new nodes from old nodes. Reads the states of all old nodes before it writes
    /// any.
    fn inherit(&mut self, remodelled: &Remodelled) {
        let inherited = &remodelled.inherited;
        let mean = |rows: &IndexVec<NodeId, Row>, from: &[(NodeId, f64)]| {
            let mut sum = [0.0f64; 4];
            for &(old, weight) in from {
                for axis in 0..D::N {
                    sum[axis] += weight * f64::from(rows[old][axis]);
                }
            }
            Row::from_array(sum.map(|component| component as f32))
        };
        let state = |new: &Inheritance| {
            let (position, velocity) = (&self.state.position, &self.state.velocity);
            let from = remodelled.from(new);
            (mean(position, from), mean(velocity, from))
        };
        let states: Vec<(Row, Row)> = inherited.iter().map(state).collect();
        self.make_room();
        for (new, (position, velocity)) in inherited.iter().zip(states) {
            let node = new.node;
            self.state.position[node] = position;
            self.state.ahead[node] = position;
            self.state.velocity[node] = velocity;
            self.state.damage[node] = 0.0;
            let from = remodelled.from(new);
            self.topology.pieces.inherit(new.node, from[0].0);
            self.inherit_hold(new.node, from);
        }
    }

    /// Returns the nodes of the given elements, ascending.
    fn nodes_of(&self, elements: &[ElementId]) -> Vec<NodeId> {
        let elements = elements
            .iter()
            .filter_map(|&id| self.topology.mesh.element(id));
        let nodes = elements.flat_map(|element| element.nodes.iter().copied());
        ascending(nodes, self.topology.mesh.node_capacity())
    }

    /// Adds a rigid motion to the velocities of `nodes` that restores their momentum to `before`, the
    /// momentum about `centre`. Interpolation preserves linear momentum. It changes angular momentum if new
    /// nodes are created between the corners of an element, because part of the mass moves to the new nodes.
    fn restore_momentum(&mut self, nodes: &[NodeId], before: Momentum, centre: DVec3) {
        let missing = before.less(Momentum::of(self.states(nodes), centre));
        let masses = self.states(nodes).map(|(x, _, mass)| (x, mass));
        let motion = RigidMotion::with_momentum(masses, centre, missing);
        for &id in nodes {
            let change = motion.at(self.state.position[id]);
            for axis in 0..D::N {
                self.state.velocity[id][axis] += change[axis] as f32;
            }
        }
    }
}

/// Returns the voxels around the given lattice points, each once, in memory order.
fn beside<D: Dim>(points: &[Point]) -> Vec<Point> {
    let mut voxels: Vec<Point> = points
        .iter()
        .flat_map(|&point| (0..D::CORNERS).map(move |octant| voxel_around::<D>(point, octant)))
        .collect();
    voxels.sort_unstable_by_key(|&[x, y, z]| [z, y, x]);
    voxels.dedup();
    voxels
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};
    use crate::material::Material;
    use crate::topology::grid::VoxelGrid;
    use crate::topology::pieces::Pieces;
    use std::collections::BTreeSet;

    /// Releases many points at once, some near each other and some far apart. The pieces must match those of
    /// [`Pieces::new`], which searches the whole mesh.
    fn check_pieces<D: Dim>(n: usize) {
        let grid = VoxelGrid::<D>::ball(n, 1.0).expect("a ball is not empty");
        let mut body = SoftBody::new(grid, &[Material::default()]).expect("the material is valid");
        let mut seed = 3u32;
        let mut random = |below: usize| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as usize % below
        };
        for _ in 0..40 {
            let mut releases: Vec<(Point, u8)> = Vec::new();
            for _ in 0..n * n / 4 {
                let mut at = [random(n) as i32, random(n) as i32, random(n) as i32];
                at[D::N..].fill(0);
                releases.push((at, 1 << random(D::CORNERS)));
            }
            body.release(&releases);
            let fresh = Pieces::new(&body.topology.mesh);
            let both = |(id, _)| (body.topology.pieces.of_element(id), fresh.of_element(id));
            let pairs: BTreeSet<(PieceId, PieceId)> =
                body.topology.mesh.elements().map(both).collect();
            assert_eq!(pairs.len(), fresh.list.len());
            assert_eq!(pairs.len(), body.topology.pieces.list.len());
        }
        assert!(
            body.topology.pieces.list.len() > 20,
            "too few pieces were detached to test anything"
        );
    }

    #[test]
    fn pieces_match_search_from_scratch_after_releases() {
        check_pieces::<Dim2>(20);
        check_pieces::<Dim3>(8);
    }
}
