//! Contiguous node velocities for the contact solver.

use super::contact_sides::{NodeContact, NodeRow, SphereNodeRows};
use super::scaled_pieces::ScaledPieces;
use crate::contact::broad_phase::{ContactSphere, mean};
use crate::foundation::arena::{BodySlot, RigidSlot};
use crate::foundation::dim::Dim;
use crate::foundation::ids::{Id, IndexVec, NodeId};
use crate::foundation::threads::{self, CHUNK_SIZE};
use crate::rigid_body::RigidBodies;
use crate::soft_body::SoftBodies;
use crate::soft_body::element_forces::Row;
use crate::soft_body::skin_point::SkinPoint;
use glam::Vec3;

/// Number of nodes in a chunk of `SolverVelocities`. A chunk with any node in contact is copied as a whole.
/// Larger chunks copy more unused nodes; smaller ones cost more tests.
const NODES_PER_CHUNK: usize = 16;

/// Number of chunks of [`NODES_PER_CHUNK`] nodes that a thread copies together.
const TESTS_PER_SHARE: usize = CHUNK_SIZE / NODES_PER_CHUNK;

/// Copy of the velocities of nodes in contact [m/s]. The fourth component is the inverse mass [1/kg], so that
/// applying an impulse reads one row.
#[derive(Clone, Debug, Default)]
pub struct SolverVelocities {
    /// Velocity and inverse mass of each node. Valid only in chunks with a node in contact.
    rows: IndexVec<NodeRow, Row>,
    /// Row of the first node of each body, always at the start of a chunk.
    first: IndexVec<BodySlot, NodeRow>,
    /// For each chunk, whether any of its nodes is in contact. All other chunks, which are most chunks of a
    /// large body, are not copied.
    is_touched: Vec<bool>,
    /// Pieces with scaled mass, whose nodes also move with the piece as a whole.
    pub scaled: ScaledPieces,
}

impl SolverVelocities {
    /// Prepares one row for each node and marks all nodes as without contact.
    pub fn clear<D: Dim>(&mut self, bodies: &SoftBodies<D>) {
        self.first.clear();
        let mut count = 0;
        for body in bodies.slots() {
            self.first.push(NodeRow::of(count));
            let nodes = body.map_or(0, |body| body.velocities().len());
            count += nodes.next_multiple_of(NODES_PER_CHUNK);
        }
        self.rows.resize(count, Row::ZERO);
        self.is_touched.clear();
        self.is_touched.resize(count / NODES_PER_CHUNK, false);
    }

    /// Returns the row of a node and marks it as in contact.
    #[inline(always)]
    pub fn row(&mut self, body: BodySlot, node: NodeId) -> NodeRow {
        let row = row_of(self.first[body], node);
        self.is_touched[row.index() / NODES_PER_CHUNK] = true;
        row
    }

    /// Returns the rows of a sphere's corner nodes and marks them as in contact.
    #[inline(always)]
    pub fn sphere_rows<D: Dim>(&mut self, sphere: &ContactSphere) -> SphereNodeRows {
        let first = self.first[sphere.body];
        // A loop, because the compiler does not inline `map` for eight nodes.
        let mut rows = [first; 8];
        for (row, &node) in rows.iter_mut().zip(&sphere.nodes[..D::CORNERS]) {
            *row = row_of(first, node);
            self.is_touched[row.index() / NODES_PER_CHUNK] = true;
        }
        rows
    }

    /// Copies the velocities of nodes in contact from the bodies.
    pub fn load<D: Dim>(&mut self, bodies: &SoftBodies<D>) {
        let mut others = self.rows.as_mut_slice();
        let is_touched = &self.is_touched;
        let shares = bodies.by_slot().flat_map(|(slot, body)| {
            let (velocities, inverse_masses) = (body.velocities(), body.inverse_masses());
            let rows = velocities.len().next_multiple_of(NODES_PER_CHUNK);
            let own;
            (own, others) = std::mem::take(&mut others).split_at_mut(rows);
            let nodes = velocities
                .chunks(CHUNK_SIZE)
                .zip(inverse_masses.chunks(CHUNK_SIZE));
            let touched =
                is_touched[self.first[slot].index() / NODES_PER_CHUNK..].chunks(TESTS_PER_SHARE);
            own.chunks_mut(CHUNK_SIZE).zip(nodes).zip(touched)
        });
        let shares = shares.filter(|(_, touched)| touched.contains(&true));
        threads::map_items(
            shares,
            |((rows, _), _)| rows.len(),
            |((rows, (velocities, inverse_masses)), touched)| {
                let nodes = velocities.chunks(NODES_PER_CHUNK);
                let nodes = nodes.zip(inverse_masses.chunks(NODES_PER_CHUNK));
                let chunks = rows.chunks_mut(NODES_PER_CHUNK).zip(nodes).zip(touched);
                for ((rows, (velocities, inverse_masses)), _) in chunks.filter(|(_, is)| **is) {
                    let nodes = velocities.iter().zip(inverse_masses);
                    for (row, (velocity, &inverse_mass)) in rows.iter_mut().zip(nodes) {
                        *row = with_fourth(*velocity, inverse_mass);
                    }
                }
            },
        );
        self.scaled.load(bodies, &self.first, self.rows.len());
    }

