//! Crack growth, cuts and knives.

pub mod blade;
pub mod breakable_nodes;
pub mod crack_growth;
pub mod knife;
pub mod near_field;
pub mod nodal_tension;
pub mod strength;
pub mod tip_deviations;
