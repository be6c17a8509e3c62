//! The velocities that contacts push on, side by side.

use super::sides::{Grip, NodeContact, NodeRow};
use crate::body::Bodies;
use crate::dim::Dim;
use crate::handle::{BodySlot, RigidSlot};
use crate::ids::{Id, NodeId, Table};
use crate::rigid::Rigids;
use crate::shape::Vector;
use crate::solve::Row;
use crate::touch::{ContactSphere, mean};
use crate::vector::{as_row, minus, plus, scaled, three};

/// Nodes whose velocities are copied together: more copies more in vain, less asks more often. From 4 to 64
/// `diced`, `pile` and `tear-3d` take the same.
const STRETCH: usize = 16;

/// The velocities of the nodes that contacts push on [m/s], one over their mass as the fourth
/// component [1/kg]: what a push needs is in one place.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// Where nothing is touched, anything.
    rows: Table<NodeRow, Row>,
    /// The row of the first node of each body, where a stretch begins.
    first: Table<BodySlot, NodeRow>,
    /// For each stretch whether any of its nodes is touched: of a large body few are.
    is_touched: Vec<bool>,
}

impl Motion {
    /// Nothing is touched yet.
    pub fn clear<D: Dim>(&mut self, bodies: &Bodies<D>) {
        self.first.clear();
        let mut count = 0;
        for body in bodies.slots() {
            self.first.push(NodeRow::of(count));
            let nodes = body.map_or(0, |body| body.state.velocity.len());
            count += nodes.next_multiple_of(STRETCH);
        }
        self.rows.resize(count, [0.0; 4]);
        self.is_touched.clear();
        self.is_touched.resize(count / STRETCH, false);
    }

    /// The row of a node of a body, which something touches.
    #[inline(always)]
    pub fn row(&mut self, body: BodySlot, node: NodeId) -> NodeRow {
        let row = row_of(self.first[body], node);
        self.is_touched[row.index() / STRETCH] = true;
        row
    }

    /// The rows of the corner nodes of a sphere that something touches.
    #[inline(always)]
    pub fn grip<D: Dim>(&mut self, sphere: &ContactSphere) -> Grip {
        let first = self.first[sphere.body];
        let grip = sphere.nodes.map(|node| row_of(first, node));
        for row in &grip[..D::CORNERS] {
            self.is_touched[row.index() / STRETCH] = true;
        }
        grip
    }

    /// Takes the velocities from the bodies.
    pub fn load<D: Dim>(&mut self, bodies: &Bodies<D>) {
        for (slot, body) in bodies.by_slot() {
            let first = self.first[slot].index();
            let nodes = body.state.velocity.chunks(STRETCH);
            let nodes = nodes.zip(body.state.inverse_mass.chunks(STRETCH));
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

    /// Gives them back.
    pub fn store<D: Dim>(&self, bodies: &mut Bodies<D>) {
        for (slot, body) in bodies.by_slot_mut() {
            let first = self.first[slot].index();
            let rows = self.rows.as_slice()[first..].chunks(STRETCH);
            let own = rows.zip(body.state.velocity.chunks_mut(STRETCH));
            let touched = &self.is_touched[first / STRETCH..];
            for ((rows, velocities), _) in own.zip(touched).filter(|(_, is)| **is) {
                for (row, velocity) in rows.iter().zip(velocities) {
                    *velocity = with_fourth(*row, 0.0);
                }
            }
        }
    }

    /// How fast the first sphere moves as seen from the second.
    #[inline(always)]
    pub fn between<D: Dim>(&self, grips: &[Grip; 2]) -> Row {
        let [first, second] = grips.each_ref().map(|grip| mean::<D, _>(&self.rows, grip));
        with_fourth(minus(first, second), 0.0)
    }

    /// Pushes the first sphere, and the second the other way.
    #[inline(always)]
    pub fn push_spheres<D: Dim>(&mut self, grips: &[Grip; 2], impulse: Row) {
        let share = scaled(impulse, 1.0 / D::CORNERS as f32);
        for (grip, share) in [(&grips[0], share), (&grips[1], scaled(share, -1.0))] {
            for &node in &grip[..D::CORNERS] {
                let row = &mut self.rows[node];
                *row = plus(*row, scaled(share, row[3]));
            }
        }
    }

    /// How fast a node moves as seen from what it touches.
    #[inline(always)]
    pub fn of_node(&self, row: &NodeContact, rigids: &Rigids) -> Row {
        let own = self.rows[row.node];
        let other = row.mover.map_or([0.0; 4], |mover| velocity(mover, rigids));
        with_fourth(minus(own, other), 0.0)
    }

    /// Pushes a node, and what moves against it the other way.
    #[inline(always)]
    pub fn push_node(
        &mut self,
        row: &NodeContact,
        rigids: &mut Rigids,
        impulse: Row,
        duration: f32,
    ) {
        let own = &mut self.rows[row.node];
        *own = plus(*own, scaled(impulse, own[3]));
        if let Some(mover) = row.mover {
            push(mover, rigids, scaled(impulse, -1.0), duration);
        }
    }
}

/// How fast something rigid moves so far from its position. Few contacts ask: in line it would slow down all others.
#[inline(never)]
fn velocity((mover, lever): (RigidSlot, Vector), rigids: &Rigids) -> Row {
    as_row(rigids.at(mover).velocity_at(lever))
}

/// Pushes it there.
#[inline(never)]
fn push((mover, lever): (RigidSlot, Vector), rigids: &mut Rigids, impulse: Row, duration: f32) {
    rigids
        .at_mut(mover)
        .push_at(three(impulse), lever, duration);
}

/// The row of a node of the body that has this first one.
#[inline(always)]
fn row_of(first: NodeRow, node: NodeId) -> NodeRow {
    NodeRow(first.0 + node.0)
}

#[inline(always)]
fn with_fourth(row: Row, fourth: f32) -> Row {
    [row[0], row[1], row[2], fourth]
}
