//! fuwafuwa beside the soft bodies of [Rapier](https://rapier.rs) 0.36, on the same scenes.
//!
//! A body 1 m wide, made of the same voxels as fuwafuwa's, falls on a plane. The time of every frame is taken, and the
//! *peak squash*, how flat the body gets: a solver with a fixed number of iterations is softer than its material
//! says, and the more so the finer the body, so that times compare only where the squash is the same
//! ([`compare_drop`]).
//!
//! # How Rapier is set up
//!
//! On one thread (without its feature `parallel`), with the solver that its documentation calls the cheap one.
//! Everything not listed is Rapier's default.
//!
//! | setting | is | because |
//! | --- | --- | --- |
//! | cells in 2D | corotational triangles, 2 a voxel | take Young's modulus and Poisson's ratio, and cost the least there |
//! | cells in 3D | 5 tetrahedra a voxel, each a volume constraint, and springs on their edges | at equal squash a third to a quarter of the time of corotational tetrahedra; Poisson's ratio then follows from the lattice of springs and is about 0.2 |
//! | damping | none | the material has none; Rapier's own (critical) damping makes the body softer still |
//! | sweeps over the constraints | 1, 2, 4 or 8 a substep, whichever is fastest at equal squash | 4 is Rapier's default; the more sweeps, the fewer substeps it needs |
//! | contact skin | a tenth of a voxel | the pieces of a cut body lie closer than Rapier's half voxel; and Rapier adds up to four substeps by itself while the body hits faster than a skin a substep: with the thin skin it does so in time, and the median frame at equal squash takes 20 to 50 % less than without the additions |
//! | sleep | off for a body in one piece | every frame is a frame of a moving body |
//! | floor | a half-space | |
//!
//! Two features of Rapier are left out: `simd8`, since only its rigid bodies are solved several lanes at a time (four,
//! without being asked) and its soft bodies by scalar code, whose times `-C target-cpu=native` did not change either; and
//! `fem`, an implicit solver that is cheaper in the air but far dearer on the floor, where each contact costs a solve
//! over the whole body. At 7 to 9 % of squash and with 32 voxels in 2D a frame on the floor took it 41 ms, against 10;
//! with 64 voxels 390 ms, against 70.
//!
//! # How it is measured
//!
//! Both engines run in one process, on one thread, a frame of the one and a frame of the other in turns. Times are
//! processor time of `World::step` and `PhysicsWorld::step` alone. How deep a body should be squashed is found with as many
//! substeps of fuwafuwa as its stiffness asks for, so that it is not softened. Then each engine gets as few as it can do
//! with and not be squashed more than 2 percentage points deeper; fuwafuwa no fewer than the eight that any world has, and in
//! the torn scene, where there is no squash to compare, as many as its stiffness asks for.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
// Units stand in brackets: [m].
#![allow(rustdoc::broken_intra_doc_links)]

mod mesh;
mod ours;
mod side;
mod squash;
mod tear;
mod world;

use std::fmt;

use fuwafuwa::world::Refused;
use fuwafuwa::{BodyError, BuildError, Dim2, Dim3, VoxelGrid};

pub use side::Side;
pub use squash::compare_drop;
pub use tear::compare_tear;

use mesh::Simplices;
pub use world::Effort;
use world::{Falling, Law, plane, space};

/// Width of the body [m], empty voxels at the rim included.
const WIDTH: f32 = 1.0;
/// Length of a frame [s].
const FRAME: f32 = 1.0 / 60.0;

