//! Crack growth, cuts, and removal of pieces.

pub mod blade;
pub mod breakable_nodes;
pub mod crack_growth;
pub mod knife;
