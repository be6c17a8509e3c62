//! Shapes of rigid bodies, grips and regions.

use crate::convert::{
    Any, coordinates, pickled, rotation, rotation_object, unpickled, vector, vector_array,
    vector_or_zero,
};
use crate::error::OrInvalid;
use fuwafuwa::{Dim, Dim2, Dim3, Rotation, Shape};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

/// Describes a shape as a call of its constructor.
fn repr<D: Dim>(class: &str, shape: &Shape<D>) -> String {
    let call = match *shape {
        Shape::HalfSpace { normal, offset } => {
            let (normal, point) = (coordinates(normal), coordinates(normal * offset));
            format!("half_space({normal:?}, {point:?})")
        }
        Shape::Box { centre, half } => {
            format!("box({:?}, {:?})", coordinates(half), coordinates(centre))
        }
        Shape::OrientedBox {
            centre,
            half,
            rotation,
        } => {
            let rotation = match D::N {
                2 => format!("{:?}", rotation.scaled_axis().z),
                _ => format!("{:?}", rotation.quaternion()),
            };
            let (half, centre) = (coordinates(half), coordinates(centre));
            format!("box({half:?}, {centre:?}, {rotation})")
        }
        Shape::Capsule { from, to, radius } => {
            let (from, to) = (coordinates(from), coordinates(to));
            format!("capsule({from:?}, {to:?}, {radius:?})")
        }
        Shape::Ball { centre, radius } => format!("ball({radius:?}, {:?})", coordinates(centre)),
    };
    format!("{class}.{call}")
}

/// Returns the kind of a shape and its parameters.
fn parameters<'py, D: Dim>(py: Python<'py>, shape: &Shape<D>) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    match *shape {
        Shape::HalfSpace { normal, offset } => {
            dict.set_item("kind", "half_space")?;
            dict.set_item("normal", vector_array(py, normal))?;
            dict.set_item("offset", offset)?;
        }
        Shape::Box { centre, half } => {
            dict.set_item("kind", "box")?;
            dict.set_item("centre", vector_array(py, centre))?;
            dict.set_item("half", vector_array(py, half))?;
            dict.set_item("rotation", rotation_object::<D>(py, Rotation::NONE)?)?;
        }
        Shape::OrientedBox {
            centre,
            half,
            rotation,
        } => {
            dict.set_item("kind", "box")?;
            dict.set_item("centre", vector_array(py, centre))?;
            dict.set_item("half", vector_array(py, half))?;
            dict.set_item("rotation", rotation_object::<D>(py, rotation)?)?;
        }
        Shape::Capsule { from, to, radius } => {
            dict.set_item("kind", "capsule")?;
            dict.set_item("from", vector_array(py, from))?;
            dict.set_item("to", vector_array(py, to))?;
            dict.set_item("radius", radius)?;
        }
        Shape::Ball { centre, radius } => {
            dict.set_item("kind", "ball")?;
            dict.set_item("centre", vector_array(py, centre))?;
            dict.set_item("radius", radius)?;
        }
    }
    Ok(dict)
}

