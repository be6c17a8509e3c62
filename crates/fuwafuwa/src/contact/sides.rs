//! Contacts with what is on their two sides.

use super::row::Contact;
use crate::manipulator::Manipulator;
use crate::solve::Row;

/// A node against something rigid.
#[derive(Copy, Clone, Debug)]
pub struct NodeContact {
    pub contact: Contact,
    /// Place of the node among those of all bodies.
    pub node: u32,
    /// The hand, if it is one that the node touches.
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

/// A manipulator against an obstacle or against another manipulator.
#[derive(Copy, Clone, Debug)]
pub struct HandContact {
    pub contact: Contact,
    pub hand: usize,
    pub other: Option<usize>,
}

/// Changes the velocity of a manipulator by an impulse, and notes it as a force on it.
pub fn push_hand(hand: &mut Manipulator, impulse: Row, duration: f32) {
    let inverse_mass = hand.inverse_mass();
    for axis in 0..3 {
        hand.velocity[axis] += impulse[axis] * inverse_mass;
        if let Some(reaction) = hand.reactions.last_mut() {
            reaction.contact[axis] += impulse[axis] / duration;
        }
    }
}
