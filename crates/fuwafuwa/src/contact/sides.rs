//! Contacts with what is on their two sides.

use super::row::Contact;
use crate::handle::RigidSlot;
use crate::ids::id;
use crate::shape::Vector;

id! {
    /// A node among those of all bodies.
    pub NodeRow
}

/// A node against something rigid.
#[derive(Copy, Clone, Debug)]
pub struct NodeContact {
    pub contact: Contact,
    pub node: NodeRow,
    /// The hand, if it is one that the node touches, and how far from its position the node is [m].
    pub hand: Option<(RigidSlot, Vector)>,
}

/// Two spheres against each other.
#[derive(Copy, Clone, Debug)]
pub struct SphereContact {
    pub contact: Contact,
    pub grips: [Grip; 2],
}

/// The corner nodes of a sphere; the first four in 2D.
pub type Grip = [NodeRow; 8];

/// A hand against something else that is rigid.
#[derive(Copy, Clone, Debug)]
pub struct HandContact {
    pub contact: Contact,
    /// The hand and the other.
    pub both: [RigidSlot; 2],
}
