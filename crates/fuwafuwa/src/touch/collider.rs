//! Anything rigid, as nodes meet it: obstacles and hands alike.

use crate::shape::Shape;
use crate::solve::Row;

/// Something rigid that nodes can touch.
#[derive(Copy, Clone, Debug)]
pub struct Collider {
    /// Where it is now.
    pub shape: Shape,
    /// [m/s]
    pub velocity: Row,
    /// One over its mass [1/kg]; 0 when nothing can push it.
    pub inverse_mass: f32,
    /// Coulomb friction with nodes.
    pub friction: f32,
    /// Whether it wakes what it touches.
    pub is_hand: bool,
}
