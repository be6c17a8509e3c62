//! Contacts with what is on their two sides.

use super::row::Contact;

/// A node against something rigid.
#[derive(Copy, Clone, Debug)]
pub struct NodeContact {
    pub contact: Contact,
    /// Place of the node among those of all bodies.
    pub node: u32,
    /// The place of the hand, if it is one that the node touches.
    pub hand: Option<u32>,
}

/// Two spheres against each other.
#[derive(Copy, Clone, Debug)]
pub struct SphereContact {
    pub contact: Contact,
    /// Places of their nodes among those of all bodies.
    pub grips: [Grip; 2],
}

/// The corner nodes of a sphere; the first four in 2D.
pub type Grip = [u32; 8];

/// A hand against something else that is rigid.
#[derive(Copy, Clone, Debug)]
pub struct HandContact {
    pub contact: Contact,
    /// Places of the hand and of the other.
    pub both: [u32; 2],
}
