//! Arrays of the nodes, elements and pieces of a soft body.
//!
//! Node `i` of an array is the node with the `i`-th smallest id, likewise for elements. Arrays of one body at one
//! moment belong together; when the body tears, nodes and elements come and go.

use crate::convert::{Any, described, rows, vector_array, vector_rows};
use crate::error::{OrInvalid, invalid_parameter};
use fuwafuwa::inspect::Element;
use fuwafuwa::{Dim, DimVector, ElementId, ElementState, NodeId, Shape, SoftBody, Vec3};
use numpy::ndarray::Array3;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray2, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Ids of all nodes, ascending.
pub fn node_ids<D: Dim>(body: &SoftBody<D>) -> impl Iterator<Item = NodeId> + '_ {
    body.mesh().nodes().map(|(id, _)| id)
}

/// Row of each node id; -1 for ids without a node.
fn node_rows<D: Dim>(body: &SoftBody<D>) -> Vec<i32> {
    let mut rows = vec![-1; body.mesh().node_capacity()];
    for (row, id) in (0..).zip(node_ids(body)) {
        rows[id.index()] = row;
    }
    rows
}

/// Returns an array with a value for each node.
pub fn of_nodes<'py, D: Dim, T: numpy::Element>(
    py: Python<'py>,
    body: &SoftBody<D>,
    value: impl FnMut(NodeId) -> T,
) -> Any<'py> {
    PyArray1::from_vec(py, node_ids(body).map(value).collect()).into_any()
}

/// Returns an array with a vector for each node.
pub fn vectors_of_nodes<'py, D: Dim>(
    py: Python<'py>,
    body: &SoftBody<D>,
    vector: impl FnMut(NodeId) -> D::Vector,
) -> Any<'py> {
    vector_rows(py, node_ids(body).map(vector)).into_any()
}

/// Returns an array with the position of each node in the undeformed body [m].
pub fn rest_positions<'py, D: Dim>(py: Python<'py>, body: &SoftBody<D>) -> Any<'py> {
    let voxel_size = body.grid().voxel_size();
    vectors_of_nodes(py, body, |id| {
        let at = body.mesh().node(id).at.map(|coordinate| coordinate as f32);
        D::Vector::from_vec3(Vec3::from_array(at) * voxel_size)
    })
}

/// Returns an array with a value for each element.
pub fn of_elements<'py, D: Dim, T: numpy::Element>(
    py: Python<'py>,
    body: &SoftBody<D>,
    mut value: impl FnMut(ElementId, &Element) -> T,
) -> Any<'py> {
    let elements = body.mesh().elements();
    let values = elements.map(|(id, element)| value(id, element)).collect();
    PyArray1::from_vec(py, values).into_any()
}

/// Returns an array with the node of each slot of each element, by row; -1 for slots without a node.
pub fn elements<'py, D: Dim>(py: Python<'py>, body: &SoftBody<D>) -> Any<'py> {
    let (mesh, known) = (body.mesh(), node_rows(body));
    let mut values = vec![-1; mesh.element_count() * D::SLOTS];
    let places = values.chunks_exact_mut(D::SLOTS);
    for (place, (_, element)) in places.zip(mesh.elements()) {
        let slots = &mesh.element_class(element).slots;
        for (&slot, node) in slots.iter().zip(&element.nodes) {
            place[usize::from(slot)] = known[node.index()];
        }
    }
    rows(py, D::SLOTS, values).into_any()
}

/// Returns an array with a matrix for each element.
pub fn matrices<'py, D: Dim>(
    py: Python<'py>,
    body: &SoftBody<D>,
    matrix: impl Fn(&ElementState) -> [[f64; 3]; 3],
) -> Any<'py> {
    let mut values: Vec<f64> = Vec::with_capacity(body.mesh().element_count() * D::N * D::N);
    for (id, _) in body.mesh().elements() {
        let state = body.element_state(id).expect("the element is in the mesh");
        let matrix = matrix(&state);
        values.extend(matrix[..D::N].iter().flat_map(|row| &row[..D::N]));
    }
    let shape = (body.mesh().element_count(), D::N, D::N);
    let array = Array3::from_shape_vec(shape, values);
    array
        .expect("the values fill the matrices")
        .into_pyarray(py)
        .into_any()
}

/// Returns the corners of the blocks that the elements fill [m], and the element of each block, by row.
pub fn cells<'py, D: Dim>(py: Python<'py>, body: &SoftBody<D>) -> (Any<'py>, Any<'py>) {
    let (mut corners, mut owners) = (Vec::new(), Vec::new());
    for (row, view) in (0i32..).zip(body.element_views()) {
        let children = match view.level {
            0 => 1,
            _ => view.children,
        };
        for child in (0..D::CORNERS).filter(|child| children >> child & 1 == 1) {
            for corner in view.child_corners::<D>(child) {
                corners.extend_from_slice(&corner.to_array()[..D::N]);
            }
            owners.push(row);
        }
    }
    let shape = (owners.len(), D::CORNERS, D::N);
    let corners = Array3::from_shape_vec(shape, corners).expect("each block has all corners");
    (
        corners.into_pyarray(py).into_any(),
        PyArray1::from_vec(py, owners).into_any(),
    )
}

