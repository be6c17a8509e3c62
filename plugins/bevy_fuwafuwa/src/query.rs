//! What is where, with entities.

use crate::dimension::Dimension;
use crate::world::SoftWorld;
use bevy_ecs::change_detection::Res;
use bevy_ecs::entity::Entity;
use bevy_ecs::system::SystemParam;
use bevy_math::Vec3;
use fuwafuwa::{Found, PieceId, Queries, Shape, Thing};

/// Answers about the world as it is now. Each question looks at all bare faces first; who has many takes
/// [`SoftQueries::engine`], and asks that.
#[derive(SystemParam)]
pub struct SoftQueries<'w, D: Dimension> {
    world: Res<'w, SoftWorld<D>>,
}

/// What was found.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Hit {
    /// Whose it is; none where that has no entity.
    pub entity: Option<Entity>,
    /// Number of the piece, of a soft body.
    pub piece: Option<PieceId>,
    /// Where [m].
    pub at: Vec3,
    /// Out of it, of length 1.
    pub normal: Vec3,
    /// How far it is from where it was looked for [m].
    pub distance: f32,
}

impl<D: Dimension> SoftQueries<'_, D> {
    /// The first surface that a ray meets, no further than `most` [m], which may be infinite. Nothing when the direction
    /// has no length or a number is not finite.
    pub fn ray(&self, from: Vec3, direction: Vec3, most: f32) -> Option<Hit> {
        let found = self
            .engine()
            .ray(from.into(), direction.into(), most, &|_| true)?;
        Some(self.hit(found))
    }

    /// The place on any surface that is nearest, no further than `most` [m].
    pub fn nearest(&self, at: Vec3, most: f32) -> Option<Hit> {
        let found = self.engine().nearest(at.into(), most, &|_| true)?;
        Some(self.hit(found))
    }

    /// The entities that overlap a shape, each once, in no order that means anything but the same each time.
    pub fn overlapping(&self, shape: &Shape) -> Vec<Entity> {
        let things = self.engine().overlapping(shape).into_iter();
        let mut entities: Vec<Entity> = things.filter_map(|thing| self.entity(thing)).collect();
        entities.sort();
        entities.dedup();
        entities
    }

    /// The engine's own, for many questions about the same moment.
    pub fn engine(&self) -> Queries<'_, D> {
        Queries::new(self.world.engine())
    }

    /// The entity of what the engine found.
    pub fn entity(&self, thing: Thing) -> Option<Entity> {
        match thing {
            Thing::RigidBody(rigid) => self.world.entity_of_rigid(rigid),
            Thing::Soft { body, .. } => self.world.entity_of_body(body),
        }
    }

    fn hit(&self, found: Found) -> Hit {
        let piece = match found.thing {
            Thing::Soft { piece, .. } => Some(piece),
            Thing::RigidBody(_) => None,
        };
        Hit {
            entity: self.entity(found.thing),
            piece,
            at: found.at.into(),
            normal: found.normal.into(),
            distance: found.distance,
        }
    }
}
