//! Conversion of vectors, rotations and arrays between Python and the engine.

use crate::error::{invalid, invalid_parameter};
use fuwafuwa::{Dim, DimAngular, DimVector, Rotation, Vec3, Velocity};
use numpy::ndarray::Array2;
use numpy::{Element, IntoPyArray, PyArray1, PyArray2, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyString};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Value from Python, of any type.
pub type Any<'py> = Bound<'py, PyAny>;

/// Returns the numbers of a sequence or array. `expected` describes them for the error text.
fn numbers(field: &str, expected: &str, value: &Any<'_>) -> PyResult<Vec<f32>> {
    value
        .extract()
        .map_err(|_: PyErr| invalid_parameter(field, expected, repr(value)))
}

/// Returns the text of a value for an error: its `repr`, shortened.
pub fn repr(value: &Any<'_>) -> String {
    const LONGEST: usize = 200;
    let Ok(text) = value.repr() else {
        return "?".into();
    };
    let text = text.to_string();
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// Returns a vector with as many finite numbers as the world has dimensions.
pub fn vector<D: Dim>(field: &str, value: &Any<'_>) -> PyResult<D::Vector> {
    let expected = match D::N {
        2 => "2 finite numbers",
        _ => "3 finite numbers",
    };
    let numbers = numbers(field, expected, value)?;
    if numbers.len() != D::N || numbers.iter().any(|number| !number.is_finite()) {
        return Err(invalid_parameter(field, expected, format!("{numbers:?}")));
    }
    let mut vector = Vec3::ZERO;
    for (axis, number) in numbers.into_iter().enumerate() {
        vector[axis] = number;
    }
    Ok(D::Vector::from_vec3(vector))
}

/// Returns two vectors from a pair. `expected` describes the pair for the error text.
pub fn vector_pair<D: Dim>(
    field: &str,
    expected: &str,
    value: &Any<'_>,
) -> PyResult<[D::Vector; 2]> {
    let pair: PyResult<(Any<'_>, Any<'_>)> = value.extract();
    let (first, second) = pair.map_err(|_| invalid_parameter(field, expected, repr(value)))?;
    Ok([vector::<D>(field, &first)?, vector::<D>(field, &second)?])
}

/// Returns a vector, or 0 if the argument is missing.
pub fn vector_or_zero<D: Dim>(field: &str, value: Option<&Any<'_>>) -> PyResult<D::Vector> {
    value.map_or(Ok(D::Vector::ZERO), |value| vector::<D>(field, value))
}

/// Returns an angular velocity: a number in 2D, a vector in 3D; 0 if the argument is missing.
pub fn angular<D: Dim>(field: &str, value: Option<&Any<'_>>) -> PyResult<D::Angular> {
    let Some(value) = value else {
        return Ok(D::Angular::default());
    };
    let (count, expected) = match D::N {
        2 => (1, "a finite number"),
        _ => (3, "3 finite numbers"),
    };
    let numbers = match D::N {
        2 => value
            .extract()
            .map(|number: f32| vec![number])
            .or_else(|_| numbers(field, expected, value))?,
        _ => numbers(field, expected, value)?,
    };
    if numbers.len() != count || numbers.iter().any(|number| !number.is_finite()) {
        return Err(invalid_parameter(field, expected, format!("{numbers:?}")));
    }
    Ok(D::Angular::from_vec3(match numbers[..] {
        [about] => Vec3::new(0.0, 0.0, about),
        _ => Vec3::new(numbers[0], numbers[1], numbers[2]),
    }))
}

/// Returns a velocity from its linear and its angular part.
pub fn velocity<D: Dim>(
    linear: Option<&Any<'_>>,
    angular_velocity: Option<&Any<'_>>,
) -> PyResult<Velocity<D>> {
    Ok(Velocity {
        linear: vector_or_zero::<D>("velocity", linear)?,
        angular: angular::<D>("angular_velocity", angular_velocity)?,
    })
}

/// Returns a rotation: in 2D from an angle [rad], in 3D from a quaternion x, y, z, w or from a rotation vector.
pub fn rotation<D: Dim>(value: Option<&Any<'_>>) -> PyResult<Rotation> {
    const FIELD: &str = "rotation";
    let Some(value) = value else {
        return Ok(Rotation::NONE);
    };
    let wrong = |expected: &str| invalid_parameter(FIELD, expected, repr(value));
    if D::N == 2 {
        let expected = "a finite angle in radians";
        let angle: f32 = value.extract().map_err(|_: PyErr| wrong(expected))?;
        return match angle.is_finite() {
            true => Ok(Rotation::in_plane(angle)),
            false => Err(wrong(expected)),
        };
    }
    let expected = "a quaternion of 4 finite numbers x, y, z, w, not all 0, or a rotation vector of 3 finite numbers";
    let numbers = numbers(FIELD, expected, value)?;
    let is_finite = numbers.iter().all(|number| number.is_finite());
    let is_zero = numbers.iter().all(|&number| number == 0.0);
    match numbers[..] {
        [x, y, z, w] if is_finite && !is_zero => Ok(Rotation::from_quaternion([x, y, z, w])),
        [_, _, _] if is_zero => Ok(Rotation::NONE),
        [x, y, z] if is_finite => {
            let vector = Vec3::new(x, y, z);
            Ok(Rotation::about(vector, vector.length()))
        }
        _ => Err(wrong(expected)),
    }
}

/// Returns the numbers of a vector.
pub fn coordinates<V: DimVector>(vector: V) -> Vec<f32> {
    (0..V::N).map(|axis| vector[axis]).collect()
}

/// Returns a vector as an array.
pub fn vector_array<V: DimVector>(py: Python<'_>, vector: V) -> Bound<'_, PyArray1<f32>> {
    let three = vector.to_vec3().to_array();
    PyArray1::from_slice(py, &three[..V::N])
}

/// Returns an angular velocity or a torque: a number in 2D, an array in 3D.
pub fn angular_object<D: Dim>(py: Python<'_>, angular: D::Angular) -> PyResult<Any<'_>> {
    let three = angular.to_vec3();
    Ok(match D::N {
        2 => three.z.into_pyobject(py)?.into_any(),
        _ => vector_array(py, three).into_any(),
    })
}

/// Returns a rotation: an angle in 2D, a quaternion x, y, z, w in 3D.
pub fn rotation_object<D: Dim>(py: Python<'_>, rotation: Rotation) -> PyResult<Any<'_>> {
    Ok(match D::N {
        2 => rotation.scaled_axis().z.into_pyobject(py)?.into_any(),
        _ => PyArray1::from_slice(py, &rotation.quaternion()).into_any(),
    })
}

/// Returns an array with `columns` columns.
pub fn rows<T: Element>(py: Python<'_>, columns: usize, values: Vec<T>) -> Bound<'_, PyArray2<T>> {
    let count = values.len() / columns;
    let array = Array2::from_shape_vec((count, columns), values);
    array.expect("the values fill the rows").into_pyarray(py)
}

/// Returns an array of vectors, one in each row.
pub fn vector_rows<V: DimVector>(
    py: Python<'_>,
    vectors: impl Iterator<Item = V>,
) -> Bound<'_, PyArray2<f32>> {
    let mut values = Vec::with_capacity(vectors.size_hint().0 * V::N);
    vectors.for_each(|vector| values.extend_from_slice(&vector.to_vec3().to_array()[..V::N]));
    rows(py, V::N, values)
}

/// Returns an array of torques: (n,) in 2D, (n, 3) in 3D.
pub fn angular_rows<D: Dim>(py: Python<'_>, values: impl Iterator<Item = D::Angular>) -> Any<'_> {
    let vectors = values.map(DimAngular::to_vec3);
    match D::N {
        2 => PyArray1::from_vec(py, vectors.map(|vector| vector.z).collect()).into_any(),
        _ => vector_rows(py, vectors).into_any(),
    }
}

/// Describes an array for an error text.
pub fn described(value: &Any<'_>) -> String {
    match value.cast::<PyUntypedArray>() {
        Ok(array) => {
            let text = format!("{} of shape {:?}", array.dtype(), array.shape());
            match array.is_aligned() {
                true => text,
                false => text + ", misaligned in memory",
            }
        }
        Err(_) => value
            .get_type()
            .name()
            .map_or_else(|_| "?".into(), |name| name.to_string()),
    }
}

/// Encodes a value for pickle.
pub fn pickled<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyBytes>> {
    let bytes = postcard::to_stdvec(value).map_err(invalid)?;
    Ok(PyBytes::new(py, &bytes))
}

/// Decodes a value from pickle.
pub fn unpickled<T: DeserializeOwned>(bytes: &[u8]) -> PyResult<T> {
    postcard::from_bytes(bytes).map_err(|error| invalid(format!("damaged pickle: {error}")))
}

/// Returns one of the values of a table by its name.
pub fn named<T: Copy>(field: &str, name: &str, table: &[(&str, T)]) -> PyResult<T> {
    let found = table.iter().find(|(known, _)| *known == name);
    found.map(|&(_, value)| value).ok_or_else(|| {
        let names: Vec<String> = table.iter().map(|(name, _)| format!("{name:?}")).collect();
        invalid_parameter(
            field,
            format!("one of {}", names.join(", ")),
            format!("{name:?}"),
        )
    })
}

/// Returns the name of one of the values of a table.
pub fn name_of<T: Copy + PartialEq>(value: T, table: &[(&'static str, T)]) -> &'static str {
    let found = table.iter().find(|&&(_, known)| known == value);
    found.map_or("unknown", |(name, _)| name)
}

/// Returns the text of a Python string, or `None` for other values.
pub fn text(value: &Any<'_>) -> Option<String> {
    value.cast::<PyString>().ok().map(|text| text.to_string())
}
