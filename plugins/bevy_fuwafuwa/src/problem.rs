//! Reasons why a request failed.

use bevy_ecs::component::Component;
use fuwafuwa::Error;
use std::fmt;

/// Reason why a request failed.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// The engine rejects the grid, the body or the operation.
    Engine(Error),
    /// The asset of the shape could not be loaded or was removed.
    Asset(String),
    /// The `Transform` is invalid. The text completes the sentence "the transform must …".
    InvalidTransform(&'static str),
    /// The entity already has a soft or rigid body.
    DuplicateBody,
}

/// Marks an entity that did not enter the world, with the reason. Insert the body component again after
/// correcting the problem.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct Rejected(pub Problem);

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Engine(error) => error.fmt(f),
            Self::Asset(error) => write!(f, "cannot load the shape: {error}"),
            Self::InvalidTransform(error) => write!(f, "invalid transform: it must {error}"),
            Self::DuplicateBody => write!(f, "the entity already has a soft or rigid body"),
        }
    }
}

impl std::error::Error for Problem {}

impl From<Error> for Problem {
    fn from(error: Error) -> Self {
        Self::Engine(error)
    }
}
