//! Contacts and joints: the broad phase finds pairs, the solver applies impulses.

pub mod broad_phase;
pub mod joint;
pub mod rest_speeds;
pub mod solver;