    /// Copies the velocities of nodes in contact back to the bodies.
    pub fn store<D: Dim>(&self, bodies: &mut SoftBodies<D>) {
        let shares = bodies.by_slot_mut().flat_map(|(slot, body)| {
            let first = self.first[slot].index();
            let rows = self.rows.as_slice()[first..].chunks(CHUNK_SIZE);
            let touched = self.is_touched[first / NODES_PER_CHUNK..].chunks(TESTS_PER_SHARE);
            let velocities = body.velocities_mut().chunks_mut(CHUNK_SIZE);
            velocities.zip(rows).zip(touched)
        });
        let shares = shares.filter(|(_, touched)| touched.contains(&true));
        threads::map_items(
            shares,
            |((rows, _), _)| rows.len(),
            |((velocities, rows), touched)| {
                let rows = rows.chunks(NODES_PER_CHUNK);
                let chunks = velocities
                    .chunks_mut(NODES_PER_CHUNK)
                    .zip(rows)
                    .zip(touched);
                for ((velocities, rows), _) in chunks.filter(|(_, is)| **is) {
                    for (velocity, row) in velocities.iter_mut().zip(rows) {
                        *velocity = with_fourth(*row, 0.0);
                    }
                }
            },
        );
        self.scaled.store(bodies);
    }

    /// Returns the velocity of the first sphere relative to the second [m/s].
    #[inline(always)]
    pub fn relative_of_spheres<D: Dim>(&self, spheres: &[SphereNodeRows; 2]) -> Row {
        let [first, second] = spheres
            .each_ref()
            .map(|rows| mean::<D, _>(&self.rows, rows));
        let relative = with_fourth(first - second, 0.0);
        match self.scaled.is_empty() {
            true => relative,
            false => relative + self.scaled.relative_of_spheres::<D>(spheres),
        }
    }

    /// Applies an impulse to the first sphere and its opposite to the second.
    #[inline(always)]
    pub fn apply_to_spheres<D: Dim>(&mut self, spheres: &[SphereNodeRows; 2], impulse: Row) {
        let share = impulse * (1.0 / D::CORNERS as f32);
        for (rows, share) in [(&spheres[0], share), (&spheres[1], -share)] {
            for &node in &rows[..D::CORNERS] {
                let row = &mut self.rows[node];
                *row += share * row[3];
            }
        }
        if !self.scaled.is_empty() {
            self.scaled
                .push_spheres::<D>(spheres, with_fourth(impulse, 0.0));
        }
    }

    /// Returns the velocity of a node relative to the rigid body that it touches [m/s].
    #[inline(always)]
    pub fn relative_of_node<D: Dim>(&self, row: &NodeContact, rigids: &RigidBodies) -> Row {
        let own = row.mean(&self.rows);
        let other = row.mover.map_or(Row::ZERO, |mover| velocity(mover, rigids));
        let relative = with_fourth(own - other, 0.0);
        match self.scaled.is_empty() {
            true => relative,
            false => relative + self.scaled.velocity_of_node::<D>(row),
        }
    }

    /// Applies an impulse to a node and its opposite to a moving rigid body.
    #[inline(always)]
    pub fn apply_to_node<D: Dim>(
        &mut self,
        row: &NodeContact,
        rigids: &mut RigidBodies,
        impulse: Row,
        duration: f32,
    ) {
        // The fourth component is the inverse mass of the node, which no impulse changes.
        let impulse = with_fourth(impulse, 0.0);
        let SkinPoint {
            neighbours,
            weights,
        } = row.point;
        if !row.point.is_node() {
            for axis in 0..3 {
                let other = &mut self.rows[neighbours[axis]];
                *other += impulse * (weights[axis] * other[3]);
            }
        }
        let own = &mut self.rows[row.node];
        *own += impulse * (row.point.own_weight() * own[3]);
        if !self.scaled.is_empty() {
            self.scaled.push_node::<D>(row, impulse);
        }
        if let Some(mover) = row.mover {
            push(mover, rigids, -impulse, duration);
        }
    }
}

/// Returns the velocity of a rigid body at a lever arm [m/s]. The function is not inlined: its calls are
/// rare, and its code would slow down the other contacts.
#[inline(never)]
fn velocity((mover, lever): (RigidSlot, Vec3), rigids: &RigidBodies) -> Row {
    Row::from(rigids.at(mover).velocity_at(lever))
}

/// Applies an impulse to a rigid body at a lever arm [m]. The function is not inlined, because its calls are
/// rare.
#[inline(never)]
fn push((mover, lever): (RigidSlot, Vec3), rigids: &mut RigidBodies, impulse: Row, duration: f32) {
    rigids
        .at_mut(mover)
        .apply_contact_impulse_at(impulse.xyz(), lever, duration);
}

/// Returns the row of a node of a body, given the row of the first node.
#[inline(always)]
fn row_of(first: NodeRow, node: NodeId) -> NodeRow {
    NodeRow(first.0 + node.0)
}

#[inline(always)]
fn with_fourth(row: Row, fourth: f32) -> Row {
    Row::from_array([row[0], row[1], row[2], fourth])
}
