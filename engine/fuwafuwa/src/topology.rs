//! Voxels, their connectivity, and the elements, nodes and pieces that follow from it.

pub mod cell_hierarchy;
pub mod changes;
pub mod connectivity;
pub mod element_class;
pub mod grid;
pub mod mesh;
pub mod pieces;
pub mod skin;
