//! Crack growth, cuts and knives.

pub mod blade;
pub mod breakable_nodes;
pub mod crack_growth;
pub mod knife;