/// Arrays of the exposed faces: their nodes and elements, by row, and whether they were torn.
pub type FacetArrays<'py> = (Any<'py>, Any<'py>, Any<'py>);

/// Returns the exposed faces.
pub fn facets<'py, D: Dim>(py: Python<'py>, body: &SoftBody<D>) -> FacetArrays<'py> {
    let (known, count) = (node_rows(body), D::CORNERS / 2);
    let mut element_rows = vec![-1; body.mesh().element_capacity()];
    for (row, (id, _)) in (0i32..).zip(body.mesh().elements()) {
        element_rows[id.index()] = row;
    }
    let (mut nodes, mut owners, mut torn) = (Vec::new(), Vec::new(), Vec::new());
    for facet in body.facets() {
        nodes.extend(facet.nodes[..count].iter().map(|node| known[node.index()]));
        owners.push(element_rows[facet.element.index()]);
        torn.push(facet.is_torn);
    }
    let nodes = rows(py, count, nodes).into_any();
    let owners = PyArray1::from_vec(py, owners).into_any();
    (nodes, owners, PyArray1::from_vec(py, torn).into_any())
}

/// Returns the properties of all pieces, as arrays by piece number.
pub fn pieces<'py, D: Dim>(py: Python<'py>, body: &SoftBody<D>) -> PyResult<Bound<'py, PyDict>> {
    let views = body.piece_views();
    let dict = PyDict::new(py);
    let vectors = |vector: fn(&fuwafuwa::PieceView) -> Vec3| {
        vector_rows(
            py,
            views.iter().map(|view| D::Vector::from_vec3(vector(view))),
        )
    };
    let flags = |flag: fn(&fuwafuwa::PieceView) -> bool| {
        PyArray1::from_vec(py, views.iter().map(flag).collect())
    };
    let mass = views.iter().map(|view| view.mass).collect();
    let elements = views.iter().map(|view| view.element_count).collect();
    dict.set_item("mass", PyArray1::from_vec(py, mass))?;
    dict.set_item("centre", vectors(|view| view.centre))?;
    dict.set_item("velocity", vectors(|view| view.velocity))?;
    dict.set_item("low", vectors(|view| view.low))?;
    dict.set_item("high", vectors(|view| view.high))?;
    dict.set_item("element_count", PyArray1::from_vec(py, elements))?;
    dict.set_item("asleep", flags(|view| view.asleep))?;
    dict.set_item("quarantined", flags(|view| view.quarantined))?;
    dict.set_item("removed", flags(|view| view.removed))?;
    Ok(dict)
}

/// Returns the kinetic, elastic and gravitational energy of each piece [J].
pub fn energies<'py, D: Dim>(py: Python<'py>, body: &SoftBody<D>, gravity: D::Vector) -> Any<'py> {
    let energies = body.energies(gravity);
    let values = energies
        .iter()
        .flat_map(|one| [one.kinetic, one.elastic, one.gravitational]);
    rows(py, 3, values.collect()).into_any()
}

/// Returns the closed lines around all pieces and their holes: a dict of arrays for each.
pub fn outlines<'py, D: Dim>(py: Python<'py>, body: &SoftBody<D>) -> PyResult<Bound<'py, PyList>> {
    let (list, known) = (PyList::empty(py), node_rows(body));
    for outline in body.outlines() {
        let dict = PyDict::new(py);
        let nodes = outline
            .nodes
            .iter()
            .map(|node| known[node.index()])
            .collect();
        let points = outline
            .points
            .iter()
            .map(|&point| D::Vector::from_vec3(point));
        dict.set_item("piece", outline.piece.0)?;
        dict.set_item("nodes", PyArray1::from_vec(py, nodes))?;
        dict.set_item("points", vector_rows(py, points))?;
        dict.set_item("torn", PyArray1::from_vec(py, outline.is_torn))?;
        list.append(dict)?;
    }
    Ok(list)
}

/// Returns the ids of nodes that are given as a mask or as rows.
pub fn chosen_nodes<D: Dim>(body: &SoftBody<D>, nodes: &Any<'_>) -> PyResult<Vec<NodeId>> {
    let ids: Vec<NodeId> = node_ids(body).collect();
    let count = ids.len();
    let expected = || format!("a bool array of {count} nodes, or rows below {count}");
    // A list of bools is a mask, too: Python takes True and False for the integers 1 and 0. An empty list has no rows.
    let mask: PyResult<Vec<bool>> = nodes.extract();
    if let Some(mask) = mask.ok().filter(|mask| !mask.is_empty()) {
        if mask.len() != count {
            return Err(invalid_parameter("nodes", expected(), described(nodes)));
        }
        let chosen = ids
            .into_iter()
            .zip(mask)
            .filter(|&(_, is_chosen)| is_chosen);
        return Ok(chosen.map(|(id, _)| id).collect());
    }
    let rows: Vec<i64> = nodes
        .extract()
        .map_err(|_: PyErr| invalid_parameter("nodes", expected(), described(nodes)))?;
    let id = |row: i64| {
        let id = usize::try_from(row).ok().and_then(|row| ids.get(row));
        id.copied()
            .ok_or_else(|| invalid_parameter("nodes", expected(), row.to_string()))
    };
    rows.into_iter().map(id).collect()
}

