//! Networks of trained players, computed to the same bits on every computer.

use crate::error::invalid_parameter;
use numpy::ndarray::{Array2, ArrayView1, ArrayView2};
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

/// Weights (outputs, inputs) and bias (outputs,) of a layer.
type Layer<'py> = (PyReadonlyArray2<'py, f32>, PyReadonlyArray1<'py, f32>);

/// Returns the outputs (rows, outputs) of a network for inputs (rows, inputs). All layers except the last one end in tanh.
///
/// numpy would add products in an order that depends on the processor.
#[pyfunction(name = "_network")]
pub fn network<'py>(
    py: Python<'py>,
    inputs: PyReadonlyArray2<'py, f32>,
    layers: Vec<Layer<'py>>,
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let mut values = inputs.as_array().to_owned();
    for (index, (weights, bias)) in layers.iter().enumerate() {
        let (weights, bias) = (weights.as_array(), bias.as_array());
        let expected = [bias.len(), values.ncols()];
        if weights.shape() != expected {
            let field = format!("weights of layer {index}");
            let given = format!("shape {:?}", weights.shape());
            return Err(invalid_parameter(
                field,
                format!("an array of shape {expected:?}"),
                given,
            ));
        }
        values = layer(values.view(), weights, bias);
        if index + 1 < layers.len() {
            values.mapv_inplace(libm::tanhf);
        }
    }
    Ok(values.into_pyarray(py))
}

/// Returns bias + weights · values for each row of values. The sums have a fixed order.
fn layer(
    values: ArrayView2<'_, f32>,
    weights: ArrayView2<'_, f32>,
    bias: ArrayView1<'_, f32>,
) -> Array2<f32> {
    Array2::from_shape_fn((values.nrows(), bias.len()), |(row, output)| {
        let products = weights.row(output).into_iter().zip(values.row(row));
        products.fold(bias[output], |sum, (weight, value)| sum + weight * value)
    })
}
