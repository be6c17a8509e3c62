//! Contiguous node velocities for the contact solver.

use super::contact_sides::{NodeContact, NodeRow, SphereNodeRows};
use crate::contact::broad_phase::{ContactSphere, mean};
use crate::foundation::arena::{BodySlot, RigidSlot};
use crate::foundation::dim::Dim;
use crate::foundation::ids::{Id, IndexVec, NodeId};
use crate::rigid_body::RigidBodies;
use crate::soft_body::SoftBodies;
use crate::soft_body::element_forces::Row;
use glam::Vec3;

/// Number of nodes in a chunk of `Motion`. A chunk with any node in contact is copied as a whole. Larger
/// chunks copy more unused nodes; smaller ones cost more tests.
const STRETCH: usize = 16;

/// Copy of the velocities of nodes in contact [m/s]. The fourth component is the inverse mass [1/kg], so that
/// applying an impulse reads one row.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// Velocity and inverse mass of each node. Valid only in chunks with a node in contact.
    rows: IndexVec<NodeRow, Row>,
    /// Row of the first node of each body, always at the start of a chunk.
    first: IndexVec<BodySlot, NodeRow>,
    /// For each chunk, whether any of its nodes is in contact. All other chunks, which are most chunks of a
    /// large body, are not copied.
    is_touched: Vec<bool>,
}

impl Motion {
    /// Prepares one row for each node and marks all nodes as without contact.
    pub fn clear<D: Dim>(&mut self, bodies: &SoftBodies<D>) {
        self.first.clear();
        let mut count = 0;
        for body in bodies.slots() {
            self.first.push(NodeRow::of(count));
            let nodes = body.map_or(0, |body| body.velocities().len());
            count += nodes.next_multiple_of(STRETCH);
        }
        self.rows.resize(count, Row::ZERO);
        self.is_touched.clear();
        self.is_touched.resize(count / STRETCH, false);
    }

    /// Returns the row of a node and marks it as in contact.
    #[inline(always)]
    pub fn row(&mut self, body: BodySlot, node: NodeId) -> NodeRow {
        let row = row_of(self.first[body], node);
        self.is_touched[row.index() / STRETCH] = true;
        row
    }

    /// Returns the rows of a sphere's corner nodes and marks them as in contact.
    #[inline(always)]
    pub fn grip<D: Dim>(&mut self, sphere: &ContactSphere) -> SphereNodeRows {
        let first = self.first[sphere.body];
        let grip = sphere.nodes.map(|node| row_of(first, node));
        for row in &grip[..D::CORNERS] {
            self.is_touched[row.index() / STRETCH] = true;
        }
        grip
    }

    /// Copies the velocities of nodes in contact from the bodies.
    pub fn load<D: Dim>(&mut self, bodies: &SoftBodies<D>) {
        for (slot, body) in bodies.by_slot() {
            let first = self.first[slot].index();
            let nodes = body.velocities().chunks(STRETCH);
            let nodes = nodes.zip(body.inverse_masses().chunks(STRETCH));
            let own = self.rows.as_mut_slice()[first..]
                .chunks_mut(STRETCH)
                .zip(nodes);
            let touched = &self.is_touched[first / STRETCH..];
            for ((rows, (velocities, inverse_mass)), _) in own.zip(touched).filter(|(_, is)| **is) {
                for (row, (velocity, &inverse_mass)) in
                    rows.iter_mut().zip(velocities.iter().zip(inverse_mass))
                {
                    *row = with_fourth(*velocity, inverse_mass);
                }
            }
        }
    }

    /// Copies the velocities of nodes in contact back to the bodies.
    pub fn store<D: Dim>(&self, bodies: &mut SoftBodies<D>) {
        for (slot, body) in bodies.by_slot_mut() {
            let first = self.first[slot].index();
            let rows = self.rows.as_slice()[first..].chunks(STRETCH);
            let own = rows.zip(body.velocities_mut().chunks_mut(STRETCH));
            let touched = &self.is_touched[first / STRETCH..];
            for ((rows, velocities), _) in own.zip(touched).filter(|(_, is)| **is) {
                for (row, velocity) in rows.iter().zip(velocities) {
                    *velocity = with_fourth(*row, 0.0);
                }
            }
        }
    }

    /// Returns the velocity of the first sphere relative to the second [m/s].
    #[inline(always)]
    pub fn between<D: Dim>(&self, grips: &[SphereNodeRows; 2]) -> Row {
        let [first, second] = grips.each_ref().map(|grip| mean::<D, _>(&self.rows, grip));
        with_fourth(first - second, 0.0)
    }

    /// Applies an impulse to the first sphere and its opposite to the second.
    #[inline(always)]
    pub fn push_spheres<D: Dim>(&mut self, grips: &[SphereNodeRows; 2], impulse: Row) {
        let share = impulse * (1.0 / D::CORNERS as f32);
        for (grip, share) in [(&grips[0], share), (&grips[1], -share)] {
            for &node in &grip[..D::CORNERS] {
                let row = &mut self.rows[node];
                *row += share * row[3];
            }
        }
    }

    /// Returns the velocity of a node relative to the rigid body that it touches [m/s].
    #[inline(always)]
    pub fn of_node(&self, row: &NodeContact, rigids: &RigidBodies) -> Row {
        let own = self.rows[row.node];
        let other = row.mover.map_or(Row::ZERO, |mover| velocity(mover, rigids));
        with_fourth(own - other, 0.0)
    }

    /// Applies an impulse to a node and its opposite to a moving rigid body.
    #[inline(always)]
    pub fn push_node(
        &mut self,
        row: &NodeContact,
        rigids: &mut RigidBodies,
        impulse: Row,
        duration: f32,
    ) {
        let own = &mut self.rows[row.node];
        *own += impulse * own[3];
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
    rigids.at_mut(mover).push_at(impulse.xyz(), lever, duration);
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