macro_rules! shape_class {
    ($class:ident, $dim:ty, $dims:literal) => {
        #[doc = concat!("Shape in ", $dims, "D: a ball, box, capsule or half-space. Lengths are in metres.")]
        ///
        /// Vectors are sequences or arrays. Rotations are angles [rad] in 2D. In 3D they are quaternions x, y, z, w, or
        /// rotation vectors: an axis whose length is the angle [rad].
        #[pyclass(frozen, eq, from_py_object, module = "fuwafuwa")]
        #[derive(Copy, Clone, Debug, PartialEq)]
        pub struct $class(pub Shape<$dim>);

        impl $class {
            fn checked(shape: Shape<$dim>) -> PyResult<Self> {
                shape.check().or_invalid()?;
                Ok(Self(shape))
            }
        }

        #[pymethods]
        impl $class {
            /// Returns a ball (in 2D a disc) with a radius [m] and a centre [m], by default the origin.
            #[staticmethod]
            #[pyo3(signature = (radius, centre=None))]
            fn ball(radius: f32, centre: Option<&Any<'_>>) -> PyResult<Self> {
                let centre = vector_or_zero::<$dim>("centre", centre)?;
                Self::checked(Shape::Ball { centre, radius })
            }

            /// Returns a box from half of its extents [m], its centre [m], by default the origin, and its rotation.
            #[staticmethod]
            #[pyo3(name = "box", signature = (half, centre=None, rotation=None))]
            fn cuboid(
                half: &Any<'_>,
                centre: Option<&Any<'_>>,
                rotation: Option<&Any<'_>>,
            ) -> PyResult<Self> {
                let half = vector::<$dim>("half", half)?;
                let centre = vector_or_zero::<$dim>("centre", centre)?;
                match rotation {
                    None => Self::checked(Shape::Box { centre, half }),
                    Some(turned) => {
                        let rotation = self::rotation::<$dim>(Some(turned))?;
                        Self::checked(Shape::OrientedBox { centre, half, rotation })
                    }
                }
            }

            /// Returns a capsule: all points within `radius` [m] of the segment between two points [m].
            #[staticmethod]
            fn capsule(start: &Any<'_>, end: &Any<'_>, radius: f32) -> PyResult<Self> {
                let (from, to) = (vector::<$dim>("start", start)?, vector::<$dim>("end", end)?);
                Self::checked(Shape::capsule(from, to, radius))
            }

            /// Returns the half-space on the far side of a plane through `point` [m], by default the origin. The normal points
            /// out of the solid side; its length has no effect. A floor is `half_space((0, 1))` in 2D.
            #[staticmethod]
            #[pyo3(signature = (normal, point=None))]
            fn half_space(normal: &Any<'_>, point: Option<&Any<'_>>) -> PyResult<Self> {
                let normal = vector::<$dim>("normal", normal)?;
                let point = vector_or_zero::<$dim>("point", point)?;
                Self::checked(Shape::half_space(normal, point))
            }

            /// Returns the shape translated by a vector [m].
            fn translated(&self, by: &Any<'_>) -> PyResult<Self> {
                Self::checked(self.0.translated(vector::<$dim>("by", by)?))
            }

            /// Returns the shape rotated about the origin.
            fn rotated(&self, by: &Any<'_>) -> PyResult<Self> {
                Self::checked(self.0.rotated(rotation::<$dim>(Some(by))?))
            }

            /// Returns the signed distance of a point [m], negative inside, and the outward normal there.
            fn distance<'py>(&self, py: Python<'py>, point: &Any<'_>) -> PyResult<(f32, Any<'py>)> {
                let (distance, normal) = self.0.distance(vector::<$dim>("point", point)?);
                Ok((distance, vector_array(py, normal).into_any()))
            }

            /// Low and high corner of the bounding box [m]; infinite for half-spaces.
            #[getter]
            fn bounds<'py>(&self, py: Python<'py>) -> (Any<'py>, Any<'py>) {
                let [low, high] = self.0.bounds();
                (vector_array(py, low).into_any(), vector_array(py, high).into_any())
            }

            /// Kind of the shape and its parameters, by name.
            #[getter]
            fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
                parameters(py, &self.0)
            }

            fn __repr__(&self) -> String {
                repr(stringify!($class), &self.0)
            }

            fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Any<'py>, (Bound<'py, PyBytes>,))> {
                let decode = py.get_type::<Self>().getattr("_decode")?;
                Ok((decode, (pickled(py, &self.0)?,)))
            }

            #[staticmethod]
            fn _decode(state: &[u8]) -> PyResult<Self> {
                Self::checked(unpickled(state)?)
            }
        }
    };
}

shape_class!(Shape2, Dim2, "2");
shape_class!(Shape3, Dim3, "3");
