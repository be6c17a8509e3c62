//! Python package of the soft-body engine fuwafuwa: the compiled module `fuwafuwa._core`.
//!
//! Each class exists in 2D and in 3D. A macro in the file of the class writes both; what they do is generic over the
//! dimension. Modules in reading order:
//! - `error`, `convert`, `file`: exceptions, vectors and arrays, files
//! - `handle`, `material`, `shape`, `grid`, `rigid_body`, `joint`: values
//! - `event`, `query`, `picture`: results
//! - `body_arrays`, `soft_body`, `rigid_view`: bodies, in and outside of a world
//! - `world`, `scene`: the simulated world, and worlds as text
//! - `game`: rounds of the game for learning programs
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // brackets hold units, such as [m]

mod body_arrays;
mod convert;
mod error;
mod event;
mod file;
mod game;
mod grid;
mod handle;
mod joint;
mod material;
mod picture;
mod query;
mod rigid_body;
mod rigid_view;
mod scene;
mod shape;
mod soft_body;
mod world;

use pyo3::prelude::*;

/// Compiled part of the package `fuwafuwa`.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("Error", module.py().get_type::<error::Error>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<handle::SoftBodyHandle>()?;
    module.add_class::<handle::RigidBodyHandle>()?;
    module.add_class::<handle::JointHandle>()?;
    module.add_class::<handle::KnifeHandle>()?;
    module.add_class::<handle::GripHandle>()?;
    module.add_class::<material::Material>()?;
    module.add_class::<shape::Shape2>()?;
    module.add_class::<shape::Shape3>()?;
    module.add_class::<grid::VoxelGrid2>()?;
    module.add_class::<grid::VoxelGrid3>()?;
    module.add_class::<rigid_body::RigidBody2>()?;
    module.add_class::<rigid_body::RigidBody3>()?;
    module.add_class::<joint::Joint2>()?;
    module.add_class::<joint::Joint3>()?;
    module.add_class::<soft_body::SoftBody2>()?;
    module.add_class::<soft_body::SoftBody3>()?;
    module.add_class::<soft_body::SoftBodyView2>()?;
    module.add_class::<soft_body::SoftBodyView3>()?;
    module.add_class::<rigid_view::RigidBodyView2>()?;
    module.add_class::<rigid_view::RigidBodyView3>()?;
    module.add_class::<event::StepReport>()?;
    module.add_class::<world::World2>()?;
    module.add_class::<world::World3>()?;
    module.add_class::<scene::Scene>()?;
    module.add_function(wrap_pyfunction!(material::library_names, module)?)?;
    module.add_function(wrap_pyfunction!(material::library_values, module)?)?;
    // `setattr` keeps private names out of `__all__`.
    module.setattr("_gif", wrap_pyfunction!(picture::gif, module)?)?;
    module.setattr("_Rounds", module.py().get_type::<game::Rounds>())?;
    module.setattr(
        "_network",
        wrap_pyfunction!(game::network::network, module)?,
    )?;
    module.setattr("_level_names", wrap_pyfunction!(game::level_names, module)?)?;
    module.setattr(
        "_verify_replay",
        wrap_pyfunction!(game::verify_replay, module)?,
    )?;
    Ok(())
}
