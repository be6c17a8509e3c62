//! Queries: filters from keyword arguments, and results as dicts.

use crate::convert::{Any, named, vector_array};
use crate::error::invalid_parameter;
use crate::handle::{object, selector};
use crate::rigid_body::layers;
use fuwafuwa::{Dim, QueryFilter, QueryHit, QueryOverlap};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Kinds of objects that a query can be restricted to.
#[derive(Copy, Clone)]
enum Kind {
    Soft,
    Rigid,
}

/// Checks the largest distance of a query: the engine finds nothing within a distance that is not a number.
pub fn check_distance(max_distance: f32) -> PyResult<()> {
    match max_distance >= 0.0 {
        true => Ok(()),
        false => Err(invalid_parameter(
            "max_distance",
            "0 or more",
            format!("{max_distance:?}"),
        )),
    }
}

/// Returns a filter from the keyword arguments of a query.
pub fn filter(
    exclude: Option<&Any<'_>>,
    only: Option<&str>,
    layer_masks: Option<(u32, u32)>,
    sensors: bool,
) -> PyResult<QueryFilter<'static>> {
    let mut filter = QueryFilter::default();
    if let Some(exclude) = exclude {
        if let Ok(one) = selector("exclude", exclude) {
            filter = filter.excluding(one);
        } else {
            for one in exclude.try_iter()? {
                filter = filter.excluding(selector("exclude", &one?)?);
            }
        }
    }
    if let Some(only) = only {
        filter = match named(
            "only",
            only,
            &[("soft", Kind::Soft), ("rigid", Kind::Rigid)],
        )? {
            Kind::Soft => filter.only_soft(),
            Kind::Rigid => filter.only_rigid(),
        };
    }
    if let Some(masks) = layer_masks {
        filter = filter.layers(layers(masks));
    }
    Ok(match sensors {
        true => filter.including_sensors(),
        false => filter,
    })
}

/// Returns a hit as a dict.
pub fn hit<'py, D: Dim>(py: Python<'py>, hit: &QueryHit<D>) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("object", object(py, hit.object)?)?;
    dict.set_item("element", hit.element.map(|element| element.id.0))?;
    dict.set_item("material", hit.element.map(|element| element.material))?;
    dict.set_item("point", vector_array(py, hit.point))?;
    dict.set_item("normal", vector_array(py, hit.normal))?;
    dict.set_item("distance", hit.distance)?;
    Ok(dict)
}

/// Returns overlaps as dicts.
pub fn overlaps<'py>(py: Python<'py>, found: &[QueryOverlap]) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for overlap in found {
        let dict = PyDict::new(py);
        dict.set_item("object", object(py, overlap.object)?)?;
        dict.set_item("element", overlap.element.map(|element| element.id.0))?;
        dict.set_item("material", overlap.element.map(|element| element.material))?;
        list.append(dict)?;
    }
    Ok(list)
}
