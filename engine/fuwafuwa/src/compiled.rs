//! Precompiled instances of the engine for 2D and 3D.
//!
//! A generic function is compiled in every crate that calls it with concrete types, at the optimisation level
//! of that crate. An `#[inline(never)]` function is instead linked from its own crate, if it was compiled
//! there. So all functions that loop over nodes, elements or voxels are `#[inline(never)]`, and listed here
//! together with everything that they call. A missing entry only costs compile time.

/// Names and addresses of the precompiled functions for one dimension.
#[doc(hidden)]
#[macro_export]
macro_rules! entries {
    ($dim:ty) => {
        $crate::entries![
            $crate::VoxelGrid::<$dim>::ball,
            $crate::VoxelGrid::<$dim>::cube,
            $crate::VoxelGrid::<$dim>::ring,
            $crate::VoxelGrid::<$dim>::heart,
            $crate::VoxelGrid::<$dim>::flower,
            $crate::VoxelGrid::<$dim>::solid_count,
            $crate::VoxelGrid::<$dim>::left_count,
            $crate::sharing::Connectivity::<$dim>::new,
            $crate::sharing::Connectivity::<$dim>::normalise,
            $crate::pyramid::CellHierarchy::<$dim>::new,
            $crate::stencil::ElementClass::<$dim>::new,
            $crate::Mesh::<$dim>::grade,
            $crate::Mesh::<$dim>::remodel,
            $crate::Mesh::<$dim>::validate,
            $crate::Mesh::<$dim>::is_same_as,
            $crate::Mesh::<$dim>::elements_per_level,
            $crate::Mesh::<$dim>::independent_vertex_count,
            $crate::law::forces::<$dim>,
            $crate::SoftBody::<$dim>::with_options,
            $crate::SoftBody::<$dim>::translated,
            $crate::SoftBody::<$dim>::rotated,
            $crate::SoftBody::<$dim>::with_velocity,
            $crate::SoftBody::<$dim>::centre_of_mass,
            $crate::SoftBody::<$dim>::advance,
            $crate::SoftBody::<$dim>::momentum,
            $crate::SoftBody::<$dim>::kinetic_energy,
            $crate::SoftBody::<$dim>::total_mass,
            $crate::SoftBody::<$dim>::release,
            $crate::SoftBody::<$dim>::cut,
            $crate::SoftBody::<$dim>::crumble,
            $crate::SoftBody::<$dim>::piece_views,
            $crate::SoftBody::<$dim>::mass_inside,
            $crate::SoftBody::<$dim>::outlines,
            $crate::SoftBody::<$dim>::element_view,
            $crate::SoftBody::<$dim>::strain,
            $crate::measure::element_state::<$dim>,
            $crate::measure::element_state_plastic::<$dim>,
            $crate::plasticity::forces_after::<$dim>,
            $crate::SoftBody::<$dim>::element_state,
            $crate::SoftBody::<$dim>::energies,
            $crate::World::<$dim>::new,
            $crate::World::<$dim>::step,
            $crate::World::<$dim>::step_with,
            $crate::World::<$dim>::add_soft_body,
            $crate::World::<$dim>::add_rigid_body,
            $crate::World::<$dim>::cut,
            $crate::World::<$dim>::soft_body_mut,
            $crate::World::<$dim>::remove_soft_body,
            $crate::World::<$dim>::remove_rigid_body,
            $crate::World::<$dim>::remove_piece,
            $crate::World::<$dim>::remove_small_pieces,
            $crate::World::<$dim>::remove_outside,
            $crate::World::<$dim>::translate_body,
            $crate::World::<$dim>::rotate_body,
            $crate::World::<$dim>::add_velocity,
            $crate::World::<$dim>::apply_impulse,
            $crate::World::<$dim>::set_rigid_body_pose,
            $crate::World::<$dim>::set_velocity,
            $crate::World::<$dim>::apply_rigid_body_impulse,
            $crate::World::<$dim>::add_joint,
            $crate::World::<$dim>::remove_joint,
            $crate::World::<$dim>::joint_anchor_positions,
            $crate::World::<$dim>::add_knife,
            $crate::World::<$dim>::remove_knife,
            $crate::World::<$dim>::set_layers,
            $crate::World::<$dim>::set_user_data,
            $crate::World::<$dim>::set_gravity_scale,
            $crate::World::<$dim>::wake_up,
            $crate::World::<$dim>::put_to_sleep,
            $crate::World::<$dim>::set_config,
            $crate::World::<$dim>::hash,
            $crate::Queries::<$dim>::new,
            $crate::Queries::<$dim>::ray,
            $crate::Queries::<$dim>::nearest,
            $crate::Queries::<$dim>::at,
            $crate::Queries::<$dim>::overlapping,
            ; if "serde" {
                $crate::snapshot::save::<$dim>,
                $crate::snapshot::load::<$dim>,
            }
        ]
    };
    ($($entry:expr,)* ; if $feature:literal { $($more:expr,)* }) => {
        [
            $((stringify!($entry), $entry as *const ()),)*
            $(#[cfg(feature = $feature)] (stringify!($more), $more as *const ()),)*
        ]
        .to_vec()
    };
}

/// Returns the precompiled functions of this crate, for 2D and 3D.
#[inline(never)]
pub fn compiled() -> [Vec<(&'static str, *const ())>; 2] {
    [entries!(crate::Dim2), entries!(crate::Dim3)]
}
