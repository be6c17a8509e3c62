//! Contacts of each kind: a solver row and the two objects that it acts on.

use super::contact_row::Contact;
use crate::foundation::arena::RigidSlot;
use crate::foundation::ids::{IndexVec, id};
use crate::math::row::Row;
use crate::soft_body::skin_point::SkinPoint;
use glam::Vec3;

id! {
    /// Index of a node among the velocity rows of all bodies.
    pub NodeRow
}

/// Contact between a node and a rigid body.
#[derive(Copy, Clone, Debug)]
pub struct NodeContact {
    pub contact: Contact,
    /// Velocity row of the node.
    pub node: NodeRow,
    /// Point of the contact, relative to the velocity rows.
    pub point: SkinPoint<NodeRow>,
    /// Rigid body, if it can move, and the lever arm from the body's position to the contact [m].
    pub mover: Option<(RigidSlot, Vec3)>,
}

impl NodeContact {
    /// Returns the value of a quantity at the contact, given its value at each node.
    #[inline(always)]
    pub fn mean(&self, rows: &IndexVec<NodeRow, Row>) -> Row {
        self.point.mean(self.node, rows)
    }
}

/// Contact between two contact spheres.
#[derive(Copy, Clone, Debug)]
pub struct SphereContact {
    pub contact: Contact,
    pub node_rows: [SphereNodeRows; 2],
}

/// Velocity rows of a sphere's corner nodes; in 2D only the first four are used.
pub type SphereNodeRows = [NodeRow; 8];

/// Contact point between a dynamic and any other rigid body.
#[derive(Copy, Clone, Debug)]
pub struct DynamicContact {
    pub contact: Contact,
    /// Slots of the dynamic body and of the body that it touches.
    pub both: [RigidSlot; 2],
    /// Lever arms from the position of each body to the contact point [m].
    pub levers: [Vec3; 2],
    /// Position of the point [m].
    pub at: Vec3,
    /// Approach speed at the point [m/s].
    pub speed: f32,
    /// Separation speed after a bounce [m/s]; 0 without a bounce.
    pub bounce: f32,
    /// Normal impulse before the velocity of overlap resolution is removed [N s].
    pub pressing: f32,
    /// Key of the touching corner or edge crossing: identifies the contact point in the next substep.
    pub key: u32,
}

/// Contact of a kinematic or coupled rigid body with a fixed, kinematic or coupled one.
#[derive(Copy, Clone, Debug)]
pub struct KinematicContact {
    pub contact: Contact,
    /// Slots of the kinematic or coupled body and of the body that it touches.
    pub both: [RigidSlot; 2],
}
