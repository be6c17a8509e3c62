//! Materials, and the library of published ones.

use crate::convert::{Any, pickled, repr, text, unpickled};
use crate::error::{OrInvalid, invalid, invalid_parameter};
use fuwafuwa::library::{self, LibraryMaterial};
use fuwafuwa::{Damping, PronyTerm, RateToughening, StrengthCriterion, StressLaw};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList, PyTuple};

/// Names of all fields, in the order of the constructor.
const FIELDS: [&str; 16] = [
    "young",
    "poisson",
    "stress_law",
    "prony",
    "density",
    "mass_damping",
    "stiffness_damping",
    "friction",
    "rolling_resistance",
    "strength",
    "hydrostatic_strength",
    "strength_scatter",
    "toughness",
    "rate_toughening",
    "yield_strain",
    "plastic_limit",
];

/// Material of a voxel. Materials cannot be changed; `replace` returns a changed copy.
///
/// Fields, all of them keyword arguments:
///
/// - young: Young's modulus [Pa], default 5000
/// - poisson: Poisson's ratio, 0 to 0.49, default 0.3
/// - stress_law: "corotational" (default), "neo_hookean", or ("yeoh", C2 / C1, C3 / C1)
/// - prony: viscoelasticity, up to two pairs (ratio to the shear modulus at rest, relaxation time [s]), default ()
/// - density [kg/m³], default 100; in 2D that of a sheet 1 m deep
/// - mass_damping [1/s], default 4, and stiffness_damping [s], default 2e-4: Rayleigh damping
/// - friction: Coulomb coefficient between soft surfaces, 0 to 2, default 0.4
/// - rolling_resistance of pieces of one voxel [1/s], 0 to 1000, default 20
/// - strength: tensile strength of a smooth surface [Pa], default 1000; infinite = no crack starts
/// - hydrostatic_strength [Pa]: if given, the criterion of Drucker and Prager decides and cracks start inside, too;
///   None (default) = the greatest tension decides
/// - strength_scatter: largest relative amount by which the strength of a point is raised, 0 to 10, default 0.4
/// - toughness: fracture toughness [Pa √m], default 150; infinite = cracks do not grow
/// - rate_toughening: (speed [m/s], exponent) of the growth of the fracture energy with the speed of a crack;
///   None (default) = no growth
/// - yield_strain: strain beyond which the deformation is permanent; infinite (default) = elastic
/// - plastic_limit: largest factor by which a width can shrink permanently, 1 to 4, default 2
#[pyclass(frozen, eq, from_py_object, module = "fuwafuwa")]
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Material(pub fuwafuwa::Material);

impl Material {
    /// Returns a material with other values of some fields.
    fn with_fields(&self, caller: &str, fields: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut material = self.0;
        for (name, value) in fields.into_iter().flat_map(|fields| fields.iter()) {
            let name: String = name.extract()?;
            if !FIELDS.contains(&name.as_str()) {
                let text = format!("{caller}() got an unexpected keyword argument '{name}'");
                return Err(PyTypeError::new_err(text));
            }
            set_field(&mut material, &name, &value)?;
        }
        material.check().or_invalid()?;
        Ok(Self(material))
    }
}

/// Sets a field of a material.
fn set_field(material: &mut fuwafuwa::Material, name: &str, value: &Any<'_>) -> PyResult<()> {
    let wrong = |expected: &str| invalid_parameter(name, expected, repr(value));
    let number = || value.extract().map_err(|_: PyErr| wrong("a number"));
    let double = || value.extract().map_err(|_: PyErr| wrong("a number"));
    match name {
        "young" => material.elasticity.young = double()?,
        "poisson" => material.elasticity.poisson = double()?,
        "stress_law" => {
            let expected = "\"corotational\", \"neo_hookean\" or (\"yeoh\", C2 / C1, C3 / C1)";
            material.stress_law = stress_law(value).ok_or_else(|| wrong(expected))?;
        }
        "prony" => {
            let expected = "at most 2 pairs of ratio and relaxation time in s";
            let terms: Vec<(f32, f32)> = value.extract().map_err(|_: PyErr| wrong(expected))?;
            if terms.len() > 2 {
                return Err(wrong(expected));
            }
            material.prony = [PronyTerm::NONE; 2];
            for (place, (ratio, time)) in material.prony.iter_mut().zip(terms) {
                *place = PronyTerm::new(ratio, time);
            }
        }
        "density" => material.density = number()?,
        "mass_damping" => material.damping.mass = number()?,
        "stiffness_damping" => material.damping.stiffness = number()?,
        "friction" => material.friction = number()?,
        "rolling_resistance" => material.rolling_resistance = number()?,
        "strength" => material.strength = number()?,
        "hydrostatic_strength" => {
            let hydrostatic: Option<f32> = value
                .extract()
                .map_err(|_: PyErr| wrong("a number or None"))?;
            material.strength_criterion = match hydrostatic {
                Some(hydrostatic) => StrengthCriterion::DruckerPrager { hydrostatic },
                None => StrengthCriterion::GreatestTension,
            };
        }
        "strength_scatter" => material.strength_scatter = number()?,
        "toughness" => material.toughness = number()?,
        "rate_toughening" => {
            let expected = "None or a pair of speed in m/s and exponent";
            let pair: Option<(f32, f32)> = value.extract().map_err(|_: PyErr| wrong(expected))?;
            material.rate_toughening = match pair {
                Some((speed, exponent)) => RateToughening { speed, exponent },
                None => RateToughening::NONE,
            };
        }
        "yield_strain" => material.yield_strain = number()?,
        _ => material.plastic_limit = number()?,
    }
    Ok(())
}

