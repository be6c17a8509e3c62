//! Views of rigid bodies in a world.

use crate::convert::{
    Any, angular_object, angular_rows, coordinates, rotation_object, vector_array, vector_rows,
};
use crate::error::OrInvalid;
use crate::handle::RigidBodyHandle;
use crate::rigid_body::{RigidBody2, RigidBody3, motion, motion_name};
use crate::shape::{Shape2, Shape3};
use crate::world::{World2, World3};
use fuwafuwa::{Dim2, Dim3, RigidBodyRef};
use pyo3::prelude::*;
use pyo3::types::PyDict;

macro_rules! rigid_view_class {
    ($class:ident, $world:ident, $body:ident, $shape:ident, $dim:ty, $dims:literal) => {
        #[doc = concat!("View of a rigid body in a World", $dims, ": `world[handle]` or `world.rigid_body(handle)`.")]
        ///
        /// Each access reads the present state of the world and raises `Error` if the body was removed.
        #[pyclass(frozen, module = "fuwafuwa")]
        pub struct $class {
            world: Py<$world>,
            handle: fuwafuwa::RigidBodyHandle,
        }

        impl $class {
            /// Creates a view of a rigid body.
            pub fn new(world: Py<$world>, handle: fuwafuwa::RigidBodyHandle) -> Self {
                Self { world, handle }
            }

            fn read<R>(
                &self,
                py: Python<'_>,
                work: impl FnOnce(RigidBodyRef<'_, $dim>) -> PyResult<R>,
            ) -> PyResult<R> {
                let world = self.world.bind(py).try_borrow()?;
                work(world.world.rigid_body(self.handle).or_invalid()?)
            }
        }

        #[pymethods]
        impl $class {
            /// Handle of the body.
            #[getter]
            fn handle(&self) -> RigidBodyHandle {
                RigidBodyHandle(self.handle)
            }

            /// World of the body.
            #[getter]
            fn world(&self, py: Python<'_>) -> Py<$world> {
                self.world.clone_ref(py)
            }

            /// Returns the definition of the body in its present state.
            fn definition(&self, py: Python<'_>) -> PyResult<$body> {
                self.read(py, |body| Ok($body(body.definition())))
            }

            /// Motion type and its parameters, by name.
            #[getter]
            fn motion<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
                self.read(py, |body| motion(py, body.motion_type()))
            }

            /// Whether the body sleeps.
            #[getter]
            fn asleep(&self, py: Python<'_>) -> PyResult<bool> {
                self.read(py, |body| Ok(body.is_asleep()))
            }

            /// Position [m].
            #[getter]
            fn position<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
                self.read(py, |body| Ok(vector_array(py, body.position()).into_any()))
            }

            /// Rotation: an angle [rad] in 2D, a quaternion x, y, z, w in 3D.
            #[getter]
            fn rotation<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
                self.read(py, |body| rotation_object::<$dim>(py, body.rotation()))
            }

            /// Velocity [m/s].
            #[getter]
            fn velocity<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
                self.read(py, |body| Ok(vector_array(py, body.velocity().linear).into_any()))
            }

            /// Angular velocity [rad/s]: a number in 2D, a vector in 3D.
            #[getter]
            fn angular_velocity<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
                self.read(py, |body| angular_object::<$dim>(py, body.velocity().angular))
            }

            /// Target position of a kinematic or coupled body [m].
            #[getter]
            fn target_position<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
                self.read(py, |body| Ok(vector_array(py, body.target_position()).into_any()))
            }

            /// Target rotation of a kinematic or coupled body.
            #[getter]
            fn target_rotation<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
                self.read(py, |body| rotation_object::<$dim>(py, body.target_rotation()))
            }

            /// Shape in world coordinates.
            #[getter]
            fn shape(&self, py: Python<'_>) -> PyResult<$shape> {
                self.read(py, |body| Ok($shape(body.shape())))
            }

            /// Shape in local coordinates.
            #[getter]
            fn local_shape(&self, py: Python<'_>) -> PyResult<$shape> {
                self.read(py, |body| Ok($shape(body.local_shape())))
            }

            /// Coulomb friction coefficient.
            #[getter]
            fn friction(&self, py: Python<'_>) -> PyResult<f32> {
                self.read(py, |body| Ok(body.friction()))
            }

            /// Coefficient of restitution.
            #[getter]
            fn restitution(&self, py: Python<'_>) -> PyResult<f32> {
                self.read(py, |body| Ok(body.restitution()))
            }

            /// Bit masks of the layers: memberships and filters.
            #[getter]
            fn layers(&self, py: Python<'_>) -> PyResult<(u32, u32)> {
                self.read(py, |body| Ok((body.layers().memberships, body.layers().filters)))
            }

            /// Whether the body only reports what enters it.
            #[getter]
            fn is_sensor(&self, py: Python<'_>) -> PyResult<bool> {
                self.read(py, |body| Ok(body.is_sensor()))
            }

            /// Number of the program.
            #[getter]
            fn user_data(&self, py: Python<'_>) -> PyResult<u64> {
                self.read(py, |body| Ok(body.user_data()))
            }

            /// Returns the forces on the body in each substep of the last tick: a dict of float32 arrays with s rows.
            /// contact (s, d) [N]: force of all contacts; coupling (s, d) [N]: force of the virtual coupling, which a
            /// force-feedback device should play; torque [N m]: (s,) in 2D, (s, 3) in 3D. Empty for fixed bodies.
            fn reactions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
                self.read(py, |body| {
                    let dict = PyDict::new(py);
                    let torques = body.reactions().map(|reaction| reaction.torque);
                    let contacts = body.reactions().map(|reaction| reaction.contact);
                    let couplings = body.reactions().map(|reaction| reaction.coupling);
                    dict.set_item("contact", vector_rows(py, contacts))?;
                    dict.set_item("coupling", vector_rows(py, couplings))?;
                    dict.set_item("torque", angular_rows::<$dim>(py, torques))?;
                    Ok(dict)
                })
            }

            fn __repr__(&self, py: Python<'_>) -> String {
                let name = stringify!($class);
                let described = self.read(py, |body| {
                    let kind = motion_name(body.motion_type());
                    Ok(format!("<{name} {kind} at {:?}>", coordinates(body.position())))
                });
                described.unwrap_or_else(|error| format!("<{name}: {error}>"))
            }
        }
    };
}

rigid_view_class!(RigidBodyView2, World2, RigidBody2, Shape2, Dim2, "2");
rigid_view_class!(RigidBodyView3, World3, RigidBody3, Shape3, Dim3, "3");
