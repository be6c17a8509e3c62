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
    /// What is rigid, if it moves, and how far from its position the node is [m].
    pub mover: Option<(RigidSlot, Vector)>,
}

/// Two spheres against each other.
#[derive(Copy, Clone, Debug)]
pub struct SphereContact {
    pub contact: Contact,
    pub grips: [Grip; 2],
}

/// The corner nodes of a sphere; the first four in 2D.
pub type Grip = [NodeRow; 8];

/// What is free against something else that is rigid, at one point.
#[derive(Copy, Clone, Debug)]
pub struct FreeContact {
    pub contact: Contact,
    /// The one that is free, and the other.
    pub both: [RigidSlot; 2],
    /// How far the point is from the position of each [m].
    pub levers: [Vector; 2],
    /// One over the speed across the normal that a unit of impulse gives at the most [kg].
    pub across: f32,
    /// Where [m], and how fast both approach each other there [m/s].
    pub at: Vector,
    pub speed: f32,
    /// How fast it is to go away from the other [m/s].
    pub bounce: f32,
    /// Which corner or edge it is.
    pub key: u32,
}

/// A hand against something else that is rigid.
#[derive(Copy, Clone, Debug)]
pub struct HandContact {
    pub contact: Contact,
    /// The hand and the other.
    pub both: [RigidSlot; 2],
}