fn stress_law(value: &Any<'_>) -> Option<StressLaw> {
    if let Ok((name, second, third)) = value.extract::<(String, f64, f64)>() {
        return (name == "yeoh").then_some(StressLaw::Yeoh { second, third });
    }
    match text(value)?.as_str() {
        "corotational" => Some(StressLaw::Corotational),
        "neo_hookean" => Some(StressLaw::NeoHookean),
        _ => None,
    }
}

#[pymethods]
impl Material {
    // `1e999` is the literal for infinity that `inspect.signature` understands.
    #[new]
    #[pyo3(
        signature = (**fields),
        text_signature = "(*, young=5000.0, poisson=0.3, stress_law='corotational', prony=(), density=100.0, \
            mass_damping=4.0, stiffness_damping=0.0002, friction=0.4, rolling_resistance=20.0, strength=1000.0, \
            hydrostatic_strength=None, strength_scatter=0.4, toughness=150.0, rate_toughening=None, \
            yield_strain=1e999, plastic_limit=2.0)"
    )]
    fn new(fields: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        Self(fuwafuwa::Material::default()).with_fields("Material", fields)
    }

    /// Returns a material of the library, with other values of some fields. `fuwafuwa.library()` lists the names, and
    /// `fuwafuwa.library_values(name)` the sources. A changed field changes no other one: with another `young`, for
    /// example, the toughness stays and the fracture energy changes.
    #[staticmethod]
    #[pyo3(signature = (name, /, **overrides))]
    fn library(name: &str, overrides: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        Self(find(name)?.material()).with_fields("Material.library", overrides)
    }

    /// Returns soft clay for a game: it keeps the shape into which it is pressed, and does not tear.
    #[staticmethod]
    #[pyo3(signature = (**overrides))]
    fn clay(overrides: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        Self(fuwafuwa::Material::clay()).with_fields("Material.clay", overrides)
    }

    /// Returns the material with other values of some fields.
    #[pyo3(signature = (**overrides))]
    fn replace(&self, overrides: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        self.with_fields("Material.replace", overrides)
    }

    /// Returns all fields by name.
    fn fields<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let fields = PyDict::new(slf.py());
        for name in FIELDS {
            fields.set_item(name, slf.getattr(name)?)?;
        }
        Ok(fields)
    }

    /// Returns the material with the mass damping and the stiffness damping of a damping ratio.
    ///
    /// ratio: the ratio at the frequencies `low` and `high` [Hz]; it is lower between them and higher outside. Without
    /// `high`, mass damping alone gives the ratio at `low`; at other frequencies, the ratio is inversely proportional to
    /// the frequency.
    #[pyo3(signature = (ratio, low, high=None))]
    fn with_damping_ratio(&self, ratio: f32, low: f32, high: Option<f32>) -> PyResult<Self> {
        let damping = match high {
            None => Damping::at(ratio, low),
            Some(high) => Damping::between(ratio, low, high),
        };
        let material = fuwafuwa::Material { damping, ..self.0 };
        material.check().or_invalid()?;
        Ok(Self(material))
    }

    /// Returns the damping ratio of a vibration with a frequency [Hz].
    fn damping_ratio(&self, frequency: f32) -> f32 {
        self.0.damping.ratio(frequency)
    }

    /// Young's modulus [Pa].
    #[getter]
    fn young(&self) -> f64 {
        self.0.elasticity.young
    }

    /// Poisson's ratio.
    #[getter]
    fn poisson(&self) -> f64 {
        self.0.elasticity.poisson
    }

    /// Relation between stress and large strain.
    #[getter]
    fn stress_law<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
        Ok(match self.0.stress_law {
            StressLaw::Corotational => "corotational".into_pyobject(py)?.into_any(),
            StressLaw::NeoHookean => "neo_hookean".into_pyobject(py)?.into_any(),
            StressLaw::Yeoh { second, third } => {
                ("yeoh", second, third).into_pyobject(py)?.into_any()
            }
        })
    }

    /// Terms of the Prony series: pairs of the ratio to the shear modulus at rest and the relaxation time [s].
    #[getter]
    fn prony<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let terms = self.0.prony.iter().filter(|term| **term != PronyTerm::NONE);
        let terms: Vec<(f32, f32)> = terms.map(|term| (term.ratio, term.time)).collect();
        PyTuple::new(py, terms)
    }

    /// Density [kg/m³].
    #[getter]
    fn density(&self) -> f32 {
        self.0.density
    }

    /// Mass damping [1/s]: damps slow vibrations most.
    #[getter]
    fn mass_damping(&self) -> f32 {
        self.0.damping.mass
    }

    /// Stiffness damping [s]: damps fast vibrations most.
    #[getter]
    fn stiffness_damping(&self) -> f32 {
        self.0.damping.stiffness
    }

    /// Coulomb friction coefficient between soft surfaces.
    #[getter]
    fn friction(&self) -> f32 {
        self.0.friction
    }

    /// Decay rate of the angular velocity of pieces of one voxel while they touch something [1/s].
    #[getter]
    fn rolling_resistance(&self) -> f32 {
        self.0.rolling_resistance
    }

    /// Tensile strength of a smooth surface [Pa].
    #[getter]
    fn strength(&self) -> f32 {
        self.0.strength
    }

    /// Hydrostatic strength [Pa]; None if the greatest tension decides.
    #[getter]
    fn hydrostatic_strength(&self) -> Option<f32> {
        match self.0.strength_criterion {
            StrengthCriterion::DruckerPrager { hydrostatic } => Some(hydrostatic),
            _ => None,
        }
    }

    /// Largest relative amount by which the strength of a point is raised.
    #[getter]
    fn strength_scatter(&self) -> f32 {
        self.0.strength_scatter
    }

    /// Fracture toughness in plane strain [Pa √m].
    #[getter]
    fn toughness(&self) -> f32 {
        self.0.toughness
    }

    /// Speed [m/s] and exponent of the growth of the fracture energy with the speed of a crack; None without growth.
    #[getter]
    fn rate_toughening(&self) -> Option<(f32, f32)> {
        let rate = self.0.rate_toughening;
        (rate != RateToughening::NONE).then_some((rate.speed, rate.exponent))
    }

    /// Strain beyond which the deformation is permanent.
    #[getter]
    fn yield_strain(&self) -> f32 {
        self.0.yield_strain
    }

    /// Largest factor by which a width can shrink permanently.
    #[getter]
    fn plastic_limit(&self) -> f32 {
        self.0.plastic_limit
    }

    /// Fracture energy per area of crack in plane strain [J/m²].
    #[getter]
    fn fracture_energy(&self) -> f32 {
        self.0.fracture_energy()
    }

    /// Shear modulus at small strain and at rest [Pa].
    #[getter]
    fn shear_modulus(&self) -> f64 {
        self.0.elasticity.shear_modulus()
    }

    /// Speed of a fast pressure wave [m/s].
    #[getter]
    fn wave_speed(&self) -> f64 {
        self.0.wave_speed()
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let mut parts = Vec::new();
        let usual = Bound::new(slf.py(), Self(fuwafuwa::Material::default()))?;
        for name in FIELDS {
            let value = slf.getattr(name)?;
            if !value.eq(usual.getattr(name)?)? {
                parts.push(format!("{name}={}", value.repr()?));
            }
        }
        Ok(format!("Material({})", parts.join(", ")))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Any<'py>, (Bound<'py, PyBytes>,))> {
        let decode = py.get_type::<Self>().getattr("_decode")?;
        Ok((decode, (pickled(py, &self.0)?,)))
    }

    #[staticmethod]
    fn _decode(state: &[u8]) -> PyResult<Self> {
        let material: fuwafuwa::Material = unpickled(state)?;
        material.check().or_invalid()?;
        Ok(Self(material))
    }
}

