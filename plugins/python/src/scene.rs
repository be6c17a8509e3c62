//! Scenes: worlds as text.

use crate::convert::{Any, rows};
use crate::error::{OrInvalid, invalid};
use crate::material::Material;
use crate::world::{World2, World3};
use fuwafuwa::{Dim, Dim2, Dim3, World};
use fuwafuwa_scenes::disk::{open_scene, reader_in};
use fuwafuwa_scenes::scene::NAMED;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::path::PathBuf;

/// World as text, in the format of the scene files of fuwafuwa.
#[pyclass(frozen, module = "fuwafuwa")]
pub struct Scene {
    scene: fuwafuwa_scenes::Scene,
    name: String,
}

impl Scene {
    /// Returns a scene that builds a world.
    pub fn of_world<D: Dim>(world: &World<D>) -> PyResult<Self> {
        let scene = fuwafuwa_scenes::Scene::of_world(world).or_invalid()?;
        let name = "world".to_owned();
        Ok(Self { scene, name })
    }
}

#[pymethods]
impl Scene {
    /// Reads a scene from a file, with the files that it names, or opens a built-in scene by name. `changes` replace
    /// values, for example "material.young=9000".
    #[staticmethod]
    #[pyo3(signature = (path, changes=Vec::new()), text_signature = "(path, changes=())")]
    fn read(path: PathBuf, changes: Vec<String>) -> PyResult<Self> {
        let name = path
            .to_str()
            .ok_or_else(|| invalid("the path is not valid Unicode"))?;
        let scene = open_scene(name, &changes).or_invalid()?;
        Ok(Self {
            scene,
            name: name.to_owned(),
        })
    }

    /// Reads a scene from its text. name: for error texts; folder: where the files are that the scene names.
    #[staticmethod]
    #[pyo3(
        signature = (text, changes=Vec::new(), *, name="scene", folder=None),
        text_signature = "(text, changes=(), *, name='scene', folder=None)"
    )]
    fn from_text(
        text: &str,
        changes: Vec<String>,
        name: &str,
        folder: Option<PathBuf>,
    ) -> PyResult<Self> {
        let mut scene = fuwafuwa_scenes::Scene::read(name, text, &changes).or_invalid()?;
        if let Some(folder) = folder {
            scene.embed_files(&reader_in(&folder)).or_invalid()?;
        }
        Ok(Self {
            scene,
            name: name.to_owned(),
        })
    }

    /// Returns the names of the built-in scenes.
    #[staticmethod]
    fn names() -> Vec<&'static str> {
        NAMED.iter().map(|(name, _)| *name).collect()
    }

    /// Builds the world: a World2 or a World3, as `dim` says.
    fn build<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
        let scene = &self.scene;
        Ok(match scene.dim {
            2 => {
                let world = py.detach(|| scene.build::<Dim2>()).or_invalid()?;
                World2::from(world).into_pyobject(py)?.into_any()
            }
            _ => {
                let world = py.detach(|| scene.build::<Dim3>()).or_invalid()?;
                World3::from(world).into_pyobject(py)?.into_any()
            }
        })
    }

    /// Returns the text of the scene. `from_text` reads it again.
    fn text(&self) -> PyResult<String> {
        self.scene.text().or_invalid()
    }

    /// Number of dimensions: 2 or 3.
    #[getter]
    fn dim(&self) -> u8 {
        self.scene.dim
    }

    /// Duration [s].
    #[getter]
    fn seconds(&self) -> f32 {
        self.scene.seconds
    }

    /// Duration in ticks.
    #[getter]
    fn ticks(&self) -> u64 {
        self.scene.ticks()
    }

    /// Materials of the scene, number 1 first.
    #[getter]
    fn materials(&self) -> Vec<Material> {
        self.scene.materials().into_iter().map(Material).collect()
    }

    /// Notes of the importers of pictures and models on what was left out or may surprise.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.scene.notes().iter().map(ToString::to_string).collect()
    }

    /// Returns the target of each hand at a tick [m]: float32 array (hands, d).
    fn hand_targets<'py>(&self, py: Python<'py>, tick: u64) -> Any<'py> {
        let count = usize::from(self.scene.dim);
        let targets = self.scene.hand_targets(tick);
        let numbers = targets.iter().flat_map(|target| &target[..count]).copied();
        rows(py, count, numbers.collect()).into_any()
    }

    /// Sets the targets of the hands of a world that this scene has built to those at a tick.
    fn set_hand_targets(&self, world: &Any<'_>, tick: u64) -> PyResult<()> {
        if let (Ok(world), 2) = (world.cast::<World2>(), self.scene.dim) {
            self.scene
                .set_hand_targets(&mut world.try_borrow_mut()?.world, tick);
        } else if let (Ok(world), 3) = (world.cast::<World3>(), self.scene.dim) {
            self.scene
                .set_hand_targets(&mut world.try_borrow_mut()?.world, tick);
        } else {
            let expected = format!("set_hand_targets() takes a World{}", self.scene.dim);
            return Err(PyTypeError::new_err(expected));
        }
        Ok(())
    }

    fn __repr__(&self) -> String {
        format!("<Scene {:?} in {}D>", self.name, self.scene.dim)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Any<'py>, (String,))> {
        Ok((py.get_type::<Self>().getattr("from_text")?, (self.text()?,)))
    }
}
