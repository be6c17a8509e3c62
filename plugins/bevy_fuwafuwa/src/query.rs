//! Spatial queries that return entities.

use crate::dimension::Dimension;
use crate::world::SoftWorld;
use bevy_ecs::change_detection::Res;
use bevy_ecs::entity::Entity;
use bevy_ecs::system::SystemParam;
use bevy_math::Vec3;
use fuwafuwa::{PieceId, Queries, Shape, Thing};

/// Spatial queries on the current state. Each query first gathers all bare faces; use [`SoftQueries::engine`]
/// for many queries at the same time.
#[derive(SystemParam)]
pub struct SoftQueries<'w, D: Dimension> {
    world: Res<'w, SoftWorld<D>>,
}

/// Result of a query.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct QueryHit {
    /// Entity of the body; `None` if the body has none.
    pub entity: Option<Entity>,
    /// Piece of a soft body; `None` for a rigid body.
    pub piece: Option<PieceId>,
    /// Position, world space [m].
    pub at: Vec3,
    /// Outward unit normal.
    pub normal: Vec3,
    /// Distance from the start of the query [m].
    pub distance: f32,
}

impl<D: Dimension> SoftQueries<'_, D> {
    /// Returns the first surface hit by a ray within the distance `most` [m], which may be infinite. Returns
    /// `None` if the direction has length 0 or a value is not finite.
    pub fn ray(&self, from: Vec3, direction: Vec3, most: f32) -> Option<QueryHit> {
        let found = self
            .engine()
            .ray(from.into(), direction.into(), most, &|_| true)?;
        Some(self.hit(found))
    }

    /// Returns the nearest point of any surface within the distance `most` [m].
    pub fn nearest(&self, at: Vec3, most: f32) -> Option<QueryHit> {
        let found = self.engine().nearest(at.into(), most, &|_| true)?;
        Some(self.hit(found))
    }

    /// Returns the entities that overlap a shape, each once, sorted.
    pub fn overlapping(&self, shape: &Shape) -> Vec<Entity> {
        let things = self.engine().overlapping(shape).into_iter();
        let mut entities: Vec<Entity> = things.filter_map(|thing| self.entity(thing)).collect();
        entities.sort();
        entities.dedup();
        entities
    }

    /// Returns the engine's query object, which serves many queries at the same time.
    pub fn engine(&self) -> Queries<'_, D> {
        Queries::new(self.world.engine())
    }

    /// Returns the entity of an object found by the engine.
    pub fn entity(&self, thing: Thing) -> Option<Entity> {
        match thing {
            Thing::RigidBody(rigid) => self.world.entity_of_rigid(rigid),
            Thing::Soft { body, .. } => self.world.entity_of_body(body),
        }
    }

    fn hit(&self, found: fuwafuwa::QueryHit) -> QueryHit {
        let piece = match found.thing {
            Thing::Soft { piece, .. } => Some(piece),
            Thing::RigidBody(_) => None,
        };
        QueryHit {
            entity: self.entity(found.thing),
            piece,
            at: found.at.into(),
            normal: found.normal.into(),
            distance: found.distance,
        }
    }
}
