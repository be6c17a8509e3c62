//! Definitions of rigid bodies.

use crate::convert::{
    Any, angular_object, pickled, repr, rotation, rotation_object, unpickled, vector, vector_array,
    velocity,
};
use crate::error::invalid_parameter;
use crate::shape::{Shape2, Shape3};
use fuwafuwa::{Dim, Dim2, Dim3, Layers, MotionType, RigidBody};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

/// Properties that all motion types share, as given from Python.
#[derive(Default)]
struct Properties<'a, 'py> {
    position: Option<&'a Any<'py>>,
    rotation: Option<&'a Any<'py>>,
    velocity: Option<&'a Any<'py>>,
    angular_velocity: Option<&'a Any<'py>>,
    friction: f32,
    restitution: f32,
    layers: Option<LayerMasks>,
    is_sensor: bool,
    user_data: u64,
}

/// Layers as an argument: a pair of bit masks.
#[derive(Copy, Clone)]
pub struct LayerMasks(pub Layers);

impl<'py> FromPyObject<'_, 'py> for LayerMasks {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let masks: PyResult<(u32, u32)> = value.extract();
        let (memberships, filters) = masks.map_err(|_| {
            let expected = "a pair of bit masks of 32 bits: memberships and filters";
            invalid_parameter("layers", expected, repr(&value))
        })?;
        Ok(Self(Layers {
            memberships,
            filters,
        }))
    }
}

fn with_properties<D: Dim>(
    body: RigidBody<D>,
    properties: Properties<'_, '_>,
) -> PyResult<RigidBody<D>> {
    let turned = rotation::<D>(properties.rotation)?;
    let velocity = velocity::<D>(properties.velocity, properties.angular_velocity)?;
    Ok(RigidBody {
        position: match properties.position {
            Some(position) => vector::<D>("position", position)?,
            None => body.position,
        },
        rotation: turned,
        velocity,
        friction: properties.friction,
        restitution: properties.restitution,
        layers: properties.layers.map_or(body.layers, |masks| masks.0),
        is_sensor: properties.is_sensor,
        user_data: properties.user_data,
        ..body
    })
}

/// Name of a motion type.
pub fn motion_name(motion: MotionType) -> &'static str {
    match motion {
        MotionType::Fixed => "fixed",
        MotionType::Kinematic => "kinematic",
        MotionType::Coupled { .. } => "coupled",
        MotionType::Dynamic { .. } => "dynamic",
        _ => "unknown",
    }
}

/// Returns the motion type and its parameters.
pub fn motion<'py>(py: Python<'py>, motion: MotionType) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("type", motion_name(motion))?;
    match motion {
        MotionType::Coupled {
            mass,
            stiffness,
            damping,
            max_force,
        } => {
            dict.set_item("mass", mass)?;
            dict.set_item("stiffness", stiffness)?;
            dict.set_item("damping", damping)?;
            dict.set_item("max_force", max_force)?;
        }
        MotionType::Dynamic { mass } => dict.set_item("mass", mass)?,
        _ => {}
    }
    Ok(dict)
}