/// Returns the vectors of an array, one for each of `count` nodes, with coordinates from `-most` to `most`.
fn vectors<D: Dim>(
    field: &str,
    value: &Any<'_>,
    count: usize,
    most: f32,
) -> PyResult<Vec<D::Vector>> {
    let wrong = || {
        let expected = format!(
            "an array of float32 or float64 of shape [{count}, {}]",
            D::N
        );
        invalid_parameter(field, expected, described(value))
    };
    let array = value.cast::<PyUntypedArray>();
    if !array.is_ok_and(|array| array.is_aligned() && array.shape() == [count, D::N]) {
        return Err(wrong());
    }
    let numbers: Vec<f32> = if let Ok(array) = value.extract::<PyReadonlyArray2<'_, f32>>() {
        array.as_array().iter().copied().collect()
    } else if let Ok(array) = value.extract::<PyReadonlyArray2<'_, f64>>() {
        let numbers = array.as_array();
        numbers.iter().map(|&number| number as f32).collect()
    } else {
        return Err(wrong());
    };
    let is_wrong = |number: &f32| number.is_nan() || number.abs() > most;
    if let Some(place) = numbers.iter().position(is_wrong) {
        let expected = match most < f32::MAX {
            true => format!("within {most} m of the origin on each axis"),
            false => "finite".to_owned(),
        };
        let given = format!("{:?} at node {}", numbers[place], place / D::N);
        return Err(invalid_parameter(field, expected, given));
    }
    Ok(numbers.chunks_exact(D::N).map(vector_of::<D>).collect())
}

fn vector_of<D: Dim>(numbers: &[f32]) -> D::Vector {
    let mut vector = Vec3::ZERO;
    for (axis, &number) in numbers.iter().enumerate() {
        vector[axis] = number;
    }
    D::Vector::from_vec3(vector)
}

/// New positions and velocities of all nodes.
pub type NodeStates<D> = Vec<(NodeId, <D as Dim>::Vector, <D as Dim>::Vector)>;

/// Returns the states of all nodes from arrays; missing arrays keep the present values.
pub fn node_states<D: Dim>(
    body: &SoftBody<D>,
    positions: Option<&Any<'_>>,
    velocities: Option<&Any<'_>>,
) -> PyResult<NodeStates<D>> {
    let present = node_ids(body).map(|id| {
        let (position, velocity, _) = body.node_state(id);
        (id, position, velocity)
    });
    let mut states: NodeStates<D> = present.collect();
    if let Some(positions) = positions {
        let given = vectors::<D>("positions", positions, states.len(), body.range())?;
        states
            .iter_mut()
            .zip(given)
            .for_each(|(state, position)| state.1 = position);
    }
    if let Some(velocities) = velocities {
        let given = vectors::<D>("velocities", velocities, states.len(), f32::MAX)?;
        states
            .iter_mut()
            .zip(given)
            .for_each(|(state, velocity)| state.2 = velocity);
    }
    Ok(states)
}

/// Sets the positions and velocities of nodes.
pub fn set_node_states<D: Dim>(body: &mut SoftBody<D>, states: NodeStates<D>) -> PyResult<()> {
    let set = |(id, position, velocity)| body.set_node_state(id, position, velocity);
    states.into_iter().try_for_each(set).or_invalid()
}

/// Returns the sums over the part of a body inside a shape.
pub fn sums<'py, D: Dim>(
    py: Python<'py>,
    body: &SoftBody<D>,
    region: &Shape<D>,
) -> PyResult<Bound<'py, PyDict>> {
    let sums = body.sums_inside(region).or_invalid()?;
    let dict = PyDict::new(py);
    dict.set_item("nodes", sums.nodes)?;
    dict.set_item("mass", sums.mass)?;
    dict.set_item("centre", vector_array(py, sums.centre))?;
    dict.set_item("momentum", vector_array(py, sums.momentum))?;
    dict.set_item("elastic_force", vector_array(py, sums.elastic_force))?;
    dict.set_item("elastic_energy", sums.elastic_energy)?;
    Ok(dict)
}

/// Returns rows of nodes as an array.
pub fn rows_of_nodes<'py, D: Dim>(
    py: Python<'py>,
    body: &SoftBody<D>,
    nodes: impl Iterator<Item = NodeId>,
) -> Any<'py> {
    let known = node_rows(body);
    let rows: Vec<i32> = nodes.map(|node| known[node.index()]).collect();
    PyArray1::from_vec(py, rows).into_any()
}
