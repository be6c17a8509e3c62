//! Reasons why a request failed.

use bevy_ecs::component::Component;
use fuwafuwa::{BodyError, BuildError, Refused};
use std::fmt;

/// Reason why a request failed.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// The voxel grid is invalid.
    Grid(BuildError),
    /// The body is invalid.
    Body(BodyError),
    /// The engine refused the operation.
    World(Refused),
    /// The asset of the shape could not be loaded or was removed.
    Asset(String),
    /// The `Transform` is invalid.
    Pose(&'static str),
    /// The entity is already another body.
    Twice,
}

/// Marks an entity that did not enter the world, with the reason. Insert the body component again after
/// correcting the problem.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct Rejected(pub Problem);

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Grid(error) => error.fmt(f),
            Self::Body(error) => error.fmt(f),
            Self::World(error) => error.fmt(f),
            Self::Asset(error) => write!(f, "cannot load the shape: {error}"),
            Self::Pose(error) => write!(f, "invalid transform: it must {error}"),
            Self::Twice => write!(f, "the entity already has a soft or rigid body"),
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