macro_rules! rigid_body_class {
    ($class:ident, $shape:ident, $dim:ty, $dims:literal) => {
        #[doc = concat!("Definition of a rigid body in ", $dims, "D, for `World", $dims, ".add_rigid_body`.")]
        ///
        /// All constructors have the keyword arguments position [m], rotation (an angle [rad] in 2D, a quaternion
        /// x, y, z, w or a rotation vector in 3D), friction (default 0.2; 0.5 of dynamic bodies), restitution (0 to 1,
        /// default 0), layers (a pair of bit masks: memberships and filters; default member of layer 1, meets all), is_sensor and
        /// user_data (an integer of 64 bits). A wrong value raises `Error` when the body is added to a world.
        #[pyclass(frozen, eq, from_py_object, module = "fuwafuwa")]
        #[derive(Copy, Clone, Debug, PartialEq)]
        pub struct $class(pub RigidBody<$dim>);

        #[pymethods]
        impl $class {
            /// Returns a rigid body that never moves. Bodies resting on it may sleep.
            #[staticmethod]
            #[pyo3(signature = (shape, *, position=None, rotation=None, friction=0.2, restitution=0.0, layers=None,
                is_sensor=false, user_data=0))]
            #[allow(clippy::too_many_arguments)] // keyword arguments of Python
            fn fixed(
                shape: $shape,
                position: Option<&Any<'_>>,
                rotation: Option<&Any<'_>>,
                friction: f32,
                restitution: f32,
                layers: Option<LayerMasks>,
                is_sensor: bool,
                user_data: u64,
            ) -> PyResult<Self> {
                let properties = Properties {
                    position, rotation, friction, restitution, layers, is_sensor, user_data,
                    ..Properties::default()
                };
                with_properties(RigidBody::fixed(shape.0), properties).map(Self)
            }

            /// Returns a rigid body that reaches its target pose at the end of each tick, through any obstacle.
            #[staticmethod]
            #[pyo3(signature = (shape, *, position=None, rotation=None, friction=0.2, restitution=0.0, layers=None,
                is_sensor=false, user_data=0))]
            #[allow(clippy::too_many_arguments)] // keyword arguments of Python
            fn kinematic(
                shape: $shape,
                position: Option<&Any<'_>>,
                rotation: Option<&Any<'_>>,
                friction: f32,
                restitution: f32,
                layers: Option<LayerMasks>,
                is_sensor: bool,
                user_data: u64,
            ) -> PyResult<Self> {
                let properties = Properties {
                    position, rotation, friction, restitution, layers, is_sensor, user_data,
                    ..Properties::default()
                };
                with_properties(RigidBody::kinematic(shape.0), properties).map(Self)
            }

            /// Returns a rigid body that a spring and a damper pull towards its target position, and that contacts stop.
            ///
            /// mass [kg], 1e-6 to 1e6; stiffness of the spring [N/m]; damping ratio, above 0 and up to 10; max_force of
            /// the coupling [N], infinite = no limit. Contacts do not rotate the body.
            #[staticmethod]
            #[pyo3(signature = (shape, *, mass=2.0, stiffness=3000.0, damping=0.9, max_force=1000.0, position=None,
                rotation=None, friction=0.2, restitution=0.0, layers=None, is_sensor=false, user_data=0))]
            #[allow(clippy::too_many_arguments)] // keyword arguments of Python
            fn coupled(
                shape: $shape,
                mass: f32,
                stiffness: f32,
                damping: f32,
                max_force: f32,
                position: Option<&Any<'_>>,
                rotation: Option<&Any<'_>>,
                friction: f32,
                restitution: f32,
                layers: Option<LayerMasks>,
                is_sensor: bool,
                user_data: u64,
            ) -> PyResult<Self> {
                let properties = Properties {
                    position, rotation, friction, restitution, layers, is_sensor, user_data,
                    ..Properties::default()
                };
                let motion_type = MotionType::Coupled { mass, stiffness, damping, max_force };
                with_properties(RigidBody::new(shape.0, motion_type), properties).map(Self)
            }

            /// Returns a rigid body that gravity and contacts move and rotate. The shape must be bounded. Its middle becomes
            /// the origin of the body, and is the default of position.
            ///
            /// mass [kg], 1e-6 to 1e6, with uniform density; velocity [m/s]; angular_velocity [rad/s], a number in 2D
            /// and a vector in 3D.
            #[staticmethod]
            #[pyo3(signature = (shape, mass, *, velocity=None, angular_velocity=None, position=None, rotation=None,
                friction=0.5, restitution=0.0, layers=None, is_sensor=false, user_data=0))]
            #[allow(clippy::too_many_arguments)] // keyword arguments of Python
            fn dynamic(
                shape: $shape,
                mass: f32,
                velocity: Option<&Any<'_>>,
                angular_velocity: Option<&Any<'_>>,
                position: Option<&Any<'_>>,
                rotation: Option<&Any<'_>>,
                friction: f32,
                restitution: f32,
                layers: Option<LayerMasks>,
                is_sensor: bool,
                user_data: u64,
            ) -> PyResult<Self> {
                let properties = Properties {
                    position, rotation, velocity, angular_velocity, friction, restitution, layers, is_sensor,
                    user_data,
                };
                with_properties(RigidBody::dynamic(shape.0, mass), properties).map(Self)
            }

            /// Motion type and its parameters, by name.
            #[getter]
            fn motion<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
                motion(py, self.0.motion_type)
            }

            /// Shape in local coordinates.
            #[getter]
            fn shape(&self) -> $shape {
                $shape(self.0.shape)
            }

            /// Position [m].
            #[getter]
            fn position<'py>(&self, py: Python<'py>) -> Any<'py> {
                vector_array(py, self.0.position).into_any()
            }

            /// Rotation: an angle [rad] in 2D, a quaternion x, y, z, w in 3D.
            #[getter]
            fn rotation<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
                rotation_object::<$dim>(py, self.0.rotation)
            }

            /// Velocity [m/s].
            #[getter]
            fn velocity<'py>(&self, py: Python<'py>) -> Any<'py> {
                vector_array(py, self.0.velocity.linear).into_any()
            }

            /// Angular velocity [rad/s]: a number in 2D, a vector in 3D.
            #[getter]
            fn angular_velocity<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
                angular_object::<$dim>(py, self.0.velocity.angular)
            }

            /// Coulomb friction coefficient.
            #[getter]
            fn friction(&self) -> f32 {
                self.0.friction
            }

            /// Coefficient of restitution.
            #[getter]
            fn restitution(&self) -> f32 {
                self.0.restitution
            }

            /// Bit masks of the layers: memberships and filters.
            #[getter]
            fn layers(&self) -> (u32, u32) {
                (self.0.layers.memberships, self.0.layers.filters)
            }

            /// Whether the body only reports what enters it.
            #[getter]
            fn is_sensor(&self) -> bool {
                self.0.is_sensor
            }

            /// Number of the program.
            #[getter]
            fn user_data(&self) -> u64 {
                self.0.user_data
            }

            fn __repr__(&self) -> String {
                let kind = motion_name(self.0.motion_type);
                format!("<{} {kind} at {:?}>", stringify!($class), self.0.position)
            }

            fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Any<'py>, (Bound<'py, PyBytes>,))> {
                let decode = py.get_type::<Self>().getattr("_decode")?;
                Ok((decode, (pickled(py, &self.0)?,)))
            }

            #[staticmethod]
            fn _decode(state: &[u8]) -> PyResult<Self> {
                unpickled(state).map(Self)
            }
        }
    };
}

rigid_body_class!(RigidBody2, Shape2, Dim2, "2");
rigid_body_class!(RigidBody3, Shape3, Dim3, "3");
