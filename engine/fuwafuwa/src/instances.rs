//! Compiled instances of the generic engine for 2D and 3D.
//!
//! A generic function is compiled in each crate that calls it with concrete types, at the optimisation level
//! of that crate. An `#[inline(never)]` function is an exception: if the crate that defines it already
//! contains the instance, other crates link to this instance. All functions that loop over nodes, elements or
//! voxels are therefore `#[inline(never)]` and named here. A function that is missing in this list costs
//! compile time, and is slow in debug builds.

use crate::foundation::dim::{Dim, Dim2, Dim3};
use std::hint::black_box;

/// Compiles the engine for 2D and 3D. Not meant to be called.
#[inline(never)]
pub fn instances() {
    instances_of::<Dim2>();
    instances_of::<Dim3>();
}

#[inline(always)]
fn instances_of<D: Dim>() {
    black_box([
        crate::VoxelGrid::<D>::ball as *const (),
        crate::VoxelGrid::<D>::cube as *const (),
        crate::VoxelGrid::<D>::ring as *const (),
        crate::VoxelGrid::<D>::heart as *const (),
        crate::VoxelGrid::<D>::flower as *const (),
        crate::VoxelGrid::<D>::solid_count as *const (),
        crate::VoxelGrid::<D>::remaining_count as *const (),
        crate::topology::skin::Skin::of::<D> as *const (),
        crate::topology::connectivity::Connectivity::<D>::new as *const (),
        crate::topology::connectivity::Connectivity::<D>::normalise as *const (),
        crate::topology::cell_hierarchy::CellHierarchy::<D>::new as *const (),
        crate::topology::element_class::ElementClass::<D>::new as *const (),
        crate::topology::mesh::Mesh::<D>::grade as *const (),
        crate::topology::mesh::Mesh::<D>::remodel as *const (),
        crate::topology::mesh::Mesh::<D>::validate as *const (),
        crate::topology::mesh::Mesh::<D>::is_same_as as *const (),
        crate::topology::mesh::Mesh::<D>::elements_per_level as *const (),
        crate::topology::mesh::Mesh::<D>::independent_vertex_count as *const (),
        crate::soft_body::element_law::forces::<D> as *const (),
        crate::SoftBody::<D>::with_options as *const (),
        crate::SoftBody::<D>::translated as *const (),
        crate::SoftBody::<D>::rotated_about as *const (),
        crate::SoftBody::<D>::moving_at as *const (),
        crate::SoftBody::<D>::centre_of_mass as *const (),
        crate::SoftBody::<D>::advance as *const (),
        crate::SoftBody::<D>::momentum as *const (),
        crate::SoftBody::<D>::kinetic_energy as *const (),
        crate::SoftBody::<D>::total_mass as *const (),
        crate::SoftBody::<D>::release as *const (),
        crate::SoftBody::<D>::cut as *const (),
        crate::SoftBody::<D>::crumble as *const (),
        crate::SoftBody::<D>::piece_views as *const (),
        crate::SoftBody::<D>::mass_inside as *const (),
        crate::SoftBody::<D>::outlines as *const (),
        crate::SoftBody::<D>::element_view as *const (),
        crate::SoftBody::<D>::strain as *const (),
        crate::soft_body::element_state::element_state::<D> as *const (),
        crate::soft_body::element_state::element_state_plastic::<D> as *const (),
        crate::soft_body::plasticity::forces_after::<D> as *const (),
        crate::SoftBody::<D>::element_state as *const (),
        crate::SoftBody::<D>::energies as *const (),
        crate::World::<D>::new as *const (),
        crate::World::<D>::step as *const (),
        crate::World::<D>::step_with as *const (),
        crate::World::<D>::add_soft_body as *const (),
        crate::World::<D>::add_rigid_body as *const (),
        crate::World::<D>::cut as *const (),
        crate::World::<D>::soft_body_mut as *const (),
        crate::World::<D>::remove_soft_body as *const (),
        crate::World::<D>::remove_rigid_body as *const (),
        crate::World::<D>::remove_piece as *const (),
        crate::World::<D>::remove_small_pieces as *const (),
        crate::World::<D>::remove_outside as *const (),
        crate::World::<D>::translate_body as *const (),
        crate::World::<D>::rotate_body as *const (),
        crate::World::<D>::set_pose as *const (),
        crate::World::<D>::velocity_of as *const (),
        crate::World::<D>::set_velocity_of as *const (),
        crate::World::<D>::add_velocity_to as *const (),
        crate::World::<D>::apply_impulse_to as *const (),
        crate::World::<D>::set_motion_type as *const (),
        crate::World::<D>::set_friction as *const (),
        crate::World::<D>::set_restitution as *const (),
        crate::World::<D>::set_sensor as *const (),
        crate::World::<D>::add_joint as *const (),
        crate::World::<D>::remove_joint as *const (),
        crate::World::<D>::joint_anchor_positions as *const (),
        crate::World::<D>::add_knife as *const (),
        crate::World::<D>::remove_knife as *const (),
        crate::World::<D>::set_layers_of as *const (),
        crate::World::<D>::set_gravity_scale as *const (),
        crate::World::<D>::wake_up_body as *const (),
        crate::World::<D>::put_body_to_sleep as *const (),
        crate::World::<D>::set_config as *const (),
        crate::World::<D>::hash as *const (),
        crate::World::<D>::ray_cast as *const (),
        crate::World::<D>::closest_point as *const (),
        crate::World::<D>::objects_at as *const (),
        crate::World::<D>::overlaps as *const (),
    ]);
    #[cfg(feature = "serde")]
    black_box([
        crate::snapshot::save::<D> as *const (),
        crate::snapshot::load::<D> as *const (),
    ]);
}
