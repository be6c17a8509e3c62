//! Benchmark of fuwafuwa against the soft bodies of [Rapier](https://rapier.rs) 0.36, on the same scenes.
//!
//! A body 1 m wide, made of the same voxels in both engines, falls on a plane. Each frame is timed. The *peak
//! squash* is the largest relative loss of height of the body. A solver with a fixed number of iterations is
//! softer than its material, and the error grows with the resolution. Times are therefore compared at equal
//! peak squash ([`compare_drop`]).
//!
//! # Setup of Rapier
//!
//! Rapier runs on one thread (without its feature `parallel`), with the solver that its documentation calls
//! the cheap one. Everything not listed is Rapier's default.
//!
//! | setting | value | reason |
//! | --- | --- | --- |
//! | cells in 2D | corotational triangles, 2 per voxel | take Young's modulus and Poisson's ratio, and are the fastest cells in 2D |
//! | cells in 3D | 5 tetrahedra per voxel, each with a volume constraint, and springs on their edges | at equal squash a third to a quarter of the time of corotational tetrahedra; Poisson's ratio follows from the spring lattice and is about 0.2 |
//! | damping | none | the material has none; Rapier's default (critical) damping makes the body softer |
//! | iterations over the constraints | 1, 2, 4 or 8 per substep, the fastest of them at equal squash | 4 is Rapier's default; more iterations need fewer substeps |
//! | contact skin | a tenth of a voxel | the pieces of a cut body lie closer than Rapier's default of half a voxel; Rapier adds up to four substeps while the body moves by more than a skin per substep, and the thin skin triggers them in time |
//! | sleep | off for a body in one piece | every timed frame has a moving body |
//! | floor | a half-space | |
//!
//! Two features of Rapier are not used. `simd8` affects only rigid bodies; soft bodies use scalar code. `fem`
//! is an implicit solver that is cheaper in the air but several times slower on the floor, where each contact
//! requires a solve over the whole body.
//!
//! # Measurement
//!
//! Both engines run in one process on one thread, alternating frame by frame. Times are processor times of
//! `World::step` and `PhysicsWorld::step` alone. The reference squash comes from fuwafuwa with as many
//! substeps as the stiffness requires, so that the body is not softened. Then each engine gets the fewest
//! substeps for which its squash exceeds the reference by at most 2 percentage points. fuwafuwa never gets
//! fewer than eight, the minimum of any world. The torn scene has no squash to compare; there fuwafuwa gets
//! as many substeps as its stiffness requires.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
// Allows units in brackets, such as [m], which rustdoc takes for links.
#![allow(rustdoc::broken_intra_doc_links)]

mod mesh;
mod ours;
mod side;
mod squash;
mod tear;
mod world;

use std::fmt;

use fuwafuwa::{Dim2, Dim3, VoxelGrid};

pub use side::EngineResult;
pub use squash::compare_drop;
pub use tear::compare_tear;

use mesh::Simplices;
pub use world::Effort;
use world::{CellModel, Falling, plane, space};

/// Width of the body [m], including empty voxels at the rim.
const WIDTH: f32 = 1.0;
/// Duration of a frame [s].
const FRAME: f32 = 1.0 / 60.0;

/// Scene: a soft disc or ball, 1 m wide, that falls on a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drop {
    /// Number of dimensions: 2 for a disc, 3 for a ball.
    pub dim: u8,
    /// Voxels across the body.
    pub n: usize,
    /// Young's modulus [Pa]; in 2D for a body 1 m thick.
    pub young: f32,
    /// Poisson's ratio, at least 0 and below 0.5. No effect on Rapier in 3D, see the crate documentation.
    pub poisson: f32,
    /// Density [kg/m³].
    pub density: f32,
    /// Initial gap between the body and the plane [m].
    pub height: f32,
    /// Gravitational acceleration [m/s²].
    pub gravity: f32,
    /// Coefficient of friction between the body and the plane, and between pieces of the body.
    pub friction: f32,
    /// Number of frames of 1/60 s.
    pub frames: usize,
    /// Whether bodies may sleep in Rapier. In fuwafuwa bodies may always sleep. A comparison of a body in one
    /// piece ends when that body falls asleep.
    pub sleeps: bool,
}

impl Drop {
    /// Returns the scene of a stiff body (4·10⁵ Pa) that falls 1 m. Its peak squash is 7 to 8 %.
    pub fn stiff(dim: u8, n: usize) -> Self {
        Self {
            dim,
            n,
            young: 4e5,
            poisson: 0.3,
            density: 100.0,
            height: 1.0,
            gravity: 9.81,
            friction: 0.5,
            frames: 300,
            sleeps: false,
        }
    }

