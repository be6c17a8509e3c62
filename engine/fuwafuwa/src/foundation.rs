//! Dimensions, typed ids, containers, state hashing and threads.

pub mod arena;
pub mod copy_on_write;
pub mod dim;
pub mod disjoint_sets;
pub mod hash;
pub mod id_lists;
pub mod ids;
pub mod threads;