fn find(name: &str) -> PyResult<&'static LibraryMaterial> {
    library::find(name).ok_or_else(|| {
        let similar = library::similar_names(name);
        let advice = match similar.is_empty() {
            true => "fuwafuwa.library() lists all names".to_owned(),
            false => format!("similar names are {}", similar.join(", ")),
        };
        invalid(format!("the library has no material {name:?}; {advice}"))
    })
}

/// Returns the names of the materials of the library, for `Material.library`.
#[pyfunction]
#[pyo3(name = "library")]
pub fn library_names() -> Vec<&'static str> {
    library::MATERIALS
        .iter()
        .map(|material| material.name)
        .collect()
}

/// Returns the published values of a material of the library: a list of dicts with the keys quantity, unit, value
/// (two numbers; only the Yeoh law and the rate toughening use the second), spread (lowest and highest published value),
/// temperature [°C], rate [1/s], strain (range of engineering strain of the fit) and source. Values that a source does
/// not give are None.
#[pyfunction]
pub fn library_values<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for value in find(name)?.values {
        let entry = PyDict::new(py);
        entry.set_item("quantity", value.quantity.key())?;
        entry.set_item("unit", value.quantity.unit())?;
        entry.set_item("value", value.value.to_vec())?;
        entry.set_item("spread", value.spread.map(|spread| spread.to_vec()))?;
        entry.set_item("temperature", value.temperature)?;
        entry.set_item("rate", value.rate)?;
        entry.set_item("strain", value.strain.map(|strain| strain.to_vec()))?;
        entry.set_item("source", value.source)?;
        list.append(entry)?;
    }
    Ok(list)
}
