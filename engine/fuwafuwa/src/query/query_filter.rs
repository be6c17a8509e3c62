//! Selection of the objects that a query considers.

use crate::foundation::arena::SoftBodyHandle;
use crate::foundation::dim::Dim;
use crate::object_ref::{ObjectRef, ObjectSelector};
use crate::rigid_body::RigidState;
use crate::rigid_body::layers::Layers;
use crate::soft_body::SoftBody;
use std::fmt;

/// Selection of the objects that a query considers. By default these are all pieces and all rigid bodies in
/// any layer, except sensors.
///
/// ```
/// use fuwafuwa::{Dim2, QueryFilter, Ray, RigidBody, Shape, Vec2, World, WorldConfig};
///
/// let mut world = World::<Dim2>::new(WorldConfig::default())?;
/// let ball = |x| RigidBody::fixed(Shape::ball(0.5)).at(Vec2::new(x, 0.0));
/// let near = world.add_rigid_body(ball(2.0))?;
/// world.add_rigid_body(ball(4.0))?;
/// let ray = Ray::new(Vec2::ZERO, Vec2::X);
/// let distance = |filter| world.ray_cast(ray, 10.0, filter).map(|hit| hit.distance);
/// assert_eq!(distance(QueryFilter::default()), Some(1.5));
/// assert_eq!(distance(QueryFilter::default().excluding(near)), Some(3.5));
/// assert_eq!(distance(QueryFilter::default().only_soft()), None);
/// # Ok::<(), fuwafuwa::Error>(())
/// ```
#[derive(Clone, Default)]
pub struct QueryFilter<'a> {
    excluded: Vec<ObjectSelector>,
    layers: Option<Layers>,
    kinds: Kinds,
    includes_sensors: bool,
    predicate: Option<&'a dyn Fn(ObjectRef) -> bool>,
}

/// Kinds of objects that a query considers.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
enum Kinds {
    #[default]
    All,
    Rigid,
    Soft,
}

impl<'a> QueryFilter<'a> {
    /// Excludes a rigid body, a piece, or a soft body with all its pieces. Each call adds to the excluded
    /// objects. A stale handle excludes nothing.
    #[must_use]
    pub fn excluding(mut self, object: impl Into<ObjectSelector>) -> Self {
        self.excluded.push(object.into());
        self
    }

    /// Considers only objects whose layers collide with `layers`, see [`Layers::meet`].
    #[must_use]
    pub fn layers(mut self, layers: Layers) -> Self {
        self.layers = Some(layers);
        self
    }

    /// Considers only rigid bodies. Cancels an earlier [`QueryFilter::only_soft`].
    #[must_use]
    pub fn only_rigid(mut self) -> Self {
        self.kinds = Kinds::Rigid;
        self
    }

    /// Considers only soft bodies. Cancels an earlier [`QueryFilter::only_rigid`].
    #[must_use]
    pub fn only_soft(mut self) -> Self {
        self.kinds = Kinds::Soft;
        self
    }

    /// Includes sensors, which queries ignore by default.
    #[must_use]
    pub fn including_sensors(mut self) -> Self {
        self.includes_sensors = true;
        self
    }

    /// Considers only objects for which `predicate` returns true. A query may call `predicate` several times
    /// for an object, and in any order, so it should be cheap and without side effects. The predicate may
    /// itself query the world.
    #[must_use]
    pub fn with_predicate(mut self, predicate: &'a dyn Fn(ObjectRef) -> bool) -> Self {
        self.predicate = Some(predicate);
        self
    }

    /// Returns whether a rigid body has a kind, sensor flag and layers that the filter accepts. Exclusions
    /// and the predicate are tested by [`QueryFilter::admits`].
    pub(super) fn admits_rigid(&self, rigid: &RigidState) -> bool {
        self.kinds != Kinds::Soft
            && (self.includes_sensors || !rigid.is_sensor)
            && self.meets(rigid.layers)
    }

    /// Returns whether the filter accepts the kind and layers of a soft body and does not exclude the whole
    /// body. Each piece is tested by [`QueryFilter::admits`].
    pub(super) fn admits_body<D: Dim>(&self, id: SoftBodyHandle, body: &SoftBody<D>) -> bool {
        self.kinds != Kinds::Rigid
            && !self.excluded.contains(&ObjectSelector::SoftBody(id))
            && self.meets(body.layers())
    }

    /// Returns whether an object is neither excluded nor rejected by the predicate. Kind, sensor flag and
    /// layers must be tested before, by [`QueryFilter::admits_rigid`] or [`QueryFilter::admits_body`].
    pub(super) fn admits(&self, object: ObjectRef) -> bool {
        !self.excluded.iter().any(|own| own.contains(object))
            && self.predicate.is_none_or(|predicate| predicate(object))
    }

    fn meets(&self, layers: Layers) -> bool {
        self.layers.is_none_or(|own| own.meet(layers))
    }
}

impl fmt::Debug for QueryFilter<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("QueryFilter")
            .field("excluded", &self.excluded)
            .field("layers", &self.layers)
            .field("kinds", &self.kinds)
            .field("includes_sensors", &self.includes_sensors)
            .field("has_predicate", &self.predicate.is_some())
            .finish()
    }
}
