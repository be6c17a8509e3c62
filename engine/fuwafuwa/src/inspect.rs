//! Internals for figures, renderers and checks: lattice arithmetic, mesh, element classes and elastic force
//! laws.
//!
//! Simulations do not need this module. Its items follow the implementation and may change with any release.

pub use crate::foundation::dim::{
    add, beyond, corner, face_corners, neighbourhood, points_in, scale, voxel_around,
};
pub use crate::foundation::hash::Hash;
pub use crate::math::row::Row;
pub use crate::soft_body::element_law::{Elasticity, Matrix, forces};
pub use crate::soft_body::plasticity::{
    Plasticity, elastic_part, flow, forces_after, plastic_stiffness_factor,
};
pub use crate::soft_body::view::{ElementFace, blocks, faces, outline_slots};
pub use crate::topology::cell_hierarchy::{Cell, CellHierarchy};
pub use crate::topology::connectivity::{Connectivity, Groups};
pub use crate::topology::element_class::{
    ElementClass, MissingCorner, cell_corners, closure, slot_at, slot_index,
};
pub use crate::topology::mesh::{Element, InvariantViolation, Mesh, Node, Remodelled};
