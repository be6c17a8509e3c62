//! The engine in the plane and in space, compiled here, so that no program that uses it has to do so again.
//!
//! A generic function is compiled where its types are known, in every crate that calls it and as that crate is optimised;
//! but one that is `#[inline(never)]` is taken from its own crate if it was compiled there. So what goes over all nodes,
//! elements or voxels is, and stands in this list; what it calls comes along. An entry that is missing costs a user's
//! compiler some time and changes no bit.

/// The names and the places of what is compiled, in so many dimensions.
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

/// All of them as this crate has them: in the plane, and in space.
#[inline(never)]
pub fn compiled() -> [Vec<(&'static str, *const ())>; 2] {
    [entries!(crate::Dim2), entries!(crate::Dim3)]
}
