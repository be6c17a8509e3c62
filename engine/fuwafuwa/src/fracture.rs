//! Crack growth, cuts, and removal of pieces.

pub mod blade;
pub mod breakable_nodes;
pub mod crack_growth;
pub mod knife;
pub mod piece_removal;
pub mod release;
