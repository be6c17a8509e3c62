//! Definitions of joints.

use crate::convert::{Any, pickled, unpickled, vector, vector_array};
use crate::error::invalid_parameter;
use crate::handle::{AnyBody, RigidBodyHandle, SoftBodyHandle};
use fuwafuwa::{Dim, Dim2, Dim3, Joint, JointAnchor, JointKind};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

/// Returns an anchor: a point of the world, or a body with a point and, for a soft body, a radius.
fn anchor<D: Dim>(field: &str, value: &Any<'_>) -> PyResult<JointAnchor<D>> {
    if let Ok((body, point, radius)) = value.extract::<(AnyBody, Any<'_>, f32)>() {
        let point = vector::<D>(field, &point)?;
        return Ok(match body {
            AnyBody::Soft(body) => JointAnchor::SoftBody {
                body: body.0,
                point,
                radius,
            },
            AnyBody::Rigid(_) => {
                let expected = "a pair of RigidBodyHandle and point: a rigid body has no radius";
                return Err(invalid_parameter(field, expected, "a radius"));
            }
        });
    }
    if let Ok((body, point)) = value.extract::<(AnyBody, Any<'_>)>() {
        let point = vector::<D>(field, &point)?;
        return Ok(match body {
            AnyBody::Soft(body) => JointAnchor::on(body.0, point),
            AnyBody::Rigid(body) => JointAnchor::on(body.0, point),
        });
    }
    Ok(JointAnchor::Point(vector::<D>(field, value)?))
}

/// Name of a kind of joint.
pub fn kind_name(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Pin => "pin",
        JointKind::Spring { .. } => "spring",
        JointKind::Rope { .. } => "rope",
    }
}

/// Returns the kind of a joint and its parameters.
fn parameters(py: Python<'_>, kind: JointKind) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("kind", kind_name(kind))?;
    match kind {
        JointKind::Pin => {}
        JointKind::Spring {
            stiffness,
            damping,
            length,
        } => {
            dict.set_item("stiffness", stiffness)?;
            dict.set_item("damping", damping)?;
            dict.set_item("length", length)?;
        }
        JointKind::Rope { length } => dict.set_item("length", length)?,
    }
    Ok(dict)
}

/// Returns an anchor in the form of the arguments of the constructors.
fn anchor_object<D: Dim>(py: Python<'_>, anchor: JointAnchor<D>) -> PyResult<Any<'_>> {
    Ok(match anchor {
        JointAnchor::Point(point) => vector_array(py, point).into_any(),
        JointAnchor::RigidBody { body, point } => (RigidBodyHandle(body), vector_array(py, point))
            .into_pyobject(py)?
            .into_any(),
        JointAnchor::SoftBody {
            body,
            point,
            radius,
        } => (SoftBodyHandle(body), vector_array(py, point), radius)
            .into_pyobject(py)?
            .into_any(),
    })
}

macro_rules! joint_class {
    ($class:ident, $dim:ty, $dims:literal) => {
        #[doc = concat!("Definition of a joint in ", $dims, "D, for `World", $dims, ".add_joint`.")]
        ///
        /// An anchor is a point of the world [m], a pair (handle of a body, point), or (handle of a soft body, point,
        /// radius [m]), which spreads the force over the nodes within the radius. Points are in world coordinates at
        /// the time at which the joint is added. `breaking_force` [N]: the joint breaks above it; infinite (default) =
        /// never.
        #[pyclass(frozen, eq, from_py_object, module = "fuwafuwa")]
        #[derive(Copy, Clone, Debug, PartialEq)]
        pub struct $class(pub Joint<$dim>);

        #[pymethods]
        impl $class {
            /// Returns a joint that holds both anchors together.
            #[staticmethod]
            #[pyo3(signature = (first, second, *, breaking_force=f32::INFINITY),
                text_signature = "(first, second, *, breaking_force=1e999)")]
            fn pin(first: &Any<'_>, second: &Any<'_>, breaking_force: f32) -> PyResult<Self> {
                let (first, second) = (anchor("first", first)?, anchor("second", second)?);
                Ok(Self(Joint::pin(first, second).with_breaking_force(breaking_force)))
            }

            /// Returns a joint that keeps both anchors within `length` [m] of each other.
            #[staticmethod]
            #[pyo3(signature = (first, second, length, *, breaking_force=f32::INFINITY),
                text_signature = "(first, second, length, *, breaking_force=1e999)")]
            fn rope(
                first: &Any<'_>,
                second: &Any<'_>,
                length: f32,
                breaking_force: f32,
            ) -> PyResult<Self> {
                let (first, second) = (anchor("first", first)?, anchor("second", second)?);
                Ok(Self(Joint::rope(first, second, length).with_breaking_force(breaking_force)))
            }

            /// Returns a spring with a stiffness [N/m], a damping [N s/m] and a rest length [m].
            #[staticmethod]
            #[pyo3(signature = (first, second, stiffness, damping, length, *, breaking_force=f32::INFINITY),
                text_signature = "(first, second, stiffness, damping, length, *, breaking_force=1e999)")]
            fn spring(
                first: &Any<'_>,
                second: &Any<'_>,
                stiffness: f32,
                damping: f32,
                length: f32,
                breaking_force: f32,
            ) -> PyResult<Self> {
                let anchors = [anchor("first", first)?, anchor("second", second)?];
                let joint = Joint::spring(anchors, stiffness, damping, length);
                Ok(Self(joint.with_breaking_force(breaking_force)))
            }

            /// Kind of the joint: "pin", "rope" or "spring".
            #[getter]
            fn kind(&self) -> &'static str {
                kind_name(self.0.kind)
            }

            /// Kind of the joint and its parameters, by name: length [m] of a rope; stiffness [N/m], damping [N s/m] and rest
            /// length [m] of a spring.
            #[getter]
            fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
                parameters(py, self.0.kind)
            }

            /// First and second anchor, in the form of the arguments of the constructors.
            #[getter]
            fn anchors<'py>(&self, py: Python<'py>) -> PyResult<(Any<'py>, Any<'py>)> {
                let [first, second] = self.0.anchors;
                Ok((anchor_object(py, first)?, anchor_object(py, second)?))
            }

            /// Force above which the joint breaks [N].
            #[getter]
            fn breaking_force(&self) -> f32 {
                self.0.breaking_force
            }

            fn __repr__(&self) -> String {
                format!("<{} {}>", stringify!($class), self.kind())
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

joint_class!(Joint2, Dim2, "2");
joint_class!(Joint3, Dim3, "3");