/// A soft disc or ball, 1 m wide, that falls on a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drop {
    /// 2 for a disc, 3 for a ball.
    pub dim: u8,
    /// Voxels across the body.
    pub n: usize,
    /// Young's modulus [Pa]; in 2D of a body 1 m thick.
    pub young: f32,
    /// Poisson's ratio, from 0 up to but not including 0.5. Without effect on Rapier's side in 3D, see the crate's
    /// documentation.
    pub poisson: f32,
    /// Density [kg/m³].
    pub density: f32,
    /// Gap between the body and the plane at the start [m].
    pub height: f32,
    /// Acceleration of free fall [m/s²].
    pub gravity: f32,
    /// Coefficient of friction between the body and the plane, and between pieces of the body.
    pub friction: f32,
    /// Frames of 1/60 s to run.
    pub frames: usize,
    /// Whether what rests may fall asleep, on Rapier's side; fuwafuwa always lets it, and a comparison of a body in one
    /// piece ends when it does.
    pub sleeps: bool,
}

impl Drop {
    /// A body of 4·10⁵ Pa falls 1 m, and is squashed by 7 to 8 %.
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

    /// A body as soft as in a game, 5000 Pa, falls gently, from so high that it is squashed by about 10 %.
    pub fn soft(dim: u8, n: usize) -> Self {
        Self {
            young: 5000.0,
            height: if dim == 2 { 0.15 } else { 0.1 },
            gravity: 1.0,
            ..Self::stiff(dim, n)
        }
    }

    /// The soft body falls fast, to be cut into pieces before.
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

/// Why a scene could not be run.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// The voxels of the body could not be made.
    Shape(BuildError),
    /// The body could not be made of them.
    Body(BodyError),
    /// The world refused something.
    World(Refused),
    /// A field of the scene has a value that makes no sense.
    Scene {
        /// Its name.
        field: &'static str,
        /// What would have made sense.
        expected: &'static str,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Shape(error) => write!(formatter, "the body cannot be made: {error}"),
            Error::Body(error) => write!(formatter, "the body cannot be made: {error}"),
            Error::World(error) => write!(formatter, "the world refuses it: {error}"),
            Error::Scene { field, expected } => {
                write!(formatter, "`{field}` of the scene has to be {expected}")
            }
        }
    }
}

impl std::error::Error for Error {}

impl From<BuildError> for Error {
    fn from(error: BuildError) -> Self {
        Error::Shape(error)
    }
}

impl From<BodyError> for Error {
    fn from(error: BodyError) -> Self {
        Error::Body(error)
    }
}

impl From<Refused> for Error {
    fn from(error: Refused) -> Self {
        Error::World(error)
    }
}

/// What a scene gives, or why it could not be run.
pub type Result<T> = std::result::Result<T, Error>;

/// The scene in Rapier.
fn theirs(scene: &Drop, effort: Effort) -> Result<Box<dyn Falling>> {
    if scene.dim == 2 {
        return Ok(Box::new(disc(scene, effort)?));
    }
    scene.check()?;
    let mesh = Simplices::tetrahedra(&VoxelGrid::<Dim3>::ball(scene.n, WIDTH)?);
    let law = Law::springs(scene, mesh.voxel_size);
    Ok(Box::new(space::World::new(&mesh, scene, effort, law)))
}

fn disc(scene: &Drop, effort: Effort) -> Result<plane::World> {
    scene.check()?;
    let mesh = Simplices::triangles(&VoxelGrid::<Dim2>::ball(scene.n, WIDTH)?);
    let law = Law::Corotational;
    Ok(plane::World::new(&mesh, scene, effort, law))
}

/// The scene in fuwafuwa, with so many substeps or as many as its stiffness asks for.
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
    fn a_scene_without_sense_is_refused_by_name() {
        let scene = Drop {
            poisson: 0.5,
            ..Drop::stiff(2, 8)
        };
        let error = ours(&scene, None).err().expect("a Poisson's ratio of 0.5");
        assert_eq!(
            error.to_string(),
            "`poisson` of the scene has to be from 0 to below 0.5"
        );
        assert_eq!(theirs(&scene, Effort::default()).err(), Some(error));
        let empty = Drop::stiff(3, 0);
        let refused = Some(Error::Shape(BuildError::Empty));
        assert_eq!(theirs(&empty, Effort::default()).err(), refused);
        assert_eq!(ours(&empty, None).err(), refused);
    }
}
