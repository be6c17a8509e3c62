//! Spatial queries that return entities.

use crate::convert::{bevy_vector, engine_vector};
use crate::dimension::Dimension;
use crate::world::SoftWorld;
use bevy_ecs::change_detection::Res;
use bevy_ecs::entity::Entity;
use bevy_ecs::system::SystemParam;
use bevy_math::Vec3;
use fuwafuwa::{Error, ObjectRef, PieceId, QueryFilter, Ray, Shape};

/// Spatial queries on the current state. After a change, the first query visits the exposed faces of the
/// bodies that moved; further queries are cheap.
#[derive(SystemParam)]
pub struct SoftQueries<'w, D: Dimension> {
    world: Res<'w, SoftWorld<D>>,
}

/// Result of a query.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct QueryHit {
    /// Entity of the hit body; `None` if this body has no entity.
    pub entity: Option<Entity>,
    /// Piece of a soft body; `None` for a rigid body.
    pub piece: Option<PieceId>,
    /// Position on the surface, world space [m].
    pub point: Vec3,
    /// Outward unit normal.
    pub normal: Vec3,
    /// Distance from the origin of the ray, or from the given point [m].
    pub distance: f32,
}

impl<D: Dimension> SoftQueries<'_, D> {
    /// Returns the first surface hit by a ray within `max_distance` [m], which may be infinite. Returns `None`
    /// if the direction has length 0 or a value is not finite.
    pub fn ray_cast(
        &self,
        origin: Vec3,
        direction: Vec3,
        max_distance: f32,
        filter: QueryFilter<'_>,
    ) -> Option<QueryHit> {
        let ray = Ray::new(engine_vector(origin), engine_vector(direction));
        let hit = self.world.engine().ray_cast(ray, max_distance, filter)?;
        Some(self.hit(hit))
    }

    /// Returns the closest point of any surface within `max_distance` [m], also for a point inside a body.
    /// Returns `None` if no surface is that close.
    pub fn closest_point(
        &self,
        point: Vec3,
        max_distance: f32,
        filter: QueryFilter<'_>,
    ) -> Option<QueryHit> {
        let engine = self.world.engine();
        let hit = engine.closest_point(engine_vector(point), max_distance, filter)?;
        Some(self.hit(hit))
    }

    /// Returns the entities with a body that overlaps a shape, each once, sorted.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the shape is not [valid](Shape::check).
    pub fn overlaps(
        &self,
        shape: &Shape<D>,
        filter: QueryFilter<'_>,
    ) -> Result<Vec<Entity>, Error> {
        let found = self.world.engine().overlaps(shape, filter)?.into_iter();
        let entities = found.filter_map(|found| self.entity(found.object));
        let mut entities: Vec<Entity> = entities.collect();
        entities.sort();
        entities.dedup();
        Ok(entities)
    }

    /// Returns the entity of an object of the engine; `None` if the object has no entity.
    pub fn entity(&self, object: ObjectRef) -> Option<Entity> {
        match object {
            ObjectRef::RigidBody(rigid) => self.world.entity_of_rigid_body(rigid),
            ObjectRef::Piece { body, .. } => self.world.entity_of_soft_body(body),
        }
    }

    fn hit(&self, hit: fuwafuwa::QueryHit<D>) -> QueryHit {
        QueryHit {
            entity: self.entity(hit.object),
            piece: hit.object.piece(),
            point: bevy_vector(hit.point),
            normal: bevy_vector(hit.normal),
            distance: hit.distance,
        }
    }
}
