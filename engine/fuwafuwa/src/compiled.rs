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
            $crate::sharing::Sharing::<$dim>::new,
            $crate::sharing::Sharing::<$dim>::normalise,
            $crate::pyramid::Pyramid::<$dim>::new,
            $crate::stencil::Stencil::<$dim>::new,
            $crate::Mesh::<$dim>::grade,
            $crate::Mesh::<$dim>::remodel,
            $crate::Mesh::<$dim>::validate,
            $crate::Mesh::<$dim>::is_same_as,
            $crate::Mesh::<$dim>::elements_per_level,
            $crate::Mesh::<$dim>::independent_vertex_count,
            $crate::law::forces::<$dim>,
            $crate::Body::<$dim>::with,
            $crate::Body::<$dim>::moved,
            $crate::Body::<$dim>::rotated,
            $crate::Body::<$dim>::thrown,
            $crate::Body::<$dim>::centre_of_mass,
            $crate::Body::<$dim>::advance,
            $crate::Body::<$dim>::momentum,
            $crate::Body::<$dim>::kinetic_energy,
            $crate::Body::<$dim>::total_mass,
            $crate::Body::<$dim>::release,
            $crate::Body::<$dim>::cut,
            $crate::Body::<$dim>::crumble,
            $crate::Body::<$dim>::piece_views,
            $crate::Body::<$dim>::mass_inside,
            $crate::Body::<$dim>::outlines,
            $crate::Body::<$dim>::element_view,
            $crate::Body::<$dim>::strain,
            $crate::measure::strained::<$dim>,
            $crate::measure::strained_after::<$dim>,
            $crate::plasticity::forces_after::<$dim>,
            $crate::Body::<$dim>::strained,
            $crate::Body::<$dim>::energies,
            $crate::World::<$dim>::new,
            $crate::World::<$dim>::step,
            $crate::World::<$dim>::step_with,
            $crate::World::<$dim>::add_body,
            $crate::World::<$dim>::add_rigid,
            $crate::World::<$dim>::cut,
            $crate::World::<$dim>::body_mut,
            $crate::World::<$dim>::remove_body,
            $crate::World::<$dim>::remove_rigid,
            $crate::World::<$dim>::remove_piece,
            $crate::World::<$dim>::remove_small_pieces,
            $crate::World::<$dim>::remove_outside,
            $crate::World::<$dim>::move_body,
            $crate::World::<$dim>::rotate_body,
            $crate::World::<$dim>::add_velocity,
            $crate::World::<$dim>::apply_impulse,
            $crate::World::<$dim>::place_rigid,
            $crate::World::<$dim>::set_velocity,
            $crate::World::<$dim>::push_rigid,
            $crate::World::<$dim>::add_joint,
            $crate::World::<$dim>::remove_joint,
            $crate::World::<$dim>::joint_places,
            $crate::World::<$dim>::add_knife,
            $crate::World::<$dim>::remove_knife,
            $crate::World::<$dim>::set_layers,
            $crate::World::<$dim>::set_user_data,
            $crate::World::<$dim>::set_gravity_scale,
            $crate::World::<$dim>::wake_up,
            $crate::World::<$dim>::put_to_sleep,
            $crate::World::<$dim>::set_settings,
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
