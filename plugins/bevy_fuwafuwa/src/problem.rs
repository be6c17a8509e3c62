//! Why something was not done.

use bevy_ecs::component::Component;
use fuwafuwa::{BodyError, BuildError, Refused};
use std::fmt;

/// Why something was not done.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// There is no such voxel grid.
    Grid(BuildError),
    /// There is no such body.
    Body(BodyError),
    /// The world does not take it.
    World(Refused),
    /// The asset of its shape could not be loaded, or is gone.
    Asset(String),
    /// It cannot be put there: what is wrong with its `Transform`.
    Pose(&'static str),
    /// Its entity is something else in a world already.
    Twice,
}

/// Its entity is not in the world, and this is why. Insert the component anew when that is mended.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct Rejected(pub Problem);

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Grid(error) => error.fmt(f),
            Self::Body(error) => error.fmt(f),
            Self::World(error) => error.fmt(f),
            Self::Asset(error) => write!(f, "its shape could not be loaded: {error}"),
            Self::Pose(error) => write!(f, "its transform must {error}"),
            Self::Twice => write!(f, "its entity is something soft or rigid already"),
        }
    }
}

impl std::error::Error for Problem {}

impl From<BuildError> for Problem {
    fn from(error: BuildError) -> Self {
        Self::Grid(error)
    }
}

impl From<BodyError> for Problem {
    fn from(error: BodyError) -> Self {
        Self::Body(error)
    }
}

impl From<Refused> for Problem {
    fn from(error: Refused) -> Self {
        Self::World(error)
    }
}
