//! Queries: selections from keyword arguments, and results as dicts.

use crate::convert::{Any, named, vector_array};
use crate::error::{FirstException, invalid_parameter};
use crate::handle::{object, selector};
use crate::rigid_body::LayerMasks;
use fuwafuwa::{Dim, ObjectRef, QueryFilter, QueryHit, QueryOverlap};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Kinds of objects that a query can be restricted to.
#[derive(Copy, Clone)]
enum Kind {
    Soft,
    Rigid,
}

/// Names of the kinds of objects.
const KINDS: [(&str, Kind); 2] = [("soft", Kind::Soft), ("rigid", Kind::Rigid)];

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

/// Keyword arguments by which a query selects objects.
pub struct Selection<'a, 'py> {
    /// Object that is left out, or several.
    pub exclude: Option<&'a Any<'py>>,
    /// Kind of the objects: "soft" or "rigid".
    pub only: Option<&'a str>,
    /// Layers that the objects must meet.
    pub layers: Option<LayerMasks>,
    /// Whether sensors count.
    pub sensors: bool,
    /// Function of Python that returns whether an object counts.
    pub predicate: Option<&'a Any<'py>>,
}

impl Selection<'_, '_> {
    /// Runs a query among the selected objects. An exception of the predicate is raised after the query.
    pub fn run<R>(&self, query: impl FnOnce(QueryFilter<'_>) -> R) -> PyResult<R> {
        let filter = self.filter()?;
        let Some(predicate) = self.predicate else {
            return Ok(query(filter));
        };
        let exception = FirstException::default();
        let counts = |found: ObjectRef| {
            exception.catch(false, || {
                let found = object(predicate.py(), found)?;
                predicate.call1((found,))?.is_truthy()
            })
        };
        let result = query(filter.with_predicate(&counts));
        exception.or(result)
    }

    /// Returns the filter without the predicate.
    fn filter(&self) -> PyResult<QueryFilter<'static>> {
        let mut filter = QueryFilter::default();
        if let Some(exclude) = self.exclude {
            if let Ok(one) = selector("exclude", exclude) {
                filter = filter.excluding(one);
            } else {
                for one in exclude.try_iter()? {
                    filter = filter.excluding(selector("exclude", &one?)?);
                }
            }
        }
        if let Some(only) = self.only {
            filter = match named("only", only, &KINDS)? {
                Kind::Soft => filter.only_soft(),
                Kind::Rigid => filter.only_rigid(),
            };
        }
        if let Some(LayerMasks(layers)) = self.layers {
            filter = filter.layers(layers);
        }
        Ok(match self.sensors {
            true => filter.including_sensors(),
            false => filter,
        })
    }
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