    /// Returns the scene of a body as soft as in the game (5000 Pa) that falls gently. Its peak squash is
    /// about 10 %.
    pub fn soft(dim: u8, n: usize) -> Self {
        Self {
            young: 5000.0,
            height: if dim == 2 { 0.15 } else { 0.1 },
            gravity: 1.0,
            ..Self::stiff(dim, n)
        }
    }

    /// Returns the scene of a disc of 5000 Pa that falls 0.2 m. [`compare_tear`] cuts the disc into pieces
    /// first.
    pub fn diced(n: usize) -> Self {
        Self {
            height: 0.2,
            gravity: 9.81,
            frames: 240,
            sleeps: true,
            ..Self::soft(2, n)
        }
    }
}

/// Error of running a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// The engine rejected the grid, the body or an operation on the world.
    Engine(fuwafuwa::Error),
    /// A field of the scene is out of range.
    Scene {
        /// Name of the field.
        field: &'static str,
        /// Expected range.
        expected: &'static str,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Engine(error) => error.fmt(formatter),
            Error::Scene { field, expected } => {
                write!(formatter, "invalid scene: `{field}` must be {expected}")
            }
        }
    }
}

impl std::error::Error for Error {}

impl From<fuwafuwa::Error> for Error {
    fn from(error: fuwafuwa::Error) -> Self {
        Error::Engine(error)
    }
}

/// Result of running a scene.
pub type Result<T> = std::result::Result<T, Error>;

/// Builds the scene in Rapier, with the given solver effort.
fn theirs(scene: &Drop, effort: Effort) -> Result<Box<dyn Falling>> {
    if scene.dim == 2 {
        return Ok(Box::new(disc(scene, effort)?));
    }
    scene.check()?;
    let mesh = Simplices::tetrahedra(&VoxelGrid::<Dim3>::ball(scene.n, WIDTH)?);
    let law = CellModel::springs(scene, mesh.voxel_size);
    Ok(Box::new(space::World::new(&mesh, scene, effort, law)))
}

fn disc(scene: &Drop, effort: Effort) -> Result<plane::World> {
    scene.check()?;
    let mesh = Simplices::triangles(&VoxelGrid::<Dim2>::ball(scene.n, WIDTH)?);
    let law = CellModel::Corotational;
    Ok(plane::World::new(&mesh, scene, effort, law))
}

/// Builds the scene in fuwafuwa, with `substeps` substeps or, for `None`, with as many as its stiffness
/// requires.
fn ours(scene: &Drop, substeps: Option<usize>) -> Result<Box<dyn Falling>> {
    scene.check()?;
    Ok(match scene.dim {
        2 => Box::new(ours::world::<Dim2>(scene, substeps)?),
        _ => Box::new(ours::world::<Dim3>(scene, substeps)?),
    })
}

impl Drop {
    fn check(&self) -> Result<()> {
        let positive = |value: f32| value > 0.0 && value.is_finite();
        let not_negative = |value: f32| value >= 0.0 && value.is_finite();
        let above_zero = "above 0 and finite";
        let from_zero = "0 or more, and finite";
        for (field, holds, expected) in [
            ("young", positive(self.young), above_zero),
            ("density", positive(self.density), above_zero),
            ("gravity", positive(self.gravity), above_zero),
            ("height", not_negative(self.height), from_zero),
            ("friction", not_negative(self.friction), from_zero),
            (
                "poisson",
                (0.0..0.5).contains(&self.poisson),
                "from 0 to below 0.5",
            ),
            ("dim", (2..=3).contains(&self.dim), "2 or 3"),
            ("frames", self.frames > 0, "at least 1"),
        ] {
            if !holds {
                return Err(Error::Scene { field, expected });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_scene_is_refused_with_field_name() {
        let scene = Drop {
            poisson: 0.5,
            ..Drop::stiff(2, 8)
        };
        let error = ours(&scene, None).err().expect("a Poisson's ratio of 0.5");
        assert_eq!(
            error.to_string(),
            "invalid scene: `poisson` must be from 0 to below 0.5"
        );
        assert_eq!(theirs(&scene, Effort::default()).err(), Some(error));
        let empty = Drop::stiff(3, 0);
        let refused = Some(Error::Engine(fuwafuwa::Error::EmptyGrid));
        assert_eq!(theirs(&empty, Effort::default()).err(), refused);
        assert_eq!(ours(&empty, None).err(), refused);
    }
}
