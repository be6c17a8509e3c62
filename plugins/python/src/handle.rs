//! Handles of the objects in a world.

use crate::convert::{Any, pickled, repr, unpickled};
use crate::error::invalid_parameter;
use fuwafuwa::{BodyHandle, ObjectRef, ObjectSelector, PieceId};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

macro_rules! handle {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {$(
        $(#[$doc])*
        ///
        /// Handles of removed objects are stale: methods that get one raise `Error`. Handles can be compared, hashed,
        /// sorted and pickled, and are valid in copies and restored snapshots of their world.
        #[pyclass(frozen, eq, ord, hash, from_py_object, module = "fuwafuwa")]
        #[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub fuwafuwa::$name);

        #[pymethods]
        impl $name {
            fn __repr__(&self) -> String {
                let text = format!("{:?}", self.0);
                let numbers = text.split(|letter: char| !letter.is_ascii_digit());
                let numbers: Vec<&str> = numbers.filter(|digits| !digits.is_empty()).collect();
                match numbers[..] {
                    [slot, generation] => {
                        format!("{}(slot={slot}, generation={generation})", stringify!($name))
                    }
                    _ => text,
                }
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
    )*};
}

handle! {
    /// Handle of a soft body in a world.
    SoftBodyHandle,
    /// Handle of a rigid body in a world.
    RigidBodyHandle,
    /// Handle of a joint in a world.
    JointHandle,
    /// Handle of a knife in a world.
    KnifeHandle,
    /// Handle of a grip in a world.
    GripHandle,
}

/// Handle of a soft body or of a rigid body.
#[derive(FromPyObject)]
pub enum AnyBody {
    /// Handle of a soft body.
    Soft(SoftBodyHandle),
    /// Handle of a rigid body.
    Rigid(RigidBodyHandle),
}

impl From<AnyBody> for BodyHandle {
    fn from(body: AnyBody) -> Self {
        match body {
            AnyBody::Soft(body) => body.0.into(),
            AnyBody::Rigid(body) => body.0.into(),
        }
    }
}

/// Handle of any object.
#[derive(FromPyObject)]
pub enum AnyHandle {
    /// Handle of a soft body.
    Soft(SoftBodyHandle),
    /// Handle of a rigid body.
    Rigid(RigidBodyHandle),
    /// Handle of a joint.
    Joint(JointHandle),
    /// Handle of a knife.
    Knife(KnifeHandle),
    /// Handle of a grip.
    Grip(GripHandle),
}

/// Returns the object that a value of Python selects: a handle of a body, or a soft body with the number of a piece.
pub fn selector(field: &str, value: &Any<'_>) -> PyResult<ObjectSelector> {
    if let Ok(body) = value.extract::<AnyBody>() {
        return Ok(BodyHandle::from(body).into());
    }
    if let Ok((body, piece)) = value.extract::<(SoftBodyHandle, u32)>() {
        let (body, piece) = (body.0, PieceId(piece));
        return Ok(ObjectRef::Piece { body, piece }.into());
    }
    let expected =
        "a SoftBodyHandle, a RigidBodyHandle, or a tuple of SoftBodyHandle and piece number";
    Err(invalid_parameter(field, expected, repr(value)))
}

/// Returns a piece as a tuple of handle and number, and a rigid body as its handle.
pub fn object(py: Python<'_>, object: ObjectRef) -> PyResult<Any<'_>> {
    Ok(match object {
        ObjectRef::Piece { body, piece } => {
            let body = SoftBodyHandle(body).into_pyobject(py)?.into_any();
            let piece = piece.0.into_pyobject(py)?.into_any();
            PyTuple::new(py, [body, piece])?.into_any()
        }
        ObjectRef::RigidBody(body) => RigidBodyHandle(body).into_pyobject(py)?.into_any(),
    })
}
